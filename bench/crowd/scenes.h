// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "throng/avatar.h"
#include "throng/base.h"
#include "throng/scene.h"

/// Scenes for crowds: a world, and avatars with one goal each.
namespace throng::bench {

struct Walker {
  Vec3d from, to;    ///< On the ground. [m]
  double speed = 0;  ///< [m/s]
};

/// A world and its walkers, each with one goal.
struct Play {
  std::string name;
  Scene scene;
  AvatarClass avatar;
  std::vector<Walker> walkers;
};

/// A corridor 4 m wide; `side` walkers at each end, one per `area` m2, change ends.
Play corridor(uint32_t side, double area, uint64_t seed);

/// Two corridors 10 m wide that cross; `arm` walkers in each of the four arms, one per `area` m2,
/// walk to the opposite arm.
Play crossing(uint32_t arm, double area, uint64_t seed);

/// A case of SteerBench (XML): its agents with their first targets, and its boxes. Fails with
/// kBadFile and the element that is not supported.
Result<Play> steer_bench_case(const std::string& path);

}  // namespace throng::bench
