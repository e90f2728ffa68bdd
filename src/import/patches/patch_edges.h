// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "throng/scene.h"

/// Neighbours along the edges of patches.
namespace throng::importer {

/// How many entries of PatchEdge::next an edge of this kind uses; 5 for a kind that does not exist.
[[nodiscard]] constexpr size_t neighbour_count(EdgeBind bind) {
  switch (bind) {
    case EdgeBind::kOpen:
      return 0;
    case EdgeBind::kOne:
    case EdgeBind::kPart:
      return 1;
    case EdgeBind::kTwo:
      return 2;
    case EdgeBind::kFour:
      return 4;
  }
  return 5;
}

/// All four control points in one place.
[[nodiscard]] bool is_collapsed(const std::array<Vec3d, 4>& curve);

/// For formats without neighbours: binds open edges of the patches from `first` on whose control
/// points are the same numbers in opposite order. Edges that are collapsed, or that three or more
/// patches share, stay open.
void bind_equal_edges(PatchSet& set, uint32_t first);

/// A number for each corner, corner_of[4 * patch + vertex]: the smallest 4 * patch + vertex among
/// the corners that bindings and collapsed edges identify. The set must pass check_patches.
[[nodiscard]] std::vector<uint32_t> weld_corners(const PatchSet& set);

}  // namespace throng::importer
