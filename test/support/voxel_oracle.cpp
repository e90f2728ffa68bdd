// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "voxel_oracle.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <queue>
#include <utility>

// A* over all convex corners of filled voxels; visibility face by face, in integers.
namespace throng::test {
namespace {

int64_t floor_div(int64_t a, int64_t b) {
  return a / b - (a % b != 0 && (a < 0) != (b < 0) ? 1 : 0);
}

double length(const HalfPoint3& a, const HalfPoint3& b) {
  double sum = 0;
  for (size_t i = 0; i < 3; ++i) {
    const auto d = static_cast<double>(a[i] - b[i]);
    sum += d * d;
  }
  return std::sqrt(sum) / 2;
}

}  // namespace

VoxelOracle::VoxelOracle(const VoxelCells& cells) : size_{cells.width, cells.height, cells.depth} {
  filled_.assign(static_cast<size_t>(size_[0] * size_[1] * size_[2] / 64 + 1), 0);
  for (const VoxelCells::Cube& c : cells.filled) {
    const auto i = static_cast<size_t>((c.z * size_[1] + c.y) * size_[0] + c.x);
    filled_[i / 64] |= uint64_t{1} << (i % 64);
  }
}

bool VoxelOracle::is_open(int64_t x, int64_t y, int64_t z) const {
  if (x < 0 || y < 0 || z < 0 || x >= size_[0] || y >= size_[1] || z >= size_[2]) return false;
  const auto i = static_cast<size_t>((z * size_[1] + y) * size_[0] + x);
  return (filled_[i / 64] >> (i % 64) & 1) == 0;
}

bool VoxelOracle::is_clear(const Vec3d& a, const Vec3d& b) const {
  constexpr double kTouch = 1e-9;
  const Vec3d ray = b - a;
  const double length = std::sqrt(ray.x * ray.x + ray.y * ray.y + ray.z * ray.z);
  const auto steps = static_cast<int64_t>(length * 100) + 1;
  for (int64_t s = 0; s <= steps; ++s) {
    const double t = static_cast<double>(s) / static_cast<double>(steps);
    bool open = false;
    for (int i = 0; i < 8 && !open; ++i) {
      const auto voxel = [&](double v, int bit) {
        return static_cast<int64_t>(std::floor(v + ((i & bit) != 0 ? kTouch : -kTouch)));
      };
      open =
          is_open(voxel(a.x + t * ray.x, 1), voxel(a.y + t * ray.y, 2), voxel(a.z + t * ray.z, 4));
    }
    if (!open) return false;
  }
  return true;
}

// The voxels of `to` that are connected to `from` by open voxels, face to face, within the box of
// both: these touch the point where two pieces of a segment meet.
std::vector<VoxelOracle::Voxel> VoxelOracle::reachable(const std::vector<Voxel>& from,
                                                       const std::vector<Voxel>& to) const {
  std::vector<Voxel> reached = from, found;
  Voxel low = from[0], high = from[0];
  for (const auto* side : {&from, &to}) {
    for (const Voxel& v : *side) {
      for (size_t i = 0; i < 3; ++i) {
        low[i] = std::min(low[i], v[i]);
        high[i] = std::max(high[i], v[i]);
      }
    }
  }
  for (size_t r = 0; r < reached.size(); ++r) {
    const Voxel at = reached[r];
    if (std::find(to.begin(), to.end(), at) != to.end()) found.push_back(at);
    for (size_t axis = 0; axis < 3; ++axis) {
      for (const int64_t step : {-1, 1}) {
        Voxel next = at;
        next[axis] += step;
        if (next[axis] < low[axis] || next[axis] > high[axis]) continue;
        if (!is_open(next[0], next[1], next[2])) continue;
        if (std::find(reached.begin(), reached.end(), next) == reached.end()) {
          reached.push_back(next);
        }
      }
    }
  }
  return found;
}

// Adds a corner once for each connected set of the open voxels around it.
void VoxelOracle::add_sides(int64_t x, int64_t y, int64_t z, std::vector<Node>& nodes) const {
  std::vector<Voxel> open;
  for (int i = 0; i < 8; ++i) {
    const Voxel v{x - (i & 1), y - (i >> 1 & 1), z - (i >> 2)};
    if (is_open(v[0], v[1], v[2])) open.push_back(v);
  }
  std::vector<Voxel> left = open;
  while (!left.empty()) {
    std::vector<Voxel> side{left[0]};
    for (size_t s = 0; s < side.size(); ++s) {
      for (const Voxel& v : left) {
        int64_t apart = 0;
        for (size_t i = 0; i < 3; ++i) apart += std::llabs(v[i] - side[s][i]);
        if (apart == 1 && std::find(side.begin(), side.end(), v) == side.end()) side.push_back(v);
      }
    }
    std::erase_if(
        left, [&](const Voxel& v) { return std::find(side.begin(), side.end(), v) != side.end(); });
    nodes.push_back({{2 * x, 2 * y, 2 * z}, std::move(side)});
  }
}

// Piece by piece between the planes of voxel faces. Each piece lies inside one voxel, on the face
// of two or along the edge of four: one of them must be open. Where two pieces meet, open voxels
// must connect those of the one with those of the other.
bool VoxelOracle::sees(const Node& from, const Node& to) const {
  const HalfPoint3 &a = from.at, &b = to.at;
  const auto is_of = [](const Node& node) {
    return [&node](const Voxel& v) {
      return std::find(node.side.begin(), node.side.end(), v) != node.side.end();
    };
  };
  const int64_t d[3] = {b[0] - a[0], b[1] - a[1], b[2] - a[2]};
  int64_t next[3];  // next plane on each axis, in half voxels
  for (size_t i = 0; i < 3; ++i) {
    next[i] = d[i] > 0 ? 2 * (floor_div(a[i], 2) + 1) : 2 * -(floor_div(-a[i], 2) + 1);
  }
  // The parameter of plane p on axis i is (p - a) / d: compared by products.
  const auto earlier = [&](size_t i, size_t j) {
    return std::llabs(next[i] - a[i]) * std::llabs(d[j]) <
           std::llabs(next[j] - a[j]) * std::llabs(d[i]);
  };
  std::vector<Voxel> before, now;
  for (;;) {
    now.clear();
    Voxel low, high;
    for (size_t i = 0; i < 3; ++i) {
      if (d[i] > 0) {
        low[i] = high[i] = next[i] / 2 - 1;
      } else if (d[i] < 0) {
        low[i] = high[i] = floor_div(next[i], 2);
      } else if (a[i] % 2 != 0) {
        low[i] = high[i] = floor_div(a[i], 2);
      } else {
        low[i] = a[i] / 2 - 1;
        high[i] = a[i] / 2;
      }
    }
    for (int64_t z = low[2]; z <= high[2]; ++z) {
      for (int64_t y = low[1]; y <= high[1]; ++y) {
        for (int64_t x = low[0]; x <= high[0]; ++x) {
          if (is_open(x, y, z)) now.push_back({x, y, z});
        }
      }
    }
    if (before.empty()) {
      std::erase_if(now, std::not_fn(is_of(from)));
    } else if (!now.empty()) {
      now = reachable(before, now);
    }
    if (now.empty()) return false;
    // To the next plane, or several at once.
    size_t first = 3;
    for (size_t i = 0; i < 3; ++i) {
      if (d[i] == 0) continue;
      const bool beyond = std::llabs(next[i] - a[i]) >= std::llabs(d[i]);
      if (!beyond && (first == 3 || earlier(i, first))) first = i;
    }
    if (first == 3) return std::any_of(now.begin(), now.end(), is_of(to));
    const size_t leader = first;
    bool crossed[3] = {false, false, false};
    for (size_t i = 0; i < 3; ++i) {
      crossed[i] = d[i] != 0 && !earlier(leader, i) && !earlier(i, leader);
    }
    for (size_t i = 0; i < 3; ++i) {
      if (crossed[i]) next[i] += d[i] > 0 ? 2 : -2;
    }
    before = now;
  }
}

// On a convex edge: of the four voxels around a unit edge that ends here, just one is filled.
bool VoxelOracle::is_corner(int64_t x, int64_t y, int64_t z) const {
  const Voxel at{x, y, z};
  for (size_t axis = 0; axis < 3; ++axis) {
    const size_t u = (axis + 1) % 3, v = (axis + 2) % 3;
    for (const int64_t along : {-1, 0}) {
      int filled = 0;
      for (int i = 0; i < 4; ++i) {
        Voxel cell = at;
        cell[axis] += along;
        cell[u] -= i & 1;
        cell[v] -= i >> 1;
        filled += is_open(cell[0], cell[1], cell[2]) ? 0 : 1;
      }
      if (filled == 1) return true;
    }
  }
  return false;
}

VoxelOracle::Answer VoxelOracle::shortest(const HalfPoint3& from, const HalfPoint3& to,
                                          double limit, size_t max_corners) const {
  const auto node_of = [](const HalfPoint3& p) {
    return Node{p, {{floor_div(p[0], 2), floor_div(p[1], 2), floor_div(p[2], 2)}}};
  };
  if (sees(node_of(from), node_of(to)))
    return {.budget_exhausted = false, .length = length(from, to)};
  std::vector<Node> points;
  // Half of the width of the ellipsoid of points on paths within the limit.
  const double straight = length(from, to);
  const double width = std::sqrt(std::max(0.0, limit * limit - straight * straight)) / 2;
  const auto spare = static_cast<int64_t>(width) + 2;
  int64_t low[3], high[3];
  for (size_t i = 0; i < 3; ++i) {
    low[i] = std::max<int64_t>(0, std::min(from[i], to[i]) / 2 - spare);
    high[i] = std::min<int64_t>(size_[i], std::max(from[i], to[i]) / 2 + spare);
  }
  for (int64_t z = low[2]; z <= high[2]; ++z) {
    for (int64_t y = low[1]; y <= high[1]; ++y) {
      for (int64_t x = low[0]; x <= high[0]; ++x) {
        const HalfPoint3 p{2 * x, 2 * y, 2 * z};
        if (length(from, p) + length(p, to) <= limit && is_corner(x, y, z))
          add_sides(x, y, z, points);
      }
    }
  }
  if (points.size() > max_corners) return {.budget_exhausted = true, .length = {}};
  points.push_back(node_of(to));
  const size_t goal = points.size() - 1;
  points.push_back(node_of(from));
  std::vector<double> best(points.size(), 1e300);
  std::vector<uint8_t> done(points.size(), 0);
  using Entry = std::pair<double, size_t>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
  best[goal + 1] = 0;
  open.push({length(from, to), goal + 1});
  while (!open.empty()) {
    const size_t at = open.top().second;
    open.pop();
    if (done[at] != 0) continue;
    if (at == goal) return {.budget_exhausted = false, .length = best[goal]};
    done[at] = 1;
    for (size_t p = 0; p <= goal; ++p) {
      if (done[p] != 0) continue;
      const double there = best[at] + length(points[at].at, points[p].at);
      const double whole = there + length(points[p].at, to);
      if (there >= best[p] || whole > limit || !sees(points[at], points[p])) continue;
      best[p] = there;
      open.push({whole, p});
    }
  }
  return {};
}

}  // namespace throng::test
