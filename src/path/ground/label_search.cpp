// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "path/ground/label_search.h"

#include <algorithm>
#include <cmath>

#include "path/ground/border.h"
#include "path/ground/mesh_ray.h"

// The shortest path by hub labels: the ends see corners, and the smallest sum of two labels of one
// hub is the length. Linear in the labels that are read.
namespace throng::path {
namespace {

constexpr float kUnreached = 3e38f;
constexpr double kMaxLonger = 1.02;  // of paths over middles
// Sums of two or three floats of up to 2^20 cells; what is as short within their error stays.
constexpr float kBoundTolerance = 0.25f;  // cells

uint32_t block_of(const PathMesh& mesh, const Stop& end) {
  return mesh.block_at(end.rect, end.at.cell_x(), end.at.cell_z());
}

float distance_to(const MeshCorner& corner, CellPoint p) {
  const double dx = corner.x - p.x, dz = corner.z - p.z;
  return static_cast<float>(std::sqrt(dx * dx + dz * dz));
}

}  // namespace

// Joins the labels of the corners that the ends see. A path from one end to the other over a corner
// is at least as long as the straight lines to it and from it, so no corner outside the ellipse of
// a known path can be on a shorter one, and rays are sent only to the corners within.
bool LabelSearch::narrow(const PathMesh& mesh, const HubLabels& labels, const Stop& from,
                         const Stop& to, float known, Best& best) {
  const CellPoint start = in_cells(from.at), goal = in_cells(to.at);
  const auto gather = [&](const Stop& end, CellPoint here, CellPoint there,
                          std::vector<Turn>& turns) {
    turns.clear();
    const uint32_t block = block_of(mesh, end), last = labels.first_candidate[block + 1];
    for (uint32_t i = labels.first_candidate[block]; i < last; ++i) {
      const HubLabels::Candidate candidate = labels.candidates[i];
      const MeshCorner& corner = mesh.corners[candidate.corner];
      if (!is_taut(corner, corner.x - here.x, corner.z - here.z)) continue;
      const float distance = distance_to(corner, here);
      turns.push_back({candidate.corner, distance, distance + distance_to(corner, there),
                       candidate.from_all != 0});
    }
  };
  const auto see = [&](const Stop& end, Turn& turn) {
    turn.is_seen = turn.is_seen || sees_corner(mesh, end, turn.corner);
    return turn.is_seen;
  };
  gather(from, start, goal, start_);
  gather(to, goal, start, goal_);
  const auto keep = [&](const Stop& end, std::vector<Turn>& turns) {
    std::erase_if(
        turns, [&](Turn& turn) { return turn.bound > known + kBoundTolerance || !see(end, turn); });
  };
  keep(from, start_);
  keep(to, goal_);
  return join(mesh, labels, best);
}

// The shortest path over the gathered corners; false if there is none.
bool LabelSearch::join(const PathMesh& mesh, const HubLabels& labels, Best& best) {
  if (reached_hubs_.size() != mesh.corner_count()) reached_hubs_.assign(mesh.corner_count(), {});
  if (++search_ == 0) {
    reached_hubs_.assign(mesh.corner_count(), {});
    search_ = 1;
  }
  for (const Turn& s : start_) {
    for (const HubLabels::Label& label : labels.of(s.corner)) {
      ReachedHub& reached = reached_hubs_[label.hub];
      const float here = s.distance + label.length;
      if (reached.search != search_ || here < reached.length) reached = {search_, s.corner, here};
    }
  }
  best.length = kUnreached;
  for (const Turn& s : goal_) {
    for (const HubLabels::Label& label : labels.of(s.corner)) {
      const ReachedHub& reached = reached_hubs_[label.hub];
      const float here = reached.length + label.length + s.distance;
      if (reached.search != search_ || here >= best.length) continue;
      best = {here, label.hub, reached.corner, s.corner};
    }
  }
  return best.length < kUnreached;
}

namespace {

world::GroundPoint middle_of(const PathMesh& mesh, uint32_t rect, uint32_t block) {
  return throng::path::middle_of(mesh.block(rect, block - mesh.rects[rect].first_block));
}

// A block whose middle is seen from an end, and how far that is.
struct SeenMiddle {
  uint32_t block = 0;
  Stop middle;
  double distance = 0;  // [cells]
};

// Behind an end, as seen from its path's first waypoint: a path from there passes the end or nearly
// so, and the rest of it is shorter by the distance to the end. Else `own`.
SeenMiddle middle_behind(const PathMesh& mesh, const Stop& end, CellPoint turn, SeenMiddle own) {
  const CellPoint at = in_cells(end.at);
  const double length = distance(at, turn);
  if (!(length > 0)) return own;
  // The farther, the less it matters that a middle is not straight behind.
  for (const double offset : {128.0, 48.0, 24.0, 12.0}) {  // cells
    const auto behind = [&](double from, double to) {
      return std::llround((from + (from - to) * (offset / length)) * world::kUnitsPerCell);
    };
    const world::GroundPoint there{behind(at.x, turn.x), behind(at.z, turn.z)};
    const uint32_t rect = mesh_ray(mesh, end.rect, end.at, there);
    if (rect == kNoRect) continue;
    const uint32_t block = mesh.block_at(rect, there.cell_x(), there.cell_z());
    const world::GroundPoint middle = middle_of(mesh, rect, block);
    if (mesh_ray(mesh, end.rect, end.at, middle) != rect) continue;
    return {block, {middle, rect}, distance(at, in_cells(middle))};
  }
  return own;
}

}  // namespace

// The path over the middles of the ends' blocks, pulled taut. It is as short as the shortest except
// where that passes something on another side. False if there is none, or if it cannot be proved to
// be no longer than `kMaxLonger` times the shortest; `length` is then still that of a path.
bool LabelSearch::by_middles(const PathMesh& mesh, const HubLabels& labels, const Stop& from,
                             const Stop& to, std::vector<uint32_t>& corners, double& length) {
  const MiddleLabels& middles = labels.by_middle;
  const CellPoint start = in_cells(from.at), goal = in_cells(to.at);
  const uint32_t a = block_of(mesh, from), b = block_of(mesh, to);
  const Meeting best = meet(middles.of(a), middles.of(b));
  if (!(best.length < kUnreached)) return false;
  const Waypoint from_middle{in_cells(middle_of(mesh, from.rect, a)), from.rect};
  const Waypoint to_middle{in_cells(middle_of(mesh, to.rect, b)), to.rect};
  labels.walk(middles.tree_place[middles.first[a] + best.first],
              middles.tree_place[middles.first[b] + best.last], corners);
  path_.assign({{start, from.rect}, from_middle});
  for (const uint32_t c : corners) path_.push_back(waypoint(mesh, c));
  path_.insert(path_.end(), {to_middle, {goal, to.rect}});
  if (!pull_.pull(mesh, path_, corners, length)) return false;
  // No path is shorter than that between two middles less the ends' distances from them. Labels
  // hold paths over corners only: where the middles see each other, the shortest is the straight
  // line.
  const double straight = distance(start, goal);
  const auto is_proved = [&](const SeenMiddle& p, const SeenMiddle& q, double between) {
    const auto is_short = [&](double least) { return length <= kMaxLonger * least; };
    if (is_short(straight)) return true;
    const double off = p.distance + q.distance + kBoundTolerance;
    if (!is_short(between - off)) return false;
    const double apart = distance(in_cells(p.middle.at), in_cells(q.middle.at));
    return is_short(apart - off) ||
           mesh_ray(mesh, p.middle.rect, p.middle.at, q.middle.at) != q.middle.rect;
  };
  const SeenMiddle own_a{
      a, {middle_of(mesh, from.rect, a), from.rect}, distance(start, from_middle.at)};
  const SeenMiddle own_b{b, {middle_of(mesh, to.rect, b), to.rect}, distance(goal, to_middle.at)};
  if (is_proved(own_a, own_b, best.length)) return true;
  const auto at = [&](uint32_t corner) { return waypoint(mesh, corner).at; };
  const SeenMiddle behind_a =
      middle_behind(mesh, from, corners.empty() ? goal : at(corners.front()), own_a);
  const SeenMiddle behind_b =
      middle_behind(mesh, to, corners.empty() ? start : at(corners.back()), own_b);
  const Meeting longer = meet(middles.of(behind_a.block), middles.of(behind_b.block));
  return longer.length < kUnreached && is_proved(behind_a, behind_b, longer.length);
}

// The corners from each end to the hub.
void LabelSearch::trace(const HubLabels& labels, const Best& best,
                        std::vector<uint32_t>& corners) const {
  labels.walk(labels.place_of(best.first, best.hub), labels.place_of(best.last, best.hub), corners);
}

namespace {

void distances(const PathMesh& mesh, const HubLabels& labels, const Stop& end,
               std::vector<float>& out) {
  const CellPoint from = in_cells(end.at);
  out.clear();
  const uint32_t block = block_of(mesh, end), last = labels.first_candidate[block + 1];
  for (uint32_t i = labels.first_candidate[block]; i < last; ++i) {
    const MeshCorner& corner = mesh.corners[labels.candidates[i].corner];
    out.push_back(distance_to(corner, from));
  }
}

// The shortest of the entries of a block's hub, by the distances of an end.
struct HubDistance {
  float length = kUnreached;
  uint32_t candidate = 0;

  HubDistance(const BlockLabels& labels, uint32_t hub, const std::vector<float>& to) {
    for (uint32_t at = labels.entries[hub]; at < labels.entries[hub + 1]; ++at) {
      const float here = to[labels.candidate[at]] + labels.length[at];
      if (here >= length) continue;
      length = here;
      candidate = labels.candidate[at];
    }
  }
};

}  // namespace

// Joins the lists of the ends' blocks. Where a ray does not reach the best path's first or last
// corner, the best without it.
bool LabelSearch::merge(const PathMesh& mesh, const HubLabels& labels, const Stop& from,
                        const Stop& to, Best& best) {
  const BlockLabels& by_block = labels.by_block;
  const uint32_t from_block = block_of(mesh, from), to_block = block_of(mesh, to);
  distances(mesh, labels, from, from_);
  distances(mesh, labels, to, to_);
  const auto is_seen = [&](const Stop& end, uint32_t candidate, float& length) {
    const HubLabels::Candidate& c =
        labels.candidates[labels.first_candidate[block_of(mesh, end)] + candidate];
    if (c.from_all != 0 || sees_corner(mesh, end, c.corner)) return true;
    length = kUnreached;
    return false;
  };
  for (;;) {
    best.length = kUnreached;
    uint32_t first = 0, last = 0;  // candidates
    uint32_t i = by_block.first[from_block], j = by_block.first[to_block];
    const uint32_t i_end = by_block.first[from_block + 1], j_end = by_block.first[to_block + 1];
    while (i < i_end && j < j_end) {
      const uint32_t hub = by_block.hub[i], other = by_block.hub[j];
      if (hub < other) {
        ++i;
      } else if (other < hub) {
        ++j;
      } else {
        const HubDistance a(by_block, i++, from_), b(by_block, j++, to_);
        if (a.length + b.length >= best.length) continue;
        best.length = a.length + b.length;
        best.hub = hub;
        first = a.candidate;
        last = b.candidate;
      }
    }
    if (!(best.length < kUnreached)) return false;
    const bool seen = is_seen(from, first, from_[first]);
    const bool both = is_seen(to, last, to_[last]) && seen;
    if (!both) continue;
    best.first = labels.candidates[labels.first_candidate[from_block] + first].corner;
    best.last = labels.candidates[labels.first_candidate[to_block] + last].corner;
    return true;
  }
}

bool LabelSearch::find(const PathMesh& mesh, const HubLabels& labels, const Stop& from,
                       const Stop& to, std::vector<uint32_t>& corners, double& length) {
  corners.clear();
  const CellPoint start = in_cells(from.at), goal = in_cells(to.at);
  length = distance(start, goal);
  if (mesh_ray(mesh, from.rect, from.at, to.at) == to.rect) return true;
  double known = kUnreached;
  if (!labels.by_middle.first.empty()) {
    if (by_middles(mesh, labels, from, to, corners, known)) {
      length = known;
      return true;
    }
    corners.clear();
  }
  Best best;
  const bool merged = labels.by_block.first.empty()
                          ? narrow(mesh, labels, from, to, static_cast<float>(known), best)
                          : merge(mesh, labels, from, to, best);
  if (!merged) {
    // Rays to points beside corners may graze what a line to the corner itself passes by: cast rays
    // from both ends.
    const auto take_seen = [&](std::vector<Turn>& turns) {
      turns.clear();
      for (const SeenCorner& s : sight_.corners())
        turns.push_back({s.corner, static_cast<float>(s.distance), 0, true});
    };
    sight_.cast(mesh, from.rect, start, to.rect, goal);
    if (sight_.sees_goal()) return true;
    take_seen(start_);
    sight_.cast(mesh, to.rect, goal, kNoRect, {});
    take_seen(goal_);
    if (!join(mesh, labels, best)) return false;
  }
  trace(labels, best, corners);
  length = 0;
  CellPoint at = start;
  for (const uint32_t c : corners) {
    const CellPoint next{double(mesh.corners[c].x), double(mesh.corners[c].z)};
    length += distance(at, next);
    at = next;
  }
  length += distance(at, goal);
  return true;
}

}  // namespace throng::path
