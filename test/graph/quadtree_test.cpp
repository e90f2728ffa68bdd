// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "graph/quadtree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <map>
#include <numeric>

#include "core/random.h"
#include "graph/node_links.h"

// Trees and links against the cells themselves, on random patches.
namespace throng {
namespace {

constexpr uint16_t kClasses = 0b1111;

// Blotches of promises, so that there are blocks of all sizes, and cuts between some cells.
graph::PatchCells random_cells(int32_t depth, uint64_t seed, bool with_cuts) {
  graph::PatchCells patch;
  patch.depth = depth;
  const auto count = size_t{1} << (2 * depth);
  patch.cells.resize(count, {kClasses, 1, 3, 3});
  for (uint64_t blot = 0; blot < 6; ++blot) {
    const auto draw = [&](uint64_t k, uint64_t n) {
      return static_cast<int32_t>(random_below(seed, blot, k, n));
    };
    const int32_t side = patch.side();
    const int32_t s0 = draw(0, static_cast<uint64_t>(side)),
                  t0 = draw(1, static_cast<uint64_t>(side));
    const int32_t s1 = std::min(side, s0 + 1 + draw(2, 5)),
                  t1 = std::min(side, t0 + 1 + draw(3, 5));
    const graph::Promise worse{static_cast<uint16_t>(draw(4, 16)), static_cast<uint8_t>(draw(5, 4)),
                               static_cast<uint8_t>(draw(6, 4)), static_cast<uint8_t>(draw(7, 4))};
    for (int32_t t = t0; t < t1; ++t) {
      for (int32_t s = s0; s < s1; ++s) {
        graph::Promise& cell = patch.cells[patch.index(s, t)];
        cell = graph::both(cell, worse);
      }
    }
  }
  if (!with_cuts) return patch;
  patch.cut_s.resize(count);
  patch.cut_t.resize(count);
  for (size_t i = 0; i < count; ++i) {
    if (random_below(seed, i, 20, 12) == 0) {
      patch.cut_s[i] = static_cast<uint16_t>(random_below(seed, i, 21, 16));
    }
    if (random_below(seed, i, 22, 12) == 0) {
      patch.cut_t[i] = static_cast<uint16_t>(random_below(seed, i, 23, 16));
    }
  }
  return patch;
}

// Calls visit(s, t) for the cells of a node.
template <class Visit>
void for_cells(const graph::PatchTree& tree, const graph::PatchNode& node, Visit visit) {
  const int32_t size = 1 << (tree.depth - node.level);
  for (int32_t t = node.t * size; t < (node.t + 1) * size; ++t) {
    for (int32_t s = node.s * size; s < (node.s + 1) * size; ++s) visit(s, t);
  }
}

TEST(Quadtree, ANodePromisesTheWorstOfItsCells) {
  for (uint64_t seed = 1; seed <= 60; ++seed) {
    const graph::PatchCells cells =
        random_cells(static_cast<int32_t>(seed % 5), seed, seed % 2 == 0);
    const graph::PatchTree tree = graph::build_tree(cells);
    std::vector<bool> has_child(tree.nodes.size(), false);
    for (const graph::PatchNode& node : tree.nodes) {
      graph::Promise worst{0xffff, 0, 255, 255};
      uint16_t cut = 0;
      const int32_t size = 1 << (tree.depth - node.level);
      for_cells(tree, node, [&](int32_t s, int32_t t) {
        worst = graph::both(worst, cells.cells[cells.index(s, t)]);
        if (cells.cut_s.empty()) return;
        if (s + 1 < (node.s + 1) * size) cut |= cells.cut_s[cells.index(s, t)];
        if (t + 1 < (node.t + 1) * size) cut |= cells.cut_t[cells.index(s, t)];
      });
      worst.classes = static_cast<uint16_t>(worst.classes & ~cut);
      EXPECT_EQ(node.promise, worst) << "seed " << seed;
      EXPECT_NE(node.promise.classes, 0);
      if (node.parent == graph::kNoNode) continue;
      has_child[node.parent] = true;
      EXPECT_TRUE(graph::covers(node.promise, tree.nodes[node.parent].promise));
      EXPECT_NE(node.promise, tree.nodes[node.parent].promise);
    }
    for (size_t n = 0; n < tree.nodes.size(); ++n) {
      EXPECT_EQ(tree.nodes[n].terminal, !has_child[n]);
    }
  }
}

TEST(Quadtree, EveryClassHasTheCellsThatItHasAlone) {
  for (uint64_t seed = 1; seed <= 60; ++seed) {
    const graph::PatchCells cells = random_cells(4, seed, seed % 2 == 0);
    const graph::PatchTree tree = graph::build_tree(cells);
    std::vector<uint16_t> covered(cells.cells.size(), 0);
    std::vector<uint32_t> smallest(cells.cells.size(), graph::kNoNode);
    for (uint32_t n = 0; n < tree.nodes.size(); ++n) {
      for_cells(tree, tree.nodes[n], [&](int32_t s, int32_t t) {
        covered[cells.index(s, t)] |= tree.nodes[n].promise.classes;
        smallest[cells.index(s, t)] = n;  // Parents come first.
      });
    }
    for (size_t i = 0; i < cells.cells.size(); ++i) {
      EXPECT_EQ(covered[i], cells.cells[i].classes) << "seed " << seed << " cell " << i;
      EXPECT_EQ(tree.leaf_of(i), smallest[i]);
    }
  }
}

// The cells of a partial node on which a class stands.
uint64_t own_cells(const graph::PatchCells& cells, const graph::PatchNode& node, uint16_t bit) {
  uint64_t own = 0;
  for (uint64_t left = node.cells; left != 0; left &= left - 1) {
    const int32_t at = std::countr_zero(left);
    const size_t cell = cells.index(node.s * 8 + at % 8, node.t * 8 + at / 8);
    if ((cells.cells[cell].classes & bit) != 0) own |= uint64_t{1} << at;
  }
  return own;
}

// Those of some cells of a block that are connected to the first, step by step.
uint64_t first_piece(const graph::PatchCells& cells, const graph::PatchNode& node, uint64_t own,
                     uint16_t bit) {
  std::vector<int32_t> reached{std::countr_zero(own)};
  uint64_t piece = own & (~own + 1);
  const auto is_cut = [&](const std::vector<uint16_t>& cuts, int32_t at) {
    return !cuts.empty() &&
           (cuts[cells.index(node.s * 8 + at % 8, node.t * 8 + at / 8)] & bit) != 0;
  };
  for (size_t i = 0; i < reached.size(); ++i) {
    const int32_t at = reached[i];
    const auto go = [&](int32_t to, bool open) {
      if (!open || (own >> to & 1) == 0 || (piece >> to & 1) != 0) return;
      piece |= uint64_t{1} << to;
      reached.push_back(to);
    };
    if (at % 8 < 7) go(at + 1, !is_cut(cells.cut_s, at));
    if (at % 8 > 0) go(at - 1, !is_cut(cells.cut_s, at - 1));
    if (at / 8 < 7) go(at + 8, !is_cut(cells.cut_t, at));
    if (at / 8 > 0) go(at - 8, !is_cut(cells.cut_t, at - 8));
  }
  return piece;
}

// Each class alone has as many partial nodes in a block as its cells there have pieces, and
// together with others it has one node for each.
TEST(Quadtree, PartialNodesAreThePiecesOfEachClass) {
  size_t tested = 0, shared = 0;
  for (uint64_t seed = 1; seed <= 120; ++seed) {
    graph::PatchCells cells = random_cells(4 + static_cast<int32_t>(seed % 3), seed, seed % 2 == 0);
    for (uint64_t k = 0; k < seed % 4 * 40; ++k) {  // And single cells.
      const size_t i = random_below(seed, k, 50, cells.cells.size());
      cells.cells[i].classes &= static_cast<uint16_t>(random_below(seed, k, 51, 16));
    }
    cells.partial = true;
    const graph::PatchTree tree = graph::build_tree(cells);
    std::vector<uint16_t> covered(cells.cells.size(), 0);
    for (const graph::PatchNode& node : tree.nodes) {
      const uint16_t from_parent =
          node.parent == graph::kNoNode ? uint16_t{0} : tree.nodes[node.parent].promise.classes;
      ASSERT_LE(node.level, tree.leaf_depth);
      if (node.cells == 0) {
        for_cells(tree, node, [&](int32_t s, int32_t t) {
          const uint16_t fresh = node.promise.classes & ~from_parent & 0xffff;
          EXPECT_EQ(covered[cells.index(s, t)] & fresh, 0) << "seed " << seed;
          covered[cells.index(s, t)] |= fresh;
        });
        continue;
      }
      ASSERT_EQ(node.level, tree.leaf_depth);
      ASSERT_TRUE(node.terminal);
      EXPECT_EQ(node.promise.classes & from_parent, 0);
      shared += std::popcount(node.promise.classes) > 1 ? 1 : 0;
      for (uint16_t bit = 1; bit < 16; bit = static_cast<uint16_t>(bit << 1)) {
        if ((node.promise.classes & bit) == 0) continue;
        const uint64_t own = own_cells(cells, node, bit);
        ASSERT_NE(own, 0u) << "seed " << seed;
        EXPECT_EQ(first_piece(cells, node, own, bit), own) << "seed " << seed;
        for (uint64_t left = own; left != 0; left &= left - 1) {
          const int32_t at = std::countr_zero(left);
          const size_t cell = cells.index(node.s * 8 + at % 8, node.t * 8 + at / 8);
          EXPECT_EQ(covered[cell] & bit, 0) << "seed " << seed;
          covered[cell] |= bit;
          const graph::Promise& is = cells.cells[cell];
          EXPECT_LE(is.inclination, node.promise.inclination);
          EXPECT_GE(is.height, node.promise.height);
          EXPECT_GE(is.headroom, node.promise.headroom);
        }
        ++tested;
      }
    }
    for (size_t i = 0; i < cells.cells.size(); ++i) {
      ASSERT_EQ(covered[i], cells.cells[i].classes) << "seed " << seed << " cell " << i;
      ASSERT_EQ(tree.classes_on(i), cells.cells[i].classes) << "seed " << seed << " cell " << i;
      // All nodes around a cell, the smallest first.
      std::vector<uint32_t> around;
      for (uint32_t n = tree.nodes.empty() ? graph::kNoNode : tree.leaf_of(i); n != graph::kNoNode;
           n = tree.next_around(n, i)) {
        around.push_back(n);
      }
      std::vector<uint32_t> all;
      for (uint32_t n = 0; n < tree.nodes.size(); ++n) {
        const graph::PatchNode& node = tree.nodes[n];
        const int32_t up = tree.depth - node.level;
        const auto s = static_cast<int32_t>(i) & (cells.side() - 1);
        const auto t = static_cast<int32_t>(i) >> tree.depth;
        if (s >> up != node.s || t >> up != node.t) continue;
        if (node.cells == 0 || (node.cells >> ((t & 7) * 8 + (s & 7)) & 1) != 0) all.push_back(n);
      }
      std::sort(around.begin(), around.end());
      ASSERT_EQ(around, all) << "seed " << seed << " cell " << i;
    }
    // Alone.
    graph::PatchCells alone = cells;
    for (graph::Promise& cell : alone.cells) cell.classes &= 1;
    for (auto* cuts : {&alone.cut_s, &alone.cut_t}) {
      for (uint16_t& cut : *cuts) cut &= 1;
    }
    // (A class that goes anywhere in a block has a node there that is not partial.)
    const auto pieces = [&](const graph::PatchTree& of) {
      size_t count = 0;
      for (const graph::PatchNode& node : of.nodes) {
        if (node.cells == 0 || (node.promise.classes & 1) == 0) continue;
        bool cut = false;
        for (int32_t at = 0; at < 64 && !cells.cut_s.empty(); ++at) {
          const size_t cell = cells.index(node.s * 8 + at % 8, node.t * 8 + at / 8);
          cut |= at % 8 < 7 && (cells.cut_s[cell] & 1) != 0;
          cut |= at / 8 < 7 && (cells.cut_t[cell] & 1) != 0;
        }
        count += cut || own_cells(cells, node, 1) != ~uint64_t{0} ? 1 : 0;
      }
      return count;
    };
    EXPECT_EQ(pieces(graph::build_tree(alone)), pieces(tree)) << "seed " << seed;
  }
  EXPECT_GT(tested, 2000u);
  EXPECT_GT(shared, 300u);
}

TEST(Quadtree, AnEvenPatchIsOneNode) {
  graph::PatchCells cells{.depth = 6, .cells = {}, .cut_s = {}, .cut_t = {}};
  cells.cells.assign(4096, {1, 2, 3, 4});
  const graph::PatchTree tree = graph::build_tree(cells);
  ASSERT_EQ(tree.nodes.size(), 1u);
  EXPECT_TRUE(tree.nodes[0].terminal);
  EXPECT_TRUE(tree.leaf.empty());
  cells.cells[77].inclination = 3;  // One steeper cell: the whole is as steep, and its rest less.
  EXPECT_GT(graph::build_tree(cells).nodes.size(), 6u);
}

class Sets {
 public:
  explicit Sets(size_t count) : root_(count) { std::iota(root_.begin(), root_.end(), 0u); }
  uint32_t find(uint32_t i) {
    while (root_[i] != i) i = root_[i];
    return i;
  }
  void join(uint32_t a, uint32_t b) { root_[find(a)] = find(b); }

 private:
  std::vector<uint32_t> root_;
};

// Two patches beside each other, some pairs of their border cells joined for some classes: cells
// are connected for a class exactly if the nodes that hold them are.
TEST(NodeLinks, NodesConnectWhatCellsConnect) {
  size_t tested = 0, steps = 0;
  for (uint64_t seed = 1; seed <= 160; ++seed) {
    std::array<graph::PatchCells, 2> cells = {random_cells(4, seed, seed % 2 == 0),
                                              random_cells(3, seed + 1000, seed % 3 == 0)};
    cells[0].partial = seed % 4 > 1;
    cells[1].partial = seed % 8 > 3;
    // Steps divide nodes, but no class's paths.
    for (uint64_t p = 0; p < 2 && seed % 5 > 1; ++p) {
      const auto side = static_cast<uint64_t>(cells[p].side());
      for (uint64_t t = 0; t < side; ++t) {
        const auto some = [&](uint64_t stream) {
          uint64_t row = 0;
          for (uint64_t s = 0; s < side; ++s) {
            row |= uint64_t{random_below(seed, stream + p, t * side + s, 8) == 0} << s;
          }
          return row;
        };
        cells[p].step_s.push_back(some(50));
        cells[p].step_t.push_back(some(60));
      }
    }
    graph::NodeForest forest;
    for (const graph::PatchCells& patch : cells) forest.add(graph::build_tree(patch));
    std::vector<graph::CellPair> pairs;
    for (uint32_t i = 0; i < 16; ++i) {
      pairs.push_back({.patch_a = 0,
                       .cell_a = i * 16 + 15,
                       .patch_b = 1,
                       .cell_b = i / 2 * 8,
                       .classes = static_cast<uint16_t>(random_below(seed, i, 40, 16))});
    }
    graph::NodeLinker linker(forest);
    for (uint32_t p = 0; p < 2; ++p) linker.link_inside(p, cells[p]);
    for (const graph::CellPair& pair : pairs) linker.link(pair);
    const std::vector<graph::NodeLink> links = linker.take();
    for (size_t i = 0; i < links.size(); ++i) {
      EXPECT_LT(links[i].a, links[i].b);
      steps += links[i].kind == LinkKind::kStep ? 1 : 0;
      if (i == 0 || links[i - 1].a != links[i].a || links[i - 1].b != links[i].b) continue;
      EXPECT_EQ(links[i - 1].classes & links[i].classes, 0) << "a class that walks needs no step";
    }

    for (uint32_t c = 0; c < 4; ++c) {
      const uint16_t bit = static_cast<uint16_t>(1u << c);
      Sets naive(256 + 64), nodes(forest.size());
      for (uint32_t p = 0; p < 2; ++p) {
        const graph::PatchCells& patch = cells[p];
        const uint32_t base = p == 0 ? 0 : 256;
        const auto join = [&](size_t a, size_t b, const std::vector<uint16_t>& cuts) {
          const uint16_t cut = cuts.empty() ? uint16_t{0} : cuts[a];
          if ((patch.cells[a].classes & patch.cells[b].classes & ~cut & bit) == 0) return;
          naive.join(base + static_cast<uint32_t>(a), base + static_cast<uint32_t>(b));
        };
        for (int32_t t = 0; t < patch.side(); ++t) {
          for (int32_t s = 0; s < patch.side(); ++s) {
            const size_t i = patch.index(s, t);
            if (s + 1 < patch.side()) join(i, i + 1, patch.cut_s);
            if (t + 1 < patch.side()) join(i, i + static_cast<size_t>(patch.side()), patch.cut_t);
          }
        }
        const graph::PatchTree& tree = forest.trees[p];
        for (uint32_t n = 0; n < tree.nodes.size(); ++n) {
          const uint32_t parent = tree.nodes[n].parent;
          if (parent != graph::kNoNode && (tree.nodes[parent].promise.classes & bit) != 0) {
            nodes.join(forest.first[p] + n, forest.first[p] + parent);
          }
        }
      }
      for (const graph::CellPair& pair : pairs) {
        const bool stands = (cells[0].cells[pair.cell_a].classes &
                             cells[1].cells[pair.cell_b].classes & pair.classes & bit) != 0;
        if (stands) naive.join(pair.cell_a, 256 + pair.cell_b);
      }
      for (const graph::NodeLink& link : links) {
        if ((link.classes & bit) != 0) nodes.join(link.a, link.b);
      }
      std::map<uint32_t, uint32_t> part_of;  // naive part -> part of nodes, and back
      std::map<uint32_t, uint32_t> back;
      for (uint32_t i = 0; i < 320; ++i) {
        const uint32_t p = i < 256 ? 0 : 1, cell = i < 256 ? i : i - 256;
        if ((cells[p].cells[cell].classes & bit) == 0) continue;
        // Of the nodes around the cell one in which the class stands.
        const graph::PatchTree& tree = forest.trees[p];
        uint32_t node = tree.leaf_of(cell);
        while (node != graph::kNoNode && (tree.nodes[node].promise.classes & bit) == 0) {
          node = tree.next_around(node, cell);
        }
        ASSERT_NE(node, graph::kNoNode);
        const uint32_t a = naive.find(i), b = nodes.find(forest.first[p] + node);
        EXPECT_EQ(part_of.try_emplace(a, b).first->second, b) << "seed " << seed;
        EXPECT_EQ(back.try_emplace(b, a).first->second, a) << "seed " << seed;
        ++tested;
      }
    }
  }
  EXPECT_GT(tested, 80000u);
  EXPECT_GT(steps, 1000u);
}

TEST(NodeLinks, PairsOfTheSameCellsAndSidesAreOneInAnyOrder) {
  const auto pair = [](uint32_t cell_b, uint16_t classes, uint8_t side_a) {
    return graph::CellPair{.patch_a = 1,
                           .cell_a = 5,
                           .patch_b = 2,
                           .cell_b = cell_b,
                           .classes = classes,
                           .side_a = side_a};
  };
  const std::vector<graph::CellPair> given{pair(7, 1, 2), pair(7, 2, 3), pair(6, 8, 2),
                                           pair(7, 4, 2)};
  std::vector<size_t> order{0, 1, 2, 3};
  do {
    std::vector<graph::CellPair> pairs;
    for (const size_t i : order) pairs.push_back(given[i]);
    graph::merge_cell_pairs(pairs);
    ASSERT_EQ(pairs.size(), 3u);
    EXPECT_EQ(pairs[0].cell_b, 6u);
    EXPECT_EQ(pairs[1].side_a, 2);
    EXPECT_EQ(pairs[1].classes, 5);
    EXPECT_EQ(pairs[2].side_a, 3);
    EXPECT_EQ(pairs[2].classes, 2);
  } while (std::next_permutation(order.begin(), order.end()));
}

TEST(NodeLinks, LinkTheLargestThatIsNoMoreRestrictive) {
  // A gentle half and a steep half, side by side: the whole is one steep node, the gentle half two.
  graph::PatchCells cells{.depth = 2, .cells = {}, .cut_s = {}, .cut_t = {}};
  cells.cells.assign(16, {1, 2, 1, 1});
  for (int32_t t = 0; t < 4; ++t) {
    for (int32_t s = 0; s < 2; ++s) cells.cells[cells.index(s, t)].inclination = 0;
  }
  graph::NodeForest forest;
  forest.add(graph::build_tree(cells));
  ASSERT_EQ(forest.size(), 3u);
  EXPECT_FALSE(forest.trees[0].nodes[0].terminal);
  graph::NodeLinker linker(forest);
  linker.link_inside(0, cells);
  const auto links = linker.take();
  ASSERT_EQ(links.size(), 1u);  // The two gentle ones; the steep one holds both.
  EXPECT_EQ(links[0].a, 1u);
  EXPECT_EQ(links[0].b, 2u);
}

}  // namespace
}  // namespace throng
