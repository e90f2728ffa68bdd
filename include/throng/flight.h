// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "throng/base.h"
#include "throng/context.h"
#include "throng/live_ground.h"
#include "throng/math.h"
#include "throng/path.h"
#include "throng/prism.h"
#include "throng/result.h"
#include "throng/world.h"

/// Paths through the air of a baked world, from the ground and back to it.
namespace throng {

struct FlightSpace;

/// Sizes of a world's air.
struct AirSummary {
  double cell = 0;          ///< Side of a voxel. [m]
  double floor = 0;         ///< Lowest height of feet. [m]
  double ceiling = 0;       ///< Feet stay below; higher is open sky. [m]
  uint64_t zones = 0;       ///< Zones with solids; the others are all air.
  uint64_t bytes = 0;       ///< Of all air files.
  uint64_t nodes = 0;       ///< Air boxes of their octrees that are all free or mixed.
  uint64_t free_cells = 0;  ///< Free voxels in zones with solids, within their octrees.
};

/// Sums up the air of a world. Reads every air file once. Fails with kNotFound (the world was baked
/// without air) or kBadFile.
[[nodiscard]] THRONG_API Result<AirSummary> air_summary(const World& world);

/// Settings for FlightFinder::make.
struct FlightConfig {
  int32_t avatar_class = 0;  ///< A class that flies.
  int32_t workers = 0;       ///< Threads for making the finder, 0 for all cores.
};

/// How an avatar moves along a segment of a path.
enum class SegmentKind : uint8_t { kWalk, kTakeOff, kFly, kLand };

/// Input of FlightFinder::find.
struct FlightQuery {
  /// Feet. In the air, or on the ground within `vertical_tolerance` above or below. [m]
  Vec3d from, to;
  double vertical_tolerance = 0.5;  ///< [m, >= 0]
  /// Limit of air boxes expanded; of nodes, for each path on foot.
  uint64_t max_nodes = UINT64_MAX;
  /// SearchBudget::max_bytes of each flight and of each path on foot. [bytes]
  uint64_t max_bytes = SearchBudget::kDefaultBytes;
  /// Set from any thread to stop the search. A search on foot ends before it is read.
  const std::atomic<bool>* cancel = nullptr;
  /// If no single flight leads to the goal, search paths that land, walk and take off again.
  bool by_turns = true;
  /// If no path leads to the goal, find the path to the point that comes nearest. Linear in the air
  /// boxes.
  bool nearest = true;
};

/// A path through the air and over the ground, or why there is none.
struct FlightPath {
  PathEnd end = PathEnd::kNoPlace;
  /// Feet, from the start to the goal. If the goal is unreachable: to the nearest point of the air,
  /// or of the ground where the avatar cannot take off. [m]
  std::vector<Vec3d> points;
  std::vector<SegmentKind> segments;  ///< One fewer than the points.
  double length = 0;                  ///< Of all segments. [m]
  /// What blocks the straight line on to an unreachable goal: kLow where a lower body would pass,
  /// or where the avatar cannot take off, else kNarrow.
  Obstacle obstacle = Obstacle::kNone;
  uint64_t nodes = 0;                      ///< Air boxes that the search expanded.
  SpentBudget spent = SpentBudget::kNone;  ///< Which part of the budget was exhausted, if one was.
};

/// Sizes of a FlightFinder.
struct FlightSummary {
  uint64_t boxes = 0;  ///< Air boxes that are legal.
  uint64_t bytes = 0;  ///< Of the boxes and their index.
  double seconds = 0;  ///< To make them.
};

/// Finds paths for one class that flies. All copies share the legal air as it was baked; each copy
/// has its own obstacles and its own memory for searching, so give every thread one. Queries do not
/// allocate once they are warm.
class THRONG_API FlightFinder {
 public:
  /// Makes a finder. Reads every zone once. Fails with kNotFound (a world without air), kBadConfig
  /// (no such class, or it does not fly), kBadFile or kCancelled.
  [[nodiscard]] static Result<FlightFinder> make(const World& world, const FlightConfig& config,
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
  /// not always the shortest (docs/results.md). `path` is reused: its memory stays.
  void find(const FlightQuery& query, FlightPath& path);

  /// Puts up an obstacle: no path leads where the body could touch the prism; on the ground, as in
  /// LiveGround, the body counts from body_bottom() up. A start or goal inside is no place. Fails
  /// with kBadInput. Time: the air boxes that it touches and those of what it cuts off, up to 65
  /// 536.
  [[nodiscard]] Result<ChangeId> add_obstacle(const Prism& prism);
  /// The same for triangles. Only these are solid: a closed shell is hollow.
  [[nodiscard]] Result<ChangeId> add_obstacle(std::span<const Vec3d> corners,
                                              std::span<const std::array<uint32_t, 3>> triangles);
  /// Removes an obstacle, or switches it off and on, as a door. False if there is none of this id.
  bool remove(ChangeId change);
  bool set_active(ChangeId change, bool active);

  /// Is a point of the air legal for the feet? Constant time.
  [[nodiscard]] bool is_legal(Vec3d feet) const;
  /// The n-th of a reproducible stream of points, uniform over the legal air. Empty only if there
  /// is no legal air.
  [[nodiscard]] std::optional<Vec3d> random_point(uint64_t seed, uint64_t n) const;

  /// The end of the take-off from a place on the ground: where the feet come into the air, straight
  /// up. Empty if a solid blocks it.
  [[nodiscard]] std::optional<Vec3d> take_off(const Place& place) const;
  /// The place of a landing from a point of the air: straight down to the lowest air box, and there
  /// the best place: the one with the largest clearance, then the nearest to the box's axis
  /// [PACS00]. Nowhere if there is none.
  [[nodiscard]] Place landing(Vec3d feet) const;

  [[nodiscard]] FlightSummary summary() const;
  /// The legal air as it was baked, for internal use. It lives as long as the finder or a copy of
  /// it.
  [[nodiscard]] const FlightSpace& space() const;

 private:
  struct Shared;
  struct Scratch;
  struct End;
  explicit FlightFinder(std::shared_ptr<const Shared> shared);

  bool locate(Vec3d at, double vertical_tolerance, End& end) const;
  void find_flight(const FlightQuery& query, FlightPath& path);
  void find_by_turns(const FlightQuery& query, FlightPath& path);
  size_t follow_route(const FlightQuery& query, const End& from, const End& to, FlightPath& path);
  void find_nearest(const FlightQuery& query, FlightPath& path);
  void find_nearest_on_foot(const FlightQuery& query, const Place& from, FlightPath& path);
  PathEnd walk(const FlightQuery& query, const Place& from, const Place& to, Path& path);

  std::shared_ptr<const Shared> shared_;
  std::unique_ptr<Scratch> scratch_;
};

}  // namespace throng
