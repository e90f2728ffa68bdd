// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <string>
#include <vector>

#include "core/random.h"
#include "validate/plane_crowd.h"
#include "validate/tests.h"

// People that have come to their places: they stand, also where their places are closer to each
// other than their bodies permit.
namespace throng::validate {
namespace {

constexpr double kRoom = 12;        // [m] long and wide
constexpr double kFrom = 30;        // [s] from when on they must stand
constexpr double kMaxSpeed = 0.01;  // [m/s]

struct Waiting {
  const char* name;
  std::vector<Point2> starts, goals;
  double max_distance = 1;  // from the goals, so that none stands because it never came [m]
};

// Goals at random points of an area of 16 m2.
Waiting on_small_area(uint64_t seed) {
  Waiting waiting{.name = "24 people on 16 m2", .starts = {}, .goals = {}};
  for (uint64_t n = 0; n < 24; ++n) {
    waiting.starts.push_back(
        {1 + 0.7 * static_cast<double>(n / 6), 4 + 0.7 * static_cast<double>(n % 6)});
    waiting.goals.push_back({7 + 4 * random_unit(seed, 1, n), 4 + 4 * random_unit(seed, 2, n)});
  }
  return waiting;
}

// Goals in three rows of three.
Waiting in_rows() {
  Waiting waiting{.name = "nine people at 0.6 m", .starts = {}, .goals = {}};
  for (uint64_t n = 0; n < 9; ++n) {
    const auto row = static_cast<double>(n / 3), column = static_cast<double>(n % 3);
    waiting.starts.push_back({1 + row, 5 + column});
    waiting.goals.push_back({8 + 0.6 * row, 5.4 + 0.6 * column});
  }
  return waiting;
}

// Goals within half a metre of one point, where four have room.
Waiting around_a_point(uint64_t seed) {
  Waiting waiting{
      .name = "16 people around a point", .starts = {}, .goals = {}, .max_distance = 1.25};
  for (uint64_t n = 0; n < 16; ++n) {
    const double angle = 2 * std::numbers::pi * random_unit(seed, 3, n);
    const double off = 0.5 * std::sqrt(random_unit(seed, 4, n));
    waiting.starts.push_back(
        {1 + 0.7 * static_cast<double>(n / 4), 4 + 0.7 * static_cast<double>(n % 4)});
    waiting.goals.push_back({8 + off * std::cos(angle), 6 + off * std::sin(angle)});
  }
  return waiting;
}

struct Rest {
  double mean_speed = 0, max_speed = 0;  // of a person, over the time [m/s]
  double distance = 0;                   // from the goals at the end, mean [m]
};

Result<Rest> come_to_rest(const World& world, const Waiting& waiting, double dt,
                          const ValidationConfig& config, ValidationResult& result,
                          Context& context) {
  auto crowd = PlaneCrowd::create(world, Routing::kPaths, config, dt);
  if (!crowd) return crowd.error();
  const auto ids =
      crowd->add(waiting.starts, std::vector<double>(waiting.starts.size(), 0), context);
  if (!ids) return ids.error();
  std::map<uint32_t, Point2> goal_of;  // by slot
  for (size_t i = 0; i < ids->size(); ++i) {
    crowd->set_goal((*ids)[i], waiting.goals[i]);
    goal_of[(*ids)[i].slot1] = waiting.goals[i];
  }
  const double until = config.brief ? kFrom + 3 : 2 * kFrom;
  std::map<uint32_t, double> walked;  // since kFrom, by slot [m]
  while (crowd->time() < until - 1e-9) {
    const bool counts = crowd->time() >= kFrom - 1e-9;
    crowd->step();
    if (context.cancel) return Error{Errc::kCancelled, "cancelled"};
    if (!counts) continue;
    for (const AvatarMotion& s : crowd->avatars()) {
      walked[s.id.slot1] += std::hypot(s.vx, s.vz) * dt;
    }
  }
  Rest rest;
  const auto people = static_cast<double>(waiting.starts.size());
  for (const auto& [slot, distance] : walked) {
    rest.mean_speed += distance / (until - kFrom) / people;
    rest.max_speed = std::max(rest.max_speed, distance / (until - kFrom));
  }
  for (const AvatarMotion& s : crowd->avatars()) {
    const Point2& goal = goal_of[s.id.slot1];
    rest.distance += std::hypot(s.x - goal.x, s.z - goal.z) / people;
  }
  crowd->report(result);
  return rest;
}

Result<ValidationResult> rest(const ValidationConfig& config, Context& context) {
  ValidationResult result;
  PlaneConfig plane;
  plane.ground = box(0, 0, kRoom, kRoom);
  const auto world = bake_plane(plane, AvatarClass{}, config, context);
  if (!world) return world.error();
  for (const Waiting& waiting :
       {on_small_area(config.seed), in_rows(), around_a_point(config.seed)}) {
    for (const double dt : {0.02, 0.1, 0.2}) {
      const auto found = come_to_rest(*world, waiting, dt, config, result, context);
      if (!found) return found.error();
      const std::string at = fmt::format("{}, dt {:.2f} s: ", waiting.name, dt);
      result.measures.push_back({.name = at + "mean speed",
                                 .value = found->mean_speed,
                                 .unit = "m/s",
                                 .high = kMaxSpeed});
      result.measures.push_back(
          {.name = at + "speed of the fastest", .value = found->max_speed, .unit = "m/s"});
      result.measures.push_back({.name = at + "distance from the goals",
                                 .value = found->distance,
                                 .unit = "m",
                                 .high = waiting.max_distance});
    }
  }
  return result;
}

const std::array<Test, 1> kRestTests{Test{
    {.name = "motion.rest",
     .title = "People that have come to their places stand",
     .method = "The default adult, steps of 0.02, 0.1 and 0.2 s. 24 people go to random places on "
               "16 m2, nine to places in rows 0.6 m apart, 16 to random places within 0.5 m of a "
               "point. From 30 to 60 s: length of the paths by the time, mean and maximum of a "
               "person; at the end the mean distance from the places.",
     .source = "ours: a mean speed of 0.01 m/s, a mean distance of 1 m, of 1.25 m around a point"},
    rest}};

}  // namespace

std::span<const Test> rest_tests() { return kRestTests; }

}  // namespace throng::validate
