// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include "bake/folder/world_folder.h"
#include "bake/surface/node_scene.h"
#include "throng/bake.h"
#include "throng/base.h"

/// The end of a bake into a folder, by one process or by many.
namespace throng::bake {

/// Puts a world whose zones, air and graph are all in the folder into its place, if what will be
/// made of it can be: else nothing of the old world is lost. Fails with kIo, kBadInput (off-mesh
/// links), kBadFile or kCancelled.
Result<void> finish_bake(WorldFolder& folder, const world::WorldData& world,
                         const world::GraphData& graph, const NodeScene& scene,
                         const BakeConfig& config, Context& context, BakeReport& report);

}  // namespace throng::bake
