// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "throng/base.h"
#include "world/walk.h"
#include "world/zone_data.h"

/// The walkable ground of one class as rectangles of cells joined by portals: what path search runs
/// on.
namespace throng::path {

inline constexpr uint32_t kNoRect = UINT32_MAX;
inline constexpr uint32_t kNoCorner = UINT32_MAX;

/// Sides of blocks, of small worlds and of others. [cells]
inline constexpr int32_t kSmallBlock = 8;
inline constexpr int32_t kLargeBlock = 32;

/// A point of the ground's plane. [cells]
struct CellPoint {
  double x = 0, z = 0;
};

/// Cells [x, x + width) x [z, z + depth) of the world's grid on one level.
struct MeshRect {
  uint32_t level = 0;  // of the world
  int32_t x = 0, z = 0;
  int32_t width = 0, depth = 0;
  uint32_t first_portal = 0;  // its portals end where the next rectangle's begin
  uint32_t component = 0;     // rectangles that portals connect share it
  uint32_t first_block = 0;   // of its blocks, in rows
};

/// A stretch of a rectangle's border over which a step leads to another, and back. Portals of a
/// rectangle go around it with its inside on the left: south (z), east (x + width), north, west.
/// `from` and `to` count cells in that direction.
struct MeshPortal {
  uint32_t rect = 0;  // behind it
  int32_t from = 0, to = 0;
  uint32_t from_corner = kNoCorner, to_corner = kNoCorner;
};

/// Where three of four cells are connected and the fourth blocks: shortest paths turn only here.
struct MeshCorner {
  int32_t x = 0, z = 0;           // the point that the four cells share
  int8_t away_x = 0, away_z = 0;  // from the missing cell: 1 or -1
  uint32_t first_rect = 0;        // of corner_rects; they end where the next corner's begin
};

/// A point of a path, in a rectangle.
struct Stop {
  world::GroundPoint at;
  uint32_t rect = kNoRect;
};

/// A unit beside a corner, away from what is missing there.
inline world::GroundPoint beside(const MeshCorner& corner) {
  return {(int64_t{corner.x} << world::kUnitBits) + corner.away_x,
          (int64_t{corner.z} << world::kUnitBits) + corner.away_z};
}

/// Where the search sees a point.
inline CellPoint in_cells(world::GroundPoint p) {
  return {static_cast<double>(p.x) / world::kUnitsPerCell,
          static_cast<double>(p.z) / world::kUnitsPerCell};
}

/// Makes portals when a search comes to them, for a mesh that is made on demand.
class PortalSource {
 public:
  /// Of a rectangle. Rectangles may move, their numbers stay. Valid until the next call.
  virtual std::span<const MeshPortal> portals_of(uint32_t rect) = 0;
  /// What a search has to count as memory of its own. [bytes]
  [[nodiscard]] virtual uint64_t counted_bytes() const = 0;

 protected:
  PortalSource() = default;
  PortalSource(const PortalSource&) = default;
  PortalSource& operator=(const PortalSource&) = default;
  ~PortalSource() = default;
};

struct PathMesh {
  int32_t avatar_class = 0;
  int32_t step = 0;             // [mm]
  uint64_t kinds = 0;           // bit by area kind: some cell of a rectangle has it, as baked
  std::vector<uint32_t> first;  // per level of the world: its first rectangle; one more
  std::vector<MeshRect> rects;  // one more at the end, for its first_portal and first_block
  std::vector<MeshPortal> portals;
  std::vector<MeshCorner> corners;     // one more at the end, for its first_rect
  std::vector<uint32_t> corner_rects;  // rectangles around each corner
  PortalSource* source = nullptr;      // null: all portals are made

  /// In the order in which they go around it. Take references to rectangles after this.
  [[nodiscard]] std::span<const MeshPortal> portals_of(uint32_t rect) const {
    if (source != nullptr) return source->portals_of(rect);
    const uint32_t begin = rects[rect].first_portal;
    return {portals.data() + begin, rects[rect + size_t{1}].first_portal - begin};
  }
  [[nodiscard]] uint32_t rect_at(uint32_t level, int32_t x, int32_t z) const;  // cell of the grid
  /// Rectangles are cut into blocks of at most so many cells along a side, small enough for lists
  /// of what may matter to any of their points.
  int32_t block_side = kSmallBlock;
  [[nodiscard]] uint32_t block_count() const { return rects.back().first_block; }
  [[nodiscard]] uint32_t block_at(uint32_t rect, int32_t x, int32_t z) const {  // cell of the grid
    const MeshRect& r = rects[rect];
    const int32_t across = (r.width + block_side - 1) / block_side;
    return r.first_block +
           static_cast<uint32_t>((z - r.z) / block_side * across + (x - r.x) / block_side);
  }
  /// The cells of the n-th block of a rectangle.
  [[nodiscard]] MeshRect block(uint32_t rect, uint32_t n) const;
  [[nodiscard]] size_t corner_count() const { return corners.size() - 1; }
  [[nodiscard]] uint64_t bytes() const;
};

/// Cuts the rectangles into blocks of a side; returns how many there are then.
uint32_t cut_into_blocks(PathMesh& mesh, int32_t side);

/// Of a world whose zones can all be used. Fails with kCancelled. The same for any number of
/// workers.
Result<PathMesh> build_mesh(const world::WorldData& world, int32_t avatar_class, int32_t workers,
                            Context& context);

}  // namespace throng::path
