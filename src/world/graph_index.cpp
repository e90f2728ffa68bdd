// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "world/graph_index.h"

#include <algorithm>
#include <bit>
#include <numeric>

#include "core/files/var_number.h"
#include "throng/avatar.h"

// Packs the components of a world into bytes: 7 bits a byte, as differences from the one before.
// Linear.
namespace throng::world {
namespace {

constexpr size_t kMaxClasses = kMaxAvatarClasses;
constexpr uint64_t kMaxComponentCells = uint64_t{1} << 50;  // of a component

// The place of the last component that was read or written; the next is stored as the difference.
struct LastPlace {
  int64_t level = 0, cell_x = 0, cell_z = 0, feet = 0;

  void put(std::vector<uint8_t>& bytes, const GraphComponent& of) {
    put_number(bytes, folded(of.cell_x - cell_x));
    put_number(bytes, folded(of.cell_z - cell_z));
    put_number(bytes, folded(of.level - level));
    put_number(bytes, folded(of.feet - feet));
    *this = {of.level, of.cell_x, of.cell_z, of.feet};
  }
  // False if there is none, or none that is in the world.
  bool take(std::span<const uint8_t> bytes, size_t& at, const WorldData& world) {
    for (int64_t* value : {&cell_x, &cell_z, &level, &feet}) {
      const auto change = take_number(bytes, at);
      if (!change || *change > uint64_t{1} << 34) return false;
      *value += unfolded(*change);
    }
    return level >= 0 && level < world.level_count && cell_x >= 0 && cell_x < world.width &&
           cell_z >= 0 && cell_z < world.depth && feet >= INT32_MIN && feet <= INT32_MAX;
  }
};

bool is_same_place(const GraphComponent& a, const GraphComponent& b) {
  return a.level == b.level && a.cell_x == b.cell_x && a.cell_z == b.cell_z && a.feet == b.feet;
}

// Components of a zone that follow each other, one for each of some classes in order: those that
// are the first of one of the world have the same place. Mostly all are, of one region each.
struct Cluster {
  // What the next number is, if not all are first with one region.
  enum Code : uint64_t { kOneRegion = 0, kRegions = 1, kJoinsAsLast = 2, kJoins = 3 };

  uint64_t classes = 0;
  const GraphComponent* place = nullptr;  // of those that are first
  bool is_plain = true;
  std::vector<uint8_t> codes;
  std::vector<uint64_t> cells;  // of those that are first

  void put(std::vector<uint8_t>& bytes, LastPlace& last) const {
    put_number(bytes, classes << 1 | (is_plain ? 0 : 1));
    if (!is_plain) bytes.insert(bytes.end(), codes.begin(), codes.end());
    if (place != nullptr) last.put(bytes, *place);
    for (size_t i = 0; i < cells.size(); ++i) {
      // Where classes begin together they have about as many.
      put_number(bytes, i == 0 ? cells[0] : folded(static_cast<int64_t>(cells[i] - cells[i - 1])));
    }
  }
};

}  // namespace

std::vector<std::vector<uint32_t>> rank_components(
    std::span<const std::vector<GraphComponent>> found, GraphData& graph) {
  std::vector<std::vector<uint32_t>> rank(found.size());
  graph.components.clear();
  graph.class_first.assign(1, 0);
  for (size_t c = 0; c < found.size(); ++c) {
    std::vector<uint32_t> order(found[c].size());
    rank[c].resize(order.size());
    std::iota(order.begin(), order.end(), uint32_t{0});
    std::stable_sort(order.begin(), order.end(),
                     [&](uint32_t a, uint32_t b) { return found[c][a].cells > found[c][b].cells; });
    for (uint32_t i = 0; i < order.size(); ++i) {
      rank[c][order[i]] = i;
      graph.components.push_back(found[c][order[i]]);
    }
    graph.class_first.push_back(static_cast<uint32_t>(graph.components.size()));
  }
  return rank;
}

std::vector<uint8_t> pack_components(const GraphData& graph) {
  constexpr uint32_t kNotSeen = UINT32_MAX;
  std::vector<uint8_t> packed;
  std::vector<uint32_t> order(graph.components.size(), kNotSeen);  // within their class
  std::vector<uint32_t> count(graph.class_first.size() - 1, 0);    // seen, of a class
  std::vector<uint32_t> joined(count.size(), 0);  // the last that one was joined to
  LastPlace last;
  Cluster cluster;
  const auto finish = [&] {
    if (cluster.classes != 0) cluster.put(packed, last);
    cluster.classes = 0;
    cluster.place = nullptr;
    cluster.is_plain = true;
    cluster.codes.clear();
    cluster.cells.clear();
  };
  for (size_t i = 0; i < graph.component_of.size(); ++i) {
    const size_t c = graph.class_of[i];
    if (c >= count.size() || c >= kMaxClasses) return {};  // of a graph that is none
    const size_t at = size_t{graph.class_first[c]} + graph.component_of[i];
    if (at >= order.size()) return {};
    const GraphComponent& of = graph.components[at];
    const bool is_first = order[at] == kNotSeen;
    const bool is_elsewhere =
        is_first && cluster.place != nullptr && !is_same_place(of, *cluster.place);
    if (cluster.classes >> c != 0 || is_elsewhere) finish();
    cluster.classes |= uint64_t{1} << c;
    if (is_first) {
      order[at] = count[c]++;
      cluster.place = &of;
      cluster.is_plain &= of.regions == 1;
      put_number(cluster.codes, of.regions == 1 ? Cluster::kOneRegion : Cluster::kRegions);
      if (of.regions != 1) put_number(cluster.codes, of.regions);
      cluster.cells.push_back(of.cells);
    } else {
      cluster.is_plain = false;
      const uint64_t back = count[c] - 1 - order[at];
      put_number(cluster.codes,
                 order[at] == joined[c] ? Cluster::kJoinsAsLast : Cluster::kJoins + back);
      joined[c] = order[at];
    }
  }
  finish();
  return packed;
}

namespace {

// Reads them in the order in which they are first seen; unpack_components puts them in theirs.
class Unpacker {
 public:
  Unpacker(std::span<const uint8_t> bytes, const WorldData& world, GraphData& graph)
      : bytes_(bytes),
        world_(world),
        graph_(graph),
        found_(graph.class_first.size() - 1),
        joined_(found_.size(), 0) {}

  const char* take_all() {
    if (found_.size() > kMaxClasses) return "it has more classes than a world can have";
    while (at_ < bytes_.size()) {
      if (const char* what = take_cluster()) return what;
    }
    return nullptr;
  }
  [[nodiscard]] const std::vector<std::vector<GraphComponent>>& found() const { return found_; }

 private:
  const char* take_cluster() {
    constexpr const char* kFault = "its zones' components make no sense";
    const auto head = take_number(bytes_, at_);
    if (!head || *head >> 1 == 0 || *head >> 1 >> found_.size() != 0) return kFault;
    first_.clear();
    for (uint64_t left = *head >> 1; left != 0; left &= left - 1) {
      const auto c = static_cast<size_t>(std::countr_zero(left));
      auto& of_class = found_[c];
      const auto code = (*head & 1) != 0 ? take_number(bytes_, at_) : Cluster::kOneRegion;
      if (!code) return kFault;
      auto number = static_cast<uint32_t>(of_class.size());
      if (*code >= Cluster::kJoinsAsLast) {
        const uint64_t back = *code == Cluster::kJoinsAsLast ? number - uint64_t{1} - joined_[c]
                                                             : *code - Cluster::kJoins;
        if (back >= number) return kFault;
        number -= 1 + static_cast<uint32_t>(back);
        joined_[c] = number;
      } else {
        const auto regions = *code == Cluster::kRegions ? take_number(bytes_, at_) : uint64_t{1};
        if (!regions || *regions == 0 || *regions > UINT32_MAX) return kFault;
        of_class.push_back({.regions = static_cast<uint32_t>(*regions)});
        first_.push_back(c);
      }
      graph_.class_of.push_back(static_cast<uint8_t>(c));
      graph_.component_of.push_back(number);
    }
    return first_.empty() ? nullptr : take_first();
  }

  // Place and cells of those that were first in their cluster.
  const char* take_first() {
    if (!last_.take(bytes_, at_, world_)) return "a component is nowhere";
    int64_t cells = 0;
    for (const size_t c : first_) {
      const auto change = take_number(bytes_, at_);
      if (!change || *change > 2 * kMaxComponentCells) return "a component makes no sense";
      cells = cells == 0 ? static_cast<int64_t>(*change) : cells + unfolded(*change);
      if (cells <= 0 || cells > static_cast<int64_t>(kMaxComponentCells)) {
        return "a component makes no sense";
      }
      GraphComponent& of = found_[c].back();
      of.cells = static_cast<uint64_t>(cells);
      of.level = static_cast<uint32_t>(last_.level);
      of.cell_x = static_cast<int32_t>(last_.cell_x);
      of.cell_z = static_cast<int32_t>(last_.cell_z);
      of.feet = static_cast<int32_t>(last_.feet);
    }
    return nullptr;
  }

  std::span<const uint8_t> bytes_;
  size_t at_ = 0;
  const WorldData& world_;
  GraphData& graph_;
  LastPlace last_;
  std::vector<std::vector<GraphComponent>> found_;  // per class
  std::vector<uint32_t> joined_;                    // per class: the last that one was joined to
  std::vector<size_t> first_;  // classes of a cluster whose component is the first
};

}  // namespace

const char* unpack_components(std::span<const uint8_t> packed, const WorldData& world,
                              GraphData& graph) {
  Unpacker unpacker(packed, world, graph);
  if (const char* what = unpacker.take_all()) return what;
  const auto& found = unpacker.found();
  for (size_t c = 0; c < found.size(); ++c) {
    if (found[c].size() != graph.class_first[c + 1] - graph.class_first[c]) {
      return "its components do not fit together";
    }
  }
  const auto rank = rank_components(found, graph);
  for (size_t i = 0; i < graph.component_of.size(); ++i) {
    graph.component_of[i] = rank[graph.class_of[i]][graph.component_of[i]];
  }
  return nullptr;
}

}  // namespace throng::world
