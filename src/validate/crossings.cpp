// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "core/random.h"
#include "validate/arrivals.h"
#include "validate/tests.h"

// Four streams that meet, by the pattern of SteerBench's cases: a group at each end of two streets
// that cross, each person with one goal at the end of another street.
namespace throng::validate {
namespace {

constexpr double kPeopleApart = 1;     // [m] in a group, before they are moved at random
constexpr double kMoved = 0.2;         // [m] by at most this much along each axis
constexpr double kFromEnd = 0.8;       // [m] of the first row from the end of the street
constexpr double kCrossingTime = 400;  // [s] in which all must arrive

// Where four streets meet, and what stands there.
struct Crossing {
  double street;  // Width of each street. [m]
  double length;  // Of each street, up to the square. [m]
  double square;  // Side of the square in the middle, at least as wide as the streets. [m]
  std::vector<Polygon> obstacles = {};
  bool turns = false;  // People go to any of the other streets, not only straight on.

  [[nodiscard]] double middle() const { return length + square / 2; }
};

// The point after a number of quarter turns about the middle.
Point2 turned(Point2 p, double middle, uint64_t quarters) {
  for (uint64_t k = 0; k < quarters % 4; ++k) p = {2 * middle - p.z, p.x};
  return p;
}

// A regular polygon around the point (middle, middle).
Polygon round_island(double middle, double radius) {
  constexpr int kCorners = 24;
  Polygon polygon;
  for (int k = 0; k < kCorners; ++k) {
    const double angle = 2 * std::numbers::pi * k / kCorners;
    polygon.outer.push_back({middle + radius * std::cos(angle), middle + radius * std::sin(angle)});
  }
  return polygon;
}

PlaneConfig crossing_plane(const Crossing& crossing) {
  const double middle = crossing.middle(), half = crossing.street / 2;
  const double begin = crossing.length;  // of the square
  // The outline of the street towards low z; those of the others are the same, turned.
  std::vector<Point2> outline{
      {middle - half, begin}, {middle - half, 0}, {middle + half, 0}, {middle + half, begin}};
  if (crossing.square > crossing.street) {
    outline.insert(outline.begin(), Point2{begin, begin});
  } else {
    outline.pop_back();  // It is the next street's first corner.
  }
  PlaneConfig plane;
  for (uint64_t street = 0; street < 4; ++street) {
    for (const Point2& corner : outline) {
      const Point2 p = turned(corner, middle, street);
      plane.ground.outer.push_back({p.x, p.z});
    }
  }
  plane.obstacles = crossing.obstacles;
  return plane;
}

// One person of each street after the other. Goals are places where people of that street start,
// the last row's for the first, so all of a group have equally far to go.
Trips crossing_trips(const Crossing& crossing, uint64_t each, uint64_t seed) {
  Trips trips;
  const auto abreast = static_cast<uint64_t>(crossing.street / kPeopleApart) - 1;
  const double aside = (crossing.street - kPeopleApart * static_cast<double>(abreast - 1)) / 2;
  const uint64_t rows = (each + abreast - 1) / abreast;
  const double depth = 2 * kFromEnd + kPeopleApart * static_cast<double>(rows - 1);
  const double middle = crossing.middle();
  for (uint64_t n = 0; n < 4 * each; ++n) {
    const uint64_t street = n % 4, place = n / 4;
    const double off_end = kFromEnd + kPeopleApart * static_cast<double>(place / abreast) +
                           kMoved * (2 * random_unit(seed, 1, n) - 1);
    const double across = aside + kPeopleApart * static_cast<double>(place % abreast) +
                          kMoved * (2 * random_unit(seed, 2, n) - 1);
    const uint64_t quarters = crossing.turns ? 1 + random_below(seed, 3, n, 3) : 2;
    const double low = middle - crossing.street / 2;  // of the street
    trips.starts.push_back(turned({low + across, off_end}, middle, street));
    trips.goals.push_back(
        turned({low + crossing.street - across, depth - off_end}, middle, street + quarters));
  }
  return trips;
}

Result<ValidationResult> cross(const Crossing& crossing, const ValidationConfig& config,
                               Context& context) {
  ValidationResult result;
  const auto world = bake_plane(crossing_plane(crossing), AvatarClass{}, config, context);
  if (!world) return world.error();
  const uint64_t each = config.brief ? 20 : 100, runs = config.brief ? 1 : 3;
  for (uint64_t k = 0; k < runs; ++k) {
    const ValidationConfig one = config_of_run(config, runs, k);
    const Trips trips = crossing_trips(crossing, each, one.seed);
    const auto run = walk_trips(*world, trips, kCrossingTime, one, result, context);
    if (!run) return run.error();
    add_arrivals(*run, trips.starts.size(), fmt::format("run {}", k + 1), result);
  }
  return result;
}

Result<ValidationResult> pillar(const ValidationConfig& config, Context& context) {
  Crossing crossing{.street = 6, .length = 24, .square = 6};
  const double low = crossing.middle() - 1.5, high = crossing.middle() + 1.5;
  crossing.obstacles = {box(low, low, high, high)};
  return cross(crossing, config, context);
}

Result<ValidationResult> square(const ValidationConfig& config, Context& context) {
  return cross({.street = 6, .length = 24, .square = 20}, config, context);
}

Result<ValidationResult> roundabout(const ValidationConfig& config, Context& context) {
  Crossing crossing{.street = 6, .length = 24, .square = 16, .turns = true};
  crossing.obstacles = {round_island(crossing.middle(), 5)};
  return cross(crossing, config, context);
}

const std::array<Test, 3> kCrossingTests{
    Test{{.name = "motion.pillar",
          .title = "Four streams of 100 people meet at a pillar",
          .method = "Two streets 6 m wide cross, and a pillar of 3 x 3 m stands in the middle. A "
                    "group of default adults, one a square metre, walks from each end to the "
                    "other end of its street, three runs. Each leaves where it has arrived.",
          .source = "ours, by the pattern of [SKFR09]: all arrive within 400 s"},
         pillar},
    Test{{.name = "motion.square",
          .title = "Four streams of 100 people cross a square",
          .method = "As motion.pillar, with streets that lead to the middles of the sides of an "
                    "open square of 20 x 20 m.",
          .source = "ours, by the pattern of [SKFR09]: all arrive within 400 s"},
         square},
    Test{{.name = "motion.roundabout",
          .title = "Four streams of 100 people meet at a roundabout",
          .method = "As motion.square, with a round island 10 m wide on a square of 16 x 16 m; "
                    "each person goes to the end of one of the other three streets, at random.",
          .source = "ours, by the pattern of [SKFR09]: all arrive within 400 s"},
         roundabout}};

}  // namespace

std::span<const Test> crossing_tests() { return kCrossingTests; }

}  // namespace throng::validate
