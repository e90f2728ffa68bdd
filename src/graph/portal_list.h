// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "throng/surface.h"

/// Portals between blocks of nodes, in little memory: a city of 100 km2 has 67 million.
namespace throng::graph {

/// Lines on level tiles keep that far inside cells, whose far border is the next cell's. [s and t]
inline constexpr double kTileInset = 1e-5;

/// Where the class gets from block a to block b: along a line that they share, by the parameters of
/// each one's patch; of a hole link both ends are the same.
struct NodePortal {
  uint32_t a = 0, b = 0;
  std::array<double, 4> on_a{}, on_b{};  ///< (s, t) where it begins and where it ends.
  LinkKind kind = LinkKind::kWalk;
  bool over_hole = false;  ///< A body goes straight from a's point to b's, which do not touch.
  bool one_way = false;    ///< From a to b only.
  bool inside = false;     ///< Within one node: no link.
};

/// The part of a portal that most callers need.
struct PortalSides {
  uint32_t a = 0, b = 0;
  bool one_way = false;
};

/// Nearly all lines end at, or an inset beside, a border or a middle of cells, of which a patch has
/// 64 at most along each side: these take 20 bytes. The others, doors over parts of edges, are kept
/// as they are. What is got is what was added, to the bit.
class PortalList {
 public:
  PortalList() = default;
  explicit PortalList(const std::vector<NodePortal>& portals);
  void add(const NodePortal& portal);
  /// Adds all of some lists. Each is given back once it is copied: of a large world all of them
  /// take gigabytes.
  void add_all(std::vector<PortalList>& lists);

  [[nodiscard]] size_t size() const { return packed_.size(); }
  [[nodiscard]] NodePortal operator[](size_t p) const {
    const Packed& packed = packed_[p];
    if ((packed.flags & kWide) != 0) return wide_[packed.wide()];
    return {.a = packed.a,
            .b = packed.b,
            .on_a = line(packed.on_a, packed.insets_a),
            .on_b = line(packed.on_b, packed.insets_b),
            .kind = packed.kind,
            .over_hole = (packed.flags & kOverHole) != 0,
            .one_way = (packed.flags & kOneWay) != 0,
            .inside = (packed.flags & kInside) != 0};
  }
  [[nodiscard]] PortalSides sides(size_t p) const {
    const Packed& packed = packed_[p];
    return {packed.a, packed.b, (packed.flags & kOneWay) != 0};
  }
  [[nodiscard]] uint64_t bytes() const {
    return packed_.size() * sizeof(Packed) + wide_.size() * sizeof(NodePortal);
  }

 private:
  static constexpr uint8_t kOverHole = 1, kOneWay = 2, kInside = 4, kWide = 8;
  static constexpr double kParts = 128;  // half cells of a side

  struct Packed {
    uint32_t a = 0, b = 0;
    std::array<uint8_t, 4> on_a{}, on_b{};  // half cells; of a wide one: its place
    uint8_t insets_a = 0, insets_b = 0;     // two bits each: 0 less an inset, 1 none, 2 more one
    LinkKind kind = LinkKind::kWalk;
    uint8_t flags = 0;

    [[nodiscard]] uint32_t wide() const {
      return on_a[0] | uint32_t{on_a[1]} << 8 | uint32_t{on_a[2]} << 16 | uint32_t{on_a[3]} << 24;
    }
    void set_wide(uint32_t place) {
      for (size_t k = 0; k < 4; ++k) on_a[k] = static_cast<uint8_t>(place >> (8 * k));
    }
  };
  static_assert(sizeof(Packed) == 20);

  static double number(uint8_t half_cells, int32_t inset) {
    return half_cells * (1 / kParts) + inset * kTileInset;
  }
  static std::array<double, 4> line(const std::array<uint8_t, 4>& at, uint8_t insets) {
    std::array<double, 4> found;
    for (size_t k = 0; k < 4; ++k) found[k] = number(at[k], (insets >> (2 * k) & 3) - 1);
    return found;
  }
  static bool pack(const std::array<double, 4>& line, std::array<uint8_t, 4>& at, uint8_t& insets);

  std::vector<Packed> packed_;
  std::vector<NodePortal> wide_;
};

}  // namespace throng::graph
