// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <unordered_map>
#include <utility>
#include <vector>

#include "graph/node_mesh.h"
#include "path/edits/solid.h"
#include "path/surface/block_squares.h"
#include "throng/path.h"
#include "world/cell_blocks.h"

/// Obstacles placed on a mesh of nodes since the bake.
namespace throng::path {

/// Where a body could touch a solid its block is cut: level tiles by their cells, curved patches by
/// squares of about a quarter of a metre. What is left of a block are *parts*. What a solid blocks
/// is found once, when it is added; parts and portals are those of all active solids, in whatever
/// order they were added. Copies share the mesh.
class NodeChanges {
 public:
  /// No link over a hole of the mesh is longer. [m]
  NodeChanges(const graph::NodeMesh& mesh, const BlockSquares& squares, double longest_hole_link)
      : mesh_(&mesh), squares_(&squares), longest_hole_link_(longest_hole_link) {}

  ChangeId add(Solid solid);
  /// False if there is none of that id, which is never used again once removed.
  bool set_active(ChangeId change, bool active, bool remove);
  /// Rises with every change.
  [[nodiscard]] uint64_t version() const { return version_; }
  /// Brings what follows up to date. Time: linear in the active obstacles.
  void update();

  [[nodiscard]] bool empty() const { return touched_.empty(); }
  [[nodiscard]] std::span<const graph::NodeBlock> parts() const { return parts_; }
  [[nodiscard]] std::span<const graph::NodePortal> portals() const { return portals_; }
  /// Of a part, or of a block whose portals have changed; none: they are as they were.
  [[nodiscard]] std::optional<std::span<const uint32_t>> portals_of(uint32_t block) const;
  [[nodiscard]] uint32_t base_of(uint32_t part) const {
    return base_of_part_[part - mesh_->blocks().size()];
  }
  /// The numbers of the parts that are left of a block, [first, last); none: it is whole.
  [[nodiscard]] std::optional<std::pair<uint32_t, uint32_t>> parts_of(uint32_t block) const;
  /// The block or the part of it that holds a point, which may lie on its border; or kNoNode.
  [[nodiscard]] uint32_t part_at(uint32_t block, double s, double t) const;
  /// Blocks of the mesh that are cut or have other portals, rising.
  [[nodiscard]] std::span<const uint32_t> touched() const { return touched_; }
  /// Portals of the mesh that are closed, rising, and what is left of each among portals().
  struct Replaced {
    uint32_t portal = 0;
    uint32_t first = 0, last = 0;  // of portals(), numbered as a NodeView does
  };
  [[nodiscard]] std::span<const Replaced> replaced() const { return replaced_; }
  /// Patches with parts, rising.
  [[nodiscard]] std::span<const uint32_t> cut_patches() const { return cut_patches_; }
  [[nodiscard]] uint64_t bytes() const;

 private:
  struct BlockedTile {
    uint32_t patch = 0;
    world::CellRows rows{};
  };
  // Of a curved block: a square of its finest ones, in the order of a quadtree.
  struct BlockedSquare {
    uint32_t block = 0, order = 0;
    friend auto operator<=>(const BlockedSquare&, const BlockedSquare&) = default;
  };
  // Of a portal that leads through the air: those of its 16 pieces that are blocked; a link over a
  // hole has one.
  struct BlockedPieces {
    uint32_t portal = 0;
    uint16_t pieces = 0;
  };
  struct Change {
    bool active = true, removed = false;
    std::vector<BlockedTile> tiles;
    std::vector<BlockedSquare> squares;
    std::vector<BlockedPieces> pieces;
  };

  void block_tiles(const Solid& solid, double around, Change& change,
                   std::vector<uint32_t>& near) const;
  void block_squares(const Solid& solid, uint32_t block, Change& change) const;
  void block_pieces(const Solid& solid, std::span<const uint32_t> near, Change& change) const;
  [[nodiscard]] bool blocks_portal(const Solid& solid, const graph::NodePortal& portal, double from,
                                   double to) const;
  [[nodiscard]] uint8_t finest_level(const graph::NodeBlock& block) const;
  void cut_tiles(const std::vector<BlockedTile>& blocked);
  void cut_squares(const std::vector<BlockedSquare>& blocked);
  template <class IsBlocked>
  void cut(uint32_t block, const IsBlocked& blocked);
  void join_parts(uint32_t block);
  void replace_portals(const std::unordered_map<uint32_t, uint16_t>& pieces);
  void list_portals();

  const graph::NodeMesh* mesh_;
  const BlockSquares* squares_;
  double longest_hole_link_;  // [m]
  uint64_t version_ = 0, updated_ = 0;
  std::vector<Change> changes_;
  std::vector<ChangeId> active_;  // rising

  struct Cut {
    uint32_t first = 0, last = 0;  // of parts_
  };
  std::unordered_map<uint32_t, Cut> cuts_;  // by block; looked up only
  std::vector<uint32_t> cut_blocks_, cut_patches_;
  std::vector<graph::NodeBlock> parts_;
  std::vector<uint32_t> base_of_part_;
  std::vector<graph::NodePortal> portals_;
  std::vector<Replaced> replaced_;
  std::vector<uint32_t> touched_;
  std::unordered_map<uint32_t, uint32_t> place_of_touched_;  // looked up only
  std::vector<uint32_t> first_portal_, portal_of_;           // of those touched, then of parts
};

}  // namespace throng::path
