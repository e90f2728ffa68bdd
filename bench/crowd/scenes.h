// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "throng/avatar_class.h"
#include "throng/result.h"
#include "throng/scene.h"

/// Scenes that crowds have to get through.
namespace throng::bench {

struct Walker {
  Vec3d from, to;    ///< On the ground. [m]
  double speed = 0;  ///< [m/s]
};

/// A world and who walks in it, each to one goal.
struct Play {
  std::string name;
  Scene scene;
  AvatarClass avatar;
  std::vector<Walker> walkers;
};

/// A corridor 4 m wide; `side` walkers at each end, one in `area` m2, change ends.
Play corridor(uint32_t side, double area, uint64_t seed);

/// Two corridors 10 m wide that cross; `arm` walkers in each of the four arms, one in `area` m2, go
/// to the one beyond.
Play crossing(uint32_t arm, double area, uint64_t seed);

/// A case of SteerBench (XML): its agents with their first targets, and its boxes. Fails with
/// kBadFile and what cannot be used.
Result<Play> steer_bench_case(const std::string& path);

}  // namespace throng::bench
