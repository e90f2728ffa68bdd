// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "throng/base.h"
#include "throng/context.h"
#include "throng/result.h"
#include "throng/world.h"

/// The accessibility graph of a baked world: which places are connected, for every class. Source:
/// [PACS00], as docs/design/003-graph.md reads it for level tiles.
namespace throng {

struct GraphData;  // Internal: regions and links.

/// Settings for Graph::make.
struct GraphConfig {
  int32_t workers = 0;  ///< Threads, 0 for all cores; used if the graph is not on disk.
};

/// Sizes of a graph.
struct GraphSummary {
  uint64_t regions = 0;  ///< Connected parts of level tiles, shared by classes.
  uint64_t links = 0;    ///< Undirected links: pairs of regions between which some class can walk.
  uint64_t bytes = 0;    ///< Of both, without files and data of classes.
  bool on_disk = false;  ///< Read from the files of the bake, not made in memory.
  double seconds = 0;    ///< To read or to make them.
};

/// A connected component: a class can walk from each of its places to every other.
struct Component {
  double area = 0;       ///< Of the cells where the class may stand. [m^2]
  uint64_t regions = 0;  ///< Regions that it consists of.
  Place place;           ///< One of its places, the middle of a cell.
};

/// The regions and links of a world. Cheap to copy (shared, immutable); safe to read from many
/// threads.
class THRONG_API Graph {
 public:
  Graph() = default;

  /// Opens the graph that a bake has left in the world's folder: reads only its index, and the
  /// regions of a zone when a query needs them. If there is none (a world in memory, or of an old
  /// bake), makes it: reads every zone once; the result is the same for any number of workers.
  /// Fails with kBadFile (the index or, where it is made, a zone cannot be used, by name) or
  /// kCancelled.
  [[nodiscard]] static Result<Graph> make(const World& world, const GraphConfig& config,
                                          Context& context);

  [[nodiscard]] GraphSummary summary() const;
  /// The components of a class, largest first; empty for a class that the world does not have.
  [[nodiscard]] std::span<const Component> components(int32_t avatar_class) const;
  /// Index in components() of the component that a place belongs to. -1 if the class cannot stand
  /// there, or its zone cannot be used: see check_at().
  [[nodiscard]] int32_t component_at(int32_t avatar_class, const Place& place) const;
  /// Checks that the files of the zone at a position can be used, ground and regions. Fails with
  /// kBadFile and the file.
  [[nodiscard]] Result<void> check_at(Vec3d position) const;
  /// Checks that all files of the graph in a world's folder can be used, also those of links, which
  /// no query here reads. Succeeds if there is no graph. Fails as check_at().
  [[nodiscard]] static Result<void> check_files(const World& world);

 private:
  explicit Graph(std::shared_ptr<const GraphData> data) : data_(std::move(data)) {}

  std::shared_ptr<const GraphData> data_;
};

}  // namespace throng
