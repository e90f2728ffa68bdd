// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "throng/base.h"
#include "throng/context.h"
#include "throng/ground_query.h"
#include "throng/result.h"
#include "throng/search_budget.h"
#include "throng/world.h"

/// Shortest paths for a class over the ground of a baked world.
namespace throng {

struct PathMesh;  // Internal: rectangles and portals.

/// Settings for PathFinder::make.
struct PathConfig {
  int32_t avatar_class = 0;
  int32_t workers = 0;  ///< Threads for making the finder, 0 for all cores.
  /// Makes hub labels of all corners: queries then look paths up and do not search. For many
  /// queries. Labels take time and memory when the finder is made: about 10 kB per square metre of
  /// small worlds, 1 kB of large ones (over some 2^23 cells). In large worlds a path may pass an
  /// obstacle on the wrong side; it is provably at most 2 % longer than the shortest (0.02 % on
  /// average over a city).
  bool labels = false;
  /// Makes paths inside each zone between the entrances of its borders, and labels of these
  /// entrances: for long paths over large worlds. A path between zones that do not touch is then
  /// the shortest that passes every obstacle on the same side, but it may pass one on the wrong
  /// side.
  bool zones = false;
};

/// How a search ended.
enum class PathEnd {
  kReached,
  kUnreachable,      ///< No path on foot leads there.
  kNoPlace,          ///< `from` or `to` is no place of the class.
  kBudgetExhausted,  ///< The budget was exhausted: `spent` names the part.
};

/// A path, or why there is none.
struct Path {
  PathEnd end = PathEnd::kNoPlace;
  std::vector<Place> points;  ///< From the start to the goal; each segment is a legal move.
  double length = 0;          ///< Along the ground's plane. [m]
  /// Of LiveGround: indices of points that an off-mesh link leads to, not a move.
  std::vector<uint32_t> off_mesh_links;
  double cost = 0;  ///< Of LiveGround: metres times their costs.
  /// Of LiveGround: what blocks the path to an unreachable goal.
  Obstacle obstacle = Obstacle::kNone;
  uint64_t nodes = 0;  ///< Intervals that the search expanded; 0 with labels.
  /// Which part of the budget was exhausted, if one was.
  SpentBudget spent = SpentBudget::kNone;
};

/// Sizes of a PathFinder.
struct PathSummary {
  uint64_t rectangles = 0;
  uint64_t portals = 0;
  uint64_t corners = 0;
  uint64_t entrances = 0;  ///< Of zones; 0 without `zones`.
  uint64_t labels = 0;     ///< 0 without `labels`.
  uint64_t bytes = 0;      ///< Of all.
  double seconds = 0;      ///< To make them.
};

/// Finds paths for one class. All copies share the ground; each copy has its own memory for
/// searching: give every thread one. No allocation once it is warm.
class THRONG_API PathFinder {
 public:
  /// Makes a finder. Reads every zone once. Fails with kBadConfig (no such class, or zones with too
  /// many corners for `zones`), kBadFile (a zone cannot be used) or kCancelled.
  [[nodiscard]] static Result<PathFinder> make(const World& world, const PathConfig& config,
                                               Context& context);
  PathFinder(const PathFinder& other);
  PathFinder& operator=(const PathFinder& other);
  PathFinder(PathFinder&&) noexcept;
  PathFinder& operator=(PathFinder&&) noexcept;
  ~PathFinder();

  /// Finds the shortest any-angle path over all legal cells: no legal path is shorter by more than
  /// 1/1000 of a cell per corner. If the places are connected, a path is found; where legal cells
  /// side by side lie more than a step height apart, it may go from portal to portal and be a
  /// little longer. `path` is reused: its memory stays. When the budget is exhausted the search
  /// stops (Path::spent); with labels there is none. Between queries a finder keeps up to 64 MiB of
  /// search memory, and 16 bytes per corner.
  void find(const Place& from, const Place& to, Path& path, const SearchBudget& budget = {});

  [[nodiscard]] PathSummary summary() const;
  /// The rectangles and portals, for internal use. They live as long as the finder or a copy of it.
  [[nodiscard]] const PathMesh& mesh() const;

 private:
  struct Shared;
  struct Scratch;
  explicit PathFinder(std::shared_ptr<const Shared> shared);

  std::shared_ptr<const Shared> shared_;
  std::unique_ptr<Scratch> scratch_;
};

}  // namespace throng
