// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <optional>

#include "path/air/flight_finder.h"
#include "path/edits/edit_list.h"
#include "path/edits/ground_finder.h"
#include "path/overlay/mesh_finder.h"
#include "path/overlay/node_finder.h"
#include "throng/path.h"

/// What a PathFinder holds.
namespace throng {

struct PathFinder::State {
  World world;
  PathConfig config;  // its space is not kOfClass
  PathSummary summary;

  // Of the space. On the ground `live` has edits and costs; made when a query needs it.
  std::optional<path::MeshFinder> mesh;
  std::optional<path::GroundFinder> live;
  std::optional<path::NodeFinder> nodes;
  std::optional<path::FlightFinder> flight;
  path::AppliedEdits applied;  // by `live`, `nodes` or `flight`

  // The query in parts. What it has found is the finder's that it searches with, so another query
  // there, or an edit of what it may have seen, makes it begin again. Edits do so kMaxRestarts
  // times: from then on neither this query nor look-ups make the finder follow them before the
  // query has ended.
  static constexpr uint32_t kMaxRestarts = 4;
  PathQuery begun;
  bool is_begun = false;
  bool is_disturbed = false;
  uint32_t restarts = 0;
  uint64_t begun_version = 0;  // of the edits that it knows, or that do not concern it
  uint64_t begun_finder = 0;   // finder_version() when it began
  uint64_t begun_nodes = 0;    // expanded so far
  // On the ground: what its search leads to.
  enum class Target : uint8_t {
    kGoal,
    kNearest,  // the nearest place that is connected, as far as the mesh knows
    kFlood,    // obstacles cut that off: the nearest of all that is reached
    kNothing,  // the goal is not connected
  };
  Target target = Target::kGoal;
  Place begun_from, begun_to;
  uint64_t nodes_before = 0;  // expanded before the flood

  [[nodiscard]] const path::EditList& edits() const;
  /// Area kinds of the mesh, see EditList::has_costs; without a mesh all paths are searched with
  /// costs.
  [[nodiscard]] uint64_t baked_kinds() const { return mesh ? mesh->mesh().kinds : 0; }
  /// May paths on the ground differ from those of the mesh?
  [[nodiscard]] bool bears_on_ground() const { return edits().bears_on_ground(baked_kinds()); }
  /// The finder of ground with edits, up to date.
  path::GroundFinder& ground();
  /// The same apart from this finder, of any class that has ground.
  [[nodiscard]] path::GroundFinder ground_of_its_own() const;
  [[nodiscard]] Place place_of(const PathPoint& point, double tolerance) const;
  [[nodiscard]] NodePlace node_place_of(const PathPoint& point, double tolerance);
  void find_on_ground(const Place& from, const Place& to, path::IfUnreachable otherwise,
                      const SearchBudget& budget, Path& path);
  void find_connected(const Place& from, const Place& to, path::IfUnreachable otherwise,
                      const SearchBudget& budget, Path& path);
  /// Does the mesh know that nothing connects the two? Both must be free, too.
  [[nodiscard]] bool is_apart(const Place& from, const Place& to) const;
  bool are_free(const Place& from, const Place& to);
  /// Of what is connected with a place, the place nearest to another one, as far as the mesh knows.
  Place nearest_connected(const Place& from, const Place& to);
  /// Of a path to that place: it does not lead to the goal.
  void end_before(const Place& to, Path& path);
  void find_over_nodes(const PathQuery& query, Path& path);
  void find_in_air(const PathQuery& query, Path& path);
  void begin_over_nodes(const PathQuery& query);
  void begin_in_air(const PathQuery& query);
  void begin_on_ground();
  void trim_ground(const SearchBudget& budget);
  /// Applies edits to the finder that searches.
  void follow_edits();
  /// The same for what is no query, such as is_free: not if that would keep a query in parts from
  /// ever ending.
  void follow_edits_to_look_up();
  /// Rises where these concern what a search of that finder may have seen.
  [[nodiscard]] uint64_t finder_version() const;
  /// Do edits since begun_version change a place of the ground, a link, or a cost of some ground?
  [[nodiscard]] bool are_on_ground();
  /// Does an area's cost differ from the one that `live` knows, and may some ground have it?
  [[nodiscard]] bool is_cost_on_ground(uint8_t kind);
  /// Does an edit of an obstacle or an area change cells, from what `live` knows to what is now?
  [[nodiscard]] bool is_on_ground(EditId id);
  bool must_begin_again();
  bool advance_on_ground(path::Slice& slice, Path& path);
  void begin();
  bool advance(path::Slice& slice, Path& path);
};

}  // namespace throng
