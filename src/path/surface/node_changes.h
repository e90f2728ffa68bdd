// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <unordered_map>
#include <utility>
#include <vector>

#include "graph/node_mesh.h"
#include "path/edits/found_blocker.h"
#include "path/edits/solid.h"
#include "path/surface/block_squares.h"
#include "throng/path.h"
#include "world/cell_blocks.h"

/// What edits have changed on a mesh of nodes since the bake.
namespace throng::path {

/// Where a body could touch a solid its block is cut: level tiles by their cells, curved patches by
/// squares of about a quarter of a metre. What is left of a block are *parts*. An area of another
/// cost cuts its blocks likewise, so all of a part costs the same; where areas overlap, the one
/// that was added last counts. Off-mesh links are portals. What a change touches is found once,
/// when it is added; parts and portals are those of all active changes, in whatever order solids
/// were added and however often they were updated between. Copies share the mesh.
class NodeChanges {
 public:
  /// No link over a hole of the mesh is longer. [m]
  NodeChanges(const graph::NodeMesh& mesh, const BlockSquares& squares, double longest_hole_link)
      : mesh_(&mesh), squares_(&squares), longest_hole_link_(longest_hole_link) {
    area_cost_.fill(1);
  }

  ChangeId add(Solid solid);
  /// Cells whose middle lies in the prism, and squares of curved ground.
  ChangeId add_area(const Prism& prism, uint8_t kind);
  /// An end of a link, in a block as it was baked.
  struct LinkEnd {
    uint32_t block = graph::kNoNode;
    double s = 0, t = 0;
  };
  struct Link {
    LinkEnd from, to;
    double cost = 0;  // [m]
    bool two_way = true;
  };
  ChangeId add_link(const Link& link);
  /// Of a metre, as Edits::set_area_cost.
  void set_area_cost(uint8_t kind, double cost);
  /// False if there is none of that id, which is never used again once removed.
  bool set_active(ChangeId change, bool active, bool remove);
  /// Rises with every change that concerns the mesh: a solid that blocks none of it does not, nor
  /// does a cost that none of it has.
  [[nodiscard]] uint64_t version() const { return version_; }
  /// Brings what follows up to date. Cuts the blocks again that changes since the last call touch;
  /// parts and portals of the others are copied, because their numbers change.
  void update();
  /// How often update() has cut a block.
  [[nodiscard]] uint64_t cut_count() const { return cut_count_; }

  [[nodiscard]] bool empty() const { return touched_.empty(); }
  [[nodiscard]] std::span<const graph::NodeBlock> parts() const { return parts_; }
  [[nodiscard]] std::span<const graph::NodePortal> portals() const { return portals_; }
  /// Of a part, or of a block whose portals have changed; none: they are as they were.
  [[nodiscard]] std::optional<std::span<const uint32_t>> portals_of(uint32_t block) const;
  [[nodiscard]] uint32_t base_of(uint32_t part) const {
    return base_of_part_[part - mesh_->blocks().size()];
  }
  /// Cost of a metre in a part.
  [[nodiscard]] double factor(uint32_t part) const {
    return area_cost_[area_of_part_[part - mesh_->blocks().size()]];
  }
  /// No path costs less than the straight line times this. [0 to 1]
  [[nodiscard]] double min_factor() const { return min_factor_; }
  /// Is a link in force?
  [[nodiscard]] bool has_links() const { return !link_costs_.empty(); }
  /// What crossing a portal costs if it is a link of add_link(); null: it is none. [m]
  [[nodiscard]] const double* link_cost(uint32_t portal) const {
    return portal < first_link_ ? nullptr : &link_costs_[portal - first_link_];
  }
  /// The numbers of the parts that are left of a block, [first, last); none: it is whole.
  [[nodiscard]] std::optional<std::pair<uint32_t, uint32_t>> parts_of(uint32_t block) const;
  /// The block or the part of it that holds a point, which may lie on its border; or kNoNode.
  [[nodiscard]] uint32_t part_at(uint32_t block, double s, double t) const;
  /// The obstacle, or the area of infinite cost, that keeps the class from a point of a block.
  [[nodiscard]] FoundBlocker blocker_at(uint32_t block, double s, double t) const;
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
  enum class Kind : uint8_t { kSolid, kArea, kLink };
  struct Change {
    bool active = true, removed = false;
    Kind kind = Kind::kSolid;
    uint8_t area = 0;
    // Blocked, or in the area.
    std::vector<BlockedTile> tiles;
    std::vector<BlockedSquare> squares;
    std::vector<BlockedPieces> pieces;
    Link link;
  };
  // What becomes of a cell or square: its area kind, or
  static constexpr int kBlocked = 64, kMixed = -1;
  struct TileLabels {
    uint32_t patch = 0;
    world::CellRows blocked{};
    std::vector<std::pair<uint8_t, world::CellRows>> areas;  // which share no cell
  };
  struct SquareLabel {
    BlockedSquare square;
    int label = 0;
  };
  // While they are collected: of several for one square the one of the highest rank counts.
  struct RankedSquare {
    BlockedSquare square;
    uint32_t rank = 0;
    int label = 0;
  };

  // A block that is cut: what is left of it, and the portals between, numbered from 0.
  struct CutBlock {
    uint32_t block = 0;
    std::vector<graph::NodeBlock> parts;
    std::vector<uint8_t> areas;  // of the parts
    std::vector<graph::NodePortal> portals;
  };
  // What is left of a portal of the mesh. An end in a block that is cut is the number of its part.
  struct LeftPortal {
    graph::NodePortal portal;
    bool in_part_a = false, in_part_b = false;
  };
  using ChangesByPlace = std::map<uint32_t, std::vector<ChangeId>>;  // active ones, rising
  // Places to cut again. Areas list them with every switch, also while nothing is ever cut because
  // all costs are 1: doubles are removed whenever half of the list may be doubles.
  class StalePlaces {
   public:
    void add(uint32_t place);
    void clear();
    /// Rising, without doubles.
    const std::vector<uint32_t>& sorted();
    [[nodiscard]] uint64_t bytes() const { return places_.capacity() * sizeof(uint32_t); }

   private:
    static constexpr size_t kMinPlaces = 256;
    std::vector<uint32_t> places_;
    size_t max_places_ = kMinPlaces;  // until doubles are removed
  };

  ChangeId keep(Change change);
  /// Lists a change, or no longer, where it blocks something, and marks that as stale.
  void list(ChangeId id, bool active);
  /// Counts a change that concerns the mesh.
  void note(const Change& change);

  void block_tiles(const Solid& solid, double around, Change& change,
                   std::vector<uint32_t>& near) const;
  void block_squares(const Solid& solid, uint32_t block, Change& change) const;
  void mark_squares(const Prism& prism, uint32_t block, Change& change) const;
  [[nodiscard]] TileLabels tile_labels(uint32_t patch) const;
  [[nodiscard]] std::vector<SquareLabel> square_labels(uint32_t block) const;
  void block_pieces(const Solid& solid, std::span<const uint32_t> near, Change& change) const;
  [[nodiscard]] bool blocks_portal(const Solid& solid, const graph::NodePortal& portal, double from,
                                   double to) const;
  [[nodiscard]] uint8_t finest_level(const graph::NodeBlock& block) const;
  void cut_tile(uint32_t patch, std::vector<uint32_t>& recut);
  void cut_squares(uint32_t block, std::vector<uint32_t>& recut);
  template <class LabelOf>
  [[nodiscard]] CutBlock cut(uint32_t block, const LabelOf& label_of);
  void join_parts(CutBlock& cut) const;
  /// Null: the block is whole.
  [[nodiscard]] const CutBlock* find_cut(uint32_t block) const;
  [[nodiscard]] std::vector<LeftPortal> left_of(uint32_t portal, uint16_t blocked) const;
  void cut_portals(const std::vector<uint32_t>& recut);
  void number_parts();
  void number_portals();
  [[nodiscard]] const graph::NodeBlock& block_of_part(uint32_t b) const {
    return b < mesh_->blocks().size() ? mesh_->blocks()[b] : parts_[b - mesh_->blocks().size()];
  }
  void add_links();
  void find_min_factor();
  void list_portals();

  const graph::NodeMesh* mesh_;
  const BlockSquares* squares_;
  double longest_hole_link_;  // [m]
  uint64_t version_ = 0, updated_ = 0;
  std::vector<Change> changes_;
  std::vector<ChangeId> active_;  // rising
  std::array<double, kBlocked + 1> area_cost_;
  double min_factor_ = 1;

  // What is kept from one update to the next, by the tile's patch, the curved block and the portal.
  ChangesByPlace tile_changes_, block_changes_, portal_changes_;
  StalePlaces stale_tiles_, stale_blocks_, stale_portals_;
  std::map<uint32_t, std::vector<CutBlock>> cut_tiles_;  // blocks rising
  std::map<uint32_t, CutBlock> cut_curved_;
  std::map<uint32_t, std::vector<LeftPortal>> left_;  // of portals that are closed
  uint64_t cut_count_ = 0;

  struct Cut {
    uint32_t first = 0, last = 0;  // of parts_
  };
  std::unordered_map<uint32_t, Cut> cuts_;  // by block; looked up only
  std::vector<uint32_t> cut_blocks_, cut_patches_;
  std::vector<graph::NodeBlock> parts_;
  std::vector<uint32_t> base_of_part_;
  std::vector<uint8_t> area_of_part_;
  std::vector<graph::NodePortal> portals_;
  std::vector<Replaced> replaced_;
  uint32_t first_link_ = UINT32_MAX;  // Portals from here on are links,
  std::vector<double> link_costs_;    // of these costs. [m]
  std::vector<uint32_t> touched_;
  std::unordered_map<uint32_t, uint32_t> place_of_touched_;  // looked up only
  std::vector<uint32_t> first_portal_, portal_of_;           // of those touched, then of parts
};

}  // namespace throng::path
