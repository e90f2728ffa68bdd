// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "bake/folder/graph_bake.h"

#include <chrono>

#include "graph/graph_passes.h"

// Runs the passes of graph/graph_passes.h on a world's folder, which lends their files of an
// earlier bake.
namespace throng::bake {
namespace {

constexpr uint64_t kResidentBytes = uint64_t{8} << 20;  // of zones in use [bytes]

class FilesInFolder : public graph::GraphFiles {
 public:
  explicit FilesInFolder(WorldFolder& folder) : folder_(folder) {}
  std::unique_ptr<world::RegionZone> reuse_regions(int32_t x, int32_t z, uint64_t input) override {
    return folder_.reuse_regions(x, z, input);
  }
  std::unique_ptr<world::LinkZone> reuse_links(int32_t x, int32_t z, uint64_t input) override {
    return folder_.reuse_links(x, z, input);
  }
  Result<void> write(const std::string& name, std::span<const uint8_t> bytes) override {
    return folder_.write_file_of_zone(name, bytes);
  }

 private:
  WorldFolder& folder_;
};

}  // namespace

Result<std::shared_ptr<world::GraphData>> bake_graph(WorldFolder& folder, world::WorldData& world,
                                                     int32_t workers, Context& context,
                                                     BakeReport& report) {
  const auto start = std::chrono::steady_clock::now();
  world.path = folder.part();
  world.budget = kResidentBytes;
  FilesInFolder files(folder);
  auto made = graph::make_graph(world, &files, workers, context);
  if (!made) {
    if (made.error().code != Errc::kCancelled) return made.error();
    return Error{Errc::kCancelled, "bake: cancelled; nothing was written"};
  }
  report.zones_relinked = made->zones_relinked;
  for (const auto& slot : made->graph->slots) {
    report.graph_bytes += slot->entry.region_bytes() + slot->entry.link_bytes();
  }
  report.seconds_graph =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return std::move(made->graph);
}

}  // namespace throng::bake
