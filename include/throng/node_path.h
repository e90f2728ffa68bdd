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

/// Ways over nodes, for every class and with it for climbers: over walls and under ceilings.
/// Source: [PACS00] 1.2.3; docs/design/006-nodes.md.
namespace throng {

struct NodePathConfig {
  int32_t avatar_class = 0;
  /// A metre over ground that inclines by an angle a costs 1 + slope_cost * (1 - cos a): flat
  /// ground 1, a wall 1 + slope_cost, a ceiling 1 + 2 slope_cost. [>= 0]
  double slope_cost = 0;
  /// Where there are many crossings (2^15), know what it costs to go through squares of ground:
  /// long ways are put together of that, and are seldom much dearer than the best. Takes as long as
  /// some searches over all to make.
  bool overlay = true;
  int32_t workers = 0;  ///< Threads for making the finder, 0 for all cores.
};

/// A point of a way and how it is reached from the one before it.
struct NodePathPoint {
  /// In its node, which also holds the next point if that is reached on the surface. Nowhere, but
  /// with feet and axis, in the air above the place that a body drops to.
  NodePlace place;
  /// On the surface: straight by the parameters of the last point's patch, whose node holds both.
  /// Otherwise the feet go straight through the air, and the axis turns evenly: over the edge of a
  /// patch, where there is nearly nothing to go or nothing at all, for this is the same place by
  /// the parameters of the next; along a leap; or out over an edge and then down.
  bool on_surface = true;
};

/// A link that a way uses: the one by which it comes from another node to `point`.
struct NodePathLink {
  uint32_t point = 0;
  LinkKind kind = LinkKind::kWalk;
  bool over_hole = false;  ///< Between places that do not touch.
};

struct NodePath {
  PathEnd end = PathEnd::kNoPlace;
  std::vector<NodePathPoint> points;
  std::vector<NodePathLink> links;  ///< In order of their points.
  std::vector<uint32_t> corridor;   ///< Nodes, from the start's to the goal's.
  double length = 0;                ///< Of the line through the points. [m]
  double cost = 0;                  ///< Metres times what they cost.
  /// Of the crossings by which the search came, before the way was pulled taut.
  double searched_cost = 0;
  /// If the goal is unreachable, `points` lead to the nearest place that is reached, in all three
  /// dimensions; more than 25 m from the goal, or with obstacles put up, to the nearest in the
  /// block whose border comes nearest. And what is in the way there.
  Obstacle obstacle = Obstacle::kNone;
  uint64_t nodes = 0;  ///< Crossings, and gates of districts, that the search looked at.
  SpentBudget spent = SpentBudget::kNone;  ///< What there was too little of, if it gave up.
};

struct NodePathSummary {
  uint64_t blocks = 0;     ///< Squares of patches where the class can stand.
  uint64_t crossings = 0;  ///< Where it gets from one to the next.
  uint64_t bytes = 0;
  double seconds = 0;  ///< To make them.
};

/// By the parameters of a patch.
struct NodeSquare {
  double s0 = 0, t0 = 0, s1 = 0, t1 = 0;
};

/// Finds ways for one class over nodes. The nodes are shared by all copies; each copy has its own
/// memory for searching: give every thread one. No allocation once it is warm.
class THRONG_API NodePathFinder {
 public:
  /// Reads all nodes once. Fails with kBadConfig, kBadFile (a zone cannot be used) or kCancelled.
  [[nodiscard]] static Result<NodePathFinder> make(const Nodes& nodes, const NodePathConfig& config,
                                                   Context& context);
  NodePathFinder(const NodePathFinder& other);
  NodePathFinder& operator=(const NodePathFinder& other);
  NodePathFinder(NodePathFinder&&) noexcept;
  NodePathFinder& operator=(NodePathFinder&&) noexcept;
  ~NodePathFinder();

  /// The place of the class that is nearest to a position, or nowhere within `search_radius`.
  /// Queries of one finder are for one thread at a time. [m, m]
  [[nodiscard]] NodePlace find_place(Vec3d position, double search_radius) const;

  /// A square of a node's patch that holds two of its places, a leg of a way, and on which the
  /// class may go straight from anywhere to anywhere; none if the finder knows none. [s and t 0 to
  /// 1]
  [[nodiscard]] std::optional<NodeSquare> square(uint32_t node, double from_s, double from_t,
                                                 double to_s, double to_t) const;

  /// A way of little cost: A* over the middles of the lines along which nodes touch, where it is
  /// long and the finder has districts put together over these, then pulled taut within the nodes
  /// that it leads over. `spacing` is how far its points on curved ground
  /// are apart at most. [m, > 0] `path` is reused: its memory stays. Gives up when the
  /// budget is spent.
  void find(const NodePlace& from, const NodePlace& to, NodePath& path, double spacing = 0.25,
            const SearchBudget& budget = {});

  /// Nobody of the class is led to where his body could touch the prism, whichever way he stands:
  /// blocks are cut there, by cells of level tiles and by squares of about a quarter of a metre of
  /// curved ground. Ways around it are found over what is left, and long ones are put together as
  /// before, but for the districts that it touches. Of this finder and of copies made later. Fails
  /// with kBadInput. Time: what lies within a body of it, here; all that is up, at the next query.
  [[nodiscard]] Result<ChangeId> add_obstacle(const Prism& prism);
  /// The same for triangles, and only for those: a closed shell is hollow.
  [[nodiscard]] Result<ChangeId> add_obstacle(std::span<const Vec3d> corners,
                                              std::span<const std::array<uint32_t, 3>> triangles);
  /// Takes an obstacle back, for good or, as a door, until it is set again: ways are then what they
  /// are without it. False if there is none.
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
