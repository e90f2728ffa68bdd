// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "throng/base.h"
#include "throng/context.h"
#include "throng/live_ground.h"
#include "throng/nodes.h"
#include "throng/path.h"
#include "throng/result.h"
#include "throng/search_budget.h"

/// Paths over nodes, for every class and in particular for climbers: over walls and under ceilings.
/// Source: [PACS00] 1.2.3; docs/design/006-nodes.md.
namespace throng {

/// Settings for NodePathFinder::make.
struct NodePathConfig {
  int32_t avatar_class = 0;
  /// Cost of a metre on ground with an inclination a is 1 + slope_cost * (1 - cos a): level ground
  /// 1, a wall 1 + slope_cost, a ceiling 1 + 2 slope_cost. [>= 0]
  double slope_cost = 0;
  /// Makes an overlay where there are many crossings (2^15), over which long paths are searched: it
  /// knows the costs of crossing squares of ground. Its paths are seldom much longer than the best.
  /// Making it takes as long as a few searches of the whole world.
  bool overlay = true;
  int32_t workers = 0;  ///< Threads for making the finder, 0 for all cores.
};

/// A point of a path, and how the body moves to it from the point before.
struct NodePathPoint {
  /// In its node, which also holds the next point if that is reached on the surface. In the air
  /// above the place of a drop it is nowhere, but has feet and axis.
  NodePlace place;
  /// True: on the surface, straight by the parameters of the last point's patch, whose node holds
  /// both points. False: the feet move straight through the air, and the axis turns evenly: over
  /// the edge of a patch, where both points are (nearly) the same place by the parameters of two
  /// patches; along a link over a hole; or out over an edge and then down.
  bool on_surface = true;
};

/// A link that a path uses: it leads from another node to `point`.
struct NodePathLink {
  uint32_t point = 0;
  LinkKind kind = LinkKind::kWalk;
  bool over_hole = false;  ///< Over a hole: between places that do not touch.
};

/// A path over nodes, or why there is none.
struct NodePath {
  PathEnd end = PathEnd::kNoPlace;
  std::vector<NodePathPoint> points;
  std::vector<NodePathLink> links;  ///< In order of their points.
  std::vector<uint32_t> corridor;   ///< Nodes from the start's to the goal's.
  double length = 0;                ///< Of the line through the points. [m]
  double cost = 0;                  ///< Metres times their costs.
  /// Cost of the search's path over crossings, before string pulling.
  double searched_cost = 0;
  /// What blocks the path to an unreachable goal. Then `points` lead to the nearest reachable
  /// place, in three dimensions; if that is more than 25 m from the goal, or obstacles are up, to
  /// the nearest place in the block whose border comes nearest.
  Obstacle obstacle = Obstacle::kNone;
  /// Crossings, and boundary nodes of overlay cells, that the search expanded.
  uint64_t nodes = 0;
  SpentBudget spent = SpentBudget::kNone;  ///< Which part of the budget was exhausted, if one was.
};

/// Sizes of a NodePathFinder.
struct NodePathSummary {
  uint64_t blocks = 0;     ///< Squares of patches where the class can stand.
  uint64_t crossings = 0;  ///< Connections between blocks.
  uint64_t bytes = 0;
  double seconds = 0;  ///< To make them.
};

/// A rectangle of a patch's parameters.
struct NodeSquare {
  double s0 = 0, t0 = 0, s1 = 0, t1 = 0;
};

/// Finds paths for one class over nodes. All copies share the nodes; each copy has its own memory
/// for searching: give every thread one. No allocation once it is warm.
class THRONG_API NodePathFinder {
 public:
  /// Makes a finder. Reads all nodes once. Fails with kBadConfig, kBadFile (a zone cannot be used)
  /// or kCancelled.
  [[nodiscard]] static Result<NodePathFinder> make(const Nodes& nodes, const NodePathConfig& config,
                                                   Context& context);
  NodePathFinder(const NodePathFinder& other);
  NodePathFinder& operator=(const NodePathFinder& other);
  NodePathFinder(NodePathFinder&&) noexcept;
  NodePathFinder& operator=(NodePathFinder&&) noexcept;
  ~NodePathFinder();

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
  /// is reused: its memory stays. Stops when the budget is exhausted.
  void find(const NodePlace& from, const NodePlace& to, NodePath& path, double spacing = 0.25,
            const SearchBudget& budget = {});

  /// Puts up an obstacle: no path leads where the body could touch the prism, whatever its axis.
  /// Blocks are cut there, by cells of level tiles and by squares of about a quarter of a metre of
  /// curved ground. Paths lead around it over the rest; long ones still use the overlay, but for
  /// the overlay cells that the obstacle touches. Holds for this finder and for copies made later.
  /// Fails with kBadInput. Time: here what lies within a body's size of it; at the next query all
  /// obstacles that are up.
  [[nodiscard]] Result<ChangeId> add_obstacle(const Prism& prism);
  /// The same for triangles. Only these are solid: a closed shell is hollow.
  [[nodiscard]] Result<ChangeId> add_obstacle(std::span<const Vec3d> corners,
                                              std::span<const std::array<uint32_t, 3>> triangles);
  /// Removes an obstacle, or switches it off and on, as a door; paths are then the same as without
  /// it. False if there is none of this id.
  bool remove(ChangeId change);
  bool set_active(ChangeId change, bool active);

  [[nodiscard]] NodePathSummary summary() const;

 private:
  struct Shared;
  struct Scratch;
  explicit NodePathFinder(std::shared_ptr<const Shared> shared);

  std::shared_ptr<const Shared> shared_;
  std::unique_ptr<Scratch> scratch_;
};

}  // namespace throng
