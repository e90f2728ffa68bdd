// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "path/air/flight_search.h"

#include <algorithm>
#include <cmath>

// A* over the free boxes of the air's octree, from face to face; the path's points lie on the
// faces. Source: [PACS00]. Cost: n log n in the boxes that are expanded.
namespace throng::path {
namespace {

constexpr double kMinGain = 1e-9;
// The heuristic is weighted a little: among paths that are nearly as short, the one that is nearly
// at the goal is expanded first. It costs 0.02 % of length and spares three boxes of four.
constexpr double kHeuristicWeight = 1.02;
constexpr double kLargeHeuristicWeight = 1.1;  // through large boxes

// Over hills and roofs most boxes are a cell or two wide, and expanding most of them is of no use.
// So if the ends are far apart, the first search goes through boxes of a minimum size that grows
// with the distance from both ends. Its result is used if it is hardly longer than the straight
// line; otherwise the search through all boxes has a budget in which to find a shorter one. String
// pulling moves the path to the edges of what is in between in either case.
constexpr double kCoarseDistance = 256;  // ends so many voxels apart
constexpr double kMaxStretch = 1.05;     // before it is pulled taut
constexpr uint64_t kBudget = 1u << 17;   // boxes
struct Ring {
  double within;     // voxels from an end
  int32_t min_side;  // voxels a side of a box
};
constexpr Ring kRings[] = {{64, 1}, {256, 4}, {1024, 8}, {HUGE_VAL, 16}};

// The plane between two boxes that share a part of a face.
struct Door {
  int axis = 0;
  double plane = 0;
  double skin = 0;  // what leads from the plane into the second box
};

Door door_between(const world::AirCube& a, const world::AirCube& b) {
  const int32_t low_a[3] = {a.x, a.y, a.z}, low_b[3] = {b.x, b.y, b.z};
  for (int i = 0; i < 3; ++i) {
    if (low_a[i] + a.side == low_b[i]) return {i, static_cast<double>(low_b[i]), kAirSkin};
    if (low_b[i] + b.side == low_a[i]) return {i, static_cast<double>(low_a[i]), -kAirSkin};
  }
  return {};
}

// Where the path from `from` to `to` best passes from one box into another: on the face that they
// share, where the straight line crosses its plane (mirrored, if both lie on one side of it).
AirPoint pass(const world::AirCube& a, const world::AirCube& b, AirPoint from, AirPoint to) {
  const int32_t low_a[3] = {a.x, a.y, a.z}, low_b[3] = {b.x, b.y, b.z};
  const auto [axis, plane, skin] = door_between(a, b);
  const double inside = plane + skin;
  const double da = std::fabs(axis_of(from, axis) - plane),
               db = std::fabs(axis_of(to, axis) - plane);
  const double t = da + db > 0 ? da / (da + db) : 0.5;
  double out[3];
  for (int i = 0; i < 3; ++i) {
    if (i == axis) {
      out[i] = inside;
      continue;
    }
    const double low = std::max(low_a[i], low_b[i]) + kAirSkin;
    const double high = std::min(low_a[i] + a.side, low_b[i] + b.side) - kAirSkin;
    const double at = axis_of(from, i) + t * (axis_of(to, i) - axis_of(from, i));
    out[i] = std::clamp(at, low, high);
  }
  return {out[0], out[1], out[2]};
}

}  // namespace

void FlightSearch::push(uint32_t node) { open_.push({nodes_[node].estimate, node}); }

// A box takes a node, a mark and an entry of the heap each time it is reached.
uint64_t FlightSearch::used_bytes() const {
  return nodes_.size() * (sizeof(Node) + sizeof(Mark)) + open_.used_bytes();
}

uint64_t FlightSearch::allocated_bytes() const {
  return nodes_.allocated_bytes() + marks_.allocated_bytes() + open_.allocated_bytes();
}

void FlightSearch::give_back() {
  if (allocated_bytes() <= kKeptBytes) return;
  nodes_.clear();
  nodes_.shrink(0);
  marks_.give_back();
  open_.give_back();
}

SearchResult FlightSearch::find(const AirView& air, AirPoint from, AirPoint to,
                                const SearchBudget& budget, std::vector<AirPoint>& path) {
  begin(air, from, to);
  Slice all;
  return *advance(budget, all, path);
}

void FlightSearch::begin(const AirView& air, AirPoint from, AirPoint to) {
  air_ = air;
  start_ = from;
  goal_ = to;
  expanded_ = 0;
  found_large_ = false;
  all_nodes_ = UINT64_MAX;
  start_box_ = air.box_at(from);
  goal_box_ = air.box_at(to);
  step_ = Step::kNone;
  if (start_box_ == kNoBox || goal_box_ == kNoBox) return;
  step_ = Step::kStraight;
  if (air.sees(from, to)) return;
  begin_boxes(air_distance(from, to) <= kCoarseDistance ? Step::kAll : Step::kLarge);
}

std::optional<SearchResult> FlightSearch::advance(const SearchBudget& budget, Slice& slice,
                                                  std::vector<AirPoint>& path) {
  path.clear();
  if (step_ == Step::kNone) return SearchResult::kNone;
  if (step_ == Step::kStraight) {
    path = {start_, goal_};
    return SearchResult::kFound;
  }
  if (step_ == Step::kLarge) {
    const auto large = search(budget, slice, large_path_);
    if (!large || large == SearchResult::kBudget) return large;
    found_large_ = large == SearchResult::kFound;
    if (found_large_ && length_of(large_path_) <= kMaxStretch * air_distance(start_, goal_)) {
      path = large_path_;
      return SearchResult::kFound;
    }
    const uint64_t left = budget.max_nodes - expanded_;
    all_nodes_ = expanded_ + (found_large_ ? std::min(left, kBudget) : left);
    begin_boxes(Step::kAll);
  }
  SearchBudget rest = budget;
  rest.max_nodes = std::min(budget.max_nodes, all_nodes_);
  const auto all = search(rest, slice, path);
  if (!all || !found_large_) return all;
  if (all == SearchResult::kFound && length_of(path) <= length_of(large_path_)) return all;
  path = large_path_;
  return SearchResult::kFound;
}

int32_t FlightSearch::min_around(const world::AirCube& box) const {
  if (!large_) return 1;
  const auto off = [&](AirPoint p) {
    return std::max({box.x - p.x, p.x - (box.x + box.side), box.y - p.y, p.y - (box.y + box.side),
                     box.z - p.z, p.z - (box.z + box.side)});
  };
  const double distance = std::min(off(start_), off(goal_));
  const Ring* ring = kRings;
  while (distance >= ring->within) ++ring;
  return ring->min_side;
}

void FlightSearch::begin_boxes(Step step) {
  step_ = step;
  large_ = step == Step::kLarge;
  marks_.begin(air_->end());
  nodes_.clear();
  open_.clear();
  nodes_.push_back({start_, 0, air_distance(start_, goal_), start_box_, 0, 0, false});
  marks_[start_box_] = {marks_.search(), 0};
  push(0);
}

std::optional<SearchResult> FlightSearch::search(const SearchBudget& budget, Slice& slice,
                                                 std::vector<AirPoint>& path) {
  path.clear();
  while (!open_.empty()) {
    if (slice.is_empty()) return {};
    const Entry entry = open_.pop();
    Node& node = nodes_[entry.node];
    if (node.opened || entry.estimate > node.estimate) continue;
    if (budget.is_spent(expanded_ + 1, used_bytes())) return SearchResult::kBudget;
    slice.take();
    ++expanded_;
    // Seen from the parent's waypoint after all? Else the path turns where it entered the box
    // before.
    if (node.parent != node.via && !air_->sees(nodes_[node.parent].point, node.point)) {
      node.parent = node.via;
      const Node& via = nodes_[node.via];
      const double longer = via.length + air_distance(via.point, node.point) - node.length;
      node.length += longer;
      node.estimate += longer;
      if (!open_.empty() && open_.first().estimate < node.estimate) {
        push(entry.node);
        continue;
      }
    }
    node.opened = true;
    if (node.box == goal_box_) {
      trace(entry.node, path);
      return SearchResult::kFound;
    }
    open(entry.node);
  }
  return SearchResult::kNone;
}

AirPoint FlightSearch::nearest_reached(AirPoint goal) const {
  AirPoint nearest = start_;
  double min_side = air_distance(start_, goal);
  for (size_t n = 0; n < nodes_.size(); ++n) {
    const Node& node = nodes_[n];
    const AirPoint p = nearest_of(air_->cube(node.box), goal);
    const double far = air_distance(p, goal);
    if (far >= min_side) continue;
    min_side = far;
    nearest = p;
  }
  return nearest;
}

// From the goal back. A segment from box to box leaves the first through the face that they share,
// but a skin before its end: where it runs so flat that this matters, it goes straight up to the
// face.
void FlightSearch::trace(uint32_t node, std::vector<AirPoint>& path) const {
  path.push_back(goal_);
  for (uint32_t n = node;; n = nodes_[n].parent) {
    const Node& at = nodes_[n];
    path.push_back(at.point);
    if (n == 0) break;
    const Node& via = nodes_[at.via];
    if (at.parent != at.via || air_->sees(via.point, at.point)) continue;
    const Door door = door_between(air_->cube(via.box), air_->cube(at.box));
    double before[3] = {at.point.x, at.point.y, at.point.z};
    before[door.axis] = door.plane - door.skin;
    path.push_back({before[0], before[1], before[2]});
  }
  std::reverse(path.begin(), path.end());
}

void FlightSearch::open(uint32_t node) {
  const world::AirCube& box = air_->cube(nodes_[node].box);
  air_->for_neighbours(
      box, [&](uint32_t next) { reach(node, next); }, min_around(box));
}

void FlightSearch::reach(uint32_t from, uint32_t box) {
  Mark& mark = marks_[box];
  const bool known = marks_.is_reached(mark);
  if (known && nodes_[mark.node].opened) return;
  const uint32_t parent = nodes_[from].parent;
  const Node& turn = nodes_[parent];
  Node next;
  next.point = pass(air_->cube(nodes_[from].box), air_->cube(box), turn.point, goal_);
  next.length = turn.length + air_distance(turn.point, next.point);
  next.estimate = next.length + (large_ ? kLargeHeuristicWeight : kHeuristicWeight) *
                                    air_distance(next.point, goal_);
  next.box = box;
  next.parent = parent;
  next.via = from;
  if (known) {
    Node& old = nodes_[mark.node];
    if (next.estimate >= old.estimate - kMinGain) return;
    old = next;
    push(mark.node);
    return;
  }
  mark = {marks_.search(), static_cast<uint32_t>(nodes_.size())};
  nodes_.push_back(next);
  push(mark.node);
}

}  // namespace throng::path
