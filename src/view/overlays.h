// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "throng/base.h"
#include "throng/scenario.h"
#include "throng/surface.h"
#include "throng/world.h"
#include "throng_draw/draw.h"
#include "view/node_pick.h"
#include "view/timeline_frame.h"

/// Marks that are drawn over the scene to explain it. All are relative to `origin`.
namespace throng::view {

/// The value is the slot of the drawing.
enum class Overlay : uint8_t {
  kClearance,
  kLevels,
  kNodes,
  kLinks,
  kAir,
  kDensity,
  kPath,
  kNeighbours,
  kPainted,
  kFields,
  kCylinders,
  kBoxes,
};
inline constexpr size_t kOverlays = 12;
/// The name: "Clearance", ...
[[nodiscard]] const char* word_for(Overlay overlay);
/// The meaning of its colours, one sentence.
[[nodiscard]] const char* legend_of(Overlay overlay);

/// Where a class may stand, by clearance: from red beside a blocker over yellow and green to blue.
/// Reads every zone; incomplete if cancelled.
[[nodiscard]] Marks clearance_marks(const World& world, int32_t avatar_class, Vec3d origin,
                                    Context& context);
/// Every level in a colour of its own; level tiles of one storey share it.
[[nodiscard]] Marks level_marks(const World& world, Vec3d origin, Context& context);
/// Terminal nodes by inclination: from green (level) over yellow to red (steep). `drawn` gets those
/// that are drawn.
[[nodiscard]] Marks node_marks(const Nodes& nodes, Vec3d origin, DrawnNodes& drawn,
                               Context& context);
/// The cylinders of terminal nodes [PACS00]: as wide and as high as these promise, by inclination.
[[nodiscard]] Marks cylinder_marks(const Nodes& nodes, Vec3d origin, Context& context);
/// The free boxes of the air's octree [PACS00], by size: from red (small) to blue. Fails as
/// air_boxes does.
[[nodiscard]] Result<Marks> box_marks(const World& world, Vec3d origin);
/// Arcs between nodes: white walk, orange step, magenta climb, blue off-mesh link, red drop link.
[[nodiscard]] Marks link_marks(const Nodes& nodes, Vec3d origin, Context& context);
/// Where a flyer's feet may be at one height [m, world]. Fails as PathFinder::create does.
[[nodiscard]] Result<Marks> air_marks(const World& world, double height, Vec3d origin,
                                      Context& context);
/// Avatars per square metre, over squares of two metres: blue few, red four and more.
[[nodiscard]] Marks density_marks(const TimelineFrame& crowd);
/// The protection fields of [CAACD] in metres: three circles and the probe ahead, green tolerable,
/// yellow alert, orange critical, red collision. Shows avatars within 8 m of `picked`, an index; if
/// `picked` is `crowd.size()`, the 300 nearest to a point. `radii`: of bodies, by class. Of avatars
/// that [CAACD] steers, fields and states are those of the frame,
/// and the 300 nearest are always shown.
[[nodiscard]] Marks field_marks(const TimelineFrame& crowd, size_t picked, Vec3d middle,
                                const std::vector<double>& radii);
/// The weights of density maps: the larger, the more opaque. A pixel is drawn on the ground of the
/// first class that has some under its middle.
[[nodiscard]] Marks painted_marks(const World& world, const std::vector<DensityMap>& maps,
                                  Vec3d origin, Context& context);
/// The outline of a brush on the ground.
[[nodiscard]] Marks brush_marks(Vec3d where, double radius, Rgba colour);
/// A path, a little above the ground.
[[nodiscard]] Marks path_marks(const std::vector<Vec3d>& points, Vec3d origin);
/// The avatars within `sight` of one avatar, on its storey.
[[nodiscard]] Marks neighbour_marks(const TimelineFrame& crowd, size_t picked, double sight);

}  // namespace throng::view
