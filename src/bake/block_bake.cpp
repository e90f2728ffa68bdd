// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "bake/folder/block_bake.h"

#include <utility>

#include "bake/folder/finish_bake.h"
#include "bake/folder/graph_bake.h"
#include "core/stopwatch.h"
#include "throng/bake.h"

// A bake of a scene that is never in memory as a whole, by one process: the ground and the air of
// one block after the other, then one graph of all zones, which reads their files alone.
namespace throng {
namespace {

// Steps of a block say nothing about the whole: what is shown are its blocks.
class BlockProgress {
 public:
  BlockProgress(Context& context, uint64_t zones)
      : context_(context), zones_(zones), show_(std::exchange(context.on_progress, nullptr)) {
    if (!show_) return;
    context_.on_progress = [this](const Progress&) { show_({"bake", done_, zones_}); };
  }
  BlockProgress(const BlockProgress&) = delete;
  BlockProgress& operator=(const BlockProgress&) = delete;
  ~BlockProgress() { context_.on_progress = std::move(show_); }

  void add(const world::ZoneRect& block) {
    done_ +=
        static_cast<uint64_t>(block.x1 - block.x0) * static_cast<uint64_t>(block.z1 - block.z0);
  }

 private:
  Context& context_;
  uint64_t zones_, done_ = 0;
  decltype(Context::on_progress) show_;
};

Result<std::shared_ptr<world::WorldData>> bake_blocks(bake::BlockBake& blocks,
                                                      bake::WorldFolder& folder, Context& context,
                                                      BakeReport& report) {
  BlockProgress progress(context, blocks.place_count());
  for (const world::ZoneRect& block : blocks.blocks()) {
    auto made = blocks.bake(block, folder, context);
    if (!made) return made.error();
    blocks.enter(*std::move(made));
    progress.add(block);
  }
  const auto whole = blocks.finish();
  if (!whole) return whole.error();
  auto world = blocks.world(*whole, report);
  if (world) blocks.set_air(**world, report);
  return world;
}

}  // namespace

Result<BakeReport> bake_world_to(const std::string& path, const SceneRegions& scene,
                                 const BakeConfig& config, Context& context) {
  if (auto ok = bake::BlockBake::check(scene, config); !ok) return ok.error();
  auto folder = bake::WorldFolder::begin(path, config.old_zones);
  if (!folder) return folder.error();
  if (auto ok = folder->check_part(config); !ok) return ok.error();
  BakeReport report;
  const auto start = Clock::now();
  auto blocks = bake::BlockBake::begin(scene, config, folder->old_world());
  if (!blocks) return blocks.error();
  auto world = bake_blocks(*blocks, *folder, context, report);
  if (!world) return world.error();
  if (context.on_progress) {
    context.on_progress({"bake", blocks->place_count(), blocks->place_count()});
  }
  const auto graph = bake::bake_graph(*folder, **world, config.workers, context, report);
  if (!graph) return graph.error();
  if (auto ok = bake::finish_bake(*folder, **world, **graph, scene, config, context, report); !ok) {
    return ok.error();
  }
  report.seconds_total = seconds_since(start);
  return report;
}

}  // namespace throng
