// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "path/edits/saved_edits.h"

#include <array>
#include <cstring>
#include <memory>
#include <type_traits>
#include <utility>

#include "path/edits/ground_finder.h"
#include "throng/base.h"

// A head, the edits one after the other, each a row with its corners and triangles behind it. What
// is read was perhaps not written here, so all that Edits checks is checked again.
namespace throng::path {
namespace {

struct Head {
  uint64_t version = 0, edits = 0;
  std::array<double, 64> area_costs{};
};
static_assert(sizeof(Head) == 66 * 8 && std::is_trivially_copyable_v<Head>);

struct EditRow {
  uint8_t kind = 0, area = 0, active = 0, removed = 0;
  uint8_t obstacle_kind = 0, policy = 0, two_way = 0;
  uint8_t on_nodes = 0;  // a link with ends on nodes, which follow the row

  uint32_t moves = 0, corners = 0;
  uint64_t triangles = 0;
  double low = 0, high = 0;
  // Of an off-mesh link.
  std::array<double, 3> from{}, to{};
  uint32_t from_level1 = 0, to_level1 = 0;
  double cost = 0;
};
static_assert(sizeof(EditRow) == 104 && std::is_trivially_copyable_v<EditRow>);

// A place on nodes.
struct NodeRow {
  uint32_t node1 = 0, unused = 0;
  std::array<double, 3> feet{}, axis{}, normal{};
  double s = 0, t = 0;
};
static_assert(sizeof(NodeRow) == 96 && std::is_trivially_copyable_v<NodeRow>);

struct CallRow {
  uint32_t edit = 0;
  uint8_t area = 0, call = 0;
  uint16_t corners = 0;
  double low = 0, high = 0;
};
static_assert(sizeof(CallRow) == 24 && std::is_trivially_copyable_v<CallRow>);

template <class T>
void put(std::vector<uint8_t>& out, const T* values, size_t count) {
  static_assert(std::is_trivially_copyable_v<T>);
  if (count == 0) return;
  const size_t before = out.size();
  out.resize(before + count * sizeof(T));
  std::memcpy(out.data() + before, values, count * sizeof(T));
}

// Takes values from the front. False: there are not so many bytes.
template <class T>
bool take(std::span<const uint8_t>& from, T* values, size_t count) {
  static_assert(std::is_trivially_copyable_v<T>);
  if (count > from.size() / sizeof(T)) return false;
  if (count > 0) std::memcpy(values, from.data(), count * sizeof(T));
  from = from.subspan(count * sizeof(T));
  return true;
}

// None: it is no prism.
std::shared_ptr<const Prism> take_prism(std::span<const uint8_t>& from, size_t corners, double low,
                                        double high) {
  if (corners > 64) return nullptr;
  auto prism = std::make_shared<Prism>();
  prism->corners.resize(corners);
  prism->low = low;
  prism->high = high;
  if (!take(from, prism->corners.data(), corners) || !check_prism(*prism)) return nullptr;
  return prism;
}

std::array<double, 3> numbers_of(const Vec3d& v) { return {v.x, v.y, v.z}; }
Vec3d vector_of(const std::array<double, 3>& v) { return {v[0], v[1], v[2]}; }

NodeRow row_of(const NodePlace& place) {
  return {.node1 = place.node1,
          .feet = numbers_of(place.feet),
          .axis = numbers_of(place.axis),
          .normal = numbers_of(place.normal),
          .s = place.s,
          .t = place.t};
}
NodePlace place_of(const NodeRow& row) {
  return {.node1 = row.node1,
          .feet = vector_of(row.feet),
          .axis = vector_of(row.axis),
          .normal = vector_of(row.normal),
          .s = row.s,
          .t = row.t};
}

bool is_flag(uint8_t value) { return value <= 1; }

// Is it a row of which Edits could have made an edit, whatever follows it?
bool is_sound(const EditRow& row) {
  if (row.kind > static_cast<uint8_t>(EditList::Kind::kOffMeshLink) || !is_flag(row.active) ||
      !is_flag(row.removed) || !is_flag(row.obstacle_kind) || !is_flag(row.policy) ||
      !is_flag(row.two_way) || !is_flag(row.on_nodes) || (row.active != 0 && row.removed != 0)) {
    return false;
  }
  const auto kind = static_cast<EditList::Kind>(row.kind);
  const bool is_area = kind == EditList::Kind::kArea;
  if (is_area ? !check_area(row.area) : row.area != 0) return false;
  const bool is_obstacle = kind == EditList::Kind::kObstacle;
  if (row.on_nodes != 0 && (is_obstacle || is_area)) return false;
  if (!is_obstacle && (row.triangles != 0 || row.moves != 0)) return false;
  if (row.removed != 0) return row.corners == 0 && row.triangles == 0;
  if (is_obstacle || is_area) return (row.corners != 0) != (row.triangles != 0);
  return row.corners == 0;
}

bool take_edit(std::span<const uint8_t>& from, EditList::Edit& edit) {
  EditRow row;
  if (!take(from, &row, 1) || !is_sound(row)) return false;
  edit.kind = static_cast<EditList::Kind>(row.kind);
  edit.area = row.area;
  edit.active = row.active != 0;
  edit.removed = row.removed != 0;
  edit.obstacle_kind = static_cast<ObstacleKind>(row.obstacle_kind);
  edit.policy = static_cast<ObstaclePolicy>(row.policy);
  edit.moves = row.moves;
  edit.link = {.from = {vector_of(row.from), row.from_level1},
               .to = {vector_of(row.to), row.to_level1},
               .cost = row.cost,
               .two_way = row.two_way != 0};
  if (row.on_nodes != 0) {
    std::array<NodeRow, 2> ends;
    if (!take(from, ends.data(), ends.size()) || ends[0].unused != 0 || ends[1].unused != 0) {
      return false;
    }
    edit.link.from_on_nodes = place_of(ends[0]);
    edit.link.to_on_nodes = place_of(ends[1]);
    if (!is_over_nodes(edit.link)) return false;
  }
  if (edit.kind == EditList::Kind::kOffMeshLink) return bool(check_link(edit.link));
  if (row.corners > 0) {
    edit.place = take_prism(from, row.corners, row.low, row.high);
    return edit.place != nullptr;
  }
  if (row.triangles > from.size() / sizeof(std::array<Vec3d, 3>)) return false;
  edit.triangles.resize(static_cast<size_t>(row.triangles));
  for (std::array<Vec3d, 3>& triangle : edit.triangles) {
    for (Vec3d& p : triangle) {
      std::array<double, 3> numbers{};
      if (!take(from, &numbers, 1)) return false;
      p = vector_of(numbers);
      if (!is_on_earth(p)) return false;
    }
  }
  if (!edit.triangles.empty()) {
    edit.place = std::make_shared<const Prism>(prism_around(solid_of(edit.triangles)));
  }
  return true;
}

bool take_call(std::span<const uint8_t>& from, const EditList& list, EditList::Changed& call) {
  using Call = EditList::Call;
  CallRow row;
  if (!take(from, &row, 1) || row.call > static_cast<uint8_t>(Call::kSetCost)) return false;
  call.edit = row.edit;
  call.area = row.area;
  call.call = static_cast<Call>(row.call);
  if (row.edit > list.edits.size()) return false;
  if (row.edit == 0) return call.call == Call::kSetCost && check_area(row.area) && row.corners == 0;
  if (call.call == Call::kSetCost || row.area != 0) return false;
  const bool has_place = list.edits[row.edit - 1].is_obstacle() && call.call != Call::kRemove;
  if (!has_place) return row.corners == 0 && call.call != Call::kMove;
  call.place = take_prism(from, row.corners, row.low, row.high);
  return call.place != nullptr;
}

}  // namespace

std::vector<uint8_t> save_edits(const EditList& list) {
  std::vector<uint8_t> out;
  const Head head{list.version(), list.edits.size(), list.area_costs};
  put(out, &head, 1);
  for (const EditList::Edit& edit : list.edits) {
    // (The place of triangles is made of these.)
    const bool has_corners = edit.place != nullptr && edit.triangles.empty();
    const EditRow row{
        .kind = static_cast<uint8_t>(edit.kind),
        .area = edit.area,
        .active = edit.active,
        .removed = edit.removed,
        .obstacle_kind = static_cast<uint8_t>(edit.obstacle_kind),
        .policy = static_cast<uint8_t>(edit.policy),
        .two_way = edit.link.two_way,
        .on_nodes = is_over_nodes(edit.link),
        .moves = edit.moves,
        .corners = has_corners ? static_cast<uint32_t>(edit.place->corners.size()) : 0,
        .triangles = edit.triangles.size(),
        .low = has_corners ? edit.place->low : 0,
        .high = has_corners ? edit.place->high : 0,
        .from = numbers_of(edit.link.from.position),
        .to = numbers_of(edit.link.to.position),
        .from_level1 = edit.link.from.level1,
        .to_level1 = edit.link.to.level1,
        .cost = edit.link.cost};
    put(out, &row, 1);
    if (row.on_nodes != 0) {
      const std::array ends{row_of(edit.link.from_on_nodes), row_of(edit.link.to_on_nodes)};
      put(out, ends.data(), ends.size());
    }
    if (has_corners) put(out, edit.place->corners.data(), edit.place->corners.size());
    for (const std::array<Vec3d, 3>& triangle : edit.triangles) {
      for (const Vec3d& p : triangle) {
        const std::array<double, 3> numbers = numbers_of(p);
        put(out, &numbers, 1);
      }
    }
  }
  return out;
}

std::vector<uint8_t> save_calls(const EditList& list, uint64_t since) {
  std::vector<uint8_t> out;
  if (!list.knows_calls_since(since)) return out;
  list.for_changed(since, [&](const EditList::Changed& call) {
    const Prism* place = call.place.get();
    const CallRow row{
        .edit = call.edit,
        .area = call.area,
        .call = static_cast<uint8_t>(call.call),
        .corners = static_cast<uint16_t>(place != nullptr ? place->corners.size() : 0),
        .low = place != nullptr ? place->low : 0,
        .high = place != nullptr ? place->high : 0};
    put(out, &row, 1);
    if (place != nullptr) put(out, place->corners.data(), place->corners.size());
  });
  return out;
}

std::optional<EditList> restore_edits(std::span<const uint8_t> edits,
                                      std::span<const uint8_t> calls) {
  EditList list;
  Head head;
  if (!take(edits, &head, 1) || head.edits > edits.size()) return {};
  if (head.area_costs[0] != 1) return {};
  for (uint8_t kind = 1; kind < head.area_costs.size(); ++kind) {
    if (!check_area_cost(kind, head.area_costs[kind])) return {};
  }
  list.area_costs = head.area_costs;
  for (uint64_t n = 0; n < head.edits; ++n) {
    if (!take_edit(edits, list.edits.emplace_back())) return {};
  }
  while (!calls.empty()) {
    if (!take_call(calls, list, list.changed.emplace_back())) return {};
  }
  // Each edit was made by a call.
  if (!edits.empty() || head.version < list.changed.size() || head.version < head.edits) return {};
  list.first_version = head.version - list.changed.size();
  list.count_all();
  return list;
}

}  // namespace throng::path
