// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "path/ground/segments.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>

#include "path/ground/mesh_ray.h"

// Turns corners into stops that a body can walk between, each segment tested on the mesh or cell by
// cell. Time: linear in the rectangles that the path crosses; a segment that the mesh cannot decide
// is tested cell by cell, and in parts if it grazes corners.
namespace throng::path {
namespace {

constexpr int32_t kMaxGrazed = 64;       // corners past which one segment is led
constexpr double kGrazeDistance = 0.02;  // cells

bool is_same(world::GroundPoint a, world::GroundPoint b) { return a.x == b.x && a.z == b.z; }

// The point a unit beside a corner in one of the four cells around it, counted around.
world::GroundPoint quadrant(const CellCorner& corner, size_t i) {
  return {(int64_t{corner.x} << world::kUnitBits) + (i == 0 || i == 3 ? 1 : -1),
          (int64_t{corner.z} << world::kUnitBits) + (i < 2 ? 1 : -1)};
}

// From a corner to the line that a segment lies on. [cells]
double distance(const CellCorner& corner, world::GroundPoint from, world::GroundPoint to) {
  const CellPoint a = in_cells(from), b = in_cells(to);
  const double dx = b.x - a.x, dz = b.z - a.z;
  return std::fabs((corner.x - a.x) * dz - (corner.z - a.z) * dx) / std::hypot(dx, dz);
}

}  // namespace

bool SegmentWalker::walk(const Stop& from, const std::vector<uint32_t>& corners,
                         world::GroundPoint to, std::vector<Stop>& stops) {
  stops.clear();
  stops.push_back(from);
  for (const uint32_t c : corners) {
    if (!segment(beside(mesh_.corners[c]), kMaxGrazed, stops)) return false;
  }
  return segment(to, kMaxGrazed, stops);
}

// Adds the stops after the last one up to `to`.
bool SegmentWalker::segment(world::GroundPoint to, int32_t depth, std::vector<Stop>& stops) {
  const Stop from = stops.back();
  const uint32_t rect = mesh_ray(mesh_, from.rect, from.at, to);
  if (rect != kNoRect) {
    stops.push_back({to, rect});
    return true;
  }
  // Only the cells can decide.
  const uint32_t level = mesh_.rects[from.rect].level;
  uint32_t end = level;
  if (cells_.walk(end, from.at, to)) {
    stops.push_back({to, cells_.rect_at(end, to.cell_x(), to.cell_z())});
    return stops.back().rect != kNoRect;
  }
  if (depth == 0) return false;
  const auto past = grazed(level, from.at, to);
  if (!past || is_same(*past, from.at) || is_same(*past, to)) {
    return slip_by(level, from.at, to, stops) && segment(to, depth - 1, stops);
  }
  return segment(*past, depth / 2, stops) && segment(to, depth - 1, stops);
}

// Adds stops a unit beside the corner at which the segment ends, on the sides from which the body
// can continue. Between two cells on which it may stand the ground may rise by more than the step
// height: nothing is missing there, and a body at the end of such a rise has to go around it, from
// one side of one point to the other.
bool SegmentWalker::slip_by(uint32_t level, world::GroundPoint from, world::GroundPoint to,
                            std::vector<Stop>& stops) {
  const world::WalkStop stop = cells_.walk_far(level, from, to);
  // Both ends of the border that stops it, or the corner that does.
  std::array<CellCorner, 2> corners;
  for (int32_t i = 0; i < 2; ++i) {
    corners[static_cast<size_t>(i)] = {
        stop.toward_x != 0 ? std::max(stop.x, stop.x + stop.toward_x) : stop.x + i,
        stop.toward_z != 0 ? std::max(stop.z, stop.z + stop.toward_z) : stop.z + i};
  }
  if (distance(corners[1], from, to) < distance(corners[0], from, to)) {
    std::swap(corners[0], corners[1]);
  }
  for (const CellCorner& corner : corners) {
    if (distance(corner, from, to) > kGrazeDistance) continue;
    const size_t before = stops.size();
    for (size_t a = 0; a < 4; ++a) {
      stops.resize(before);
      if (!segment(quadrant(corner, a), 0, stops)) continue;
      if (gets_past(corner, stops.back(), to)) return true;
      for (const size_t b : {(a + 1) % 4, (a + 3) % 4}) {
        stops.resize(before + 1);
        if (!segment(quadrant(corner, b), 0, stops)) continue;
        if (gets_past(corner, stops.back(), to)) return true;
      }
    }
    stops.resize(before);
  }
  return false;
}

// Does a straight line from a stop lead out of the four cells around a corner, or to its end?
bool SegmentWalker::gets_past(const CellCorner& corner, const Stop& from,
                              world::GroundPoint to) const {
  const world::WalkStop stop = cells_.walk_far(mesh_.rects[from.rect].level, from.at, to);
  const auto is_beside = [](int32_t cell, int32_t line) {
    return cell == line || cell == line - 1;
  };
  return stop.arrived || !is_beside(stop.x, corner.x) || !is_beside(stop.z, corner.z);
}

// The point beside the corner of the first blocking cell, if the segment just grazes it.
std::optional<world::GroundPoint> SegmentWalker::grazed(uint32_t level, world::GroundPoint from,
                                                        world::GroundPoint to) const {
  const double fx = static_cast<double>(from.x) / world::kUnitsPerCell;
  const double fz = static_cast<double>(from.z) / world::kUnitsPerCell;
  const double dx = static_cast<double>(to.x) / world::kUnitsPerCell - fx;
  const double dz = static_cast<double>(to.z) / world::kUnitsPerCell - fz;
  const double length = std::sqrt(dx * dx + dz * dz);
  if (!(length > 0)) return {};
  // The segment is legal up to the first border of cells at which it is not: halving could miss
  // one, so it is tested cell by cell, as walk() does.
  int32_t x = from.cell_x(), z = from.cell_z();
  const int32_t sx = to.x > from.x ? 1 : -1, sz = to.z > from.z ? 1 : -1;
  const int64_t ux = std::llabs(to.x - from.x), uz = std::llabs(to.z - from.z);
  while (x != to.cell_x() || z != to.cell_z()) {
    const int64_t line_x = int64_t{sx > 0 ? x + 1 : x} << world::kUnitBits;
    const int64_t line_z = int64_t{sz > 0 ? z + 1 : z} << world::kUnitBits;
    const int64_t ax = std::llabs(line_x - from.x) * uz, az = std::llabs(line_z - from.z) * ux;
    const bool cross_x = x != to.cell_x() && (z == to.cell_z() || ax <= az);
    const bool cross_z = z != to.cell_z() && (x == to.cell_x() || az <= ax);
    const int32_t nx = cross_x ? x + sx : x, nz = cross_z ? z + sz : z;
    const world::GroundPoint here{(int64_t{x} << world::kUnitBits) + 1024,
                                  (int64_t{z} << world::kUnitBits) + 1024};
    const world::GroundPoint there{(int64_t{nx} << world::kUnitBits) + 1024,
                                   (int64_t{nz} << world::kUnitBits) + 1024};
    if (!cells_.walk(level, here, there)) {
      // Of the cells that may block, the corner that the segment passes closest.
      double nearest = kGrazeDistance;
      std::optional<world::GroundPoint> best;
      // The cells beside the segment first: a diagonal one that can be stood on shares their
      // corner, but it is not what is missing there.
      const std::array<std::array<int32_t, 2>, 3> cells{{{nx, z}, {x, nz}, {nx, nz}}};
      for (const auto& [cx, cz] : cells) {
        if (cx == x && cz == z) continue;
        const bool is_beside = cx == x || cz == z;
        if (is_beside && cells_.has_step(level, x, z, cx, cz)) continue;  // not this one
        for (const int32_t px : {cx, cx + 1}) {
          for (const int32_t pz : {cz, cz + 1}) {
            const double along = ((px - fx) * dx + (pz - fz) * dz) / length;
            const double off = std::fabs((px - fx) * dz - (pz - fz) * dx) / length;
            if (off >= nearest || along < -0.01 || along > length + 0.01) continue;
            nearest = off;
            best = beside({px, pz, static_cast<int8_t>(px > cx ? 1 : -1),
                           static_cast<int8_t>(pz > cz ? 1 : -1), 0});
          }
        }
      }
      return best;
    }
    x = nx;
    z = nz;
  }
  return {};
}

}  // namespace throng::path
