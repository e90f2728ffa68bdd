// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "world/regions_generated.h"

/// The connected components within a zone, for all its classes at once. A group is all regions that
/// the same classes have and that belong, for each of these, to the same component: that is stored
/// once for all its regions. A component is named by the group in which it begins, that of its
/// first region; most begin where others of the same place do, and need no name.
namespace throng::world {

/// The groups as their file has them. docs/file_format.md explains every field.
struct GroupTables {
  std::vector<format::RegionGroup> groups;
  std::vector<format::GroupBlock> blocks;
  std::vector<uint8_t> names;
  std::vector<uint8_t> begun;
};

/// Where components begin, read group by group: all but the first as differences.
struct BegunReader {
  std::span<const uint8_t> bytes;
  size_t at = 0;
  uint32_t tile = 0;
  int64_t feet = 0;   // [mm]
  int64_t cells = 0;  // of the last class

  /// The next group's place; false if there is none, or none that could be.
  bool next_place();
  /// And for each of its classes the component's legal cells; false as well.
  bool next_cells();
};

/// Puts them together, group by group.
class GroupWriter {
 public:
  /// The next group. `begins_in` has, for each of its classes in order of bits, the group in which
  /// its component begins; `cells` the legal cells of those components that begin in this one,
  /// `feet` [mm] and `tile` where, if any does.
  struct Group {
    uint32_t classes = 0;
    std::span<const uint32_t> begins_in;
    std::span<const uint64_t> cells;
    int32_t feet = 0;
    uint16_t tile = 0;
  };
  void add(const Group& group);
  [[nodiscard]] GroupTables take() { return std::move(tables_); }

 private:
  GroupTables tables_;
  uint32_t components_ = 0;
  int64_t tile_ = 0, feet_ = 0;  // of the last group in which a component begins
};

/// Reads them where they lie.
struct RegionGroups {
  static constexpr uint32_t kBlock = 32;  // groups

  std::span<const format::RegionGroup> groups;
  std::span<const format::GroupBlock> blocks;
  std::span<const uint8_t> names;
  std::span<const uint8_t> begun;

  /// What is wrong with them, or null: what is checked here need not be checked by any look-up.
  /// Fills `begins_in`: for each group and class, the group in which the component begins.
  [[nodiscard]] const char* fault(uint32_t classes, std::vector<uint32_t>& begins_in) const;

  [[nodiscard]] uint32_t component_count() const;
  /// Number of the component of a group for one of its classes: they count by the group in which
  /// they begin, then by class. Constant time.
  [[nodiscard]] uint32_t component(uint32_t group, uint32_t avatar_class) const;

 private:
  [[nodiscard]] uint32_t begins_in(uint32_t group, uint32_t avatar_class) const;
};

}  // namespace throng::world
