// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "path/legs.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>

#include "path/mesh_ray.h"

namespace throng {
namespace {

constexpr int32_t kMostGrazed = 64;  // corners past which one leg is led

}  // namespace

bool LegWalker::walk(const Stop& from, const std::vector<uint32_t>& corners, GroundPoint to,
                     std::vector<Stop>& stops) {
  stops.clear();
  stops.push_back(from);
  for (const uint32_t c : corners) {
    if (!leg(beside(mesh_->corners[c]), kMostGrazed, stops)) return false;
  }
  return leg(to, kMostGrazed, stops);
}

// Adds the stops after the last one up to `to`.
bool LegWalker::leg(GroundPoint to, int32_t depth, std::vector<Stop>& stops) {
  const Stop from = stops.back();
  const uint32_t rect = mesh_ray(*mesh_, from.rect, from.at, to);
  if (rect != kNoRect && rect != kUnsure) {
    stops.push_back({to, rect});
    return true;
  }
  // Only the cells can tell.
  const GroundLevel level =
      ground_level(ground_.world, mesh_->rects[from.rect].level, ground_.avatar_class);
  GroundLevel end = level;
  if (throng::walk(ground_, end, from.at, to, mesh_->step)) {
    stops.push_back({to, mesh_->rect_at(end.world_level, to.cell_x(), to.cell_z())});
    return stops.back().rect != kNoRect;
  }
  if (depth == 0) return false;
  const auto past = grazed(level, from.at, to);
  if (!past || (past->x == from.at.x && past->z == from.at.z) ||
      (past->x == to.x && past->z == to.z))
    return false;
  return leg(*past, depth / 2, stops) && leg(to, depth - 1, stops);
}

// The point beside the corner of the first cell in the way, if the leg just grazes it.
std::optional<GroundPoint> LegWalker::grazed(GroundLevel level, GroundPoint from,
                                             GroundPoint to) const {
  const double fx = static_cast<double>(from.x) / kUnitsPerCell;
  const double fz = static_cast<double>(from.z) / kUnitsPerCell;
  const double dx = static_cast<double>(to.x) / kUnitsPerCell - fx;
  const double dz = static_cast<double>(to.z) / kUnitsPerCell - fz;
  const double length = std::sqrt(dx * dx + dz * dz);
  if (!(length > 0)) return {};
  // The way is legal up to the first border of cells at which it is not: found by halving would
  // miss one, so cell by cell, as walk() goes.
  int32_t x = from.cell_x(), z = from.cell_z();
  const int32_t sx = to.x > from.x ? 1 : -1, sz = to.z > from.z ? 1 : -1;
  const int64_t ux = std::llabs(to.x - from.x), uz = std::llabs(to.z - from.z);
  while (x != to.cell_x() || z != to.cell_z()) {
    const int64_t line_x = int64_t{sx > 0 ? x + 1 : x} << kUnitBits;
    const int64_t line_z = int64_t{sz > 0 ? z + 1 : z} << kUnitBits;
    const int64_t ax = std::llabs(line_x - from.x) * uz, az = std::llabs(line_z - from.z) * ux;
    const bool cross_x = x != to.cell_x() && (z == to.cell_z() || ax <= az);
    const bool cross_z = z != to.cell_z() && (x == to.cell_x() || az <= ax);
    const int32_t nx = cross_x ? x + sx : x, nz = cross_z ? z + sz : z;
    GroundLevel next = level;
    const GroundPoint here{(int64_t{x} << kUnitBits) + 1024, (int64_t{z} << kUnitBits) + 1024};
    const GroundPoint there{(int64_t{nx} << kUnitBits) + 1024, (int64_t{nz} << kUnitBits) + 1024};
    if (!throng::walk(ground_, next, here, there, mesh_->step)) {
      // Of the cells that may be in the way, the corner that the leg passes closest.
      double nearest = 0.02;  // cells
      std::optional<GroundPoint> best;
      // The cells beside the leg first: a diagonal one that can be stood on shares their corner,
      // but it is not what is missing there.
      const std::array<std::array<int32_t, 2>, 3> cells{{{nx, z}, {x, nz}, {nx, nz}}};
      for (const auto& [cx, cz] : cells) {
        if (cx == x && cz == z) continue;
        const auto stands = step_to(ground_, level, x, z, cx, cz, mesh_->step);
        if (stands && (cx == x || cz == z)) continue;  // not this one
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
    level = next;
    x = nx;
    z = nz;
  }
  return {};
}

}  // namespace throng
