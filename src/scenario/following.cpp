// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <vector>

#include "scenario/simulation_state.h"

// Source: [TC00] 5. Avatars "move and decide their paths by probabilistically sampling this map".
// An avatar that enters by a density map, or whose journey names one, follows it: the crowd keeps
// it off weight 0 and lets paths cost by weight (Crowd::add_density_class), and on a long trip it
// samples the map for places to go by. Time: constant for a trip; for new weights, the ground.
namespace throng {
namespace {

constexpr int kMaxPixelDraws = 16;  // drawn to find one with a floor
constexpr int kMaxSamples = 8;      // of the map, for a waypoint
constexpr double kLongTrip = 20;    // [m] A shorter one has no waypoints.
constexpr double kMaxDetour = 1.2;  // of a trip by a waypoint, in lengths of the straight one
constexpr double kMaxLeft = 0.8;    // of the trip after a waypoint, likewise
constexpr double kMinWalk = 5;      // [m] to a waypoint
constexpr double kCostPeriod = 60;  // [s] between changes of costs

// Has some of the ground under an area a weight, at any time, or lies it beside the picture?
bool has_weight(const DensityMap& map, const ScenarioArea& area) {
  Box3d box;
  for (const Prism& prism : area.prisms) {
    for (const auto& [x, z] : prism.corners) box.add({x, 0, z});
  }
  if (box.min.x < map.x0 || box.max.x > map.x1 || box.min.z < map.z0 || box.max.z > map.z1) {
    return true;
  }
  const auto pixel = [](double at, double low, double high, int32_t count) {
    const double n = std::floor((at - low) / (high - low) * count);
    return static_cast<int32_t>(std::clamp(n, 0.0, count - 1.0));
  };
  const int32_t first = pixel(box.min.x, map.x0, map.x1, map.width);
  const int32_t last = pixel(box.max.x, map.x0, map.x1, map.width);
  const int32_t end = pixel(box.max.z, map.z0, map.z1, map.height);
  const auto any = [&](const std::vector<uint8_t>& weights) {
    for (int32_t row = pixel(box.min.z, map.z0, map.z1, map.height); row <= end; ++row) {
      for (int32_t column = first; column <= last; ++column) {
        if (weights[static_cast<size_t>(row) * static_cast<size_t>(map.width) +
                    static_cast<size_t>(column)] != 0) {
          return true;
        }
      }
    }
    return false;
  };
  return any(map.weights) ||
         std::any_of(map.hours.begin(), map.hours.end(),
                     [&](const DensityHour& hour) { return any(hour.weights); });
}

bool is_zero_alike(const std::vector<uint8_t>& a, const std::vector<uint8_t>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](uint8_t x, uint8_t y) { return (x == 0) == (y == 0); });
}

}  // namespace

// The map that avatars of a source follow on a journey: that by which they enter, or the first that
// the journey names. -1: none.
int32_t Simulation::State::map_of(const Source& source, int32_t journey) const {
  if (source.density >= 0 || journey < 0) return source.density;
  const auto number = static_cast<size_t>(&source - scenario.sources.data());
  for (const Stage& stage : scenario.journeys[static_cast<size_t>(journey)].stages) {
    if (stage.density < 0) continue;
    return from_outside[number][static_cast<size_t>(stage.density)] != 0 ? -1 : stage.density;
  }
  return -1;
}

// Avatars of a source all of whose areas have weight 0 cannot follow that map: they visit what it
// shows from outside, as where only destinations are painted. Found once, so that it stays so.
void Simulation::State::find_sources_outside() {
  for (const Source& source : scenario.sources) {
    std::vector<uint8_t>& outside = from_outside.emplace_back();
    for (const DensityMap& map : scenario.densities) {
      const bool has_ground = std::any_of(
          source.areas.begin(), source.areas.end(),
          [&](int32_t area) { return has_weight(map, scenario.areas[static_cast<size_t>(area)]); });
      outside.push_back(!source.areas.empty() && !has_ground ? 1 : 0);
    }
  }
}

// The class of the crowd of avatars that follow a map. Those that fly or go over nodes follow none.
Result<int32_t> Simulation::State::class_that_follows(int32_t density, int32_t avatar_class,
                                                      Context& context) {
  if (density < 0) return avatar_class;
  const auto found = density_classes.find({density, avatar_class});
  if (found != density_classes.end()) return found->second;
  const DensityMap& map = scenario.densities[static_cast<size_t>(density)];
  const auto made = crowd.add_density_class(avatar_class,
                                            {.x0 = map.x0,
                                             .z0 = map.z0,
                                             .x1 = map.x1,
                                             .z1 = map.z1,
                                             .low = map.low,
                                             .high = map.high,
                                             .width = map.width,
                                             .height = map.height,
                                             .weights = map.weights},
                                            context);
  if (!made && made.error().code == Errc::kBadConfig) return avatar_class;
  if (made) density_classes[{density, avatar_class}] = *made;
  return made;
}

void Simulation::State::blend_densities() {
  for (size_t d = 0; d < densities.size(); ++d) {
    DensityMap& map = scenario.densities[d];
    if (!map.hours.empty()) {
      std::vector<uint8_t> weights = scenario::weights_at(map, time());
      if (weights != map.weights) {
        map.weights = std::move(weights);
        densities[d] = scenario::DensityDraw(map);
      }
    }
    give_density(d);
  }
}

// What becomes 0 counts at once; that paths cost something else by now waits, because all search
// again then.
void Simulation::State::give_density(size_t density) {
  const std::vector<uint8_t>& now = scenario.densities[density].weights;
  GivenDensity& last = given[density];
  const bool is_due = time() - last.at >= kCostPeriod && now != last.weights;
  if (!is_due && is_zero_alike(now, last.weights)) return;
  given[density] = {scenario.densities[density].weights, time()};
  for (const auto& [key, number] : density_classes) {
    if (key.first != static_cast<int32_t>(density)) continue;
    const auto ok = crowd.set_density(number, given[density].weights);
    THRONG_ASSERT(ok);  // It has as many pixels.
  }
}

// Where the class may stand, too: not on a cell that touches weight 0.
Place Simulation::State::random_place_of(int32_t density, ScenarioAvatar& p) {
  const auto d = static_cast<size_t>(density);
  return random_place_of(scenario.densities[d], densities[d], p);
}

Place Simulation::State::random_place_of(const DensityMap& map, const scenario::DensityDraw& draw,
                                         ScenarioAvatar& p) {
  const int32_t of_crowd = crowd_class_of(p);
  for (int k = 0; k < kMaxPixelDraws; ++k) {
    const double which = unit(p), along_x = unit(p), along_z = unit(p);
    const auto [x, z] = draw.point(which, along_x, along_z);
    const Place place =
        world.find_place(class_of(p), {x, (map.low + map.high) / 2, z}, (map.high - map.low) / 2);
    if (place && (of_crowd == class_of(p) || crowd.may_stand(of_crowd, place))) return place;
  }
  return {};
}

// To its goal, or first to a place that it samples on the trip there. Each waypoint is nearer to
// the goal, so it comes to an end.
void Simulation::State::go_on_trip(ScenarioAvatar& p) {
  const auto state = crowd.read(p.id);
  const double straight = plan_distance(state->position, p.goal.position);
  Place waypoint;
  for (int k = 0; k < kMaxSamples && p.follows >= 0 && straight > kLongTrip && !waypoint; ++k) {
    const Place place = random_place_of(p.follows, p);
    if (!place) break;
    const double there = plan_distance(state->position, place.position),
                 rest = plan_distance(place.position, p.goal.position);
    const bool is_between =
        there >= kMinWalk && rest <= kMaxLeft * straight && there + rest <= kMaxDetour * straight;
    if (is_between) waypoint = place;
  }
  if (!waypoint) {
    if (p.doing == Doing::kToWaypoint) walk_to(p, p.goal, Doing::kToRandomPlace);
    return;
  }
  const Place goal = p.goal;
  walk_to(p, waypoint, Doing::kToWaypoint);
  p.waypoint = waypoint;
  p.goal = goal;
}

}  // namespace throng
