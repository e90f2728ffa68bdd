// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/random.h"
#include "import/builtin/builtin_table.h"
#include "import/builtin/world_shapes.h"

// A road along x on a stone bridge. Spans of 16 m with segmental arches (4.4 m under the crown)
// cross a road, a river and footpaths; embankments with retaining walls carry it down to the ground
// (about 11 %); a pedestrian underpass pierces the left one; stairs climb along the right one on
// both sides.
namespace throng::importer::builtin {
namespace {

using namespace shapes;

constexpr double kDepth = 60;      // Of the ground, along z.
constexpr double kDeck = 5.2;      // Height of the road.
constexpr double kDeckBegin = 25;  // The deck: z from 25 to 35.
constexpr double kDeckEnd = 35;
constexpr double kParapet = 0.25;
constexpr double kPavement = 1.75;
constexpr double kSpan = 16;
constexpr double kApproach = 6;  // Level road at each end.
constexpr double kFlat = 3;      // Level deck between the last arch and the slope.
constexpr double kBed = -1.6;
constexpr double kWater = -0.7;

struct Plan {
  double size = 160;
  int32_t spans = 3;
  double first = 0;  // x of the first arch.
  [[nodiscard]] double last() const { return first + spans * kSpan; }
  // Height of the road at x.
  [[nodiscard]] double deck(double x) const {
    const double from = first - kFlat;
    const double to = last() + kFlat;
    const double run = from - kApproach;
    const double outside = std::max({from - x, x - to, 0.0});
    return kDeck * std::max(0.0, 1 - outside / run);
  }
  // The river takes the middle third of the spans, the road below the first one.
  [[nodiscard]] bool is_river(int32_t span) const {
    const int32_t third = std::max(1, spans / 3);
    return span >= (spans - third) / 2 && span < (spans - third) / 2 + third;
  }
};

// A piece of masonry along x whose top (and foot) may slope.
void block(WorldBuilder& b, Mat material, double x0, double x1, double z0, double z1,
           std::array<double, 2> foot, std::array<double, 2> top) {
  hexahedron(b, material,
             {{{x0, foot[0], z0},
               {x0, foot[0], z1},
               {x1, foot[1], z1},
               {x1, foot[1], z0},
               {x0, top[0], z0},
               {x0, top[0], z1},
               {x1, top[1], z1},
               {x1, top[1], z0}}});
}

// Half of the clear width is 7 m, springing at 1.2 m, 3.2 m of rise: a circle's segment.
double soffit(double from_middle) {
  constexpr double kHalf = 7;
  constexpr double kRise = 3.2;
  constexpr double kRadius = (kHalf * kHalf + kRise * kRise) / (2 * kRise);
  return 1.2 + kRise - kRadius + std::sqrt(kRadius * kRadius - from_middle * from_middle);
}

void add_arch(WorldBuilder& b, const Plan& p, int32_t span) {
  constexpr int32_t kParts = 14;
  const double x = p.first + span * kSpan;
  const double pier = p.is_river(span) || (span > 0 && p.is_river(span - 1)) ? kBed : 0;
  b.node(fmt::format("arch {}", span));
  block(b, Mat::kStone, x - 1, x + 1, kDeckBegin, kDeckEnd, {pier, pier}, {kDeck, kDeck});
  std::array<uint32_t, 4> last{};
  for (int32_t i = 0; i <= kParts; ++i) {
    const double off = -7 + 14.0 * i / kParts;
    const double at = x + kSpan / 2 + off;
    const double low = soffit(off);
    const std::array<uint32_t, 4> now{
        b.vertex({at, low, kDeckBegin}), b.vertex({at, low, kDeckEnd}),
        b.vertex({at, kDeck, kDeckBegin}), b.vertex({at, kDeck, kDeckEnd})};
    if (i > 0) {
      b.quad(Mat::kStone, last[0], now[0], now[1], last[1]);
      b.quad(Mat::kStone, last[0], last[2], now[2], now[0]);
      b.quad(Mat::kStone, last[1], now[1], now[3], last[3]);
      b.quad(Mat::kStone, last[2], last[3], now[3], now[2]);
    }
    last = now;
  }
}

// The slope from the ground at `outer` to the deck at `inner`, solid, with a tunnel at [t0, t1].
void add_embankment(WorldBuilder& b, const Plan& p, double outer, double inner, double t0,
                    double t1) {
  const auto piece = [&](double x0, double x1, double foot) {
    if (!(x1 > x0)) return;
    block(b, Mat::kStone, x0, x1, kDeckBegin, kDeckEnd, {foot, foot}, {p.deck(x0), p.deck(x1)});
  };
  std::array<double, 6> cuts{outer, outer < inner ? inner - kFlat : inner + kFlat, inner, t0, t1,
                             inner};
  std::sort(cuts.begin(), cuts.end());
  for (size_t i = 0; i + 1 < cuts.size(); ++i) {
    const bool tunnel = cuts[i] >= t0 && cuts[i + 1] <= t1;
    piece(cuts[i], cuts[i + 1], tunnel ? 2.6 : 0);
  }
}

// What lies on the masonry along the whole road: pavements, parapets, with gaps for the stairs.
void add_deck(WorldBuilder& b, const Plan& p, double gap0, double gap1) {
  const std::array<double, 8> all{0,    kApproach,        p.first - kFlat,    gap0,
                                  gap1, p.last() + kFlat, p.size - kApproach, p.size};
  std::vector<double> cuts(all.begin(), all.end());
  std::sort(cuts.begin(), cuts.end());
  for (size_t i = 0; i + 1 < cuts.size(); ++i) {
    const double x0 = cuts[i];
    const double x1 = cuts[i + 1];
    if (!(x1 > x0)) continue;
    const std::array<double, 2> road{p.deck(x0), p.deck(x1)};
    const std::array<double, 2> kerb{road[0] + 0.12, road[1] + 0.12};
    const std::array<double, 2> rail{road[0] + 1.1, road[1] + 1.1};
    block(b, Mat::kPavement, x0, x1, kDeckBegin + kParapet, kDeckBegin + kPavement, road, kerb);
    block(b, Mat::kPavement, x0, x1, kDeckEnd - kPavement, kDeckEnd - kParapet, road, kerb);
    if (x0 >= gap0 && x1 <= gap1) {
      block(b, Mat::kPavement, x0, x1, kDeckBegin, kDeckBegin + kParapet, road, kerb);
      block(b, Mat::kPavement, x0, x1, kDeckEnd - kParapet, kDeckEnd, road, kerb);
    } else if (road[0] + road[1] > 0) {
      block(b, Mat::kStone, x0, x1, kDeckBegin, kDeckBegin + kParapet, road, rail);
      block(b, Mat::kStone, x0, x1, kDeckEnd - kParapet, kDeckEnd, road, rail);
    }
    // Asphalt a finger over the masonry.
    const double z0 = kDeckBegin + kPavement;
    const double z1 = kDeckEnd - kPavement;
    const uint32_t v0 = b.vertex({x0, road[0] + 0.01, z0});
    const uint32_t v1 = b.vertex({x0, road[0] + 0.01, z1});
    const uint32_t v2 = b.vertex({x1, road[1] + 0.01, z1});
    b.quad(Mat::kRoad, v0, v1, v2, b.vertex({x1, road[1] + 0.01, z0}));
  }
}

// Two flights of 15 risers from the ground to the deck's pavement, descending towards +x.
void add_stairs(WorldBuilder& b, double landing0, double landing1, double z) {
  const double top = kDeck + 0.12;
  const double foot = landing1 + 2 * 14 * 0.3 + 1.6;
  Flight f{.x = 0,
           .y = 0,
           .z = 0,
           .width = 2.2,
           .rise = top / 30,
           .run = 0.3,
           .risers = 15,
           .thickness = 0.35};
  b.place({{foot, 0, z + 2.2}, -1, 0});
  flight(b, Mat::kStairs, f);
  const double half = f.length();
  box(b, Mat::kStone, {half, 0, 0}, {half + 1.6, top / 2, 2.2}, kNoBottom);
  for (const double side : {0.05, 2.15}) {
    railing(b, {0, 0, side}, {half, top / 2, side});
    railing(b, {half, top / 2, side}, {half + 1.6, top / 2, side});
    railing(b, {half + 1.6, top / 2, side}, {2 * half + 1.6, top, side});
  }
  f.x = half + 1.6;
  f.y = top / 2;
  flight(b, Mat::kStairs, f);
  b.place({});
  box(b, Mat::kStone, {landing0, 0, z}, {landing1, top, z + 2.2}, kNoBottom);
  const double outside = z < kDeckBegin ? z + 0.05 : z + 2.15;
  railing(b, {landing0, top, outside}, {landing1, top, outside});
  railing(b, {landing0 + 0.05, top, z}, {landing0 + 0.05, top, z + 2.2});
}

void add_ground(WorldBuilder& b, const Plan& p, uint64_t seed) {
  b.node("ground");
  std::vector<Rect> holes;
  for (int32_t span = 0; span < p.spans; ++span) {
    const double x = p.first + span * kSpan;
    if (p.is_river(span)) {
      const bool begins = span == 0 || !p.is_river(span - 1);
      const bool ends = span + 1 == p.spans || !p.is_river(span + 1);
      const Rect river{begins ? x + 2 : x, 0, ends ? x + kSpan - 2 : x + kSpan, kDepth};
      holes.push_back(river);
      floor_rect(b, Mat::kStone, river, kBed);
      floor_rect(b, Mat::kWater, river, kWater);
      if (begins) thin_wall(b, Mat::kStone, river.x0, kDepth, river.x0, 0, kBed, 0);
      if (ends) thin_wall(b, Mat::kStone, river.x1, 0, river.x1, kDepth, kBed, 0);
      for (const double bank : {begins ? river.x0 - 0.1 : -1.0, ends ? river.x1 + 0.1 : -1.0}) {
        if (bank < 0) continue;
        railing(b, {bank, 0, 0}, {bank, 0, kDeckBegin});
        railing(b, {bank, 0, kDeckEnd}, {bank, 0, kDepth});
      }
    } else {
      const double wide = span == 0 ? 8 : 3;
      const Rect passage{x + (kSpan - wide) / 2, 0, x + (kSpan + wide) / 2, kDepth};
      holes.push_back(passage);
      floor_rect(b, span == 0 ? Mat::kRoad : Mat::kPavement, passage, 0);
    }
  }
  for (const double x : {0.0, p.size - kApproach}) {
    const Rect road{x, kDeckBegin + kPavement, x + kApproach, kDeckEnd - kPavement};
    holes.push_back(road);
  }
  floor_with_holes(b, Mat::kGrass, {0, 0, p.size, kDepth}, holes, 0);

  b.node("trees");
  const auto trees = static_cast<uint64_t>(p.size / 4);
  for (uint64_t i = 0; i < trees; ++i) {
    const double x = 3 + (p.size - 6) * random_unit(seed, 1, i);
    const double off = 16 * random_unit(seed, 2, i);
    const double z = i % 2 == 0 ? 2 + off : kDepth - 2 - off;
    const bool on_passage = std::any_of(holes.begin(), holes.end(), [&](const Rect& r) {
      return x > r.x0 - 2.5 && x < r.x1 + 2.5 && z > r.z0 - 2 && z < r.z1 + 2;
    });
    if (!on_passage) tree(b, {x, 0, z}, random_u64(seed, 3, i));
  }
}

}  // namespace

void build_bridge(WorldBuilder& b, const BuiltinWorldConfig& config) {
  Plan p;
  p.size = config.size;
  p.spans = std::max(3, static_cast<int32_t>((p.size - 112) / kSpan));
  p.first = (p.size - p.spans * kSpan) / 2;
  add_ground(b, p, config.seed);
  for (int32_t span = 0; span < p.spans; ++span) add_arch(b, p, span);
  b.node("abutment");
  block(b, Mat::kStone, p.last() - 1, p.last() + 1, kDeckBegin, kDeckEnd, {0, 0}, {kDeck, kDeck});
  b.node("embankments");
  const double tunnel = p.first - kFlat - 9;
  add_embankment(b, p, kApproach, p.first - 1, tunnel, tunnel + 3.5);
  add_embankment(b, p, p.size - kApproach, p.last() + 1, p.last() + 1, p.last() + 1);
  b.node("deck");
  const double gap0 = p.last() + 0.3;
  const double gap1 = p.last() + 2.5;
  add_deck(b, p, gap0, gap1);
  b.node("stairs");
  add_stairs(b, gap0 - 0.2, gap1 + 0.2, kDeckEnd);
  add_stairs(b, gap0 - 0.2, gap1 + 0.2, kDeckBegin - 2.2);
}

}  // namespace throng::importer::builtin
