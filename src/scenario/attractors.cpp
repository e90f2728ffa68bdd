// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "scenario/attractors.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "scenario/simulation_state.h"

// Source: [TC00] 5. "A crowd can be attracted towards a jogger by rendering a darker (ie more
// dense) polygon using interpolated shading": it falls evenly to the polygon's rim, and once a
// second it is painted again. Avatars on their trips go there by its share of all weights, so that
// in the end the crowd is spread as the map with the shading says. Time of a second: the pixels of
// the shaded maps, and the avatars.
namespace throng {
namespace {

constexpr uint64_t kRedirectPeriod = 5;  // [reviews] One avatar of so many thinks again.

double length_of(const std::vector<std::array<double, 2>>& line) {
  double length = 0;
  for (size_t i = 1; i < line.size(); ++i) {
    length += plan_length(line[i][0] - line[i - 1][0], line[i][1] - line[i - 1][1]);
  }
  return length;
}

// Paints a cone over the weights: the larger weight counts, and 0 stays.
void paint_cone(const DensityMap& map, const Vec3d& middle, double radius, uint8_t weight,
                std::vector<uint8_t>& weights) {
  const double dx = (map.x1 - map.x0) / map.width, dz = (map.z1 - map.z0) / map.height;
  const auto index = [](double at, int32_t count) {
    return static_cast<int32_t>(std::clamp(std::floor(at), 0.0, static_cast<double>(count)));
  };
  const int32_t first_x = index((middle.x - radius - map.x0) / dx, map.width),
                last_x = index((middle.x + radius - map.x0) / dx + 1, map.width),
                first_z = index((middle.z - radius - map.z0) / dz, map.height),
                last_z = index((middle.z + radius - map.z0) / dz + 1, map.height);
  for (int32_t z = first_z; z < last_z; ++z) {
    for (int32_t x = first_x; x < last_x; ++x) {
      const double away =
          plan_length(map.x0 + (x + 0.5) * dx - middle.x, map.z0 + (z + 0.5) * dz - middle.z);
      uint8_t& here =
          weights[static_cast<size_t>(z) * static_cast<size_t>(map.width) + static_cast<size_t>(x)];
      if (here == 0 || away >= radius) continue;
      here = std::max(here, static_cast<uint8_t>(weight * (1 - away / radius) + 0.5));
    }
  }
}

Vec3d middle_of(const Prism& prism) {
  Vec3d sum;
  for (const auto& [x, z] : prism.corners) sum = sum + Vec3d{x, 0, z};
  return sum * (1.0 / static_cast<double>(prism.corners.size()));
}

}  // namespace

namespace scenario {

Result<void> check_line(const ScenarioObstacle& obstacle) {
  if (obstacle.line.empty()) return {};
  const double length = length_of(obstacle.line);
  const bool moves =
      std::isfinite(length) && length > 0 && obstacle.speed > 0 && obstacle.speed <= 100;
  if (moves) return {};
  return Error{Errc::kBadInput, "obstacle '" + obstacle.name +
                                    "': its line must be longer than 0, and its speed above 0 and "
                                    "at most 100 m/s"};
}

Result<void> check_attractor(const Attractor& attractor, const Scenario& scenario) {
  const auto is_index = [](int32_t index, size_t count) {
    return index >= 0 && static_cast<size_t>(index) < count;
  };
  const bool of_source = is_index(attractor.source, scenario.sources.size());
  const bool of_obstacle = is_index(attractor.obstacle, scenario.obstacles.size());
  if (is_index(attractor.density, scenario.densities.size()) && of_source != of_obstacle &&
      attractor.radius > 0 && attractor.radius <= 1000 && attractor.weight > 0) {
    return {};
  }
  return Error{Errc::kBadInput, "attractor '" + attractor.name +
                                    "': it needs a density, a source or an obstacle, a radius "
                                    "above 0 and at most 1000 m, and a weight above 0"};
}

Prism prism_after(const ScenarioObstacle& obstacle, double distance) {
  const double length = length_of(obstacle.line);
  double left = distance - 2 * length * std::floor(distance / (2 * length));
  if (left > length) left = 2 * length - left;
  std::array<double, 2> at = obstacle.line.front();
  for (size_t i = 1; i < obstacle.line.size(); ++i) {
    const auto &a = obstacle.line[i - 1], &b = obstacle.line[i];
    const double side = plan_length(b[0] - a[0], b[1] - a[1]);
    const double part = side > 0 ? std::min(left / side, 1.0) : 1;
    at = {a[0] + part * (b[0] - a[0]), a[1] + part * (b[1] - a[1])};
    if (left <= side) break;
    left -= side;
  }
  Prism prism = obstacle.prism;
  for (auto& [x, z] : prism.corners) {
    x += at[0] - obstacle.line.front()[0];
    z += at[1] - obstacle.line.front()[1];
  }
  return prism;
}

}  // namespace scenario

// One that waits for avatars to step out of its path does not get ahead of itself.
void Simulation::State::move_obstacle(size_t n) {
  const auto state = crowd.obstacle(obstacles[n]);
  if (!state || state->phase != ObstaclePhase::kUp) return;
  const ScenarioObstacle& obstacle = scenario.obstacles[n];
  moved[n] += obstacle.speed * scenario.dt;
  const auto ok = edits.move_obstacle(obstacles[n], scenario::prism_after(obstacle, moved[n]));
  THRONG_ASSERT(ok);  // Its prism was checked, and moving it changes no side.
}

bool Simulation::State::carries(const ScenarioAvatar& p) const {
  const int32_t source = trips[p.number].source;
  return std::any_of(scenario.attractors.begin(), scenario.attractors.end(),
                     [&](const Attractor& a) { return a.source >= 0 && a.source == source; }) ||
         std::any_of(carried.begin(), carried.end(),
                     [&](const CarriedAttractor& a) { return a.number == p.number; });
}

// Of its weights as they are, with all attractors where they are now.
void Simulation::State::shade(size_t density) {
  const DensityMap& map = scenario.densities[density];
  std::vector<uint8_t> weights = map.weights;
  bool some = false;
  const auto paint = [&](const Vec3d& middle, double radius, uint8_t weight) {
    some = true;
    paint_cone(map, middle, radius, weight, weights);
  };
  for (const Attractor& attractor : scenario.attractors) {
    if (static_cast<size_t>(attractor.density) != density) continue;
    if (attractor.obstacle >= 0) {
      const EditId id = obstacles[static_cast<size_t>(attractor.obstacle)];
      const auto state = crowd.obstacle(id);
      if (id != 0 && state && state->is_up()) {
        paint(middle_of(state->prism), attractor.radius, attractor.weight);
      }
      continue;
    }
    for (const ScenarioAvatar& p : avatars) {
      if (!p.id || trips[p.number].source != attractor.source) continue;
      paint(crowd.read(p.id)->position, attractor.radius, attractor.weight);
    }
  }
  for (const CarriedAttractor& attractor : carried) {
    const ScenarioAvatar* p = find_avatar(attractor.number);
    if (attractor.density != density || p == nullptr) continue;
    paint(crowd.read(p->id)->position, attractor.radius, attractor.weight);
  }
  const bool was_shaded = shaded.erase(density) > 0;
  if (!some) {
    if (was_shaded) densities[density] = scenario::DensityDraw(map);
    return;
  }
  densities[density] = scenario::DensityDraw(map, weights);
  for (size_t i = 0; i < weights.size(); ++i) {
    weights[i] = static_cast<uint8_t>(weights[i] - map.weights[i]);
  }
  ShadedDensity now{scenario::DensityDraw(map, weights), 0};
  now.share = static_cast<double>(now.extra.sum()) /
              static_cast<double>(std::max<uint64_t>(1, densities[density].sum()));
  shaded.emplace(density, std::move(now));
}

void Simulation::State::shade_densities() {
  if (scenario.attractors.empty() && carried.empty() && shaded.empty()) return;
  std::erase_if(carried,
                [&](const CarriedAttractor& a) { return find_avatar(a.number) == nullptr; });
  for (size_t d = 0; d < densities.size(); ++d) shade(d);
}

// Of the avatars on a trip to a place that was drawn from a shaded map, those that are due go to
// one of the places that the shading adds, by its share.
void Simulation::State::redirect_attracted() {
  if (shaded.empty()) return;
  const auto review = static_cast<uint64_t>(time() + 0.5);
  for (ScenarioAvatar& p : avatars) {
    if (!p.id || (review + p.number) % kRedirectPeriod != 0 || carries(p)) continue;
    if (p.doing != Doing::kToRandomPlace && p.doing != Doing::kToWaypoint) continue;
    const auto here = shaded.find(static_cast<size_t>(stage_of(p).density));
    if (stage_of(p).density < 0 || here == shaded.end()) continue;
    if (!(unit(p) < here->second.share)) continue;
    const Place place = random_place_of(scenario.densities[here->first], here->second.extra, p);
    if (place) walk_to(p, place, Doing::kToRandomPlace);
  }
}

Result<void> Simulation::attract(const std::string& density, uint64_t person, double radius,
                                 uint8_t weight) {
  State& s = *state_;
  const auto& maps = s.scenario.densities;
  const auto map = std::find_if(maps.begin(), maps.end(),
                                [&](const DensityMap& m) { return m.name == density; });
  if (map == maps.end()) return Error{Errc::kNotFound, "there is no density '" + density + "'"};
  if (person >= s.slot_of.size() || s.find_avatar(person) == nullptr) {
    return Error{Errc::kNotFound, "avatar " + std::to_string(person) + " is not in the crowd"};
  }
  if (!(radius > 0 && radius <= 1000)) {
    return Error{Errc::kBadConfig, "attractor: radius must be above 0 and at most 1000 m"};
  }
  std::erase_if(s.carried, [&](const CarriedAttractor& a) { return a.number == person; });
  const auto index = static_cast<size_t>(map - maps.begin());
  if (weight > 0) s.carried.push_back({index, person, radius, weight});
  s.shade(index);
  return {};
}

}  // namespace throng
