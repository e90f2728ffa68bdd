// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "bake/surface/body_sweep.h"
#include "bake/surface/patch_links.h"
#include "world/cell_blocks.h"
#include "world/zone_data.h"

/// Objects on, in, over and under ground of Bezier patches: which level tiles carry them, and how
/// bodies get from there to the patches and back.
namespace throng::bake {

/// Adds up where a scene has patches and where it has other ground, triangle by triangle. The
/// result does not depend on their order.
class ObjectSurvey {
 public:
  explicit ObjectSurvey(const world::WorldData& world);
  void add(const Scene& scene, size_t triangle);

  /// Is most of the ground, as seen from above, of Bezier patches? Then these carry walkers, too.
  [[nodiscard]] bool is_mostly_patches() const;
  /// By level tiles as seen from above, row by row: may a level there carry ground that is not of a
  /// patch?
  [[nodiscard]] const std::vector<uint8_t>& tiles() const { return tiles_; }

 private:
  /// Areas as whole numbers, so that a sum is exact.
  struct Sum {
    uint64_t high = 0, low = 0;  ///< In 2^12 m^2, and what is left in 2^-20 m^2.
    void add(double area);
  };

  const world::WorldData& world_;
  Sum patches_, others_;
  std::vector<uint8_t> tiles_;
};

/// The cells of a level whose floor is not a patch's. Linear in the triangles in the tile and the
/// cells under them.
[[nodiscard]] world::CellRows find_object_cells(const TriangleSquares& triangles,
                                                const world::WorldData& world, uint32_t level);

/// A level whose nodes lie on objects alone.
struct ObjectLevel {
  uint32_t level = 0;  ///< Of the world.
  world::CellRows cells{};
};

/// Is a cell of a level's tile one of an object? `objects`: sorted by level; levels that are not
/// among them have none.
[[nodiscard]] bool is_object_cell(std::span<const ObjectLevel> objects, uint32_t level, int32_t x,
                                  int32_t z);

/// From cells of objects beside which a class steps down, or up, to ground of a patch, to the
/// nearest of the patch's cells to which its body can go straight: one for each half metre.
/// `patch_b` counts levels of the world.
[[nodiscard]] std::vector<graph::CellPair> link_objects(const PatchLinkInput& input,
                                                        std::span<const ObjectLevel> objects,
                                                        int32_t workers);

}  // namespace throng::bake
