// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <vector>

#include "path/air/air_view.h"
#include "path/edits/found_blocker.h"
#include "path/ground/circle_flood.h"
#include "throng/world.h"

/// Between the ground and the air: where a body that stands comes into the air, and where it lands.
namespace throng::path {

/// What a body meets first on the straight line from where it may be: kLow where it would fit if it
/// were less tall, else kNarrow; an obstacle; kNone if it meets nothing. Linear in the voxels on
/// the line.
[[nodiscard]] FoundBlocker air_blocker(const world::AirData& air, const world::AirBody& body,
                                       const AirView& view, AirPoint from, AirPoint to);

class FlightEndpoints {
 public:
  FlightEndpoints(const world::WorldData& world, const AirView& air, int32_t avatar_class);

  [[nodiscard]] AirPoint to_air(Vec3d p) const;
  [[nodiscard]] Vec3d to_metres(AirPoint p) const;
  /// The point of the air that stands for feet: the same, but for a skin off the faces of its
  /// voxel. None where the body may not fly.
  [[nodiscard]] std::optional<AirPoint> in_air(Vec3d feet) const;

  /// May a body stand at a place of the class, as far as active obstacles permit?
  [[nodiscard]] bool may_stand(const Place& place) const;
  /// Straight up from feet on the ground (world::take_off_height).
  [[nodiscard]] std::optional<AirPoint> take_off(const Place& place) const;
  /// A flood in parts.
  struct FloodPart {
    uint64_t visited = 0;        ///< Cells, in all parts. Not 0: the flood has begun.
    uint64_t left = UINT64_MAX;  ///< Cells that it may still visit in this part.
    bool is_done = true;
  };
  /// The nearest place, by cells crossed, from which feet come into the air; `max_cells` cells are
  /// visited. Only into air of this component (see AirView), unless it is kNoBox.
  struct TakeOff {
    Place place;                    ///< Null if there is none among them.
    bool budget_exhausted = false;  ///< There were more cells.
  };
  /// Until the part is done, what it returns is of no use, and the flood is used for nothing else.
  [[nodiscard]] TakeOff nearest_take_off(const Place& from, uint64_t max_cells, uint32_t component,
                                         CircleFlood& flood, FloodPart& part) const;
  /// Fills `components` with the components of the air over those places, the nearest first. True
  /// if there were more than `max_cells` cells.
  bool components_over(const Place& from, uint64_t max_cells, CircleFlood& flood,
                       std::vector<uint32_t>& components) const;
  /// Of the places that are connected to one, the nearest to a goal; null if there were more than
  /// `max_cells` cells, or that one is no place.
  [[nodiscard]] Place nearest_place(const Place& from, uint64_t max_cells, Vec3d goal,
                                    CircleFlood& flood) const;
  /// The best place to land on under a box that holds no air below it.
  [[nodiscard]] Place best_landing(uint32_t box) const;
  /// The lowest box straight under a point of the air.
  [[nodiscard]] uint32_t lowest_box(AirPoint p) const;

 private:
  /// Calls visit(place), or visit(place, component of the air over it), for every cell that is
  /// connected to a place, until it returns false. True if there are too many cells.
  template <class Visit>
  bool for_places(const Place& from, uint64_t max_cells, CircleFlood& flood, FloodPart& part,
                  Visit visit) const;
  template <class Visit>
  bool for_take_offs(const Place& from, uint64_t max_cells, CircleFlood& flood, FloodPart& part,
                     Visit visit) const;

  const world::WorldData& world_;
  AirView air_;
  world::WorldGround ground_;
  const AvatarClass& avatar_;
  double cell_;  // of the air [m]
};

}  // namespace throng::path
