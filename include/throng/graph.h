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

/// The accessibility graph of a baked world: which places hold together, for every class.
/// Source: [PACS00], as docs/design/003-graph.md reads it for level tiles.
namespace throng {

struct GraphData;  // Internal: regions and links.

struct GraphConfig {
  int32_t workers = 0;  ///< Threads, 0 for all cores, where the graph is not on disk.
};

struct GraphSummary {
  uint64_t regions = 0;  ///< Connected parts of level tiles, shared by classes.
  uint64_t links = 0;    ///< Pairs of regions that a step joins, both ways.
  uint64_t bytes = 0;    ///< Of both, without what belongs to classes and files.
  bool on_disk = false;  ///< Read from the files of the bake, not made anew.
  double seconds = 0;    ///< To read or to make them.
};

/// Places that a class can all walk to from each other.
struct Component {
  double area = 0;       ///< Of the cells where the class may stand. [m^2]
  uint64_t regions = 0;  ///< Parts of level tiles that it is made of.
  Place place;           ///< One of its places: the middle of a cell.
};

/// Regions and links of a world. Cheap to copy (shared, immutable); safe to read from many threads.
class THRONG_API Graph {
 public:
  Graph() = default;

  /// The graph that a bake has left in the world's folder: only its index is read here, and the
  /// regions of a zone when something asks for a place in it. Where there is none (a world in
  /// memory, or baked before bakes made graphs), it is made: reads every zone once; the same for
  /// any number of workers. Fails with kBadFile (the index or, where it is made, a zone cannot be
  /// used, by name) or kCancelled.
  [[nodiscard]] static Result<Graph> make(const World& world, const GraphConfig& config,
                                          Context& context);

  [[nodiscard]] GraphSummary summary() const;
  /// Components of a class, the largest first; empty for a class that the world does not have.
  [[nodiscard]] std::span<const Component> components(int32_t avatar_class) const;
  /// Which of components() holds a place of the class; -1 if the class cannot stand there, or its
  /// zone cannot be used: see check_at().
  [[nodiscard]] int32_t component_at(int32_t avatar_class, const Place& place) const;
  /// Can the files of the zone at a position be used, ground and regions? Fails with kBadFile and
  /// the file.
  [[nodiscard]] Result<void> check_at(Vec3d position) const;
  /// Can all files of the graph that a bake has left be used, also those of links, which nothing
  /// else here reads? There may be none. Fails as check_at().
  [[nodiscard]] static Result<void> check_files(const World& world);

 private:
  explicit Graph(std::shared_ptr<const GraphData> data) : data_(std::move(data)) {}

  std::shared_ptr<const GraphData> data_;
};

}  // namespace throng
