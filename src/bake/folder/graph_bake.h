// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <span>
#include <string>

#include "bake/folder/world_folder.h"
#include "graph/graph_passes.h"
#include "throng/bake.h"
#include "throng/base.h"

/// The graph of a baked world, into its folder.
namespace throng::bake {

/// The files of a world's graph in its folder, which lends those of an earlier bake.
class GraphFilesInFolder : public graph::GraphFiles {
 public:
  /// Kept by reference.
  explicit GraphFilesInFolder(const WorldFolder& folder) : folder_(folder) {}
  std::unique_ptr<world::RegionZone> reuse_regions(int32_t x, int32_t z, uint64_t input) override;
  std::unique_ptr<world::LinkZone> reuse_links(int32_t x, int32_t z, uint64_t input) override;
  Result<void> write(const std::string& name, std::span<const uint8_t> bytes) override;

 private:
  const WorldFolder& folder_;
};

/// A world whose zones are all in the folder reads them there from now on.
void read_zones_in(const WorldFolder& folder, world::WorldData& world);
/// What a bake reports of its graph, but for the time.
void report_graph(const graph::GraphMade& made, BakeReport& report);

/// Makes what graph/graph_passes.h makes of a world whose zones are all in the folder, but for what
/// a killed bake or the old world has made of the same. Fails with kBadFile, kIo, kLimit or
/// kCancelled.
Result<std::shared_ptr<world::GraphData>> bake_graph(const WorldFolder& folder,
                                                     world::WorldData& world, int32_t workers,
                                                     Context& context, BakeReport& report);

}  // namespace throng::bake
