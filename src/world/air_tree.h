// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

/// An octree over cubes of air cells: what is free in a zone, or where a class may be.
namespace throng::world {

/// A word of a tree: what fills a cube of cells. The two low bits say how, the rest is a number.
enum class AirKind : uint32_t {
  kFull = 0,   // no cell of it is free
  kFree = 1,   // all are; the number is the tree's builder's own
  kInner = 2,  // the number is where its eight children begin in `nodes`
  kLeaf = 3,   // 4 x 4 x 4 cells; the number is the index of their bits in `leaves`
};

constexpr AirKind air_kind(uint32_t word) { return static_cast<AirKind>(word & 3); }
constexpr uint32_t air_number(uint32_t word) { return word >> 2; }
constexpr uint32_t air_word(AirKind kind, uint32_t number) {
  return number << 2 | static_cast<uint32_t>(kind);
}

/// Bit of a cell in the 64 of its block.
constexpr uint32_t air_bit(int32_t x, int32_t y, int32_t z) {
  return static_cast<uint32_t>((x & 3) | (y & 3) << 2 | (z & 3) << 4);
}

/// Cells [x, x + side) and likewise y, z.
struct AirCube {
  int32_t x = 0, y = 0, z = 0, side = 0;
};

/// A stack of `roots` cubes of `side` cells over each other, from layer `base` up. Child c of a
/// cube lies at x + (c & 1) half, y + (c >> 1 & 1) half, z + (c >> 2) half. Borrowed arrays.
struct AirTree {
  static constexpr int32_t kLeafSide = 4;
  static constexpr int32_t kMaxSide = 1 << 15;  // of a root

  int32_t side = 8;  // power of two, 8 or more
  int32_t base = 0;
  uint32_t roots = 0;
  std::span<const uint32_t> nodes;  // the roots, then groups of eight
  std::span<const uint64_t> leaves;

  /// The node that holds a cell, and its cube; kFull outside the stack.
  struct Place {
    uint32_t word = 0;
    AirCube cube;
  };
  [[nodiscard]] Place find(int32_t x, int32_t y, int32_t z) const {
    const int64_t up = int64_t{y} - base;
    if (x < 0 || z < 0 || up < 0 || x >= side || z >= side || up >= int64_t{side} * roots)
      return {};
    int32_t s = side;
    uint32_t word = nodes[static_cast<size_t>(up / side)];
    const auto yy = static_cast<int32_t>(up);
    while (air_kind(word) == AirKind::kInner) {
      s >>= 1;
      const auto child = static_cast<uint32_t>(((x & s) != 0 ? 1 : 0) | ((yy & s) != 0 ? 2 : 0) |
                                               ((z & s) != 0 ? 4 : 0));
      word = nodes[air_number(word) + child];
    }
    return {word, {x & -s, base + (yy & -s), z & -s, s}};
  }
  [[nodiscard]] bool is_free(int32_t x, int32_t y, int32_t z) const {
    const Place place = find(x, y, z);
    switch (air_kind(place.word)) {
      case AirKind::kFree:
        return true;
      case AirKind::kLeaf:
        return (leaves[air_number(place.word)] >> air_bit(x, y - base, z) & 1) != 0;
      default:
        return false;
    }
  }

  /// Calls visit(cube, word) for every node that is not inner, in the order of the tree.
  template <class Visit>
  void for_each(Visit&& visit) const {
    for (uint32_t r = 0; r < roots; ++r) {
      walk({0, base + static_cast<int32_t>(r) * side, 0, side}, nodes[r], visit);
    }
  }

  /// Why the arrays are no tree, or nothing: every number lies within its array, children before
  /// their parents (so that nothing goes in circles), leaves exactly where cubes have four cells.
  [[nodiscard]] std::string fault() const;

 private:
  template <class Visit>
  void walk(const AirCube& cube, uint32_t word, Visit& visit) const {
    if (air_kind(word) != AirKind::kInner) {
      visit(cube, word);
      return;
    }
    const int32_t half = cube.side / 2;
    for (int32_t c = 0; c < 8; ++c) {
      walk({cube.x + (c & 1) * half, cube.y + (c >> 1 & 1) * half, cube.z + (c >> 2) * half, half},
           nodes[air_number(word) + static_cast<uint32_t>(c)], visit);
    }
  }
};

/// The arrays of a tree.
struct AirTreeData {
  int32_t side = 8;
  int32_t base = 0;
  uint32_t roots = 0;
  std::vector<uint32_t> nodes;
  std::vector<uint64_t> leaves;
  [[nodiscard]] AirTree view() const { return {side, base, roots, nodes, leaves}; }
};

}  // namespace throng::world
