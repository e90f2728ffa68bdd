// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "crowd/ground/left_cells.h"

#include <algorithm>
#include <cmath>

#include "world/tile_grid.h"
#include "world/walk.h"

// Which blocked cells a body may cross on its exit: by the obstacles whose cells it stands on.
// Linear in the obstacles of a level.
namespace throng::crowd {
namespace {

bool has(const world::CellRows& rows, const LeftCells::Cell& cell) {
  return (rows[static_cast<size_t>(world::in_tile(cell.z))] >> world::in_tile(cell.x) & 1) != 0;
}

}  // namespace

void LeftCells::begin(const WorldSummary& summary, const AvatarClass& avatar) {
  origin_ = summary.origin;
  unit_ = summary.cell / world::kUnitsPerCell;
  radius_ = avatar.radius;
  // As WalkMode::is_inside tests it: what may become active is what may no longer be entered.
  bottom_ = static_cast<int32_t>(std::floor(body_bottom(avatar) * 1000));
  height_ = static_cast<int32_t>(std::ceil(avatar.height * 1000 - 1e-6));
}

void LeftCells::set_level(Level level, std::vector<Part> parts, const world::CellRows& kept) {
  if (parts.empty()) {
    levels_.erase(level);
    return;
  }
  OfLevel& of = levels_[level];
  of.parts = std::move(parts);
  of.held = {};
  for (const Part& part : of.parts) {
    for (size_t z = 0; z < of.held.size(); ++z) of.held[z] |= part.rows[z];
  }
  of.kept = kept;
  of.steps.fill(kNone);
}

bool LeftCells::holds(const Cell& cell) const {
  const OfLevel* of = find(cell.level);
  return of != nullptr && has(of->held, cell);
}

void LeftCells::list_obstacles(const Cell& cell, std::vector<uint32_t>& obstacles) const {
  const OfLevel* of = find(cell.level);
  if (of == nullptr) return;
  for (const Part& part : of->parts) {
    if (has(part.rows, cell)) obstacles.push_back(part.obstacle);
  }
}

bool LeftCells::may_cross(const Cell& from, const Cell& over) const {
  const OfLevel* of = find(over.level);
  const OfLevel* of_from = find(from.level);
  if (of == nullptr || of_from == nullptr || has(of->kept, over)) return false;
  const auto stands_in = [&](uint32_t obstacle) {
    return std::any_of(of_from->parts.begin(), of_from->parts.end(), [&](const Part& part) {
      return part.obstacle == obstacle && has(part.rows, from);
    });
  };
  return std::all_of(of->parts.begin(), of->parts.end(), [&](const Part& part) {
    return !has(part.rows, over) || stands_in(part.obstacle);
  });
}

bool LeftCells::enters(const Cell& cell, const AirPosition& from, const AirPosition& to) const {
  constexpr int32_t kSamples = 4;  // on the line
  const OfLevel* of = find(cell.level);
  if (of == nullptr) return false;
  const auto is_in = [&](const Part& part, AirPosition feet) {
    feet.y += bottom_;
    return part.solid->holds(feet, radius_, height_ - bottom_);
  };
  return std::any_of(of->parts.begin(), of->parts.end(), [&](const Part& part) {
    if (!part.solid) return false;
    if (!has(part.rows, cell) || is_in(part, from)) return false;
    const auto between = [](int32_t a, int32_t b, int32_t i) {
      return static_cast<int32_t>(a + (int64_t{b} - a) * i / kSamples);
    };
    for (int32_t i = 1; i <= kSamples; ++i) {
      const AirPosition position{between(from.x, to.x, i), between(from.z, to.z, i),
                                 between(from.y, to.y, i)};
      if (is_in(part, position)) return true;
    }
    return false;
  });
}

bool LeftCells::is_zero(const Cell& cell) const {
  const OfLevel* of = find(cell.level);
  return of != nullptr && std::any_of(of->parts.begin(), of->parts.end(), [&](const Part& part) {
           return part.obstacle == kZeroWeight && has(part.rows, cell);
         });
}

uint16_t LeftCells::steps_out(const Cell& cell) const {
  const OfLevel* of = find(cell.level);
  return of == nullptr ? kNone
                       : of->steps[static_cast<size_t>(
                             world::cell_index(world::in_tile(cell.x), world::in_tile(cell.z)))];
}

}  // namespace throng::crowd
