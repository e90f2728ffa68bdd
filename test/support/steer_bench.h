// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "throng/avatar.h"
#include "throng/base.h"
#include "throng/scene.h"

/// Scenes for crowds, a world and avatars with one goal each, and a reader of SteerBench's cases.
namespace throng::test {

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

/// Reads a case of SteerBench (XML). `seed` draws what the case leaves to chance; all bodies get
/// the radius of the widest. `name` is used in messages.
///
/// Read are `header` (name, worldBounds), `agent`, `agentRegion` (numAgents, regionBounds),
/// `obstacle` (a box), `obstacleRegion` (numObstacles, obstacleSize, regionBounds),
/// `circleObstacle` (position, radius), `orientedObstacle` or `orientedBoxObstacle` (position,
/// size, thetaY in degrees about Y) and `polygonObstacle` (three or more `vertex` or `point`, also
/// within `vertices`). Agents have a radius, a position (their region's if they have none, or
/// `random`), and one `seekStaticTarget`, whose targetLocation is a point or `random`: in its
/// `regionBounds`, or else in the world. Random places are clear of obstacles, and starts of each
/// other.
///
/// Fails with kBadFile, the line and the element: it is not read (as fleeStaticTarget), something
/// is missing or no number, or there is no room for what is placed at random.
Result<Play> read_steer_bench(std::string_view text, const std::string& name, uint64_t seed);

/// The same for a file. Fails as read_file does, too.
Result<Play> load_steer_bench(const std::string& path, uint64_t seed);

}  // namespace throng::test
