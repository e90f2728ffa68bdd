// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

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

/// What pass 1 makes of a zone, but for the file. Trivial: ranks send it as it is.
struct RegionsOfZone {
  uint32_t slot = 0;  ///< of the world
  format::GraphZone entry;
  uint64_t input = 0;
};

/// What pass 2 makes of a zone, but for the file.
struct LinksOfZone {
  uint32_t slot = 0;    ///< of the world
  bool is_new = false;  ///< made, not reused
  uint64_t count = 0;   ///< within the zone too
  uint64_t bytes = 0, hash = 0;
};

/// The passes zone by zone, for several processes as for one: each finds what it is given, and
/// learns by `enter` what the others have found.
class GraphPasses {
 public:
  /// With `files`, they are in the world's folder; null: all of it stays in memory, but for the
  /// links over borders, which are only counted. Both are kept by reference.
  GraphPasses(const world::WorldData& world, GraphFiles* files);
  ~GraphPasses();

  /// Pass 1 of a zone. Different zones in several threads at a time. Fails with kBadFile, kIo,
  /// kLimit or kCancelled.
  Result<RegionsOfZone> find_regions(size_t slot, int32_t workers, const Context& context);
  /// What another process has found.
  void enter(const RegionsOfZone& found);
  /// Once every zone has its regions. Fails with kLimit.
  Result<void> end_regions();

  /// Pass 2 of a zone, and which parts of zones its links join. Different zones in several threads
  /// at a time. Fails as find_regions does.
  using Joined = std::vector<std::pair<uint32_t, uint32_t>>;
  struct Found {
    LinksOfZone links;
    Joined joined;  ///< numbers among the parts of all zones
  };
  Result<Found> find_links(size_t slot, int32_t workers, const Context& context);
  /// What this or another process has found. One call at a time.
  void enter(const LinksOfZone& links, std::span<const std::pair<uint32_t, uint32_t>> joined);
  /// Once every zone has its links: the whole.
  GraphMade finish();

 private:
  class Passes;
  std::unique_ptr<Passes> passes_;
};

/// Makes the graph of a world whose zones can be used, as GraphPasses does; a zone of which
/// everything is reused is not touched. The same bytes for any number of workers. Fails with
/// kBadFile (a zone cannot be used, by name), kIo, kLimit or kCancelled.
Result<GraphMade> make_graph(const world::WorldData& world, GraphFiles* files, int32_t workers,
                             Context& context);

}  // namespace throng::graph
