// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <vector>

#include "path/mesh.h"
#include "world/ground.h"

/// From the corners of a way to legs that a body can walk.
namespace throng {

/// A stop of a way, on a level.
struct Stop {
  GroundPoint at;
  uint32_t rect = kNoRect;
};

/// A unit beside a corner, away from what is missing there.
inline GroundPoint beside(const MeshCorner& corner) {
  return {(int64_t{corner.x} << kUnitBits) + corner.away_x,
          (int64_t{corner.z} << kUnitBits) + corner.away_z};
}

/// Walks from `from` by way of the corners to `to`, a unit beside each corner, and past every other
/// corner that a leg would graze. False if a leg is blocked for another reason.
class LegWalker {
 public:
  LegWalker(const WorldData& world, const PathMesh& mesh)
      : ground_{world, mesh.avatar_class}, mesh_(&mesh) {}

  bool walk(const Stop& from, const std::vector<uint32_t>& corners, GroundPoint to,
            std::vector<Stop>& stops);

 private:
  bool leg(GroundPoint to, int32_t depth, std::vector<Stop>& stops);
  std::optional<GroundPoint> grazed(GroundLevel level, GroundPoint from, GroundPoint to) const;

  WorldGround ground_;
  const PathMesh* mesh_;
};

}  // namespace throng
