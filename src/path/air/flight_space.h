// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "throng/base.h"
#include "world/air_data.h"
#include "world/take_off.h"
#include "world/zone_data.h"

/// Where one class may fly, as boxes: what flight search runs on.
namespace throng::path {

inline constexpr uint32_t kNoBox = UINT32_MAX;

/// A point of the air, or a vector between two. [voxels from the world's origin and layer 0]
struct AirPoint {
  double x = 0, y = 0, z = 0;
  friend AirPoint operator+(AirPoint a, AirPoint b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
  friend AirPoint operator-(AirPoint a, AirPoint b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
  friend AirPoint operator*(double s, AirPoint a) { return {s * a.x, s * a.y, s * a.z}; }
};
inline double air_distance(AirPoint a, AirPoint b) {
  const AirPoint d = a - b;
  return std::sqrt(d.x * d.x + d.y * d.y + d.z * d.z);
}
/// Of the straight segments between points. [voxels]
inline double length_of(const std::vector<AirPoint>& path) {
  double sum = 0;
  for (size_t i = 1; i < path.size(); ++i) sum += air_distance(path[i - 1], path[i]);
  return sum;
}
inline double& axis_of(AirPoint& p, int axis) { return axis == 0 ? p.x : axis == 1 ? p.y : p.z; }
inline double axis_of(const AirPoint& p, int axis) {
  return axis == 0 ? p.x : axis == 1 ? p.y : p.z;
}

/// Voxels, last included. None: a first above its last.
struct AirRange {
  int32_t first[3] = {0, 0, 0}, last[3] = {-1, -1, -1};  // x, y, z
};

using world::kAirSkin;
using world::off_faces;
AirPoint off_faces(AirPoint p);

struct FlightSpace {
  world::AirShape shape;
  int32_t width = 0, depth = 0;  // [voxels]
  int32_t zone_side = 0, zones_x = 0, zones_z = 0;
  /// A zone's tree: the number of a free cube is its box, of a leaf its index in the arrays below.
  std::vector<world::AirTreeData> zones;
  struct Leaf {
    uint64_t starts = 0;     // lowest voxel of each box
    uint32_t first_box = 0;  // boxes follow in the order of these
  };
  std::vector<std::vector<Leaf>> leaves;  // per zone
  std::vector<world::AirCube> boxes;      // zone by zone
  std::vector<uint32_t> first_box;        // by zone, and the end
  std::vector<uint32_t> component;        // per box: the first box of its connected component

  /// The box that a voxel belongs to, or none if the body may not be there.
  [[nodiscard]] uint32_t box_at(int32_t x, int32_t y, int32_t z) const;
  [[nodiscard]] uint32_t box_at(AirPoint p) const;
  /// Is the straight line legal over its whole length? Points lie within boxes, a skin off their
  /// faces.
  [[nodiscard]] bool sees(AirPoint from, AirPoint to) const;
  [[nodiscard]] const world::AirCube& cube(uint32_t box) const { return boxes[box]; }
  /// The boxes with voxels in a range, rising zone by zone.
  void boxes_in(const AirRange& range, std::vector<uint32_t>& found) const;
  /// Calls visit(box) for each box of at least `min_side` voxels a side (1 or 4) that shares a part
  /// of a face with this one.
  template <class Visit>
  void for_neighbours(const world::AirCube& box, Visit&& visit, int32_t min_side = 1) const;
  /// The same for a square of voxels of a plane: at `plane` along the axis, from u and v on along
  /// the other two, the one of y first, else that of x.
  template <class Visit>
  void visit_face(int32_t axis, int32_t plane, int32_t u, int32_t v, int32_t side, int32_t min_side,
                  Visit& visit) const;
  [[nodiscard]] uint64_t bytes() const;

 private:
  /// Of a voxel of a zone, and of the node of the zone's tree that holds it.
  [[nodiscard]] uint32_t box_in(size_t zone, const world::AirTree& tree,
                                const world::AirTree::Place& place, int32_t x, int32_t y,
                                int32_t z) const;
};

/// The voxels where the body may be, given the free ones. Boxes have at most `largest` voxels a
/// side. Fails with kBadFile (a zone cannot be used) or kCancelled. The same for any number of
/// workers.
Result<FlightSpace> build_flight_space(const world::AirData& air, const world::AirBody& body,
                                       int32_t largest, int32_t workers, Context& context);

namespace flight_detail {
/// Bits of the 2 x 2 x 2 octant that holds bit b of a leaf, and the lowest of them.
constexpr uint32_t octant_low(uint32_t b) { return b & 0b101010; }
constexpr uint64_t octant(uint32_t b) {
  return uint64_t{0b11 | 0b11 << 4 | 0b11 << 16 | 0b11 << 20} << octant_low(b);
}
}  // namespace flight_detail

inline uint32_t FlightSpace::box_in(size_t zone, const world::AirTree& tree,
                                    const world::AirTree::Place& place, int32_t x, int32_t y,
                                    int32_t z) const {
  if (world::air_kind(place.word) == world::AirKind::kFree) return world::air_number(place.word);
  if (world::air_kind(place.word) != world::AirKind::kLeaf) return kNoBox;
  const uint32_t index = world::air_number(place.word), bit = world::air_bit(x, y - tree.base, z);
  const uint64_t cells = tree.leaves[index];
  if ((cells >> bit & 1) == 0) return kNoBox;
  const uint64_t all = flight_detail::octant(bit);
  const uint32_t low = (cells & all) == all ? flight_detail::octant_low(bit) : bit;
  const Leaf& leaf = leaves[zone][index];
  return leaf.first_box +
         static_cast<uint32_t>(std::popcount(leaf.starts & ((uint64_t{1} << low) - 1)));
}

inline uint32_t FlightSpace::box_at(int32_t x, int32_t y, int32_t z) const {
  if (x < 0 || z < 0 || x >= width || z >= depth) return kNoBox;
  const int32_t zx = x / zone_side, zz = z / zone_side;
  const auto zone = static_cast<size_t>(zz * zones_x + zx);
  const world::AirTree tree = zones[zone].view();
  x -= zx * zone_side;
  z -= zz * zone_side;
  return box_in(zone, tree, tree.find(x, y, z), x, y, z);
}

template <class Visit>
void FlightSpace::visit_face(int32_t axis, int32_t plane, int32_t u, int32_t v, int32_t side,
                             int32_t min_side, Visit& visit) const {
  const int32_t x = axis == 0 ? plane : u;
  const int32_t y = axis == 1 ? plane : axis == 0 ? u : v;
  const int32_t z = axis == 2 ? plane : v;
  if (x < 0 || z < 0 || x >= width || z >= depth) return;
  const int32_t zx = x / zone_side, zz = z / zone_side;
  const auto zone = static_cast<size_t>(zz * zones_x + zx);
  const world::AirTree tree = zones[zone].view();
  const int32_t own_x = x - zx * zone_side, own_z = z - zz * zone_side;
  const auto place = tree.find(own_x, y, own_z);
  const world::AirKind kind = world::air_kind(place.word);
  if (kind == world::AirKind::kFull && (place.cube.side == 0 || place.cube.side >= side)) return;
  if (kind == world::AirKind::kFree && place.cube.side >= side) {
    visit(world::air_number(place.word));
    return;
  }
  if (kind == world::AirKind::kLeaf && min_side > 2)
    return;  // boxes of leaves have 1 or 2 cells a side
  if (kind == world::AirKind::kLeaf && side <= 2) {
    const uint32_t box = box_in(zone, tree, place, own_x, y, own_z);
    if (side == 1 || (box != kNoBox && boxes[box].side == 2)) {
      if (box != kNoBox) visit(box);
      return;
    }
  }
  if (side <= min_side) return;
  const int32_t half = side / 2;
  visit_face(axis, plane, u, v, half, min_side, visit);
  visit_face(axis, plane, u + half, v, half, min_side, visit);
  visit_face(axis, plane, u, v + half, half, min_side, visit);
  visit_face(axis, plane, u + half, v + half, half, min_side, visit);
}

template <class Visit>
void FlightSpace::for_neighbours(const world::AirCube& box, Visit&& visit, int32_t min_side) const {
  visit_face(0, box.x + box.side, box.y, box.z, box.side, min_side, visit);
  visit_face(0, box.x - 1, box.y, box.z, box.side, min_side, visit);
  visit_face(1, box.y + box.side, box.x, box.z, box.side, min_side, visit);
  visit_face(1, box.y - 1, box.x, box.z, box.side, min_side, visit);
  visit_face(2, box.z + box.side, box.x, box.y, box.side, min_side, visit);
  visit_face(2, box.z - 1, box.x, box.y, box.side, min_side, visit);
}

// FlightSpace::sees over any air that has box_at(x, y, z) and cube(box). From box to box: the line
// leaves one by the face that it meets first. At an edge or a corner it passes one face after the
// other, and what lies between must be free.
template <class Air>
bool air_sees(const Air& air, AirPoint from, AirPoint to) {
  const double begin[3] = {from.x, from.y, from.z};
  const double delta[3] = {to.x - from.x, to.y - from.y, to.z - from.z};
  int32_t cell[3], last[3];
  const double end[3] = {to.x, to.y, to.z};
  for (int a = 0; a < 3; ++a) {
    cell[a] = static_cast<int32_t>(std::floor(begin[a]));
    last[a] = static_cast<int32_t>(std::floor(end[a]));
  }
  for (;;) {
    const uint32_t index = air.box_at(cell[0], cell[1], cell[2]);
    if (index == kNoBox) return false;
    const world::AirCube& box = air.cube(index);
    const int32_t low[3] = {box.x, box.y, box.z};
    double leave = std::numeric_limits<double>::infinity();
    int axis = -1;
    for (int a = 0; a < 3; ++a) {
      if (last[a] >= low[a] && last[a] < low[a] + box.side)
        continue;  // it ends between these faces
      const double face = delta[a] > 0 ? low[a] + box.side : low[a];
      const double t = (face - begin[a]) / delta[a];
      if (t < leave) {
        leave = t;
        axis = a;
      }
    }
    if (axis < 0) return true;
    for (int a = 0; a < 3; ++a) {
      if (a == axis) {
        cell[a] = delta[a] > 0 ? low[a] + box.side : low[a] - 1;
      } else {
        const auto at = static_cast<int32_t>(std::floor(begin[a] + leave * delta[a]));
        cell[a] = std::clamp(at, low[a], low[a] + box.side - 1);
      }
    }
  }
}

}  // namespace throng::path
