// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>

#include "graph/node_mesh.h"
#include "path/surface/node_changes.h"

/// A mesh of nodes as it is now: as it was baked, less what obstacles block since, with areas of
/// other costs and off-mesh links.
namespace throng::path {

/// Blocks and portals have the mesh's numbers. Above these are parts of the blocks that obstacles
/// and areas cut, to which no portal leads any more, portals between parts, and links.
class NodeView {
 public:
  /// As it was baked, if `changes` are null.
  explicit NodeView(const graph::NodeMesh& mesh, const NodeChanges* changes = nullptr)
      : mesh_(&mesh), changes_(changes) {}

  [[nodiscard]] const graph::NodeMesh& mesh() const { return *mesh_; }
  [[nodiscard]] const NodeChanges* changes() const { return changes_; }
  [[nodiscard]] bool is_as_baked() const { return changes_ == nullptr || changes_->empty(); }

  [[nodiscard]] const graph::NodeBlock& block(uint32_t b) const {
    const auto blocks = mesh_->blocks();
    return b < blocks.size() ? blocks[b] : changes_->parts()[b - blocks.size()];
  }
  [[nodiscard]] graph::NodePortal portal(uint32_t p) const {
    const graph::PortalList& portals = mesh_->portals();
    return p < portals.size() ? portals[p] : changes_->portals()[p - portals.size()];
  }
  [[nodiscard]] graph::PortalSides sides(uint32_t p) const {
    const graph::PortalList& portals = mesh_->portals();
    if (p < portals.size()) return portals.sides(p);
    const graph::NodePortal& portal = changes_->portals()[p - portals.size()];
    return {portal.a, portal.b, portal.one_way};
  }
  [[nodiscard]] size_t block_count() const {
    return mesh_->blocks().size() + (changes_ != nullptr ? changes_->parts().size() : 0);
  }
  [[nodiscard]] size_t portal_count() const {
    return mesh_->portals().size() + (changes_ != nullptr ? changes_->portals().size() : 0);
  }
  [[nodiscard]] const graph::NodeSurface& surface(uint32_t b) const {
    return mesh_->patches()[block(b).patch];
  }
  [[nodiscard]] std::span<const uint32_t> portals_of(uint32_t b) const {
    if (!is_as_baked()) {
      if (const auto changed = changes_->portals_of(b)) return *changed;
    }
    return mesh_->portals_of(b);
  }
  /// Cost of a metre in a block, beside that of its inclination.
  [[nodiscard]] double factor(uint32_t b) const {
    return b < mesh_->blocks().size() ? 1 : changes_->factor(b);
  }
  /// What going through a portal costs, from one point to the other. [m]
  [[nodiscard]] double cost_through(uint32_t p, const graph::NodePortal& portal, Vec3d out,
                                    Vec3d in) const {
    const double* link = is_as_baked() ? nullptr : changes_->link_cost(p);
    return link != nullptr ? *link : graph::portal_length(portal, out, in);
  }
  [[nodiscard]] bool is_link(uint32_t p) const {
    return !is_as_baked() && changes_->link_cost(p) != nullptr;
  }
  /// No path costs less than the straight line times this. [0 to 1]
  [[nodiscard]] double min_factor() const { return is_as_baked() ? 1 : changes_->min_factor(); }
  [[nodiscard]] bool has_links() const { return !is_as_baked() && changes_->has_links(); }
  /// The block of the mesh that it is, or is a part of.
  [[nodiscard]] uint32_t base_of(uint32_t b) const {
    return b < mesh_->blocks().size() ? b : changes_->base_of(b);
  }

 private:
  const graph::NodeMesh* mesh_;
  const NodeChanges* changes_;
};

/// Somewhere in a block.
struct BlockPoint {
  uint32_t block = graph::kNoNode;
  double s = 0, t = 0;
};

/// A portal and the direction in which it is crossed.
struct Crossing {
  uint32_t portal = 0;
  bool backward = false;  ///< From b to a.
  friend bool operator==(const Crossing&, const Crossing&) = default;
};

/// The middle of a crossing's portal in the block that it leaves and in the one that it comes to.
struct CrossingEnds {
  BlockPoint out, in;
};

inline CrossingEnds ends_of(const graph::NodePortal& portal, bool backward) {
  const auto middle = [](uint32_t block, const std::array<double, 4>& on) {
    return BlockPoint{block, (on[0] + on[2]) / 2, (on[1] + on[3]) / 2};
  };
  const BlockPoint a = middle(portal.a, portal.on_a), b = middle(portal.b, portal.on_b);
  return backward ? CrossingEnds{b, a} : CrossingEnds{a, b};
}

inline CrossingEnds ends_of(const NodeView& view, const Crossing& crossing) {
  return ends_of(view.portal(crossing.portal), crossing.backward);
}

inline Vec3d position(const NodeView& view, const BlockPoint& at) {
  return view.surface(at.block).at(at.s, at.t);
}

/// Calls visit(crossing) for each crossing out of a block.
template <class Visit>
void for_each_arc_out(const NodeView& view, uint32_t block, Visit visit) {
  for (const uint32_t p : view.portals_of(block)) {
    const graph::PortalSides portal = view.sides(p);
    const bool backward = portal.a != block;
    if (!(backward && portal.one_way)) visit(Crossing{p, backward});
  }
}

/// Calls visit(crossing) for each crossing into a block.
template <class Visit>
void for_each_arc_in(const NodeView& view, uint32_t block, Visit visit) {
  for (const uint32_t p : view.portals_of(block)) {
    const graph::PortalSides portal = view.sides(p);
    const bool backward = portal.a == block;
    if (!(backward && portal.one_way)) visit(Crossing{p, backward});
  }
}

}  // namespace throng::path
