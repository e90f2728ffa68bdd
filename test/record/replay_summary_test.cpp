// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "core/random.h"
#include "scratch_folder.h"
#include "throng/recording.h"

namespace throng {
namespace {

struct Body {
  uint64_t id = 0;
  Vec3d at;
};
using Film = std::vector<std::pair<double, std::vector<Body>>>;  // time, avatars

Result<ReplaySummary> summary_of(const Film& run, const SummaryConfig& config) {
  const test::ScratchFolder folder;
  const std::string path = folder.path() + "/run.replay";
  auto recorder = Recorder::create(path, {.world = "",
                                          .world_hash = 0,
                                          .dt = 0.1,
                                          .classes = {{.name = "adult"}},
                                          .model = "",
                                          .settings = ""});
  EXPECT_TRUE(recorder);
  uint64_t step = 0;
  for (const auto& [time, bodies] : run) {
    RecordedFrame frame;
    frame.time = time;
    frame.step = step++;
    for (const Body& body : bodies) {
      frame.ids.push_back(body.id);
      frame.positions.push_back(body.at);
    }
    frame.classes.resize(bodies.size());
    frame.radii.resize(bodies.size(), 0.25F);
    frame.headings.resize(bodies.size());
    EXPECT_TRUE(recorder->append(frame.view()));
  }
  EXPECT_TRUE(recorder->finish());
  auto replay = Replay::open(path);
  EXPECT_TRUE(replay);
  Context context;
  return summarise(*replay, config, context);
}

// Whole millimetres, which a recording keeps exactly.
double mm(double v) { return std::round(v * 1000) / 1000; }

// Random walks on two storeys; some stand, some leave for ever or for a while.
Film random_run(uint64_t seed) {
  Film run;
  std::map<uint64_t, Vec3d> here;
  double time = 5;
  uint64_t counter = 0;
  const auto unit = [&] { return random_unit(seed, 1, counter++); };
  for (int32_t f = 0; f < 60; ++f) {
    for (uint64_t id = 0; id < 30; ++id) {
      if (!here.contains(id) && unit() < 0.1) {
        here[id] = {mm(unit() * 10 - 5), unit() < 0.5 ? 0.0 : 3.5, mm(unit() * 8)};
      } else if (here.contains(id) && unit() < 0.03) {
        here.erase(id);
      }
    }
    std::vector<Body> bodies;
    for (auto& [id, at] : here) {
      if (id % 4 != 0) at = {mm(at.x + unit() - 0.5), at.y, mm(at.z + unit() - 0.5)};
      bodies.push_back({id, at});
    }
    run.emplace_back(time, bodies);
    time += f % 3 == 0 ? 0.25 : 0.5;
  }
  return run;
}

const Vec3d* find(const std::vector<Body>& bodies, uint64_t id) {
  for (const Body& body : bodies) {
    if (body.id == id) return &body.at;
  }
  return nullptr;
}

// Do the segments p q and a b cross? By signs of areas: random points never lie on a line.
int32_t crossing(const Vec3d& p, const Vec3d& q, const FlowLine& l) {
  const auto area = [](double ax, double az, double bx, double bz, double cx, double cz) {
    return (bx - ax) * (cz - az) - (bz - az) * (cx - ax);
  };
  const double s = area(l.x0, l.z0, l.x1, l.z1, p.x, p.z),
               t = area(l.x0, l.z0, l.x1, l.z1, q.x, q.z);
  const double u = area(p.x, p.z, q.x, q.z, l.x0, l.z0), v = area(p.x, p.z, q.x, q.z, l.x1, l.z1);
  if (s * t >= 0 || u * v >= 0) return 0;
  return t > 0 ? 1 : -1;
}

TEST(ReplaySummary, CountsWhatBruteForceCounts) {
  uint64_t crossings = 0;
  for (uint64_t seed = 1; seed <= 10; ++seed) {
    const Film run = random_run(seed);
    SummaryConfig config{.lines = {{-4, 1.00037, 5, 6.00041}, {0.50013, 0, 0.50017, 8, 2, 5}},
                         .bin = 2,
                         .cell = 0.7,
                         .storey = 3,
                         .slow = 0.4};
    const auto made = summary_of(run, config);
    ASSERT_TRUE(made) << made.error().message;
    const ReplaySummary& s = *made;
    ASSERT_EQ(s.time.size(), run.size());
    const double seconds = run.back().first - run.front().first;
    uint64_t entered = run[0].second.size(), left = 0;
    double waited = 0, walked = 0, walked_time = 0, last_left = 0;
    std::vector<uint64_t> forth(2), back(2);
    std::map<std::pair<int32_t, std::pair<int32_t, int32_t>>, double> density, waiting;
    const auto cell = [&](const Vec3d& p) {
      return std::pair{p.y > 3 ? 1 : 0, std::pair{static_cast<int32_t>(std::floor(p.x / 0.7)),
                                                  static_cast<int32_t>(std::floor(p.z / 0.7))}};
    };
    for (size_t f = 0; f < run.size(); ++f) {
      EXPECT_EQ(s.time[f], run[f].first);
      EXPECT_EQ(s.present[f], run[f].second.size());
      const double hold = f + 1 < run.size() ? run[f + 1].first - run[f].first : 0;
      for (const Body& body : run[f].second) density[cell(body.at)] += hold / seconds / 0.49;
      double moved = 0;
      int32_t stay = 0;
      for (const Body& body : f > 0 ? run[f - 1].second : std::vector<Body>()) {
        const Vec3d* now = find(run[f].second, body.id);
        if (now == nullptr) {
          ++left;
          last_left = run[f].first;
          continue;
        }
        const double dt = run[f].first - run[f - 1].first;
        ++stay;
        moved += length(*now - body.at);
        walked += length(*now - body.at);
        walked_time += dt;
        if (length(*now - body.at) / dt < 0.4) {
          waited += dt;
          waiting[cell(body.at)] += dt / 0.49;
        }
        for (size_t l = 0; l < 2; ++l) {
          const int32_t sign = crossing(body.at, *now, config.lines[l]);
          if (l == 1 && body.at.y < 2) continue;
          forth[l] += sign > 0 ? 1 : 0;
          back[l] += sign < 0 ? 1 : 0;
        }
      }
      for (const Body& body : f > 0 ? run[f].second : std::vector<Body>()) {
        entered += find(run[f - 1].second, body.id) == nullptr ? 1 : 0;
      }
      EXPECT_EQ(s.entered[f], entered);
      EXPECT_EQ(s.left[f], left);
      if (f > 0 && stay > 0) {
        EXPECT_NEAR(s.speed[f - 1], moved / stay / (run[f].first - run[f - 1].first), 1e-9);
      }
    }
    EXPECT_EQ(s.last_left, last_left);
    EXPECT_NEAR(s.waited, waited, 1e-9);
    EXPECT_NEAR(s.mean_speed, walked / walked_time, 1e-9);
    for (size_t l = 0; l < 2; ++l) {
      EXPECT_EQ(s.lines[l].total_forth, forth[l]);
      EXPECT_EQ(s.lines[l].total_back, back[l]);
      EXPECT_EQ(s.lines[l].forth.size(), static_cast<size_t>(std::ceil(seconds / 2)));
      EXPECT_EQ(std::accumulate(s.lines[l].forth.begin(), s.lines[l].forth.end(), 0u), forth[l]);
      EXPECT_EQ(std::accumulate(s.lines[l].back.begin(), s.lines[l].back.end(), 0u), back[l]);
      crossings += forth[l] + back[l];
    }
    ASSERT_EQ(s.maps.size(), 2u);
    for (int32_t m = 0; m < 2; ++m) {
      const SummaryMap& map = s.maps[static_cast<size_t>(m)];
      EXPECT_EQ(map.lowest, 3 * m);
      for (int32_t k = 0; k < map.depth; ++k) {
        for (int32_t i = 0; i < map.width; ++i) {
          const auto c = static_cast<size_t>(k * map.width + i);
          const auto key = cell({map.x0 + (i + 0.5) * 0.7, 4.0 * m, map.z0 + (k + 0.5) * 0.7});
          EXPECT_NEAR(map.density[c], density[key], 1e-9);
          EXPECT_NEAR(map.waiting[c], waiting[key], 1e-9);
          density.erase(key);
          waiting.erase(key);
        }
      }
    }
    EXPECT_TRUE(density.empty()) << "an avatar stood outside the maps";
    EXPECT_TRUE(waiting.empty());
  }
  EXPECT_GT(crossings, 200u);
}

// Ten avatars leave through a door, one a second: values by hand.
TEST(ReplaySummary, HasTheNumbersOfAnEvacuation) {
  Film run;
  for (int32_t t = 0; t <= 20; ++t) {
    std::vector<Body> bodies;
    for (int32_t id = 0; id < 10; ++id) {
      const double x = std::max(0, t - id);  // waits, then walks at 1 m/s; gone behind x = 5
      if (x <= 5) bodies.push_back({static_cast<uint64_t>(id), {x, 0, 0.01 * id}});
    }
    run.emplace_back(t, bodies);
  }
  const auto s = summary_of(run, {.lines = {{4.5, -1, 4.5, 1}}, .cell = 1});
  ASSERT_TRUE(s);
  EXPECT_EQ(s->entered.back(), 10u);
  EXPECT_EQ(s->left.back(), 10u);
  EXPECT_EQ(s->last_left, 15);
  EXPECT_EQ(s->lines[0].total_back, 10u);  // towards +x: to the left if z is ahead
  EXPECT_EQ(s->lines[0].total_forth, 0u);
  for (size_t bin = 0; bin < 20; ++bin) {
    EXPECT_EQ(s->lines[0].back[bin], bin >= 4 && bin < 14 ? 1u : 0u) << bin;
  }
  EXPECT_EQ(s->waited, 45);
  EXPECT_EQ(s->maps.at(0).waiting[0], 45);
}

// The line belongs to its left side: an avatar that stops on it and continues counts once, in
// either direction; one that comes from the right and turns back on it counts once in each.
TEST(ReplaySummary, AnAvatarThatStopsOnALineIsNotCountedTwice) {
  const double along[2][7] = {{-1, 0, 0, 1, 2, 3, 3}, {-1, -1, 0, 0, -1, -1, -1}};
  for (const double sign : {1.0, -1.0}) {
    Film run;
    for (int32_t t = 0; t < 7; ++t) {
      run.emplace_back(
          t, std::vector<Body>{{1, {1, 0, sign * along[0][t]}}, {2, {2, 0, sign * along[1][t]}}});
    }
    const auto s = summary_of(run, {.lines = {{0, 0, 4, 0}}});
    ASSERT_TRUE(s);
    const LineFlow& flow = s->lines[0];
    EXPECT_EQ(flow.total_forth, 1u);
    EXPECT_EQ(flow.total_back, sign > 0 ? 0u : 2u);
  }
}

TEST(ReplaySummary, RefusesBadSettings) {
  const Film run = {{0, {{1, {0, 0, 0}}}}, {1, {{1, {1e5, 0, 1e5}}}}};
  EXPECT_EQ(summary_of(run, {.cell = 0}).error().code, Errc::kBadConfig);
  EXPECT_EQ(summary_of(run, {.bin = -1}).error().code, Errc::kBadConfig);
  EXPECT_EQ(summary_of(run, {.slow = NAN}).error().code, Errc::kBadConfig);
  EXPECT_EQ(summary_of(run, {.lines = {{1, 1, 1, 1}}}).error().code, Errc::kBadConfig);
  EXPECT_EQ(summary_of(run, {.cell = 0.5}).error().code, Errc::kLimit);
  EXPECT_TRUE(summary_of(run, {.cell = 100}));
  EXPECT_EQ(summary_of(Film(), {}).error().code, Errc::kBadFile);
  const auto one = summary_of(Film{{3, {{1, {0, 0, 0}}}}}, {.cell = 1});
  ASSERT_TRUE(one);
  EXPECT_EQ(one->maps.at(0).density[0], 1);
}

}  // namespace
}  // namespace throng
