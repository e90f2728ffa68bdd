// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include "import/builtin/world_builder.h"
#include "throng/scene.h"

/// One builder for each world. The config has been checked and its zeros replaced by the world's
/// defaults.
namespace throng::importer::builtin {

void build_cube(WorldBuilder& b, const BuiltinWorldConfig& config);
void build_stairs(WorldBuilder& b, const BuiltinWorldConfig& config);
void build_garage(WorldBuilder& b, const BuiltinWorldConfig& config);
void build_bridge(WorldBuilder& b, const BuiltinWorldConfig& config);
void build_church(WorldBuilder& b, const BuiltinWorldConfig& config);
void build_powerplant(WorldBuilder& b, const BuiltinWorldConfig& config);
void build_city(WorldBuilder& b, const BuiltinWorldConfig& config);
/// Exactly `triangles` of them, at least 2.
void build_blocks(WorldBuilder& b, const BuiltinWorldConfig& config);
/// The most that blocks of this size have.
uint64_t max_block_triangles(double size);
/// The only world of patches: cut into triangles when it is made.
PatchSet build_landscape(const BuiltinWorldConfig& config);
/// The curve tolerance at which a landscape of this size still fits. [m]
double landscape_tolerance(double size);
void build_maze(WorldBuilder& b, const BuiltinWorldConfig& config);

/// The footprint that holds about `triangles`, for the worlds that grow with them. [m]
double powerplant_size(uint64_t triangles, int32_t levels);
double city_size(uint64_t triangles);

}  // namespace throng::importer::builtin
