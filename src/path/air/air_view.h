// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "path/air/air_changes.h"
#include "path/air/flight_space.h"

/// The air of a class as it is now.
namespace throng::path {

/// A space, and what obstacles leave of its boxes; a copy is two pointers. Without changes it is
/// the space. Parts of boxes are boxes here, too (see SplitBoxes).
class AirView {
 public:
  /// `changes` may be null.
  AirView(const FlightSpace& space, const AirChanges* changes = nullptr)
      : space_(&space), changes_(changes) {}

  [[nodiscard]] const FlightSpace& space() const { return *space_; }
  [[nodiscard]] const AirChanges* changes() const { return changes_; }
  [[nodiscard]] uint32_t box_at(int32_t x, int32_t y, int32_t z) const {
    const uint32_t box = space_->box_at(x, y, z);
    return is_split(box) ? changes_->splits().part_at(box, x, y, z) : box;
  }
  [[nodiscard]] uint32_t box_at(AirPoint p) const {
    const uint32_t box = space_->box_at(p);
    return is_split(box) ? changes_->splits().part_at(box, static_cast<int32_t>(std::floor(p.x)),
                                                      static_cast<int32_t>(std::floor(p.y)),
                                                      static_cast<int32_t>(std::floor(p.z)))
                         : box;
  }
  /// Above every box's number.
  [[nodiscard]] uint32_t end() const {
    return changes_ == nullptr ? static_cast<uint32_t>(space_->boxes.size())
                               : changes_->splits().end();
  }
  [[nodiscard]] const world::AirCube& cube(uint32_t box) const {
    return box < space_->boxes.size() ? space_->boxes[box] : changes_->splits().cube(box);
  }
  /// The same for boxes that are connected. For a whole box of the space it is its component there,
  /// unless obstacles have cut it off.
  [[nodiscard]] uint32_t component(uint32_t box) const {
    return changes_ == nullptr ? space_->component[box] : changes_->islands().label(box);
  }
  /// The component of the space that it is, or is a piece of.
  [[nodiscard]] uint32_t baked(uint32_t component) const {
    return changes_ == nullptr ? component : changes_->islands().component(component);
  }
  /// False only if no path joins the two.
  [[nodiscard]] bool same_component(AirPoint a, AirPoint b) const {
    const uint32_t from = box_at(a), to = box_at(b);
    return from != kNoBox && to != kNoBox && component(from) == component(to);
  }
  /// Is the straight line legal over its whole length? Points lie within boxes, a skin off their
  /// faces.
  [[nodiscard]] bool sees(AirPoint from, AirPoint to) const {
    return changes_ == nullptr ? space_->sees(from, to) : air_sees(*this, from, to);
  }
  /// As FlightSpace has it; the cube may be any that lies within a box of the space.
  template <class Visit>
  void for_neighbours(const world::AirCube& cube, Visit&& visit, int32_t min_side = 1) const;
  /// Calls visit(box) for what is left of a box of the space: itself, or its parts.
  template <class Visit>
  void for_pieces(uint32_t box, Visit visit) const {
    if (is_split(box)) {
      changes_->splits().for_parts(box, visit);
    } else {
      visit(box);
    }
  }
  /// The point nearest to a goal in boxes of some components, rising, a skin off their faces; of
  /// equally near boxes the first. Zones are visited in the order of how near they may come, in
  /// `order`, whose memory is kept. None if there is no such box.
  using ZoneOrder = std::vector<std::pair<double, uint32_t>>;
  [[nodiscard]] std::optional<AirPoint> nearest_in(std::span<const uint32_t> components,
                                                   AirPoint goal, ZoneOrder& order) const;

 private:
  [[nodiscard]] bool is_split(uint32_t box) const {
    return changes_ != nullptr && box != kNoBox && changes_->splits().is_split(box);
  }

  const FlightSpace* space_;
  const AirChanges* changes_;
};

/// The point of a cube that is nearest to another, a skin off its faces.
inline AirPoint nearest_of(const world::AirCube& cube, AirPoint goal) {
  const auto into = [&](double at, int32_t low) {
    return std::clamp(at, low + kAirSkin, low + cube.side - kAirSkin);
  };
  return {into(goal.x, cube.x), into(goal.y, cube.y), into(goal.z, cube.z)};
}

template <class Visit>
void AirView::for_neighbours(const world::AirCube& cube, Visit&& visit, int32_t min_side) const {
  if (changes_ == nullptr) {
    space_->for_neighbours(cube, visit, min_side);
    return;
  }
  // The face's cells beyond it: of a box that is split, the parts that have some of them.
  const auto face = [&](int32_t axis, int32_t plane, int32_t u, int32_t v) {
    AirRange range{{cube.x, cube.y, cube.z},
                   {cube.x + cube.side - 1, cube.y + cube.side - 1, cube.z + cube.side - 1}};
    range.first[axis] = range.last[axis] = plane;
    const auto piece = [&](uint32_t box) {
      if (changes_->splits().is_split(box)) {
        changes_->splits().for_parts_in(box, range, min_side, visit);
      } else {
        visit(box);
      }
    };
    space_->visit_face(axis, plane, u, v, cube.side, min_side, piece);
  };
  face(0, cube.x + cube.side, cube.y, cube.z);
  face(0, cube.x - 1, cube.y, cube.z);
  face(1, cube.y + cube.side, cube.x, cube.z);
  face(1, cube.y - 1, cube.x, cube.z);
  face(2, cube.z + cube.side, cube.x, cube.y);
  face(2, cube.z - 1, cube.x, cube.y);
}

}  // namespace throng::path
