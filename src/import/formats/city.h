// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <string_view>

#include "import/raw/raw_scene.h"

/// City models: CityJSON 1.0 to 2.0 and CityGML 2 and 3, read directly.
namespace throng::importer {

/// Nodes are "Type/id", materials are the semantic surface types. Of each object the highest level
/// of detail is read; if its parts (BuildingPart ...) have more detail, they are read instead.
/// Fails with kBadFile and the place.
[[nodiscard]] Result<RawScene> read_cityjson(std::string_view bytes, const ReadOptions& options,
                                             Context& context);

/// The same for GML, with any namespace prefixes. A polygon that is referenced again by xlink:href
/// counts once; implicit geometries are placed by their matrix.
[[nodiscard]] Result<RawScene> read_citygml(std::string_view bytes, const ReadOptions& options,
                                            Context& context);

/// Is the unit of a named coordinate system the degree? Such files are refused.
[[nodiscard]] bool names_degrees(std::string_view reference_system);

}  // namespace throng::importer
