// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "bake/folder/finish_bake.h"

#include <memory>
#include <utility>

#include "bake/surface/node_bake.h"
#include "throng/surface.h"
#include "throng/world.h"

// Replaces the old world by the complete one in NAME.part, after a check of the off-mesh links of
// its nodes.
namespace throng::bake {

Result<void> finish_bake(WorldFolder& folder, const world::WorldData& world,
                         const world::GraphData& graph, const NodeScene& scene,
                         const BakeConfig& config, Context& context, BakeReport& report) {
  if (auto ok = folder.complete(world, graph, config.carry_nodes); !ok) return ok;
  if (config.nodes != nullptr && !config.nodes->off_mesh_links.empty()) {
    const auto made = World::open(folder.part());
    if (!made) return made.error();
    if (auto ok = NodeBaker::check_off_mesh_links(*made, scene, *config.nodes, context); !ok) {
      return Error{ok.error().code, ok.error().message + "; nothing was written"};
    }
  }
  auto lock = folder.finish();
  if (!lock) return lock.error();
  if (config.nodes != nullptr) report.hold = std::make_shared<FolderLock>(*std::move(lock));
  return {};
}

}  // namespace throng::bake
