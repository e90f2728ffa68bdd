// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <vector>

#include "path/ground/cells.h"
#include "path/ground/mesh.h"

/// From the corners of a path to segments that a body can walk.
namespace throng::path {

/// A point that four cells of the grid share.
struct CellCorner {
  int32_t x = 0, z = 0;
};

/// Walks from `from` over the corners to `to`, a unit beside each corner, and past every other
/// corner that a segment would graze. False if a segment is blocked for another reason.
class SegmentWalker {
 public:
  SegmentWalker(const Cells& cells, const PathMesh& mesh) : cells_(cells), mesh_(mesh) {}

  bool walk(const Stop& from, const std::vector<uint32_t>& corners, world::GroundPoint to,
            std::vector<Stop>& stops);

 private:
  bool segment(world::GroundPoint to, int32_t depth, std::vector<Stop>& stops);
  std::optional<world::GroundPoint> grazed(uint32_t level, world::GroundPoint from,
                                           world::GroundPoint to) const;
  bool slip_by(uint32_t level, world::GroundPoint from, world::GroundPoint to,
               std::vector<Stop>& stops);
  [[nodiscard]] bool gets_past(const CellCorner& corner, const Stop& from,
                               world::GroundPoint to) const;

  const Cells& cells_;
  const PathMesh& mesh_;
};

}  // namespace throng::path
