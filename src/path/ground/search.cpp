// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "path/ground/search.h"

#include <algorithm>
#include <cmath>

#include "path/ground/border.h"

// Polyanya [CHG17] over rectangles: an interval of a portal, seen from a root, is expanded to what
// is seen of the portals beyond. Time: n log n in the intervals expanded and their rectangles'
// portals. Distances around a rectangle run from its south-west corner with the inside on the left,
// as its portals do. Of a node that sees [right, left] of a portal, what lies from `right` on comes
// first, then what the root sees, then what lies beyond `left`.
namespace throng::path {
namespace {

constexpr size_t kDropFrom = 1 << 16;        // open intervals, before it pays to drop any
constexpr uint32_t kMaxPushed = 0xf0000000;  // numbers of pushes that are distinct

}  // namespace

SearchResult PathSearch::find(const PathMesh& mesh, const Stop& from, const Stop& to,
                              const SearchBudget& budget, std::vector<uint32_t>& corners,
                              double& length, double longest) {
  begin(mesh, from, to, longest);
  const SearchResult result = advance(budget, corners, length);
  give_back();
  return result;
}

void PathSearch::begin(const PathMesh& mesh, const Stop& from, const Stop& to, double longest) {
  mesh_ = &mesh;
  goal_rect_ = to.rect;
  goal_ = in_cells(to.at);
  expanded_ = 0;
  best_.begin(mesh.corners.size());
  was_spent_ = false;
  drop_at_ = kDropFrom;
  roots_.clear();
  nodes_.clear();
  free_.clear();
  open_.clear();
  pushed_ = 0;
  found_length_ = longest;
  found_root_ = UINT32_MAX;
  if (from.rect != to.rect) return start(from.rect, in_cells(from.at));
  roots_.push_back({in_cells(from.at), 0, kNoCorner, 0});
  found_length_ = distance(in_cells(from.at), goal_);
  found_root_ = 0;
}

SearchResult PathSearch::advance(const SearchBudget& budget, std::vector<uint32_t>& corners,
                                 double& length) {
  corners.clear();
  if (was_spent_) --expanded_;  // The one that was too many is expanded now.
  const SearchResult result = run(budget);
  was_spent_ = result == SearchResult::kBudget && budget.spent(expanded_) == SpentBudget::kNodes;
  if (result == SearchResult::kFound) {
    length = found_length_;
    for (uint32_t r = found_root_; roots_[r].corner != kNoCorner; r = roots_[r].before)
      corners.push_back(roots_[r].corner);
    std::reverse(corners.begin(), corners.end());
  }
  if (!was_spent_) give_back();
  return result;
}

// An interval is forgotten as soon as it is expanded. When the memory is used up, so are those that
// can lead to nothing shorter; those are seldom worth expanding.
SearchResult PathSearch::run(const SearchBudget& budget) {
  while (!open_.empty()) {
    if (open_.size() >= drop_at_ || used_bytes() > budget.max_bytes || pushed_ > kMaxPushed) {
      drop_useless();
      drop_at_ = std::max(kDropFrom, 2 * open_.size());
      // So much must be free that it takes a while until the memory is full again.
      if (used_bytes() > budget.max_bytes - budget.max_bytes / 8 || pushed_ > kMaxPushed)
        return SearchResult::kBudget;
      if (open_.empty()) break;
    }
    const Entry entry = open_.first();
    if (entry.estimate >= found_length_) break;
    const Node node = nodes_[entry.node];
    const bool is_useful = !is_stale(node.root);
    if (is_useful && budget.is_spent(++expanded_)) return SearchResult::kBudget;
    open_.pop();
    free_.push_back(entry.node);
    if (is_useful) expand(node);
  }
  return found_root_ == UINT32_MAX ? SearchResult::kNone : SearchResult::kFound;
}

// The vectors hold up to twice what they need, and the old array beside the new one as they grow.
uint64_t PathSearch::used_bytes() const {
  constexpr uint64_t kGrowth = 3;
  const uint64_t ground =
      mesh_ == nullptr || mesh_->source == nullptr ? 0 : mesh_->source->counted_bytes();
  return ground + roots_.size() * sizeof(Root) + nodes_.size() * sizeof(Node) + open_.used_bytes() +
         kGrowth * free_.size() * sizeof(uint32_t);
}

uint64_t PathSearch::allocated_bytes() const {
  return roots_.allocated_bytes() + nodes_.allocated_bytes() + open_.allocated_bytes() +
         free_.capacity() * sizeof(uint32_t);
}

// Removes intervals that would be skipped; the order of the others stays.
void PathSearch::drop_useless() {
  open_.keep_if([&](const Entry& entry) {
    const bool useful = entry.estimate < found_length_ && !is_stale(nodes_[entry.node].root);
    if (!useful) free_.push_back(entry.node);
    return useful;
  });
}

void PathSearch::give_back() {
  if (allocated_bytes() <= kKeptBytes) return;
  roots_.clear();
  nodes_.clear();
  roots_.shrink(kKeptBytes / 4 / sizeof(Root));
  nodes_.shrink(kKeptBytes / 4 / sizeof(Node));
  if (open_.allocated_bytes() > kKeptBytes / 4) open_.give_back();
  if (free_.capacity() * sizeof(uint32_t) > kKeptBytes / 8) std::vector<uint32_t>().swap(free_);
}

void PathSearch::start(uint32_t start_rect, CellPoint from) {
  roots_.push_back({from, 0, kNoCorner, 0});
  rects_around(*mesh_, start_rect, from, around_);
  for (const uint32_t r : around_) {
    if (r == goal_rect_ && distance(from, goal_) < found_length_) {
      found_length_ = distance(from, goal_);
      found_root_ = 0;
    }
    const auto portals = mesh_->portals_of(r);
    const MeshRect& rect = mesh_->rects[r];
    for (const MeshPortal& portal : portals) add_piece(rect, portal, portal.from, portal.to, 0);
  }
}

// A better path to the root's corner has been found since.
bool PathSearch::is_stale(uint32_t root) const {
  const Root& r = roots_[root];
  return r.corner != kNoCorner && best_[r.corner].length < r.length - kSame;
}

// The root of paths that turn at a corner after `root`; UINT32_MAX if there was a better path
// there.
uint32_t PathSearch::turn(uint32_t root, CellPoint at, uint32_t corner) {
  const double length = roots_[root].length + distance(roots_[root].point, at);
  best_.grow(mesh_->corners.size());  // made meanwhile
  Best& best = best_[corner];
  if (best_.is_reached(best) && best.length < length - kSame) return UINT32_MAX;
  best = {best_.search(), length};
  roots_.push_back({at, length, corner, root});
  return static_cast<uint32_t>(roots_.size() - 1);
}

double PathSearch::estimate(const Node& node) const {
  const Root& root = roots_[node.root];
  CellPoint goal = goal_;
  const double side_root = cross(node.right, node.left, root.point);
  const double side_goal = cross(node.right, node.left, goal);
  const double width = distance(node.left, node.right);
  if (std::fabs(side_root) <= kSame * width) {
    // Edge on: over the nearer end, or from where the root lies on the interval.
    const double to_right = distance(root.point, node.right);
    const double to_left = distance(root.point, node.left);
    if (std::max(to_right, to_left) <= width + kSame)
      return root.length + distance(root.point, goal);
    const CellPoint end = to_right < to_left ? node.right : node.left;
    return root.length + std::min(to_right, to_left) + distance(end, goal);
  }
  // A goal on the root's side is reached over the interval all the same: its mirror image is as
  // far.
  if (side_root * side_goal > 0) {
    const bool upright = node.left.x == node.right.x;
    if (upright) {
      goal.x = 2 * node.left.x - goal.x;
    } else {
      goal.z = 2 * node.left.z - goal.z;
    }
  }
  if (cross(root.point, node.left, goal) > 0)
    return root.length + distance(root.point, node.left) + distance(node.left, goal);
  if (cross(root.point, node.right, goal) < 0)
    return root.length + distance(root.point, node.right) + distance(node.right, goal);
  return root.length + distance(root.point, goal);
}

void PathSearch::push(const Node& node) {
  auto place = static_cast<uint32_t>(nodes_.size());
  if (free_.empty()) {
    nodes_.push_back(node);
  } else {
    place = free_.back();
    free_.pop_back();
    nodes_[place] = node;
  }
  open_.push({estimate(node), pushed_++, place});
}

// The stretch [from, to] of a portal of `rect`, seen from the root.
void PathSearch::add_piece(const MeshRect& rect, const MeshPortal& portal, double from, double to,
                           uint32_t root) {
  const bool whole_from = from <= portal.from + kSame, whole_to = to >= portal.to - kSame;
  if (!(to - from > kSame)) return;
  Node node;
  node.right = point_around(rect, whole_from ? portal.from : from);
  node.left = point_around(rect, whole_to ? portal.to : to);
  if (whole_from) node.right_corner = portal.from_corner;
  if (whole_to) node.left_corner = portal.to_corner;
  node.rect = portal.rect;
  node.root = root;
  push(node);
}

// The goal is seen, or lies behind one of the interval's ends: then the path turns there, at a root
// that is made.
void PathSearch::look_at_goal(const Node& node, bool on_line, uint32_t seen_root,
                              uint32_t& right_root, uint32_t& left_root) {
  uint32_t via = seen_root;
  const CellPoint from = roots_[seen_root].point;
  if (!on_line && cross(from, node.right, goal_) < -kSame) {
    if (node.right_corner == kNoCorner)
      via = UINT32_MAX;
    else
      via = right_root = turn(node.root, node.right, node.right_corner);
  } else if (!on_line && cross(from, node.left, goal_) > kSame) {
    if (node.left_corner == kNoCorner)
      via = UINT32_MAX;
    else
      via = left_root = turn(node.root, node.left, node.left_corner);
  }
  if (via == UINT32_MAX) return;
  const double length = roots_[via].length + distance(roots_[via].point, goal_);
  if (length >= found_length_) return;
  found_length_ = length;
  found_root_ = via;
}

void PathSearch::expand(const Node& node) {
  const CellPoint root = roots_[node.root].point;
  const auto portals = mesh_->portals_of(node.rect);
  const MeshRect& rect = mesh_->rects[node.rect];
  const double base = around(rect, node.right);
  const double whole = perimeter(rect);
  const double width = distance(node.left, node.right);
  const double last = whole - width;  // of the left end, from the right one on
  const auto from_base = [&](double at) {
    const double rest = at - base;
    return rest < -kSame ? rest + whole : std::max(rest, 0.0);
  };

  // Between these the root sees the border.
  double seen_first = 0, seen_last = last;
  uint32_t seen_root = node.root;
  const double side = cross(node.right, node.left, root);
  if (std::fabs(side) <= kSame * width) {
    // The root lies on the interval's line: unless it lies on the interval, the path goes to the
    // nearer end and turns there.
    const double to_right = distance(root, node.right), to_left = distance(root, node.left);
    const bool touches = std::max(to_right, to_left) <= width + kSame;
    if (touches && roots_[node.root].corner == kNoCorner)
      return;  // start() covered what is seen from there
    if (!touches) {
      const bool right = to_right < to_left;
      const uint32_t corner = right ? node.right_corner : node.left_corner;
      if (corner == kNoCorner) return;
      seen_root = turn(node.root, right ? node.right : node.left, corner);
      if (seen_root == UINT32_MAX) return;
    }
  } else {
    // Along the border, all that the ray passes is seen, edge on.
    if (!runs_along(rect, root, node.right))
      seen_first = from_base(exit_around(rect, root, node.right));
    if (!runs_along(rect, root, node.left))
      seen_last = from_base(exit_around(rect, root, node.left));
    if (seen_last < seen_first) seen_last = seen_first;  // by rounding only
  }

  uint32_t right_root = UINT32_MAX, left_root = UINT32_MAX;
  if (node.rect == goal_rect_) {
    const bool on_line = std::fabs(side) <= kSame * width;
    look_at_goal(node, on_line, seen_root, right_root, left_root);
  }
  bool right_asked = right_root != UINT32_MAX, left_asked = left_root != UINT32_MAX;
  const auto behind = [&](bool right) {
    uint32_t& made = right ? right_root : left_root;
    bool& asked = right ? right_asked : left_asked;
    const uint32_t corner = right ? node.right_corner : node.left_corner;
    if (!asked && corner != kNoCorner)
      made = turn(node.root, right ? node.right : node.left, corner);
    asked = true;
    return made;
  };

  for (const MeshPortal& portal : portals) {
    double first = from_base(portal.from), stop = first + (portal.to - portal.from);
    // A portal may hold the interval itself: what lies on either side of it counts apart.
    const auto add = [&](double a, double b) {
      a = std::max(a, 0.0);
      b = std::min(b, last);
      const double offset = portal.from - first;  // back to distances around
      const auto piece = [&](double i, double j, uint32_t root_of) {
        if (j - i > kSame && root_of != UINT32_MAX)
          add_piece(rect, portal, i + offset, j + offset, root_of);
      };
      if (a < seen_first - kSame) piece(a, std::min(b, seen_first), behind(true));
      piece(std::max(a, seen_first), std::min(b, seen_last), seen_root);
      if (b > seen_last + kSame) piece(std::max(a, seen_last), b, behind(false));
    };
    if (stop <= whole + kSame) {
      add(first, stop);
    } else {
      const double over = stop - whole;  // it goes on past the right end
      add(first, whole);
      first -= whole;
      add(0, over);
    }
  }
}

}  // namespace throng::path
