// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "path/edits/solid.h"
#include "path/ground/slice.h"
#include "throng/path.h"
#include "throng/surface.h"

/// Paths over nodes, for every class and in particular for climbers: over walls and under ceilings.
/// Source: [PACS00] 1.2.3; docs/design/006-nodes.md.
namespace throng::path {

/// A rectangle of a patch's parameters.
struct NodeSquare {
  double s0 = 0, t0 = 0, s1 = 0, t1 = 0;
};

/// Finds paths for one class over nodes. All copies share the nodes; each copy has its own memory
/// for searching: give every thread one. No allocation once it is warm.
class NodeFinder {
 public:
  /// Makes a finder. Reads all nodes once. Fails with kBadConfig, kBadFile (a zone cannot be used)
  /// or kCancelled.
  [[nodiscard]] static Result<NodeFinder> create(const Nodes& nodes, const PathConfig& config,
                                                 Context& context);
  NodeFinder(const NodeFinder& other);
  NodeFinder& operator=(const NodeFinder& other);
  NodeFinder(NodeFinder&&) noexcept;
  NodeFinder& operator=(NodeFinder&&) noexcept;
  ~NodeFinder();

  /// The place of the class nearest to a position in three dimensions, or nowhere if none is within
  /// `search_radius`. Queries of one finder are for one thread at a time. [m, m]
  [[nodiscard]] NodePlace find_place(Vec3d position, double search_radius) const;

  /// A rectangle of a node's patch that contains two of its places, the ends of a segment, and
  /// inside which the class may move straight between any two points. Empty if the finder knows
  /// none. [s and t 0 to 1]
  [[nodiscard]] std::optional<NodeSquare> square(uint32_t node, double from_s, double from_t,
                                                 double to_s, double to_t) const;

  /// Finds a path of low cost: A* over the middles of the lines along which nodes touch, or over
  /// the overlay if the path is long, then string pulling within the nodes of the corridor.
  /// `spacing` is the largest distance between points of the path on curved ground. [m, > 0] `path`
  /// is reused: its memory stays. Stops when the budget is exhausted. A path to an unreachable goal
  /// leads to the nearest reachable place, in three dimensions; if that is more than 25 m from the
  /// goal, or obstacles are up, to the nearest place in the block whose border comes nearest.
  void find(const NodePlace& from, const NodePlace& to, Path& path, double spacing = 0.25,
            const SearchBudget& budget = {});
  /// The same in parts: call begin, then advance until it returns true; `path` is then that of
  /// find, and before it counts what was expanded. Finding the places, the nearest one to a goal
  /// that is not connected, and string pulling are each in one go and not counted. After a change
  /// or another query, begin again.
  void begin(const NodePlace& from, const NodePlace& to, double spacing = 0.25,
             const SearchBudget& budget = {});
  bool advance(Slice& slice, Path& path);
  /// Could a path begin or end there now?
  [[nodiscard]] bool is_free(const NodePlace& place) const;

  /// Puts up an obstacle: no path leads where the body could touch the solid, whatever its axis. Of
  /// triangles only these are solid: a closed shell is hollow.
  /// Blocks are cut there, by cells of level tiles and by squares of about a quarter of a metre of
  /// curved ground. Paths lead around it over the rest; long ones still use the overlay, but for
  /// the overlay cells that the obstacle touches. Holds for this finder and for copies made later.
  /// Time: here what lies within a body's size of it; at the next query the cuts of what it
  /// touches, and a copy of all that is cut.
  ChangeId add_obstacle(Solid solid);
  /// Gives an area a kind: squares of level tiles whose middle lies in the prism, and of curved
  /// ground of about a quarter of a metre. A metre on them costs what the kind does; infinity
  /// closes them. Where several overlap, the last one counts. Fails with kBadInput or kBadConfig.
  /// Time: the blocks that it touches.
  [[nodiscard]] Result<ChangeId> add_area(const Prism& prism, uint8_t kind);
  [[nodiscard]] Result<void> set_area_cost(uint8_t kind, double cost);
  /// Adds an off-mesh link between places of the class as they were baked; while an obstacle blocks
  /// one, it is not in force. While one is in force, all crossings are searched, without the
  /// overlay, because links may join any of its cells. Fails with kBadInput.
  [[nodiscard]] Result<ChangeId> add_off_mesh_link(const OffMeshLink& link);
  /// Removes a change, or switches it off and on, as a door; paths are then the same as without it.
  /// False if there is none of this id.
  bool remove(ChangeId change);
  bool set_active(ChangeId change, bool active);
  /// Rises with every change that concerns the mesh.
  [[nodiscard]] uint64_t version() const;

  [[nodiscard]] PathSummary summary() const;

 private:
  struct Shared;
  struct Scratch;
  explicit NodeFinder(std::shared_ptr<const Shared> shared);
  void give(Path& path);

  std::shared_ptr<const Shared> state_;
  std::unique_ptr<Scratch> scratch_;
};

}  // namespace throng::path
