// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "graph/node_links.h"

#include <algorithm>
#include <array>
#include <bit>
#include <tuple>
#include <utility>

// Makes links of nodes from pairs of cells that touch: for each class between the nodes that hold
// the two cells. Linear, after sorting.
namespace throng::graph {
namespace {

constexpr size_t kLongestChain = 24;  // a patch is halved at most 6 times, classes are at most 16

}  // namespace

void NodeForest::add(PatchTree tree) {
  first.push_back(first.back() + static_cast<uint32_t>(tree.nodes.size()));
  trees.push_back(std::move(tree));
}

uint32_t NodeLinker::chain(uint32_t patch, size_t cell, std::span<uint32_t> out) const {
  const PatchTree& tree = forest_->trees[patch];
  uint32_t count = 0;
  for (uint32_t n = tree.leaf_of(cell); n != kNoNode; n = tree.next_around(n, cell)) {
    out[count++] = forest_->first[patch] + n;
  }
  return count;
}

void NodeLinker::add(uint32_t a, uint32_t b, uint16_t classes, LinkKind kind) {
  const bool turned = a > b;
  if (turned) std::swap(a, b);
  // Neighbours along a border mostly repeat the pair before them.
  for (size_t k = links_.size(); k-- > 0 && links_.size() - k <= 4;) {
    NodeLink& last = links_[k];
    if (last.a == a && last.b == b && last.kind == kind && last.hole_link1 == hole_link1_) {
      last.classes |= classes;
      return;
    }
  }
  links_.push_back({a, b, classes, kind, hole_link1_, turned, one_way_, spot_});
}

void NodeLinker::link_chains(uint32_t patch_a, size_t cell_a, uint32_t patch_b, size_t cell_b,
                             uint16_t classes, LinkKind kind) {
  std::array<uint32_t, kLongestChain> chain_a, chain_b;
  uint32_t count_a = chain(patch_a, cell_a, chain_a), count_b = chain(patch_b, cell_b, chain_b);
  // Nodes that hold both cells need no link; their classes are free to go.
  uint32_t inside = 0;
  while (count_a > 0 && count_b > 0 && chain_a[count_a - 1] == chain_b[count_b - 1]) {
    inside |= node(patch_a, chain_a[count_a - 1]).promise.classes;
    --count_a;
    --count_b;
  }
  // (Of partial nodes others may lie between.)
  for (uint32_t i = 0; i < count_a; ++i) {
    const auto same = std::find(chain_b.begin(), chain_b.begin() + count_b, chain_a[i]);
    if (same == chain_b.begin() + count_b) continue;
    inside |= node(patch_a, chain_a[i]).promise.classes;
    std::copy(same + 1, chain_b.begin() + count_b--, same);
    std::copy(chain_a.begin() + i + 1, chain_a.begin() + count_a--, chain_a.begin() + i);
    --i;
  }
  uint32_t linked = inside;
  const auto to_less_restrictive = [&](uint32_t from_patch, std::span<const uint32_t> from,
                                       uint32_t to_patch, std::span<const uint32_t> to,
                                       bool backward) {
    for (const uint32_t f : from) {
      const Promise& promise = node(from_patch, f).promise;
      const uint16_t mutual = promise.classes & classes;
      if (mutual == 0) continue;
      for (size_t k = to.size(); k-- > 0;) {  // The largest first.
        if (!covers(node(to_patch, to[k]).promise, promise)) continue;
        backward ? add(to[k], f, mutual, kind) : add(f, to[k], mutual, kind);
        linked |= mutual;
        break;
      }
    }
  };
  const std::span<const uint32_t> as(chain_a.data(), count_a), bs(chain_b.data(), count_b);
  to_less_restrictive(patch_a, as, patch_b, bs, false);
  to_less_restrictive(patch_b, bs, patch_a, as, true);
  // Neither is less restrictive: the largest nodes of a class on both sides, for what both allow.
  const auto largest_for = [&](uint32_t patch, std::span<const uint32_t> nodes, uint32_t bit) {
    for (size_t k = nodes.size(); k-- > 0;) {
      if ((node(patch, nodes[k]).promise.classes & bit) != 0) return nodes[k];
    }
    return kNoNode;
  };
  for (uint32_t left = classes & ~linked; left != 0;) {
    const uint32_t bit = left & (~left + 1);
    const uint32_t a = largest_for(patch_a, as, bit), b = largest_for(patch_b, bs, bit);
    if (a == kNoNode || b == kNoNode) {
      left &= ~bit;
      continue;
    }
    const auto mutual = static_cast<uint16_t>(node(patch_a, a).promise.classes &
                                              node(patch_b, b).promise.classes & classes);
    add(a, b, mutual, kind);
    left &= ~uint32_t{mutual};
  }
}

void NodeLinker::link_inside(uint32_t patch, const PatchCells& cells) {
  const PatchTree& tree = forest_->trees[patch];
  if (tree.leaf.empty() || tree.nodes.empty()) return;
  const auto visit = [&](size_t here, size_t next, bool along_s) {
    const uint32_t a = tree.leaf_of(here), b = tree.leaf_of(next);
    // (One partial node may be the first around both, and others around one.)
    if (a == kNoNode || b == kNoNode || (a == b && tree.nodes[a].cells == 0)) return;
    const std::vector<uint16_t>& cuts = along_s ? cells.cut_s : cells.cut_t;
    const uint16_t together = cells.cells[here].classes & cells.cells[next].classes;
    const auto classes = static_cast<uint16_t>(together & ~(cuts.empty() ? 0 : cuts[here]));
    if (classes == 0) return;
    link_chains(patch, here, patch, next, classes,
                cells.steps(here, along_s) ? LinkKind::kStep : LinkKind::kWalk);
  };
  // Blocks of cells that know their nodes together: all cells, or 8 x 8.
  const int32_t blocks = 1 << tree.leaf_depth, size = cells.side() / blocks;
  const auto divides = [&](uint32_t leaf) {
    return leaf != kNoNode && tree.nodes[leaf].cells != 0;
  };
  for (int32_t t = 0; t < blocks; ++t) {
    for (int32_t s = 0; s < blocks; ++s) {
      const size_t block = (static_cast<size_t>(t) << tree.leaf_depth) + static_cast<size_t>(s);
      const uint32_t leaf = tree.leaf[block];
      const auto differs = [&](size_t other) { return tree.leaf[other] != leaf || divides(leaf); };
      const bool inside = divides(leaf);
      const bool east = s + 1 < blocks && differs(block + 1);
      const bool south = t + 1 < blocks && differs(block + static_cast<size_t>(blocks));
      if (leaf == kNoNode || (!inside && !east && !south)) continue;
      for (int32_t j = 0; j < size; ++j) {
        for (int32_t i = 0; i < size; ++i) {
          const size_t here = cells.index(s * size + i, t * size + j);
          if (i + 1 < size ? inside : east) visit(here, here + 1, true);
          if (j + 1 < size ? inside : south) {
            visit(here, here + static_cast<size_t>(cells.side()), false);
          }
        }
      }
    }
  }
}

void NodeLinker::link(const CellPair& pair) {
  const uint32_t a = forest_->leaf(pair.patch_a, pair.cell_a);
  const uint32_t b = forest_->leaf(pair.patch_b, pair.cell_b);
  if (a == kNoNode || b == kNoNode || a == b) return;
  const auto classes =
      static_cast<uint16_t>(forest_->trees[pair.patch_a].classes_on(pair.cell_a) &
                            forest_->trees[pair.patch_b].classes_on(pair.cell_b) & pair.classes);
  hole_link1_ = pair.hole_link1;
  one_way_ = pair.one_way;
  spot_ = pair.spot;
  if (classes != 0) {
    link_chains(pair.patch_a, pair.cell_a, pair.patch_b, pair.cell_b, classes, pair.kind);
  }
  hole_link1_ = 0;
  one_way_ = false;
  spot_ = 0;
}

std::vector<NodeLink> NodeLinker::take() {
  merge_node_links(links_);
  return std::move(links_);
}

void merge_cell_pairs(std::vector<CellPair>& pairs) {
  const auto key = [](const CellPair& p) {
    return std::tie(p.patch_a, p.cell_a, p.patch_b, p.cell_b, p.side_a, p.side_b);
  };
  std::sort(pairs.begin(), pairs.end(),
            [&](const CellPair& p, const CellPair& q) { return key(p) < key(q); });
  size_t kept = 0;
  for (const CellPair& pair : pairs) {
    if (kept > 0 && key(pairs[kept - 1]) == key(pair)) {
      pairs[kept - 1].classes |= pair.classes;
    } else {
      pairs[kept++] = pair;
    }
  }
  pairs.resize(kept);
}

namespace {

// Steps that a walk between the same nodes saves a class. [sorted, each pair and kind once]
void drop_needless_steps(std::vector<NodeLink>& links) {
  size_t kept = 0;
  for (NodeLink& link : links) {
    const NodeLink* last = kept > 0 ? &links[kept - 1] : nullptr;
    if (link.kind == LinkKind::kStep && last != nullptr && last->a == link.a && last->b == link.b &&
        last->kind == LinkKind::kWalk) {
      link.classes &= static_cast<uint16_t>(~last->classes);
      if (link.classes == 0) continue;
    }
    links[kept++] = link;
  }
  links.resize(kept);
}

}  // namespace

void merge_node_links(std::vector<NodeLink>& links) {
  const auto before = [](const NodeLink& p, const NodeLink& q) {
    return std::tie(p.a, p.b, p.kind, p.hole_link1) < std::tie(q.a, q.b, q.kind, q.hole_link1);
  };
  // Of all patches these are two sorted lists, one behind the other.
  const auto second = std::is_sorted_until(links.begin(), links.end(), before);
  if (std::is_sorted(second, links.end(), before)) {
    std::inplace_merge(links.begin(), second, links.end(), before);
  } else {
    std::sort(links.begin(), links.end(), before);
  }
  size_t kept = 0, group = 0;  // `group`: where the kept links of this pair and kind begin
  for (const NodeLink& link : links) {
    const NodeLink* last = kept > group ? &links[kept - 1] : nullptr;
    if (last == nullptr || last->a != link.a || last->b != link.b || last->kind != link.kind) {
      group = kept;
    }
    if (kept > group && links[kept - 1].hole_link1 == link.hole_link1) {
      links[kept - 1].classes |= link.classes;
      continue;
    }
    // A hole link that serves no class that an earlier one does not serve is left out.
    uint16_t served = 0;
    // (Off-mesh links are given one by one, and some are one-way: all are kept. Of drops one from
    // each spot is: a ledge may be long.)
    for (size_t k = group; k < kept && link.kind != LinkKind::kOffMesh; ++k) {
      const bool same = links[k].spot == link.spot && links[k].turned == link.turned;
      if (same || link.kind != LinkKind::kDrop) served |= links[k].classes;
    }
    if ((link.classes & ~served) == 0) continue;
    links[kept++] = link;
  }
  links.resize(kept);
  drop_needless_steps(links);
}

}  // namespace throng::graph
