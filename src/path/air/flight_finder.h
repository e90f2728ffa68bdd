// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "path/edits/solid.h"
#include "path/ground/slice.h"
#include "throng/path.h"

/// Paths through the air of a baked world, from the ground and back to it.
namespace throng::path {

struct FlightSpace;

/// Input of FlightFinder::find.
struct FlightQuery {
  /// Feet. In the air, or on the ground within `vertical_tolerance` above or below. [m]
  Vec3d from, to;
  double vertical_tolerance = 0.5;  ///< [m, >= 0]
  /// Of the whole query: air boxes and the nodes of all searches on foot.
  SearchBudget budget = {};
  /// If no single flight leads to the goal, search paths that land, walk and take off again.
  bool by_turns = true;
  /// If no path leads to the goal, find the path to the point that comes nearest. Linear in the air
  /// boxes.
  bool nearest = true;
};

/// Finds paths for one class that flies. All copies share the legal air as it was baked; each copy
/// has its own obstacles and its own memory for searching, so give every thread one. Queries do not
/// allocate once they are warm.
class FlightFinder {
 public:
  /// Makes a finder. Reads every zone once. Fails with kNotFound (a world without air), kBadConfig
  /// (no such class, or it does not fly), kBadFile or kCancelled.
  [[nodiscard]] static Result<FlightFinder> create(const World& world, const PathConfig& config,
                                                   Context& context);
  FlightFinder(const FlightFinder& other);
  FlightFinder& operator=(const FlightFinder& other);
  FlightFinder(FlightFinder&&) noexcept;
  FlightFinder& operator=(FlightFinder&&) noexcept;
  ~FlightFinder();

  /// Finds a short path: over the ground where that is shorter, else straight up from the ground,
  /// through the air and straight down; from a place where it cannot take off, it walks to one
  /// where it can. If the air at the start is connected with the air at the goal only over the
  /// ground, the path lands and walks in between, as few times as possible, by the first place
  /// found on each ground. The whole body passes everywhere. Paths through the air are taut, but
  /// not always the shortest (docs/results.md). An unreachable goal is approached to the nearest
  /// point of the air, or of the ground where the avatar cannot take off; Path::blocked_by is kLow
  /// where a lower body would pass, or where the avatar cannot take off, else kNarrow. `path` is
  /// reused: its memory stays.
  void find(const FlightQuery& query, Path& path);
  /// The same in parts: call begin, then advance until it returns true; `path` is then that of
  /// find, and before it counts what was expanded in the air and on foot. Two cells of a flood on
  /// foot to a take-off take as much of a slice as a node. Each string pulling, and each look for
  /// the air over both ends, is in one go and not counted. After a change or another query, begin
  /// again.
  void begin(const FlightQuery& query);
  bool advance(Slice& slice, Path& path);

  /// Puts up an obstacle: no path leads where the body could touch the solid; on the ground, as in
  /// GroundFinder, the body counts from body_bottom() up. Of triangles only these are solid: a
  /// closed shell is hollow. A start or goal inside is no place. Time: the air boxes that it
  /// touches and those of what it cuts off, up to 65 536.
  ChangeId add_obstacle(Solid solid);
  /// Removes an obstacle, or switches it off and on, as a door. False if there is none of this id.
  bool remove(ChangeId change);
  bool set_active(ChangeId change, bool active);

  /// Rises where a change concerns what a search may have seen.
  [[nodiscard]] uint64_t version() const;

  /// Could a path begin or end at a position, in the air or on the ground near it? [m]
  [[nodiscard]] bool is_end(Vec3d at, double vertical_tolerance) const;
  /// Is a point of the air legal for the feet? Constant time.
  [[nodiscard]] bool is_legal(Vec3d feet) const;
  /// Are both points in the air, and does no flight lead from one to the other? Constant time.
  [[nodiscard]] bool is_cut_off(Vec3d from, Vec3d to) const;
  /// The n-th of a reproducible stream of points, uniform over the legal air. Empty only if there
  /// is no legal air.
  [[nodiscard]] std::optional<Vec3d> random_point(uint64_t seed, uint64_t n) const;

  /// The end of the take-off from a place on the ground: where the feet come into the air, straight
  /// up. Empty if a solid blocks it.
  [[nodiscard]] std::optional<Vec3d> take_off(const Place& place) const;
  /// The place of a landing from a point of the air, straight down to the lowest air box: the one
  /// to which a link that the bake has stored leads from there (AirLinks), else the best under the
  /// box: the one with the largest clearance, then the nearest to the box's axis [PACS00]. Nowhere
  /// if there is none.
  [[nodiscard]] Place landing(Vec3d feet) const;

  [[nodiscard]] PathSummary summary() const;
  [[nodiscard]] const FlightSpace& space() const;

 private:
  struct Shared;
  struct Scratch;
  struct End;
  explicit FlightFinder(std::shared_ptr<const Shared> shared);

  [[nodiscard]] static bool is_cancelled(const FlightQuery& query);
  bool locate(Vec3d at, double vertical_tolerance, End& end) const;
  void find_flight(const FlightQuery& query, Path& path);
  void find_by_turns(const FlightQuery& query, Path& path);
  size_t follow_route(const FlightQuery& query, const End& from, const End& to, Path& path);
  void find_nearest(const FlightQuery& query, Path& path);
  void find_nearest_on_foot(const FlightQuery& query, const Place& from, Path& path);
  const Path& walk(const FlightQuery& query, const Place& from, const Place& to);

  std::shared_ptr<const Shared> state_;
  std::unique_ptr<Scratch> scratch_;
};

}  // namespace throng::path
