// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <bit>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "throng/context.h"
#include "throng/result.h"
#include "world/air_data.h"
#include "world/air_rows.h"
#include "world/zone_data.h"

/// Where one class may fly, as boxes: what flight search runs on.
namespace throng {

inline constexpr uint32_t kNoBox = UINT32_MAX;

/// A point of the air, or the way between two. [air cells from the world's origin and layer 0]
struct AirPoint {
  double x = 0, y = 0, z = 0;
  friend AirPoint operator+(AirPoint a, AirPoint b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
  friend AirPoint operator-(AirPoint a, AirPoint b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
  friend AirPoint operator*(double s, AirPoint a) { return {s * a.x, s * a.y, s * a.z}; }
};
double air_distance(AirPoint a, AirPoint b);
inline double& axis_of(AirPoint& p, int axis) { return axis == 0 ? p.x : axis == 1 ? p.y : p.z; }
inline double axis_of(const AirPoint& p, int axis) {
  return axis == 0 ? p.x : axis == 1 ? p.y : p.z;
}

/// Points keep that far off the faces of boxes, so that a line between two never runs along one.
/// [air cells]
inline constexpr double kAirSkin = 1.0 / 1024;
/// The nearest such coordinates in the same cell.
double off_faces(double v);
AirPoint off_faces(AirPoint p);

struct FlightSpace {
  AirShape shape;
  int32_t width = 0, depth = 0;  // [air cells]
  int32_t zone_side = 0, zones_x = 0, zones_z = 0;
  /// A zone's tree: the number of a free cube is its box, of a leaf its index in the arrays below.
  std::vector<AirTreeData> zones;
  struct Leaf {
    uint64_t starts = 0;     // lowest cell of each box
    uint32_t first_box = 0;  // boxes follow in the order of these
  };
  std::vector<std::vector<Leaf>> leaves;  // per zone
  std::vector<AirCube> boxes;             // zone by zone
  std::vector<uint32_t> first_box;        // by zone, and the end
  std::vector<uint32_t> component;  // per box: the first box of all that hold together with it

  /// The box that a cell belongs to, or none if the body may not be there.
  [[nodiscard]] uint32_t box_at(int32_t x, int32_t y, int32_t z) const;
  [[nodiscard]] uint32_t box_at(AirPoint p) const;
  /// Is there any way from one to the other?
  [[nodiscard]] bool hold_together(AirPoint a, AirPoint b) const {
    const uint32_t from = box_at(a), to = box_at(b);
    return from != kNoBox && to != kNoBox && component[from] == component[to];
  }
  /// Is the straight line legal all the way? Points lie within boxes, a skin off their faces.
  [[nodiscard]] bool sees(AirPoint from, AirPoint to) const;
  /// Calls visit(box) for each box of at least `least` cells a side (1 or 4) that shares a part of
  /// a face with this one.
  template <class Visit>
  void for_neighbours(const AirCube& box, Visit&& visit, int32_t least = 1) const;
  /// The point nearest to a goal in boxes of some components, rising, a skin off their faces; of
  /// boxes as near as each other in the first. Zones are looked at in the order of how near they
  /// may come, in `order`, whose memory stays. There must be such a box.
  using ZoneOrder = std::vector<std::pair<double, uint32_t>>;
  [[nodiscard]] AirPoint nearest_in(std::span<const uint32_t> components, AirPoint goal,
                                    ZoneOrder& order) const;
  [[nodiscard]] uint64_t bytes() const;

 private:
  /// Of a cell of a zone, and of the node of the zone's tree that holds it.
  [[nodiscard]] uint32_t box_in(size_t zone, const AirTree& tree, const AirTree::Place& place,
                                int32_t x, int32_t y, int32_t z) const;
  template <class Visit>
  void visit_face(int32_t axis, int32_t plane, int32_t u, int32_t v, int32_t side, int32_t least,
                  Visit& visit) const;
};

/// The cells where the body may be, from what is free around. Boxes have at most `largest` cells a
/// side. Fails with kBadFile (a zone cannot be used) or kCancelled. The same for any number of
/// workers.
Result<FlightSpace> build_flight_space(const AirData& air, const AirBody& body, int32_t largest,
                                       int32_t workers, Context& context);

/// Clears every cell of `free` around which the body is not free; layers over the rows count as
/// free, cells beside them do not. Word by word.
void erode_air(const AirBody& body, const AirRows& free, AirRows& legal);

namespace flight_detail {
/// Bits of the 2 x 2 x 2 octant that holds bit b of a leaf, and the lowest of them.
constexpr uint32_t octant_low(uint32_t b) { return b & 0b101010; }
constexpr uint64_t octant(uint32_t b) {
  return uint64_t{0b11 | 0b11 << 4 | 0b11 << 16 | 0b11 << 20} << octant_low(b);
}
}  // namespace flight_detail

inline uint32_t FlightSpace::box_in(size_t zone, const AirTree& tree, const AirTree::Place& place,
                                    int32_t x, int32_t y, int32_t z) const {
  if (air_kind(place.word) == AirKind::kFree) return air_number(place.word);
  if (air_kind(place.word) != AirKind::kLeaf) return kNoBox;
  const uint32_t index = air_number(place.word), bit = air_bit(x, y - tree.base, z);
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
  const AirTree tree = zones[zone].view();
  x -= zx * zone_side;
  z -= zz * zone_side;
  return box_in(zone, tree, tree.find(x, y, z), x, y, z);
}

template <class Visit>
void FlightSpace::visit_face(int32_t axis, int32_t plane, int32_t u, int32_t v, int32_t side,
                             int32_t least, Visit& visit) const {
  const int32_t x = axis == 0 ? plane : u;
  const int32_t y = axis == 1 ? plane : axis == 0 ? u : v;
  const int32_t z = axis == 2 ? plane : v;
  if (x < 0 || z < 0 || x >= width || z >= depth) return;
  const int32_t zx = x / zone_side, zz = z / zone_side;
  const auto zone = static_cast<size_t>(zz * zones_x + zx);
  const AirTree tree = zones[zone].view();
  const int32_t own_x = x - zx * zone_side, own_z = z - zz * zone_side;
  const auto place = tree.find(own_x, y, own_z);
  const AirKind kind = air_kind(place.word);
  if (kind == AirKind::kFull && (place.cube.side == 0 || place.cube.side >= side)) return;
  if (kind == AirKind::kFree && place.cube.side >= side) {
    visit(air_number(place.word));
    return;
  }
  if (kind == AirKind::kLeaf && least > 2) return;  // boxes of leaves have 1 or 2 cells a side
  if (kind == AirKind::kLeaf && side <= 2) {
    const uint32_t box = box_in(zone, tree, place, own_x, y, own_z);
    if (side == 1 || (box != kNoBox && boxes[box].side == 2)) {
      if (box != kNoBox) visit(box);
      return;
    }
  }
  if (side <= least) return;
  const int32_t half = side / 2;
  visit_face(axis, plane, u, v, half, least, visit);
  visit_face(axis, plane, u + half, v, half, least, visit);
  visit_face(axis, plane, u, v + half, half, least, visit);
  visit_face(axis, plane, u + half, v + half, half, least, visit);
}

template <class Visit>
void FlightSpace::for_neighbours(const AirCube& box, Visit&& visit, int32_t least) const {
  visit_face(0, box.x + box.side, box.y, box.z, box.side, least, visit);
  visit_face(0, box.x - 1, box.y, box.z, box.side, least, visit);
  visit_face(1, box.y + box.side, box.x, box.z, box.side, least, visit);
  visit_face(1, box.y - 1, box.x, box.z, box.side, least, visit);
  visit_face(2, box.z + box.side, box.x, box.y, box.side, least, visit);
  visit_face(2, box.z - 1, box.x, box.y, box.side, least, visit);
}

}  // namespace throng
