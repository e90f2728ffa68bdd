// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "path/edits/found_blocker.h"
#include "path/edits/ground_delays.h"
#include "path/edits/solid.h"
#include "path/ground/slice.h"
#include "throng/path.h"

/// Paths over ground with edits. Data is made when a query needs it, and a change discards only the
/// tiles that it touches.
namespace throng::path {

/// Fail with kBadConfig or kBadInput.
[[nodiscard]] Result<void> check_area(uint8_t kind);
[[nodiscard]] Result<void> check_area_cost(uint8_t kind, double cost);
[[nodiscard]] Result<void> check_link(const OffMeshLink& link);

/// Has it an end that only classes over nodes can stand at?
inline bool is_over_nodes(const OffMeshLink& link) {
  return link.from_on_nodes || link.to_on_nodes;
}

/// What a search finds if no path leads to the goal: a path to what is reachable and nearest to it
/// and what blocks it there, or nothing, which takes less time if little is connected with one of
/// both.
enum class IfUnreachable : uint8_t { kNearest, kNothing };

class DensityCells;

/// The ground of one class with changes. Obstacles only remove ground: an avatar can stand on a
/// crate only if it was baked. Changes and queries are for one thread at a time; copies are
/// independent. Results are the same on every machine.
class GroundFinder {
 public:
  /// Makes the ground of a class; reads nothing yet. Fails with kBadConfig.
  [[nodiscard]] static Result<GroundFinder> create(const World& world, const PathConfig& config);
  GroundFinder(const GroundFinder&);
  GroundFinder& operator=(const GroundFinder&);
  GroundFinder(GroundFinder&&) noexcept;
  GroundFinder& operator=(GroundFinder&&) noexcept;
  ~GroundFinder();

  /// Puts up an obstacle: the class is illegal where its body, from body_bottom() up, could touch
  /// the solid. Of triangles only these are solid: a closed shell is hollow. Time: the tiles that
  /// it touches.
  ChangeId add_obstacle(Solid solid);
  /// Gives floors inside a prism an area kind; where several overlap, the last one counts.
  [[nodiscard]] Result<ChangeId> add_area(const Prism& prism, uint8_t kind);
  /// Adds an off-mesh link, which no move finds: over a ditch, up a ladder, by a lift. It leads
  /// from one place of the class to another, and back if `two_way`; what lies between is not
  /// tested. Its cost counts as metres and may be less than its length. Fails with kBadInput.
  [[nodiscard]] Result<ChangeId> add_off_mesh_link(const OffMeshLink& off_mesh_link);
  /// Removes a change, or switches it off and on, as a door. False if there is none of this id.
  bool remove(ChangeId change);
  bool set_active(ChangeId change, bool active);
  /// Sets the cost of a metre on ground of an area kind; infinity closes it. All kinds begin with
  /// 1. Fails with kBadConfig. [kind 1 to 63, 0.01 to 10000 or infinity]
  [[nodiscard]] Result<void> set_area_cost(uint8_t kind, double cost);

  /// From now on this map applies, or none (null): its pixels of weight 0 are no ground, and
  /// metres cost what it says. Time: the tiles that were made.
  void set_density(std::shared_ptr<const DensityCells> density);

  /// Is the place legal for the class now?
  [[nodiscard]] bool is_free(const Place& place);
  /// Can a path over the baked ground still be walked? Looks at cells of changed tiles only.
  bool allows(const Path& path);
  /// Finds a path of low cost; each segment is a legal move. Where every metre costs the same and
  /// no off-mesh link is in force, it is the shortest. Else the search goes over points on the
  /// borders of rectangles, and the path is pulled taut afterwards: on average within 1 % of the
  /// best. If no path leads to the goal (kUnreachable), `path` leads to the reached place nearest
  /// to it, and Path::blocked_by says what blocks it. Stops when the budget of points or memory is
  /// exhausted (Path::spent). No allocation once it is warm.
  void find(const Place& from, const Place& to, Path& path, const SearchBudget& budget = {},
            IfUnreachable otherwise = IfUnreachable::kNearest);
  /// As find, by the search over points even where the shortest path could be searched: for what
  /// cannot be drawn over corners, because neighbouring cells that are both legal lie more than a
  /// step height apart and a shortest path may lead along the line between them.
  void find_over_points(const Place& from, const Place& to, Path& path,
                        const SearchBudget& budget = {});
  /// The same search in parts: call begin, then advance with some points per frame until it returns
  /// true. Stops where it would take more than SearchBudget::kDefaultBytes.
  void begin(const Place& from, const Place& to, IfUnreachable otherwise = IfUnreachable::kNearest);
  void begin_over_points(const Place& from, const Place& to);
  bool advance(uint64_t max_nodes, Path& path);
  /// The same within a budget of the whole search; true, too, when that is exhausted.
  bool advance(const SearchBudget& budget, Slice& slice, Path& path);

  /// Of a search by delays.
  struct DelayedSearch {
    const GroundDelays* delays = nullptr;  // [not null]
    double max_cost = 0;                   // of a path, in metres of free ground
    uint64_t max_clusters = 10'000;        // that the search for its corridor expands
    SearchBudget budget;                   // of that within the corridor
  };
  /// As find_over_points, but each metre costs more where avatars get on slowly now, no path costs
  /// more than `max_cost`, and none takes off-mesh links. It looks for a corridor first, over
  /// coarse ground, and may miss the best path by 8 %. True: a path was found (kReached);
  /// Path::cost is by delays. No allocation once it is warm.
  bool find_by_delays(const Place& from, const Place& to, const DelayedSearch& search, Path& path);
  /// Does a path lead around all that is closed on the same side as another from the same place? It
  /// does if it can be moved onto that over open ground. `whole`: both end at the same place; else
  /// the other goes on, within a metre of the path's end. A pillar less than a body wide may be
  /// overlooked. False if one is no legal path, too; true if it takes more than 5000 tests.
  /// Time: linear in their lengths if it is true, quadratic if not. No allocation once it is warm.
  bool is_same_side(std::span<const Place> path, std::span<const Place> other, bool whole);
  /// Of a straight segment, by delays, in metres of free ground; infinite if it is no legal move.
  [[nodiscard]] double delayed_length(const Place& from, const Place& to,
                                      const GroundDelays& delays);

  /// Rises where a change concerns what a search may have seen.
  [[nodiscard]] uint64_t version() const;

  /// What a straight line from one place of the class to another meets first.
  FoundBlocker blocker(const Place& from, const Place& to);

  struct State;
  /// For what works on the same ground (FlowPoints).
  [[nodiscard]] State& state() { return *state_; }

 private:
  explicit GroundFinder(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace throng::path
