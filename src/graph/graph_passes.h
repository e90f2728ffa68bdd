// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "throng/base.h"
#include "world/region_data.h"

/// The graph of a world in two passes over its zones, as [PACS00] makes it.
namespace throng::graph {

/// Where the files of zones go, and where those come from that need not be made again.
class GraphFiles {
 public:
  virtual ~GraphFiles() = default;
  /// The file made from the same input, which is then among those of the new world; null if there
  /// is none.
  virtual std::unique_ptr<world::RegionZone> reuse_regions(int32_t x, int32_t z,
                                                           uint64_t input) = 0;
  virtual std::unique_ptr<world::LinkZone> reuse_links(int32_t x, int32_t z, uint64_t input) = 0;
  virtual Result<void> write(const std::string& name, std::span<const uint8_t> bytes) = 0;
};

struct GraphMade {
  std::shared_ptr<world::GraphData> graph;  // without its world
  uint64_t zones_relinked = 0;              // whose links into the next zones were made, not reused
};

/// Makes the graph of a world whose zones can be used. With `files`, they are in the world's
/// folder; null: all of it stays in memory, but for the links over borders, which are only counted.
/// A zone of which everything is reused is not touched. The same bytes for any number of workers.
/// Fails with kBadFile (a zone cannot be used, by name), kIo, kLimit or kCancelled.
Result<GraphMade> make_graph(const world::WorldData& world, GraphFiles* files, int32_t workers,
                             Context& context);

}  // namespace throng::graph
