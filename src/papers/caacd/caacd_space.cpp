// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <cmath>
#include <string>

#include "core/random.h"
#include "throng/papers.h"

// Random spaces for [CAACD] section V: a position is drawn again until it is free.
namespace throng::caacd {
namespace {

constexpr uint64_t kMaxDraws = 20000;

// One stream for each purpose and index, so that one more avatar does not change the others.
enum Purpose : uint64_t { kObstaclePlace = 1, kStart, kTarget, kHeading, kSpeed, kObstacleSize };

uint64_t stream_of(Purpose purpose, size_t index) { return uint64_t{purpose} << 32 | index; }

double square(double x) { return x * x; }

double flat_distance2(Vec3d a, Vec3d b) { return square(a.x - b.x) + square(a.z - b.z); }

// A point of the square, `margin` inside of its sides.
Vec3d random_point(uint64_t seed, uint64_t stream, uint64_t attempt, double side, double margin) {
  const double range = side - 2 * margin;
  return {margin + range * random_unit(seed, stream, 2 * attempt), 0,
          margin + range * random_unit(seed, stream, 2 * attempt + 1)};
}

// A direction, from a point of the unit disc: sines differ between machines, square roots do not.
Vec3d random_heading(uint64_t seed, size_t index) {
  for (uint64_t attempt = 0; attempt < kMaxDraws; ++attempt) {
    const Vec3d p = random_point(seed, stream_of(kHeading, index), attempt, 2, 0);
    const Vec3d v{p.x - 1, 0, p.z - 1};
    const double size = length(v);
    if (size > 0.1 && size <= 1) return v * (1 / size);
  }
  return {1, 0, 0};
}

bool outside_alert_fields(Vec3d p, const Space& space) {
  for (const Obstacle& o : space.obstacles) {
    if (flat_distance2(p, o.position) <= square(o.fields.alert)) return false;
  }
  return true;
}

bool away_from_all(Vec3d p, const Space& space, double distance) {
  for (const Body& body : space.bodies) {
    if (flat_distance2(p, body.position) <= square(distance)) return false;
  }
  return true;
}

Error too_full(const char* what, size_t placed) {
  return {Errc::kLimit, std::string("caacd: no room for ") + what + " " +
                            std::to_string(placed + 1) +
                            "; give more room, or fewer or smaller ones"};
}

bool is_sound(const SpaceConfig& c) {
  constexpr double kMax = 1e9;
  const bool fields = c.fields.repulsive > 0 && c.fields.precaution >= c.fields.repulsive &&
                      c.fields.alert >= c.fields.precaution && c.fields.alert < kMax;
  const bool sizes = c.min_obstacle > 0 && c.largest_obstacle >= c.min_obstacle &&
                     c.largest_obstacle < kMax && c.obstacle_precaution >= 0 &&
                     c.obstacle_alert >= c.obstacle_precaution && c.obstacle_alert < kMax;
  return fields && sizes && c.avatars >= 1 && c.avatars <= 2000 && c.side > 0 && c.side < kMax &&
         c.obstacles >= 0 && c.obstacles <= 1000;
}

}  // namespace

Result<Space> random_space(const SpaceConfig& config, const Model& model) {
  if (!is_sound(config)) {
    return Error{Errc::kBadConfig,
                 "caacd: need 1 to 2000 avatars, 0 to 1000 obstacles, a side above 0, and radii "
                 "above 0 that grow from the repulsive to the alert field"};
  }
  if (auto ok = check_model(model); !ok) return ok.error();
  const uint64_t seed = config.seed;
  Space space;
  for (size_t i = 0; i < static_cast<size_t>(config.obstacles); ++i) {
    const double radius =
        config.min_obstacle + (config.largest_obstacle - config.min_obstacle) *
                                  random_unit(seed, stream_of(kObstacleSize, i), 0);
    const Fields fields{radius, radius + config.obstacle_precaution,
                        radius + config.obstacle_alert};
    // Obstacles leave a gap between them for an avatar and its precaution field.
    const auto is_free = [&](Vec3d p) {
      for (const Obstacle& o : space.obstacles) {
        const double apart = o.fields.precaution + fields.precaution + 2 * config.fields.precaution;
        if (flat_distance2(p, o.position) <= square(apart)) return false;
      }
      return true;
    };
    bool placed = false;
    if (2 * fields.alert < config.side) {
      for (uint64_t attempt = 0; attempt < kMaxDraws && !placed; ++attempt) {
        const Vec3d p =
            random_point(seed, stream_of(kObstaclePlace, i), attempt, config.side, fields.alert);
        if (is_free(p)) {
          space.obstacles.push_back({p, fields});
          placed = true;
        }
      }
    }
    if (!placed) return too_full("obstacle", i);
  }
  for (size_t i = 0; i < static_cast<size_t>(config.avatars); ++i) {
    bool placed = false;
    for (uint64_t attempt = 0; attempt < kMaxDraws && !placed; ++attempt) {
      const Vec3d p = random_point(seed, stream_of(kStart, i), attempt, config.side, 0);
      if (!outside_alert_fields(p, space)) continue;
      if (!away_from_all(p, space, 2 * config.fields.precaution)) continue;
      const Vec3d heading = random_heading(seed, i);
      const double speed = model.max_speed * random_unit(seed, stream_of(kSpeed, i), 0);
      space.bodies.push_back({.position = p,
                              .velocity = heading * speed,
                              .forward = heading,
                              .fields = config.fields,
                              .id = static_cast<uint32_t>(i)});
      placed = true;
    }
    if (!placed) return too_full("avatar", i);
    for (uint64_t attempt = 0; attempt < kMaxDraws; ++attempt) {
      const Vec3d p = random_point(seed, stream_of(kTarget, i), attempt, config.side, 0);
      if (!outside_alert_fields(p, space)) continue;
      space.targets.push_back(p);
      break;
    }
    if (space.targets.size() <= i) return too_full("target", i);
  }
  return space;
}

}  // namespace throng::caacd
