// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "path/ground/mesh.h"
#include "world/walk.h"

/// The cells behind a mesh, for the few moves that its rectangles cannot decide.
namespace throng::path {

/// Levels are given by their number in the world.
class Cells {
 public:
  /// As world/walk.h's function: false leaves `level` as it was.
  virtual bool walk(uint32_t& level, world::GroundPoint from, world::GroundPoint to) const = 0;
  /// Where such a walk ends.
  [[nodiscard]] virtual world::WalkStop walk_far(uint32_t level, world::GroundPoint from,
                                                 world::GroundPoint to) const = 0;
  /// Is there a step from a cell to the neighbouring (nx, nz)?
  [[nodiscard]] virtual bool has_step(uint32_t level, int32_t x, int32_t z, int32_t nx,
                                      int32_t nz) const = 0;
  /// kNoRect if the cell is not legal.
  [[nodiscard]] virtual uint32_t rect_at(uint32_t level, int32_t x, int32_t z) const = 0;

 protected:
  Cells() = default;
  Cells(const Cells&) = default;
  Cells& operator=(const Cells&) = default;
  ~Cells() = default;
};

/// The cells of any ground of world/walk.h that finds levels by number, and their numbers:
///   Level level(uint32_t number)
///   uint32_t number(Level)
template <class Ground>
class CellsOf : public Cells {
 public:
  CellsOf(const Ground& ground, int32_t step) : ground_(ground), step_(step) {}

  bool walk(uint32_t& level, world::GroundPoint from, world::GroundPoint to) const override {
    auto end = ground_.level(level);
    if (!world::walk(ground_, end, from, to, step_)) return false;
    level = ground_.number(end);
    return true;
  }
  [[nodiscard]] world::WalkStop walk_far(uint32_t level, world::GroundPoint from,
                                         world::GroundPoint to) const override {
    auto end = ground_.level(level);
    return world::walk_far(ground_, end, from, to, step_);
  }
  [[nodiscard]] bool has_step(uint32_t level, int32_t x, int32_t z, int32_t nx,
                              int32_t nz) const override {
    return world::step_to(ground_, ground_.level(level), x, z, nx, nz, step_).has_value();
  }

 protected:
  ~CellsOf() = default;
  Ground ground_;
  int32_t step_;
};

}  // namespace throng::path
