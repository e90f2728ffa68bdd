// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "throng/context.h"
#include "throng/nodes.h"
#include "throng/scenario.h"
#include "throng/world.h"
#include "throng_draw/draw.h"
#include "view/timeline_frame.h"

/// What is drawn over the scene to explain it. All marks are relative to `origin`.
namespace throng {

/// Each in the drawing's slot of its number.
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
};
inline constexpr size_t kOverlays = 10;
/// "Clearance", ...
[[nodiscard]] const char* word_for(Overlay overlay);
/// What its colours mean, one sentence.
[[nodiscard]] const char* legend_of(Overlay overlay);

/// Where a class may stand, red next to what stops it, over yellow and green to blue where there is
/// most room. Reads every zone; cancelled, it is not complete.
[[nodiscard]] Marks clearance_marks(const World& world, int32_t avatar_class, Vec3d origin,
                                    Context& context);
/// Every sheet of ground in a colour of its own: sheets that continue each other share one.
[[nodiscard]] Marks level_marks(const World& world, Vec3d origin, Context& context);
/// Terminal nodes: green level, over yellow to red steep.
[[nodiscard]] Marks node_marks(const Nodes& nodes, Vec3d origin, Context& context);
/// Arcs between them: white walk, orange step, magenta climb, blue jump, red drop.
[[nodiscard]] Marks link_marks(const Nodes& nodes, Vec3d origin, Context& context);
/// Where feet of a flyer may be at one height [m, world]. Fails with what FlightFinder::make does.
[[nodiscard]] Result<Marks> air_marks(const World& world, double height, Vec3d origin,
                                      Context& context);
/// Avatars a square metre, over squares of two metres: blue few, red four and more.
[[nodiscard]] Marks density_marks(const TimelineFrame& crowd);
/// The protection fields of [CAACD] in metres: three circles and the zone ahead, green tolerable,
/// yellow alert, orange critical, red collision. Of who is within 8 m of the one picked; if
/// `picked` is nobody's index, of the 300 nearest to a point. `radii`: of bodies, by class.
[[nodiscard]] Marks field_marks(const TimelineFrame& crowd, size_t picked, Vec3d middle,
                                const std::vector<double>& radii);
/// Where the maps of a brush or scenario have weight: the more, the less clear. A pixel lies on the
/// ground of the first class that has any under its middle.
[[nodiscard]] Marks painted_marks(const World& world, const std::vector<DensityMap>& maps,
                                  Vec3d origin, Context& context);
/// The rim of a brush on the ground.
[[nodiscard]] Marks brush_marks(Vec3d where, double radius, Rgba colour);
/// A way, a little above the ground.
[[nodiscard]] Marks path_marks(const std::vector<Vec3d>& points, Vec3d origin);
/// Who is within `sight` of one avatar, on its storey.
[[nodiscard]] Marks neighbour_marks(const TimelineFrame& crowd, size_t picked, double sight);

}  // namespace throng
