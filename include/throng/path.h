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

/// Shortest ways for a class over the ground of a baked world.
namespace throng {

struct PathMesh;  // Internal: rectangles and portals.

struct PathConfig {
  int32_t avatar_class = 0;
  int32_t workers = 0;  ///< Threads for making the finder, 0 for all cores.
  /// Also label all corners, so that a query looks the way up instead of searching for it: for
  /// many queries. Takes time and memory when the finder is made: of the order of 10 kB for each
  /// square metre of small worlds, 1 kB of large ones (over some 2^23 cells). In large ones a way
  /// may pass something on the wrong side; it is proved to be no more than 2 % longer than the
  /// shortest, and hardly ever is (0.02 % on average over a city).
  bool labels = false;
  /// Also work out the ways inside each zone between the gates of its borders, and label the gates:
  /// for long ways over large worlds. A way between zones that do not touch is then the shortest of
  /// those that pass every obstacle on the same side, but may pass one on the wrong side.
  bool zones = false;
};

/// How a search ended.
enum class PathEnd {
  kReached,
  kUnreachable,      ///< No way on foot leads there.
  kNoPlace,          ///< `from` or `to` is no place of the class.
  kBudgetExhausted,  ///< The budget was spent: `spent` says which part of it.
};

struct Path {
  PathEnd end = PathEnd::kNoPlace;
  std::vector<Place> points;  ///< From the start to the goal; each leg is a legal move.
  double length = 0;          ///< Along the ground's plane. [m]
  std::vector<uint32_t>
      off_mesh_links;  ///< Of LiveGround's: points that a jump leads to, not a move.
  double cost = 0;     ///< Of LiveGround's ways: metres times what they cost.
  Obstacle obstacle =
      Obstacle::kNone;  ///< Of LiveGround's: what is in the way to an unreachable goal.
  uint64_t nodes = 0;   ///< Intervals that the search looked at; 0 with labels.
  /// What there was too little of, if the search gave up.
  SpentBudget spent = SpentBudget::kNone;
};

struct PathSummary {
  uint64_t rectangles = 0;
  uint64_t portals = 0;
  uint64_t corners = 0;
  uint64_t entrances = 0;  ///< Of zones; 0 without them.
  uint64_t labels = 0;     ///< 0 without them.
  uint64_t bytes = 0;      ///< Of all.
  double seconds = 0;      ///< To make them.
};

/// Finds paths for one class. The ground is shared by all copies; each copy has its own memory for
/// searching: give every thread one. No allocation once it is warm.
class THRONG_API PathFinder {
 public:
  /// Reads every zone once. Fails with kBadConfig (no such class, or zones with too many corners
  /// for `zones`), kBadFile (a zone cannot be used) or kCancelled.
  [[nodiscard]] static Result<PathFinder> make(const World& world, const PathConfig& config,
                                               Context& context);
  PathFinder(const PathFinder& other);
  PathFinder& operator=(const PathFinder& other);
  PathFinder(PathFinder&&) noexcept;
  PathFinder& operator=(PathFinder&&) noexcept;
  ~PathFinder();

  /// The shortest way from one place to another over all legal cells, any angle: no legal way is
  /// shorter by more than 1/1000 of a cell a corner. Wherever places hold together a way is found;
  /// where legal cells side by side lie more than a step apart, it may be one from portal to portal
  /// that is a little longer. `path` is reused: its memory stays. When the budget is spent the
  /// search gives up (Path::spent); with labels there is none. Between queries a finder keeps up to
  /// 64 MiB of what it searches with, and 16 bytes for each corner.
  void find(const Place& from, const Place& to, Path& path, const SearchBudget& budget = {});

  [[nodiscard]] PathSummary summary() const;
  /// What it searches on, for the library itself; as old as the finder and its copies.
  [[nodiscard]] const PathMesh& mesh() const;

 private:
  struct Shared;
  struct Scratch;
  explicit PathFinder(std::shared_ptr<const Shared> shared);

  std::shared_ptr<const Shared> shared_;
  std::unique_ptr<Scratch> scratch_;
};

}  // namespace throng
