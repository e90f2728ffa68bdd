// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "import/raw/raw_scene.h"

/// Worlds from 2D plans: flat ground, and obstacles that rise from it.
namespace throng::importer {

/// The content of a plan, in its own two axes.
struct Plan {
  struct Area {
    Polygon polygon;
    double height = 0;  ///< Of an obstacle; of the holes' walls for ground. Units of the plan.
    std::string place;  ///< Its position in the file, for messages.
  };
  struct Wall {
    Ring line;  ///< Open: two corners or more.
    double height = 0;
  };
  std::vector<Area> ground;
  std::vector<Area> obstacles;
  std::vector<Wall> walls;
};

/// How a plan's two axes lie in space.
enum class PlanAxes {
  kXZ,  ///< (x, z), Y up: the library's own.
  kXY,  ///< (x, y), Z up: maps.
};

/// Writes the plan's triangles: ground is walkable; walls and roofs are blocked, and so is a plate
/// inside each obstacle `plate_height` above the ground, so that no avatar is placed inside or on
/// top. Fails with kBadInput and the place of a polygon that crosses itself, has no area or whose
/// holes leave it.
[[nodiscard]] Result<void> write_plan(const Plan& plan, PlanAxes axes, double ground_height,
                                      double plate_height, SceneWriter& writer);

/// WKT: POLYGON, MULTIPOLYGON (ground; holes are obstacles), LINESTRING, MULTILINESTRING (thin
/// walls), GEOMETRYCOLLECTION of these, one after the other. Fails with kBadFile and the line.
[[nodiscard]] Result<RawScene> read_wkt(std::string_view bytes, const ReadOptions& options,
                                        Context& context);

/// GeoJSON: polygons with the property `kind`: "ground" (or "walkable") or "obstacle", and
/// `height`. Without `kind` a polygon is ground, or an obstacle if another one says that it is the
/// ground; a line is a thin wall. Fails with kBadFile and the feature.
[[nodiscard]] Result<RawScene> read_geojson(std::string_view bytes, const ReadOptions& options,
                                            Context& context);

}  // namespace throng::importer
