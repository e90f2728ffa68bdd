// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "bake/surface/body_sweep.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "core/math/float_origin.h"
#include "core/parallel.h"

// Exact tests of one triangle against an upright cylinder, a prism or a cylinder that moves: the
// triangle is clipped to the heights, then its distance to the axis is compared. Also clusters of a
// scene's triangles by squares of the ground, to find those near a box.
namespace throng::bake {
namespace {

// A convex polygon with space for a triangle cut twice.
struct Clipped {
  std::array<Vec3d, 6> corners;
  size_t count = 0;

  void add(Vec3d p) { corners[count++] = p; }
};

// What is left on the side of the plane where sign * (y - height) >= 0; heights are in z here.
Clipped clip(const Clipped& in, double height, double sign) {
  Clipped out;
  for (size_t i = 0; i < in.count; ++i) {
    const Vec3d a = in.corners[i], b = in.corners[(i + 1) % in.count];
    const double da = sign * (a.z - height), db = sign * (b.z - height);
    if (da >= 0) out.add(a);
    if ((da > 0 && db < 0) || (da < 0 && db > 0)) out.add(a + (b - a) * (da / (da - db)));
  }
  return out;
}

double distance2_to_segment(Vec3d a, Vec3d b) {
  const double dx = b.x - a.x, dy = b.y - a.y;
  const double along = dx * dx + dy * dy;
  double t = along > 0 ? -(a.x * dx + a.y * dy) / along : 0;
  t = std::clamp(t, 0.0, 1.0);
  const double x = a.x + t * dx, y = a.y + t * dy;
  return x * x + y * y;
}

// Squared distance from the axis to a convex polygon seen along it.
double distance2(const Clipped& polygon) {
  bool left = false, right = false;
  double nearest = kNever;
  for (size_t i = 0; i < polygon.count; ++i) {
    const Vec3d a = polygon.corners[i], b = polygon.corners[(i + 1) % polygon.count];
    const double side = a.x * b.y - a.y * b.x;
    left |= side > 0;
    right |= side < 0;
    nearest = std::min(nearest, distance2_to_segment(a, b));
  }
  return left != right ? 0 : nearest;  // All edges turn one way around the axis.
}

// Squared distance between the segments from a to b and from the axis to p, seen along it.
double distance2_to_move(Vec3d a, Vec3d b, Vec3d p) {
  const auto side = [](Vec3d u, Vec3d v) { return u.x * v.y - u.y * v.x; };
  const Vec3d ab = b - a, ap = p - a, ao = a * -1;
  if (side(p, a) * side(p, b) < 0 && side(ab, ao) * side(ab, ap) < 0) return 0;
  return std::min({distance2_to_segment(a, b), distance2_to_segment(a - p, b - p),
                   distance2_to_segment(ao, ap), distance2_to_segment(b * -1, p - b)});
}

}  // namespace

BodyFrame BodyFrame::around(Vec3d centre, Vec3d up) {
  // Any direction across will do; the coordinate axis that lies flattest is farthest from parallel.
  const double x = std::fabs(up.x), y = std::fabs(up.y), z = std::fabs(up.z);
  const Vec3d flat = x <= y && x <= z ? Vec3d{1, 0, 0} : y <= z ? Vec3d{0, 1, 0} : Vec3d{0, 0, 1};
  Vec3d side = cross(flat, up);
  side = side * (1 / length(side));
  return {centre, side, cross(up, side), up};
}

double lowest_entry(const LocalTriangle& triangle, const BodySweep& sweep) {
  const auto& [a, b, c] = triangle;
  const double low = std::min({a.z, b.z, c.z}), high = std::max({a.z, b.z, c.z});
  if (low > sweep.high || high < sweep.low) return kNever;
  const double r = sweep.radius;
  if (std::min({a.x, b.x, c.x}) > r || std::max({a.x, b.x, c.x}) < -r ||
      std::min({a.y, b.y, c.y}) > r || std::max({a.y, b.y, c.y}) < -r) {
    return kNever;
  }
  Clipped polygon{{a, b, c}, 3};
  if (low < sweep.low) polygon = clip(polygon, sweep.low, 1);
  if (high > sweep.high) polygon = clip(polygon, sweep.high, -1);
  if (polygon.count == 0 || distance2(polygon) > r * r) return kNever;
  double lowest = kNever;
  for (size_t i = 0; i < polygon.count; ++i) lowest = std::min(lowest, polygon.corners[i].z);
  return lowest;
}

bool enters_on_move(const LocalTriangle& triangle, const BodySweep& sweep, Vec3d along) {
  const auto& [a, b, c] = triangle;
  const double low = std::min({a.z, b.z, c.z}), high = std::max({a.z, b.z, c.z});
  if (low > sweep.high || high < sweep.low) return false;
  const double r = sweep.radius;
  if (std::min({a.x, b.x, c.x}) > std::max(0.0, along.x) + r ||
      std::max({a.x, b.x, c.x}) < std::min(0.0, along.x) - r ||
      std::min({a.y, b.y, c.y}) > std::max(0.0, along.y) + r ||
      std::max({a.y, b.y, c.y}) < std::min(0.0, along.y) - r) {
    return false;
  }
  Clipped polygon{{a, b, c}, 3};
  if (low < sweep.low) polygon = clip(polygon, sweep.low, 1);
  if (high > sweep.high) polygon = clip(polygon, sweep.high, -1);
  if (polygon.count == 0) return false;
  if (distance2(polygon) == 0) return true;  // The move begins in it.
  for (size_t i = 0; i < polygon.count; ++i) {
    const Vec3d p = polygon.corners[i], q = polygon.corners[(i + 1) % polygon.count];
    if (distance2_to_move(p, q, along) <= r * r) return true;
  }
  return false;
}

Box3d sweep_box(const BodyFrame& frame, const BodySweep& sweep) {
  const Vec3d up = frame.up;
  const auto across = [&](double along) {
    return sweep.radius * std::sqrt(1 - std::min(1.0, along * along));
  };
  const Vec3d r{across(up.x), across(up.y), across(up.z)};
  const Vec3d a = frame.centre + up * sweep.low, b = frame.centre + up * sweep.high;
  const Vec3d low{std::min(a.x, b.x), std::min(a.y, b.y), std::min(a.z, b.z)};
  const Vec3d high{std::max(a.x, b.x), std::max(a.y, b.y), std::max(a.z, b.z)};
  return {low - r, high + r};
}

TriangleSquares::TriangleSquares(const Scene& scene, int32_t workers) : scene_(&scene) {
  if (!scene.triangles.empty()) base_ = float_origin(corners(0)[0]);
  const std::vector<Cluster> clusters = make_clusters(workers);
  Box3d bounds;  // Clusters know it sooner than all triangles.
  for (const Cluster& cluster : clusters) {
    const auto& b = cluster.box;
    bounds.add({b[0], b[1], b[2]});
    bounds.add({b[3], b[4], b[5]});
  }
  if (clusters.empty()) bounds.add({});
  origin_x_ = bounds.min.x;
  origin_z_ = bounds.min.z;
  const double width = bounds.max.x - bounds.min.x, depth = bounds.max.z - bounds.min.z;
  // Small against bodies and sub-patches, but not so many that the squares cost more than they
  // save.
  side_ = std::max(4.0, std::max(width, depth) / 4096);
  const auto squares = [&](double extent) { return static_cast<int32_t>(extent / side_) + 1; };
  const auto box = [&](size_t c) {
    const auto& b = clusters[c].box;
    const auto at = [&](double v, double origin) { return (v - origin) / side_; };
    return CellBox{at(b[0], origin_x_), at(b[3], origin_x_), at(b[2], origin_z_),
                   at(b[5], origin_z_)};
  };
  const TriangleBins bins =
      bin_boxes(clusters.size(), box, 0, 0, squares(width), squares(depth), 1, 0, workers);
  squares_x_ = bins.squares_x;
  squares_z_ = bins.squares_z;
  first_.assign(bins.first.begin(), bins.first.end());
  items_ = std::make_unique_for_overwrite<Item[]>(bins.items.size());
  // The first square of each: boxes that only touch a border do not show it.
  struct Place {
    int32_t x = -1, z = 0;
  };
  std::vector<Place> begin(clusters.size());
  const auto for_each_item = [&](int32_t z, auto visit) {
    for (int32_t x = 0; x < squares_x_; ++x) {
      const size_t s =
          static_cast<size_t>(z) * static_cast<size_t>(squares_x_) + static_cast<size_t>(x);
      for (uint32_t i = first_[s]; i < first_[s + 1]; ++i) visit(i, x);
    }
  };
  for (int32_t z = 0; z < squares_z_; ++z) {
    for_each_item(z, [&](uint32_t i, int32_t x) {
      Place& place = begin[bins.items[i]];
      if (place.x < 0) place = {x, z};
    });
  }
  parallel_for(static_cast<size_t>(squares_z_), workers, [&](size_t row) {
    const auto z = static_cast<int32_t>(row);
    for_each_item(z, [&](uint32_t i, int32_t x) {
      const uint32_t c = bins.items[i];
      items_[i] = {.box = clusters[c].box,
                   .first = clusters[c].first,
                   .count = static_cast<uint8_t>(clusters[c].last - clusters[c].first),
                   .begins_x = x == begin[c].x,
                   .begins_z = z == begin[c].z};
    });
  });
}

namespace {

constexpr size_t kRun = 2048;         // triangles that are sorted together
constexpr double kCube = 1.5;         // [m]
constexpr uint64_t kBuckets = 32768;  // at most, to be counted instead of compared

// Where a triangle of a run belongs: patch first, then cubes.
struct CubeKey {
  uint32_t patch = 0;
  std::array<int64_t, 3> cube{};

  friend bool operator==(const CubeKey&, const CubeKey&) = default;
  // Not <=>: an array has none in the standard library that the page is compiled with.
  friend bool operator<(const CubeKey& a, const CubeKey& b) {
    return a.patch != b.patch ? a.patch < b.patch : a.cube < b.cube;
  }
};

// std::floor() is a function call in code for the oldest machines.
int64_t floor_of(double v) {
  const auto whole = static_cast<int64_t>(v);
  return whole - (static_cast<double>(whole) > v ? 1 : 0);
}

// Numbers the keys of a run so that equal ones are beside each other. Mostly the run is small and
// of few patches, so that its cubes can be numbered row by row.
void sort_run(std::span<const CubeKey> keys, std::vector<uint32_t>& order) {
  order.resize(keys.size());
  CubeKey low = keys[0], high = keys[0];
  for (const CubeKey& key : keys) {
    low.patch = std::min(low.patch, key.patch);
    high.patch = std::max(high.patch, key.patch);
    for (size_t k = 0; k < 3; ++k) {
      low.cube[k] = std::min(low.cube[k], key.cube[k]);
      high.cube[k] = std::max(high.cube[k], key.cube[k]);
    }
  }
  double buckets = static_cast<double>(high.patch - low.patch) + 1;
  std::array<uint64_t, 3> side;
  for (size_t k = 0; k < 3; ++k) {
    side[k] = static_cast<uint64_t>(high.cube[k] - low.cube[k]) + 1;
    buckets *= static_cast<double>(side[k]);
  }
  if (buckets > kBuckets) {
    std::iota(order.begin(), order.end(), 0);
    std::stable_sort(order.begin(), order.end(),
                     [&](uint32_t a, uint32_t b) { return keys[a] < keys[b]; });
    return;
  }
  const auto bucket_of = [&](const CubeKey& key) {
    uint64_t bucket = key.patch - low.patch;
    for (size_t k = 0; k < 3; ++k) {
      bucket = bucket * side[k] + static_cast<uint64_t>(key.cube[k] - low.cube[k]);
    }
    return bucket;
  };
  std::vector<uint32_t> next(static_cast<size_t>(buckets) + 1, 0);
  for (const CubeKey& key : keys) ++next[bucket_of(key) + 1];
  std::partial_sum(next.begin(), next.end(), next.begin());
  for (uint32_t i = 0; i < keys.size(); ++i) order[next[bucket_of(keys[i])]++] = i;
}

}  // namespace

// Runs of triangles that follow each other are sorted by cubes of kCube metres, and what lies in
// one cube is a cluster. Whatever the order of a soup, clusters hold all its triangles.
std::vector<TriangleSquares::Cluster> TriangleSquares::make_clusters(int32_t workers) {
  constexpr uint32_t kMax = 24;  // An item counts them in a byte.
  const size_t count = scene_->triangles.size();
  order_ = std::make_unique_for_overwrite<uint32_t[]>(count);
  const auto patch_of = [&](size_t t) {
    return scene_->patch_of_triangle.empty() ? kNoPatch : scene_->patch_of_triangle[t];
  };
  std::vector<std::vector<Cluster>> lists((count + kRun - 1) / kRun);
  parallel_for(lists.size(), workers, [&](size_t run) {
    const size_t begin = run * kRun, end = std::min(count, begin + kRun);
    std::vector<CubeKey> keys;
    keys.reserve(end - begin);
    for (size_t t = begin; t < end; ++t) {
      const LocalTriangle c = corners(static_cast<uint32_t>(t));
      const Vec3d middle = (c[0] + c[1] + c[2]) * (1.0 / 3 / kCube);
      keys.push_back({patch_of(t), {floor_of(middle.x), floor_of(middle.z), floor_of(middle.y)}});
    }
    std::vector<uint32_t> order;
    sort_run(keys, order);
    for (size_t i = 0; i < keys.size(); ++i) {
      order_[begin + i] = static_cast<uint32_t>(begin) + order[i];
    }
    for (size_t i = 0; i < keys.size();) {
      size_t j = i + 1;
      while (j < keys.size() && j - i < kMax && keys[order[j]] == keys[order[i]]) ++j;
      lists[run].push_back(
          measure(static_cast<uint32_t>(begin + i), static_cast<uint32_t>(begin + j)));
      i = j;
    }
  });
  size_t total = 0;
  for (const auto& list : lists) total += list.size();
  std::vector<Cluster> clusters;
  clusters.reserve(total);
  for (const auto& list : lists) clusters.insert(clusters.end(), list.begin(), list.end());
  return clusters;
}

TriangleSquares::Cluster TriangleSquares::measure(uint32_t first, uint32_t last) const {
  Cluster cluster;
  cluster.first = first;
  cluster.last = last;
  Box3d box;
  for (uint32_t i = first; i < last; ++i) {
    for (const Vec3d& p : corners(order_[i])) box.add(p - base_);
  }
  const auto above = [](double v) { return std::nextafter(static_cast<float>(v), INFINITY); };
  const auto below = [](double v) { return std::nextafter(static_cast<float>(v), -INFINITY); };
  cluster.box = {below(box.min.x), below(box.min.y), below(box.min.z),
                 above(box.max.x), above(box.max.y), above(box.max.z)};
  return cluster;
}

int32_t TriangleSquares::square(double v, double origin, int32_t count) const {
  return static_cast<int32_t>(
      std::clamp((v - origin) / side_, 0.0, static_cast<double>(count - 1)));
}

// A cluster in several squares is found in the first one that the box has in common with it.
void TriangleSquares::find(const Box3d& wanted, std::vector<uint32_t>& out) const {
  const Box3d box{wanted.min - base_, wanted.max - base_};
  const int32_t x0 = square(box.min.x, origin_x_, squares_x_);
  const int32_t x1 = square(box.max.x, origin_x_, squares_x_);
  const int32_t z0 = square(box.min.z, origin_z_, squares_z_);
  const int32_t z1 = square(box.max.z, origin_z_, squares_z_);
  // Rounded outward, as the clusters' are.
  const auto above = [](double v) { return std::nextafter(static_cast<float>(v), INFINITY); };
  const auto below = [](double v) { return std::nextafter(static_cast<float>(v), -INFINITY); };
  const std::array<float, 6> b{below(box.min.x), below(box.min.y), below(box.min.z),
                               above(box.max.x), above(box.max.y), above(box.max.z)};
  for (int32_t z = z0; z <= z1; ++z) {
    for (int32_t x = x0; x <= x1; ++x) {
      const size_t s =
          static_cast<size_t>(z) * static_cast<size_t>(squares_x_) + static_cast<size_t>(x);
      for (uint32_t i = first_[s]; i < first_[s + 1]; ++i) {
        const Item& item = items_[i];
        if (!(item.box[0] <= b[3] && item.box[3] >= b[0] && item.box[1] <= b[4] &&
              item.box[4] >= b[1] && item.box[2] <= b[5] && item.box[5] >= b[2])) {
          continue;
        }
        if ((x == x0 || item.begins_x) && (z == z0 || item.begins_z)) {
          const uint32_t* begin = &order_[item.first];
          out.insert(out.end(), begin, begin + item.count);
        }
      }
    }
  }
}

LocalTriangle TriangleSquares::corners(uint32_t triangle) const {
  const auto& [a, b, c] = scene_->triangles[triangle];
  return {scene_->positions[a], scene_->positions[b], scene_->positions[c]};
}

}  // namespace throng::bake
