// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <bit>
#include <compare>
#include <cstdint>
#include <optional>
#include <utility>

#include "world/air_data.h"
#include "world/air_tree.h"

/// Leaves of the octree of the air, as links to the ground name them.
namespace throng::world {

/// The sky over the octree of a zone, or all air of a zone without one.
inline constexpr uint32_t kSkyLeaf = UINT32_MAX;

/// A free cube of a zone's octree, or a connected piece of the free voxels of a block: a floor
/// through a block has one piece above it and another below.
struct AirLeaf {
  uint32_t node = kSkyLeaf;  ///< Index into AirTree::nodes.
  uint32_t piece = 0;        ///< Of a block: the lowest bit of the piece.

  friend auto operator<=>(const AirLeaf&, const AirLeaf&) = default;
};

/// The bits of a block's free voxels that are connected with one of them over faces.
constexpr uint64_t connected_voxels(uint64_t free, uint32_t bit) {
  constexpr uint64_t kLowX = 0x1111111111111111, kHighX = kLowX << 3;
  constexpr uint64_t kLowY = 0x000f000f000f000f, kHighY = kLowY << 12;
  uint64_t piece = uint64_t{1} << bit & free;
  for (uint64_t before = 0; piece != before;) {
    before = piece;
    piece |= ((piece & ~kHighX) << 1 | (piece & ~kLowX) >> 1 | (piece & ~kHighY) << 4 |
              (piece & ~kLowY) >> 4 | piece << 16 | piece >> 16) &
             free;
  }
  return piece;
}

/// A leaf, and the cube of the octree that it fills or is a piece of; of the sky: of no side.
struct AirLeafPlace {
  AirLeaf leaf;
  AirCube cube;
};

/// Index into AirTree::nodes of the node that holds a voxel, and its cube. [within the stack]
inline std::pair<uint32_t, AirCube> air_node_at(const AirTree& tree, int32_t x, int32_t y,
                                                int32_t z) {
  const int32_t up = y - tree.base;
  int32_t side = tree.side;
  auto node = static_cast<uint32_t>(up / side);
  while (air_kind(tree.nodes[node]) == AirKind::kInner) {
    side >>= 1;
    const auto child = static_cast<uint32_t>(
        ((x & side) != 0 ? 1 : 0) | ((up & side) != 0 ? 2 : 0) | ((z & side) != 0 ? 4 : 0));
    node = air_number(tree.nodes[node]) + child;
  }
  return {node, {x & -side, tree.base + (up & -side), z & -side, side}};
}

/// The leaf that holds a voxel of a zone, counted from the zone's corner; none if it is not free.
/// `tree` may be null: all of the zone is free. [inside of the zone and the layers of the air]
inline std::optional<AirLeafPlace> air_leaf_at(const AirTree* tree, int32_t x, int32_t y,
                                               int32_t z) {
  if (tree == nullptr || y < tree->base || y >= tree->base + int64_t{tree->side} * tree->roots) {
    return AirLeafPlace{};
  }
  const auto [node, cube] = air_node_at(*tree, x, y, z);
  const uint32_t word = tree->nodes[node];
  if (air_kind(word) == AirKind::kFree) return AirLeafPlace{{node, 0}, cube};
  if (air_kind(word) != AirKind::kLeaf) return std::nullopt;
  const uint64_t piece =
      connected_voxels(tree->leaves[air_number(word)], air_bit(x, y - tree->base, z));
  if (piece == 0) return std::nullopt;
  return AirLeafPlace{{node, static_cast<uint32_t>(std::countr_zero(piece))}, cube};
}

/// Does a zone's octree have this leaf? `tree` may be null.
inline bool has_leaf(const AirTree* tree, const AirLeaf& leaf) {
  if (leaf.node == kSkyLeaf) return leaf.piece == 0;
  if (tree == nullptr || leaf.node >= tree->nodes.size() || leaf.piece >= 64) return false;
  const uint32_t word = tree->nodes[leaf.node];
  if (air_kind(word) == AirKind::kFree) return leaf.piece == 0;
  if (air_kind(word) != AirKind::kLeaf) return false;
  const uint64_t piece = connected_voxels(tree->leaves[air_number(word)], leaf.piece);
  return piece != 0 && std::countr_zero(piece) == static_cast<int32_t>(leaf.piece);
}

}  // namespace throng::world
