// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "world/graph_index.h"

#include <algorithm>

#include "core/var_number.h"

namespace throng {
namespace {

constexpr uint64_t kMostCells = uint64_t{1} << 50;  // of a component

// The place of the last component that was told; the next is told by what has changed.
struct LastPlace {
  int64_t level = 0, cell_x = 0, cell_z = 0, feet = 0;

  [[nodiscard]] bool is_of(const GraphComponent& of) const {
    return level == of.level && cell_x == of.cell_x && cell_z == of.cell_z && feet == of.feet;
  }
  void put(std::vector<uint8_t>& bytes, const GraphComponent& of) {
    put_number(bytes, folded(of.cell_x - cell_x) + 1);  // 0: the same place
    put_number(bytes, folded(of.cell_z - cell_z));
    put_number(bytes, folded(of.level - level));
    put_number(bytes, folded(of.feet - feet));
    *this = {of.level, of.cell_x, of.cell_z, of.feet};
  }
  // False if there is none, or none that could be.
  bool take(std::span<const uint8_t> bytes, size_t& at) {
    const auto first = take_number(bytes, at);
    if (!first) return false;
    if (*first == 0) return true;
    if (!move(cell_x, *first - 1)) return false;
    for (int64_t* value : {&cell_z, &level, &feet}) {
      const auto change = take_number(bytes, at);
      if (!change || !move(*value, *change)) return false;
    }
    return true;
  }

 private:
  static bool move(int64_t& value, uint64_t change) {
    if (change > uint64_t{1} << 34) return false;
    value += unfolded(change);
    return value >= INT32_MIN && value <= UINT32_MAX;
  }
};

}  // namespace

PackedComponents pack_components(const GraphData& graph) {
  PackedComponents packed;
  const size_t classes = graph.class_first.size() - 1;
  uint64_t before = 0;
  for (size_t i = 0; i < graph.components.size(); ++i) {
    const GraphComponent& of = graph.components[i];
    const bool is_first =
        std::find(graph.class_first.begin(), graph.class_first.end(), i) != graph.class_first.end();
    put_number(packed.sizes, is_first ? of.cells : before - of.cells);
    put_number(packed.sizes, of.regions);
    before = of.cells;
  }
  std::vector<bool> seen(graph.components.size(), false);
  LastPlace last;
  for (size_t i = 0; i < graph.component_of.size(); ++i) {
    const size_t c = graph.class_of[i];
    put_number(packed.of_zones, uint64_t{graph.component_of[i]} * classes + c);
    const size_t at = size_t{graph.class_first[c]} + graph.component_of[i];
    if (at >= seen.size() || seen[at]) continue;
    seen[at] = true;
    if (last.is_of(graph.components[at])) {
      put_number(packed.of_zones, 0);
    } else {
      last.put(packed.of_zones, graph.components[at]);
    }
  }
  return packed;
}

const char* unpack_components(std::span<const uint8_t> sizes, std::span<const uint8_t> of_zones,
                              const WorldData& world, GraphData& graph) {
  const size_t classes = graph.class_first.size() - 1, count = graph.class_first.back();
  if (count > sizes.size() / 2) return "its components end too early";
  graph.components.assign(count, {});
  size_t at = 0;
  for (size_t c = 0; c < classes; ++c) {
    uint64_t before = 0;
    for (size_t i = graph.class_first[c]; i < graph.class_first[c + 1]; ++i) {
      const auto cells = take_number(sizes, at), regions = take_number(sizes, at);
      const bool is_first = i == graph.class_first[c];
      // The largest come first.
      if (!cells || !regions || *cells > (is_first ? kMostCells : before) || *regions == 0 ||
          *regions > UINT32_MAX) {
        return "a component makes no sense";
      }
      before = is_first ? *cells : before - *cells;
      if (before == 0) return "a component makes no sense";
      graph.components[i].cells = before;
      graph.components[i].regions = static_cast<uint32_t>(*regions);
    }
  }
  if (at != sizes.size()) return "its components do not fit together";

  std::vector<bool> seen(count, false);
  LastPlace last;
  size_t places = 0;
  for (at = 0; at < of_zones.size();) {
    const auto number = take_number(of_zones, at);
    if (!number) return "its zones' components make no sense";
    const auto c = static_cast<size_t>(*number % classes);
    const uint64_t component = *number / classes;
    if (component >= graph.class_first[c + 1] - graph.class_first[c]) {
      return "its zones' components make no sense";
    }
    graph.class_of.push_back(static_cast<uint8_t>(c));
    graph.component_of.push_back(static_cast<uint32_t>(component));
    const size_t own = graph.class_first[c] + component;
    if (seen[own]) continue;
    seen[own] = true;
    ++places;
    if (!last.take(of_zones, at) || last.level < 0 || last.level >= world.level_count ||
        last.cell_x < 0 || last.cell_x >= world.width || last.cell_z < 0 ||
        last.cell_z >= world.depth || last.feet > INT32_MAX) {
      return "a component is nowhere";
    }
    GraphComponent& of = graph.components[own];
    of.level = static_cast<uint32_t>(last.level);
    of.cell_x = static_cast<int32_t>(last.cell_x);
    of.cell_z = static_cast<int32_t>(last.cell_z);
    of.feet = static_cast<int32_t>(last.feet);
  }
  return places == count ? nullptr : "a component is nowhere";
}

}  // namespace throng
