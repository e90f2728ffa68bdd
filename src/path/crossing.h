// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "graph/node_mesh.h"

/// Portals between blocks of nodes as a way goes through them.
namespace throng {

/// Somewhere in a block.
struct BlockPoint {
  uint32_t block = kNoNode;
  double s = 0, t = 0;
};

/// A portal as it is gone through.
struct Crossing {
  uint32_t portal = 0;
  bool backward = false;  ///< From b to a.
};

/// The middle of a crossing's portal in the block that it leaves and in the one that it comes to.
struct CrossingEnds {
  BlockPoint out, in;
};

inline CrossingEnds ends_of(const NodeMesh& mesh, const Crossing& crossing) {
  const NodePortal& portal = mesh.portals()[crossing.portal];
  const auto middle = [](uint32_t block, const std::array<double, 4>& on) {
    return BlockPoint{block, (on[0] + on[2]) / 2, (on[1] + on[3]) / 2};
  };
  const BlockPoint a = middle(portal.a, portal.on_a), b = middle(portal.b, portal.on_b);
  return crossing.backward ? CrossingEnds{b, a} : CrossingEnds{a, b};
}

inline Vec3d position(const NodeMesh& mesh, const BlockPoint& at) {
  return mesh.surface(at.block).at(at.s, at.t);
}

/// Calls visit(crossing) for each way out of a block.
template <class Visit>
void for_each_way_out(const NodeMesh& mesh, uint32_t block, Visit visit) {
  for (const uint32_t p : mesh.portals_of(block)) {
    const NodePortal& portal = mesh.portals()[p];
    const bool backward = portal.a != block;
    if (!(backward && portal.one_way)) visit(Crossing{p, backward});
  }
}

/// Calls visit(crossing) for each way into a block.
template <class Visit>
void for_each_way_in(const NodeMesh& mesh, uint32_t block, Visit visit) {
  for (const uint32_t p : mesh.portals_of(block)) {
    const NodePortal& portal = mesh.portals()[p];
    const bool backward = portal.a == block;
    if (!(backward && portal.one_way)) visit(Crossing{p, backward});
  }
}

}  // namespace throng
