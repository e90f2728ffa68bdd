// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "import/builtin/world_builder.h"

namespace throng::importer::builtin {

/// A house of the city. Its frame's origin is on the ground in the middle; the front faces -z.
struct Building {
  double width = 24;  ///< Along x. [m, >= 14]
  double depth = 16;  ///< Along z. [m, >= 12]
  int32_t storeys = 2;
  bool interior = true;  ///< Floors, walls with doors and stairs inside; else a closed block.
  bool roof_access = false;
  bool gable = false;  ///< A pitched roof, not walkable; else flat with a parapet.
};

inline constexpr double kBuildingStorey = 3.2;

/// Builds in the builder's current frame. About 150 triangles and 270 more for each storey inside.
void add_building(WorldBuilder& b, const Building& building);

}  // namespace throng::importer::builtin
