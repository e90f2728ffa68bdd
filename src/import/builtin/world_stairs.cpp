// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include "core/random.h"
#include "import/builtin/builtin_table.h"
#include "import/builtin/world_shapes.h"

// Two terraces, 3.06 m and 6.12 m over a yard. Every bay (4 m along z) has its own climb from the
// yard (x = 0) to the first terrace (x = 12), and another one from there (x = 18) to the second
// (x = 30). Some fit no avatar: 0.51 m risers, a 50 degree slope.
namespace throng::importer::builtin {
namespace {

using namespace shapes;

constexpr double kStorey = 3.06;
constexpr double kBay = 4;
constexpr double kWidth = 2.4;
constexpr double kRunLength = 12;  // From the foot of a climb to the terrace's edge. [m]

enum Kind : uint64_t {
  kEasy,
  kLow,
  kSteep,
  kVerySteep,
  kTooHigh,
  kDeep,
  kMiddleLanding,
  kGentleRamp,
  kSteepRamp,
  kSpiral,
  kDogleg,
  kKinds
};

constexpr std::array<const char*, kKinds> kNames = {"easy flight",
                                                    "low flight",
                                                    "steep flight",
                                                    "very steep flight",
                                                    "risers of 0.51 m",
                                                    "deep steps",
                                                    "flight with a landing",
                                                    "ramp of 14 degrees",
                                                    "ramp of 50 degrees",
                                                    "spiral stairs",
                                                    "dogleg"};

struct Tread {
  double run;
  int32_t risers;
};

// Where a straight flight of this kind starts to be level. Zero risers: not a plain flight.
constexpr std::array<Tread, kKinds> kTreads = {
    {{0.29, 18}, {0.36, 24}, {0.24, 15}, {0.20, 12}, {0.50, 6}, {0.90, 9}, {}, {}, {}, {}, {}}};

// From the flight's end to the terrace: a slab on two posts.
void landing(WorldBuilder& b, double x0, double x1, double y, double z) {
  if (!(x1 > x0)) return;
  box(b, Mat::kFloor, {x0, y - 0.25, z}, {x1, y, z + kWidth});
  for (const double side : {z + 0.05, z + kWidth - 0.05}) {
    railing(b, {x0, y, side}, {x1, y, side});
  }
  for (const double side : {z + 0.3, z + kWidth - 0.3}) {
    box(b, Mat::kPillar, {x1 - 0.6, y - kStorey, side - 0.12}, {x1 - 0.36, y - 0.25, side + 0.12},
        kSides);
  }
}

void ramp_to(WorldBuilder& b, double x, double y, double z, double run) {
  const double top = y + kStorey;
  hexahedron(b, Mat::kRamp,
             {{{x, y, z},
               {x, y, z + kWidth},
               {x + run, top - 0.3, z + kWidth},
               {x + run, top - 0.3, z},
               {x, y, z},
               {x, y, z + kWidth},
               {x + run, top, z + kWidth},
               {x + run, top, z}}},
             kSides | kHighY | kLowY);
  for (const double side : {z + 0.05, z + kWidth - 0.05}) {
    railing(b, {x, y, side}, {x + run, top, side});
  }
}

void spiral_up(WorldBuilder& b, double x, double y, double z) {
  const double cx = x + 7;
  const double cz = z + kWidth / 2;
  spiral(b, Mat::kStairs,
         {.x = cx,
          .y = y,
          .z = cz,
          .inner = 0.15,
          .outer = 1.75,
          .from = 0.125,
          .turn = 0.75,
          .height = kStorey,
          .risers = 18});
  cylinder(b, Mat::kPillar, {cx, y, cz}, {cx, y + kStorey + 1.2, cz}, 0.18, 12, true);
  sector(b, Mat::kFloor, cx, cz, 0.1, 1.75, -0.125, 0.25, y + kStorey - 0.2, y + kStorey);
  landing(b, cx + 1.25, x + kRunLength, y + kStorey, z);
}

// Up along the wall of the terrace and back: the last flight ends on a bridge to the terrace.
void dogleg_up(WorldBuilder& b, double x, double y, double z) {
  Dogleg d{.x = 0, .y = 0, .z = 0, .height = kStorey, .width = 1.2, .gap = 0.1, .landing = 1.6};
  const Frame outer = b.frame();
  const double foot = x + kRunLength - 1.8;
  b.place({outer({foot, y, z + kWidth}), -outer.ux, -outer.uz});
  dogleg(b, Mat::kStairs, d);
  b.place(outer);
  landing(b, foot, x + kRunLength, y + kStorey, z);
}

void add_climb(WorldBuilder& b, Kind kind, double x, double y, double z) {
  const double top = y + kStorey;
  if (const Tread& t = kTreads[kind]; t.risers > 0) {
    const double rise = kStorey / t.risers;
    const Flight f{.x = x,
                   .y = y,
                   .z = z,
                   .width = kWidth,
                   .rise = rise,
                   .run = t.run,
                   .risers = t.risers,
                   .thickness = rise + 0.15};
    flight(b, Mat::kStairs, f);
    landing(b, x + f.length(), x + kRunLength, top, z);
    return;
  }
  switch (kind) {
    case kMiddleLanding: {
      Flight f{.x = x, .y = y, .z = z, .width = kWidth, .rise = 0.17, .run = 0.29, .risers = 9};
      flight(b, Mat::kStairs, f);
      const double from = f.x + f.length();
      box(b, Mat::kFloor, {from, f.top() - 0.25, z}, {from + 1.8, f.top(), z + kWidth});
      f.y = f.top();
      f.x = from + 1.8;
      flight(b, Mat::kStairs, f);
      landing(b, f.x + f.length(), x + kRunLength, top, z);
      return;
    }
    case kGentleRamp:
      ramp_to(b, x, y, z, kRunLength);
      return;
    case kSteepRamp:
      ramp_to(b, x, y, z, 2.6);
      landing(b, x + 2.6, x + kRunLength, top, z);
      return;
    case kSpiral:
      spiral_up(b, x, y, z);
      return;
    default:
      dogleg_up(b, x, y, z);
      return;
  }
}

}  // namespace

void build_stairs(WorldBuilder& b, const BuiltinWorldConfig& config) {
  const auto bays = static_cast<int32_t>(config.size / kBay);
  const double depth = config.size;
  constexpr double kFirst = kRunLength;        // The first terrace: x from 12 to 18.
  constexpr double kSecond = 18 + kRunLength;  // The second: x from 30 to 34.
  b.node("yard");
  floor_rect(b, Mat::kPavement, {-6, 0, kSecond + 4, depth}, 0);
  b.node("terraces");
  box(b, Mat::kFloor, {kFirst, kStorey - 0.3, 0}, {18, kStorey, depth});
  box(b, Mat::kFloor, {kSecond, 2 * kStorey - 0.3, 0}, {kSecond + 4, 2 * kStorey, depth});
  railing(b, {kSecond + 3.95, 2 * kStorey, 0}, {kSecond + 3.95, 2 * kStorey, depth});
  for (const double z : {0.05, depth - 0.05}) {
    railing(b, {kFirst, kStorey, z}, {18, kStorey, z});
    railing(b, {kSecond, 2 * kStorey, z}, {kSecond + 4, 2 * kStorey, z});
  }
  const double pad = (depth - bays * kBay) / 2 + (kBay - kWidth) / 2;
  double last = 0.1;
  for (int32_t i = 0; i <= bays; ++i) {  // Railings and posts between the climbs.
    const double z = i < bays ? pad + i * kBay : depth - 0.1;
    railing(b, {kFirst + 0.05, kStorey, last}, {kFirst + 0.05, kStorey, z});
    railing(b, {17.95, kStorey, last}, {17.95, kStorey, z});
    railing(b, {kSecond + 0.05, 2 * kStorey, last}, {kSecond + 0.05, 2 * kStorey, z});
    last = z + kWidth;
    if (i == bays) break;
    const double middle = z + kWidth / 2;
    for (const double x : {kFirst + 3, kSecond + 2}) {
      const double top = x < 18 ? kStorey - 0.3 : 2 * kStorey - 0.3;
      box(b, Mat::kPillar, {x - 0.2, 0, middle - 0.2}, {x + 0.2, top, middle + 0.2}, kSides);
    }
  }
  for (int32_t i = 0; i < bays; ++i) {
    const auto bay = static_cast<uint64_t>(i);
    const auto pick = [&](uint64_t terrace) {
      return static_cast<Kind>(random_below(config.seed, bay, terrace, kKinds));
    };
    // The first bays show every kind once, whatever the seed.
    const Kind low = bay < kKinds ? static_cast<Kind>(bay) : pick(0);
    const Kind high = bay < kKinds ? static_cast<Kind>((bay + 5) % kKinds) : pick(1);
    b.node(fmt::format("bay {}: {}", i, kNames[low]));
    add_climb(b, low, 0, 0, pad + i * kBay);
    b.node(fmt::format("bay {}, upper: {}", i, kNames[high]));
    add_climb(b, high, 18, kStorey, pad + i * kBay);
  }
}

}  // namespace throng::importer::builtin
