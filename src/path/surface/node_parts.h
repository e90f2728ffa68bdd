// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "path/ground/open_list.h"
#include "path/surface/node_view.h"

/// What of a mesh can be reached from where, without a search over its portals.
namespace throng::path {

/// Blocks of one part (a strongly connected component) can reach each other; one-way portals lead
/// from part to part.
class NodeParts {
 public:
  explicit NodeParts(const graph::NodeMesh& mesh, int32_t workers);

  /// A query's memory: which parts are reached.
  class Reached {
   public:
    [[nodiscard]] bool holds(uint32_t part) const { return marks_[part] == query_; }

   private:
    friend class NodeParts;
    std::vector<uint32_t> marks_;
    uint32_t query_ = 0;
    std::vector<uint32_t> open_;
    struct Near {
      double far;
      uint32_t patch;
      bool operator<(const Near& other) const {
        return far != other.far ? far > other.far : patch > other.patch;
      }
    };
    OpenList<Near> near_;
  };

  [[nodiscard]] uint32_t of_block(uint32_t block) const { return part_of_[block]; }
  /// Marks all parts that can be reached from a block. Linear in the one-way portals that lead on
  /// from them.
  void reach(uint32_t block, Reached& reached) const;
  /// Of the ends of portals on paths from a place whose parts were marked, and of that place
  /// itself, the nearest to a goal; none that lies in a block for which is_out(block) is true.
  /// Patches are visited in the order of how near they may come.
  template <class IsOut>
  [[nodiscard]] BlockPoint nearest(const NodeView& view, const BlockPoint& from, Vec3d goal,
                                   Reached& reached, IsOut is_out) const;

  [[nodiscard]] uint64_t bytes() const;

 private:
  [[nodiscard]] double distance_to(uint32_t patch, Vec3d at) const;

  std::vector<uint32_t> part_of_;  // by block
  uint32_t count_ = 0;
  std::vector<uint32_t> first_, leads_to_;  // by part: parts that one-way portals lead to
  std::vector<Box3d> boxes_;                // by patch: all ends of portals in it
};

template <class IsOut>
BlockPoint NodeParts::nearest(const NodeView& view, const BlockPoint& from, Vec3d goal,
                              Reached& reached, IsOut is_out) const {
  const graph::NodeMesh& mesh = view.mesh();
  BlockPoint best = from;
  double least = length(goal - position(view, from));
  OpenList<Reached::Near>& near = reached.near_;
  near.clear();
  for (uint32_t p = 0; p < boxes_.size(); ++p) {
    if (boxes_[p].empty()) continue;
    const double far = distance_to(p, goal);
    if (far < least) near.push({far, p});
  }
  if (!view.is_as_baked()) {
    // Ends of what is left of portals lie beside the middles that the boxes hold.
    for (const uint32_t patch : view.changes()->cut_patches()) near.push({0, patch});
  }
  const auto consider = [&](uint32_t block) {
    for_each_arc_in(view, block, [&](const Crossing& crossing) {
      const auto [out, in] = ends_of(view, crossing);
      if (!reached.holds(part_of_[view.base_of(out.block)]) || is_out(in.block)) return;
      const double away = length(goal - position(view, in));
      if (away >= least) return;
      least = away;
      best = in;
    });
  };
  while (!near.empty() && near.first().far < least) {
    const uint32_t patch = near.pop().patch;
    const auto blocks = static_cast<uint32_t>(mesh.blocks_of(patch).size());
    for (uint32_t b = mesh.first_block(patch); b < mesh.first_block(patch) + blocks; ++b) {
      if (!reached.holds(part_of_[b])) continue;
      consider(b);
      if (view.is_as_baked()) continue;
      const auto parts = view.changes()->parts_of(b);
      for (uint32_t p = parts ? parts->first : 0; parts && p < parts->second; ++p) consider(p);
    }
  }
  return best;
}

}  // namespace throng::path
