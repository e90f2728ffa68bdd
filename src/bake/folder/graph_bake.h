// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <memory>

#include "bake/folder/world_folder.h"
#include "throng/bake.h"
#include "throng/base.h"

/// The graph of a baked world, into its folder.
namespace throng::bake {

/// Makes what graph/graph_passes.h makes of a world whose zones are all in the folder, but for what
/// a killed bake or the old world has made of the same. Fails with kBadFile, kIo, kLimit or
/// kCancelled.
Result<std::shared_ptr<world::GraphData>> bake_graph(WorldFolder& folder, world::WorldData& world,
                                                     int32_t workers, Context& context,
                                                     BakeReport& report);

}  // namespace throng::bake
