// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "bake/folder/graph_bake.h"

#include "core/stopwatch.h"

// Runs the passes of graph/graph_passes.h on a world's folder.
namespace throng::bake {
namespace {

constexpr uint64_t kResidentBytes = uint64_t{8} << 20;  // of zones in use [bytes]

}  // namespace

std::unique_ptr<world::RegionZone> GraphFilesInFolder::reuse_regions(int32_t x, int32_t z,
                                                                     uint64_t input) {
  return folder_.reuse_regions(x, z, input);
}

std::unique_ptr<world::LinkZone> GraphFilesInFolder::reuse_links(int32_t x, int32_t z,
                                                                 uint64_t input) {
  return folder_.reuse_links(x, z, input);
}

Result<void> GraphFilesInFolder::write(const std::string& name, std::span<const uint8_t> bytes) {
  return folder_.write_file_of_zone(name, bytes);
}

void read_zones_in(const WorldFolder& folder, world::WorldData& world) {
  world.path = folder.part();
  world.budget = kResidentBytes;
}

void report_graph(const graph::GraphMade& made, BakeReport& report) {
  report.zones_relinked = made.zones_relinked;
  for (const auto& slot : made.graph->slots) {
    report.graph_bytes += slot->entry.region_bytes() + slot->entry.link_bytes();
  }
}

Result<std::shared_ptr<world::GraphData>> bake_graph(const WorldFolder& folder,
                                                     world::WorldData& world, int32_t workers,
                                                     Context& context, BakeReport& report) {
  const auto start = Clock::now();
  read_zones_in(folder, world);
  GraphFilesInFolder files(folder);
  auto made = graph::make_graph(world, &files, workers, context);
  if (!made) {
    if (made.error().code != Errc::kCancelled) return made.error();
    return Error{Errc::kCancelled, "bake: cancelled; nothing was written"};
  }
  report_graph(*made, report);
  report.seconds_graph = seconds_since(start);
  return std::move(made->graph);
}

}  // namespace throng::bake
