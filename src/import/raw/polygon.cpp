// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "import/raw/polygon.h"

#include <algorithm>
#include <cmath>
#include <utility>

// Ear clipping: a corner is cut off when nothing of the polygon lies in its triangle; a hole is
// first joined to the outer ring by a double edge. Signs are exact (orient.h), so rings that touch
// themselves or each other are distinguished from rings that cross. A grid of corners keeps the
// test for an ear local: 100 000 corners take about a second.
// Methods: Meisters. Polygons have ears. 1975. Held. FIST: fast industrial-strength triangulation.
// 2001 (the grid).
namespace throng::importer {
namespace {

constexpr uint32_t kNone = UINT32_MAX;
constexpr int kMaxForced = 8;  // After so many wrong cuts exactness is given up.
// Beyond it products of coordinates are meaningless as lengths.
constexpr double kMaxCoordinate = 1e15;

bool is_usable(Vec3d p) {
  return std::fabs(p.x) < kMaxCoordinate && std::fabs(p.y) < kMaxCoordinate &&
         std::fabs(p.z) < kMaxCoordinate;
}

double cross2(Vec2d a, Vec2d b, Vec2d c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

bool comes_before(Vec2d a, Vec2d b) { return a.x < b.x || (a.x == b.x && a.y < b.y); }

double distance2(Vec2d a, Vec2d b) { return (a.x - b.x) * (a.x - b.x) + (a.y - b.y) * (a.y - b.y); }

}  // namespace

// Drops the axis along which the outer ring's normal is longest: the kept coordinates stay as they
// are, so that nothing is rounded. False if the ring has almost no area.
bool PolygonCutter::project(std::span<const Vec3d> points, std::span<const uint32_t> ring_first) {
  for (const Vec3d& p : points) {
    if (!is_usable(p)) return false;  // Also false for NaN.
  }
  Vec3d normal;  // Newell's, taken from the first corner to keep digits.
  const Vec3d origin = points[ring_first[0]];
  for (uint32_t i = ring_first[0]; i < ring_first[1]; ++i) {
    const uint32_t j = i + 1 < ring_first[1] ? i + 1 : ring_first[0];
    normal = normal + cross(points[i] - origin, points[j] - origin);
  }
  const Vec3d size{std::fabs(normal.x), std::fabs(normal.y), std::fabs(normal.z)};
  if (!(size.x + size.y + size.z > 0)) return false;
  flat_.clear();
  double axis = 0;
  for (const Vec3d& p : points) {
    if (size.z >= size.x && size.z >= size.y) {
      flat_.push_back({p.x, p.y});
      axis = normal.z;
    } else if (size.y >= size.x) {
      flat_.push_back({p.z, p.x});
      axis = normal.y;
    } else {
      flat_.push_back({p.y, p.z});
      axis = normal.x;
    }
  }
  if (axis < 0) {  // Seen from behind: a mirror makes the outer ring counter-clockwise again.
    for (Vec2d& p : flat_) std::swap(p.x, p.y);
  }
  return true;
}

double PolygonCutter::ring_area(std::span<const uint32_t> ring_first, size_t ring) const {
  double area = 0;
  const Vec2d origin = flat_[ring_first[ring]];
  for (uint32_t i = ring_first[ring]; i < ring_first[ring + 1]; ++i) {
    const uint32_t j = i + 1 < ring_first[ring + 1] ? i + 1 : ring_first[ring];
    area += cross2(origin, flat_[i], flat_[j]);
  }
  return area / 2;
}

// Links the corners of a ring, counter-clockwise for sign > 0, without repeated neighbours.
uint32_t PolygonCutter::add_ring(std::span<const uint32_t> ring_first, size_t ring, double sign) {
  const uint32_t begin = ring_first[ring];
  const uint32_t count = ring_first[ring + 1] - begin;
  const bool backwards = ring_area(ring_first, ring) * sign < 0;
  const auto first = static_cast<uint32_t>(nodes_.size());
  for (uint32_t k = 0; k < count; ++k) {
    const uint32_t point = begin + (backwards ? count - 1 - k : k);
    if (nodes_.size() > first && nodes_.back().at == flat_[point]) continue;
    const auto index = static_cast<uint32_t>(nodes_.size());
    nodes_.push_back({flat_[point], point, index - 1, index + 1, true});
  }
  while (nodes_.size() > first + 1 && nodes_.back().at == nodes_[first].at) nodes_.pop_back();
  nodes_[first].prev = static_cast<uint32_t>(nodes_.size()) - 1;
  nodes_.back().next = first;
  return first;
}

// Does the interior at this corner open towards the target?
bool PolygonCutter::opens_towards(uint32_t node, Vec2d target) const {
  const Node& n = nodes_[node];
  const Vec2d prev = nodes_[n.prev].at;
  const Vec2d next = nodes_[n.next].at;
  const bool left_of_in = orient(prev, n.at, target) > 0;
  const bool left_of_out = orient(n.at, next, target) > 0;
  return orient(prev, n.at, next) > 0 ? left_of_in && left_of_out : left_of_in || left_of_out;
}

// Is the straight line between two corners free of the ring that `start` belongs to?
bool PolygonCutter::sees(uint32_t start, uint32_t from, uint32_t to) const {
  const Vec2d m = nodes_[from].at;
  const Vec2d v = nodes_[to].at;
  const Vec2d low{std::min(m.x, v.x), std::min(m.y, v.y)};
  const Vec2d high{std::max(m.x, v.x), std::max(m.y, v.y)};
  uint32_t i = start;
  do {
    const Vec2d a = nodes_[i].at;
    i = nodes_[i].next;
    const Vec2d b = nodes_[i].at;
    if (std::max(a.x, b.x) < low.x || std::min(a.x, b.x) > high.x) continue;
    if (std::max(a.y, b.y) < low.y || std::min(a.y, b.y) > high.y) continue;
    const int side_a = orient(m, v, a);
    const int side_b = orient(m, v, b);
    if (side_a * side_b > 0) continue;
    const int side_m = orient(a, b, m);
    const int side_v = orient(a, b, v);
    if (side_m * side_v > 0) continue;
    if (side_a == 0 && side_b == 0) {  // On one line: free if they meet in v alone.
      const bool beyond_a = a == v || distance2(a, m) > distance2(v, m);
      const bool beyond_b = b == v || distance2(b, m) > distance2(v, m);
      const bool same_side = (a.x - v.x) * (m.x - v.x) + (a.y - v.y) * (m.y - v.y) <= 0 &&
                             (b.x - v.x) * (m.x - v.x) + (b.y - v.y) * (m.y - v.y) <= 0;
      if (beyond_a && beyond_b && same_side) continue;
      return false;
    }
    if (a == v || b == v) continue;           // They meet in the corner itself.
    if (side_m == 0 && side_v > 0) continue;  // The hole touches this edge from inside.
    return false;
  } while (i != start);
  return true;
}

// Where the hole's first corner lies on an edge of the ring, the ring gets a corner there.
void PolygonCutter::split_edges_at(uint32_t start, uint32_t hole) {
  const Vec2d m = nodes_[hole].at;
  uint32_t i = start;
  do {
    const uint32_t next = nodes_[i].next;
    const Vec2d a = nodes_[i].at;
    const Vec2d b = nodes_[next].at;
    const bool in_box = std::min(a.x, b.x) <= m.x && m.x <= std::max(a.x, b.x) &&
                        std::min(a.y, b.y) <= m.y && m.y <= std::max(a.y, b.y);
    if (in_box && a != m && b != m && orient(a, b, m) == 0) {
      const auto added = static_cast<uint32_t>(nodes_.size());
      nodes_.push_back({m, nodes_[hole].point, i, next, true});
      nodes_[i].next = added;
      nodes_[next].prev = added;
    }
    i = next;
  } while (i != start);
}

// Joins a hole to the ring at its first corner in (x, y) order: all later holes lie behind
// it, so only the ring can block the line.
bool PolygonCutter::bridge(uint32_t start, uint32_t hole) {
  split_edges_at(start, hole);
  const Vec2d m = nodes_[hole].at;
  double tried_distance = -1;
  uint32_t tried = 0;
  uint64_t ring_size = 0;
  for (int attempt = 0;; ++attempt) {
    // The nearest corner not tried yet; near ones are nearly always visible.
    uint32_t best = kNone;
    double best_distance = 0;
    uint32_t i = start;
    ring_size = 0;
    do {
      ++ring_size;
      const Vec2d at = nodes_[i].at;
      if (at == m || comes_before(at, m)) {
        const double distance = distance2(at, m);
        const bool fresh = distance > tried_distance || (distance == tried_distance && i > tried);
        const bool nearer =
            best == kNone || distance < best_distance || (distance == best_distance && i < best);
        if (fresh && nearer) {
          best = i;
          best_distance = distance;
        }
      }
      i = nodes_[i].next;
    } while (i != start);
    if (best == kNone) return false;
    tried_distance = best_distance;
    tried = best;

    const Vec2d towards = best_distance > 0 ? m : nodes_[nodes_[hole].next].at;
    if (opens_towards(best, towards) && (best_distance == 0 || sees(start, hole, best))) {
      const auto hole_copy = static_cast<uint32_t>(nodes_.size());
      const uint32_t best_copy = hole_copy + 1;
      nodes_.push_back(nodes_[hole]);
      nodes_.push_back(nodes_[best]);
      nodes_[nodes_[hole].prev].next = hole_copy;
      nodes_[nodes_[best].next].prev = best_copy;
      nodes_[hole_copy].next = best_copy;
      nodes_[best_copy].prev = hole_copy;
      nodes_[best].next = hole;
      nodes_[hole].prev = best;
      return true;
    }
    if (attempt >= 32) {  // Only crossing rings come here often; this bounds the time.
      if (bridge_budget_ < ring_size) return false;
      bridge_budget_ -= ring_size;
    }
  }
}

bool PolygonCutter::blocks(uint32_t node, uint32_t ear) const {
  const Node& q = nodes_[node];
  const Node& c = nodes_[ear];
  if (!q.alive || node == ear || node == c.prev || node == c.next) return false;
  const Vec2d p = nodes_[c.prev].at;
  const Vec2d n = nodes_[c.next].at;
  const int first = orient(p, c.at, q.at);
  if (first < 0) return false;
  const int second = orient(c.at, n, q.at);
  if (second < 0) return false;
  const int third = orient(n, p, q.at);
  if (third < 0) return false;
  if (first > 0 && second > 0 && third > 0) return true;
  if (q.at == p || q.at == n) return false;
  // On the new edge itself: it would be cut off from its own triangles, see clip().
  if (third == 0 && !straighten_) return true;
  // It touches the triangle's rim. That is harmless unless an edge goes on into the triangle.
  const auto enters = [&](Vec2d t) {
    if (first == 0 && orient(p, c.at, t) <= 0) return false;
    if (second == 0 && orient(c.at, n, t) <= 0) return false;
    return third != 0 || orient(n, p, t) > 0;
  };
  return enters(nodes_[q.prev].at) || enters(nodes_[q.next].at);
}

bool PolygonCutter::is_ear(uint32_t node) {
  const Node& c = nodes_[node];
  const Vec2d p = nodes_[c.prev].at;
  const Vec2d n = nodes_[c.next].at;
  if (orient(p, c.at, n) <= 0) return false;
  const auto cell = [this](double value, double low, int32_t count) {
    return std::clamp(static_cast<int32_t>((value - low) / grid_step_), 0, count - 1);
  };
  const int32_t x0 = cell(std::min({p.x, c.at.x, n.x}), grid_low_.x, grid_width_);
  const int32_t x1 = cell(std::max({p.x, c.at.x, n.x}), grid_low_.x, grid_width_);
  const int32_t y0 = cell(std::min({p.y, c.at.y, n.y}), grid_low_.y, grid_depth_);
  const int32_t y1 = cell(std::max({p.y, c.at.y, n.y}), grid_low_.y, grid_depth_);
  for (int32_t y = y0; y <= y1; ++y) {
    const size_t row = static_cast<size_t>(y) * grid_width_;
    const uint32_t end = grid_first_[row + x1 + 1];
    const uint64_t steps = 1 + end - grid_first_[row + x0];
    ear_budget_ -= std::min(ear_budget_, steps);
    for (uint32_t i = grid_first_[row + x0]; i < end; ++i) {
      if (blocks(grid_nodes_[i], node)) return false;
    }
  }
  return true;
}

// About one node a cell.
void PolygonCutter::build_grid(uint32_t start) {
  Vec2d high = nodes_[start].at;
  grid_low_ = high;
  queue_.clear();
  uint32_t i = start;
  do {
    const Vec2d at = nodes_[i].at;
    grid_low_ = {std::min(grid_low_.x, at.x), std::min(grid_low_.y, at.y)};
    high = {std::max(high.x, at.x), std::max(high.y, at.y)};
    queue_.push_back(i);
    i = nodes_[i].next;
  } while (i != start);
  const double width = high.x - grid_low_.x;
  const double depth = high.y - grid_low_.y;
  const auto count = static_cast<double>(queue_.size());
  grid_step_ = std::max(std::sqrt(width * depth / count), std::max(width, depth) / count);
  if (queue_.size() < 16 || !(grid_step_ > 0)) grid_step_ = std::max({width, depth, 1e-300});
  grid_width_ = static_cast<int32_t>(width / grid_step_) + 1;
  grid_depth_ = static_cast<int32_t>(depth / grid_step_) + 1;
  const auto cell_of = [this](Vec2d at) {
    const auto x =
        std::min(static_cast<int32_t>((at.x - grid_low_.x) / grid_step_), grid_width_ - 1);
    const auto y =
        std::min(static_cast<int32_t>((at.y - grid_low_.y) / grid_step_), grid_depth_ - 1);
    return static_cast<size_t>(y) * grid_width_ + x;
  };
  grid_first_.assign(static_cast<size_t>(grid_width_) * grid_depth_ + 1, 0);
  for (const uint32_t node : queue_) ++grid_first_[cell_of(nodes_[node].at)];
  uint32_t sum = 0;
  for (uint32_t& first : grid_first_) {
    sum += first;
    first = sum;
  }
  grid_nodes_.resize(queue_.size());
  for (const uint32_t node : queue_) grid_nodes_[--grid_first_[cell_of(nodes_[node].at)]] = node;
}

uint32_t PolygonCutter::remove(uint32_t node) {
  Node& n = nodes_[node];
  n.alive = false;
  nodes_[n.prev].next = n.next;
  nodes_[n.next].prev = n.prev;
  return n.next;
}

bool PolygonCutter::clip(uint32_t start, std::vector<std::array<uint32_t, 3>>& out) {
  size_t left = 0;
  uint32_t at = start;
  do {
    ++left;
    at = nodes_[at].next;
  } while (at != start);

  bool exact = true;
  int forced = 0;
  const auto turn = [&](uint32_t node) {
    const Node& c = nodes_[node];
    return orient(nodes_[c.prev].at, c.at, nodes_[c.next].at);
  };
  const auto emit = [&](uint32_t node) {
    const Node& c = nodes_[node];
    cut_area_ += std::fabs(cross2(nodes_[c.prev].at, c.at, nodes_[c.next].at)) / 2;
    out.push_back({nodes_[c.prev].point, c.point, nodes_[c.next].point});
  };
  // Corners that are dropped at once: doubled ones, ends of spikes (two edges that lie on each
  // other look like the two sides of a corner), and those on an edge that is straight in space.
  // Where the edge is straight in the plane only, say a kerb seen from above, the corner carries a
  // height: it stays until only such corners are left.
  const auto is_idle = [&](uint32_t node) {
    if (turn(node) != 0) return false;
    return straighten_ || !bends_in_space(node);
  };
  const auto drop = [&](uint32_t node) {
    if (bends_in_space(node)) emit(node);  // An upright sliver, so that nothing solid is lost.
    return remove(node);
  };
  const auto take_out = [&](uint32_t node) {
    uint32_t prev = nodes_[node].prev;
    uint32_t next = remove(node);
    --left;
    while (left > 2) {
      if (is_idle(prev)) {
        const uint32_t dropped = prev;
        prev = nodes_[dropped].prev;
        drop(dropped);
      } else if (is_idle(next)) {
        next = drop(next);
      } else {
        break;
      }
      --left;
    }
    start = next;
    queue_.push_back(prev);
    queue_.push_back(next);
  };
  // Where rings cross, exactness is given up soon.
  const auto careful = [&] { return forced < kMaxForced && ear_budget_ > 0; };
  straighten_ = false;
  bool idle_ones = true;
  while (left > 2) {
    build_grid(start);  // Also lists all nodes in queue_.
    const size_t built = left;
    const size_t before = left;
    for (size_t k = 0; k < queue_.size() && left > 2; ++k) {
      const uint32_t node = queue_[k];
      if (!nodes_[node].alive) continue;
      if (idle_ones) {  // This pass takes no ears, so that later ones find no idle corner.
        if (!is_idle(node)) continue;
        if (bends_in_space(node)) emit(node);
        take_out(node);
        continue;
      }
      if (!(careful() ? is_ear(node) : turn(node) > 0)) continue;
      emit(node);
      take_out(node);
      if (left < built / 2 && left > 16)
        break;  // Few are left in many cells: build the grid again.
    }
    if (std::exchange(idle_ones, false) || left < before || left <= 2) continue;
    if (!std::exchange(straighten_, true)) {
      idle_ones = true;
      continue;
    }
    // Rings that cross: exactness is given up, so that the loop ends.
    exact = false;
    ++forced;
    uint32_t pick = start;
    for (uint32_t i = nodes_[start].next; i != start; i = nodes_[i].next) {
      if (turn(i) <= 0) continue;
      pick = i;
      break;
    }
    emit(pick);
    take_out(pick);
  }
  return exact;
}

// Is a corner that lies straight on an edge, seen in the plane, off that edge in space?
bool PolygonCutter::bends_in_space(uint32_t node) const {
  const Node& c = nodes_[node];
  const Vec2d p = nodes_[c.prev].at;
  const Vec2d n = nodes_[c.next].at;
  const bool between = (p.x - c.at.x) * (n.x - c.at.x) + (p.y - c.at.y) * (n.y - c.at.y) < 0;
  if (!between) return false;
  const Vec3d in = points_[c.point] - points_[nodes_[c.prev].point];
  const Vec3d out = points_[nodes_[c.next].point] - points_[c.point];
  constexpr double kStraight = 1e-7;  // [rad] A tenth of a millimetre in a kilometre.
  return length(cross(in, out)) > kStraight * length(in) * length(out);
}

void PolygonCutter::fan(std::span<const uint32_t> ring_first,
                        std::vector<std::array<uint32_t, 3>>& out) const {
  for (uint32_t i = ring_first[0] + 1; i + 1 < ring_first[1]; ++i) {
    out.push_back({ring_first[0], i, i + 1});
  }
}

bool PolygonCutter::cut(std::span<const Vec3d> points, std::span<const uint32_t> ring_first,
                        std::vector<std::array<uint32_t, 3>>& out) {
  const uint32_t outer = ring_first[1] - ring_first[0];
  if (outer < 3) return true;
  if (outer == 3 && ring_first.size() == 2) {
    fan(ring_first, out);
    return true;
  }
  if (!project(points, ring_first)) {
    fan(ring_first, out);
    return true;
  }
  points_ = points;
  nodes_.clear();
  holes_.clear();
  bridge_budget_ = 20'000'000;
  ear_budget_ = 300'000'000;
  cut_area_ = 0;
  const uint32_t start = add_ring(ring_first, 0, 1);
  double area = ring_area(ring_first, 0);
  const double whole = area;
  for (size_t ring = 1; ring + 1 < ring_first.size(); ++ring) {
    if (ring_first[ring + 1] - ring_first[ring] < 3) continue;
    const double hole_area = std::fabs(ring_area(ring_first, ring));
    if (!(hole_area > 0)) continue;  // A slit removes no area.
    area -= hole_area;
    uint32_t first = add_ring(ring_first, ring, -1);
    for (uint32_t i = nodes_[first].next, end = first; i != end; i = nodes_[i].next) {
      if (comes_before(nodes_[i].at, nodes_[first].at)) first = i;
    }
    holes_.push_back(first);
  }
  std::sort(holes_.begin(), holes_.end(), [this](uint32_t a, uint32_t b) {
    if (nodes_[a].at == nodes_[b].at) return a < b;
    return comes_before(nodes_[a].at, nodes_[b].at);
  });
  bool exact = true;
  for (const uint32_t hole : holes_) exact = bridge(start, hole) && exact;
  exact = clip(start, out) && exact;
  exact = exact && ear_budget_ > 0;
  return exact && std::fabs(cut_area_ - area) <= 1e-9 * std::fabs(whole);
}

}  // namespace throng::importer
