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

/// Ways through the air of a baked world, from the ground and back to it.
namespace throng {

struct FlightSpace;

/// The air of a world.
struct AirSummary {
  double cell = 0;          ///< Side of an air cell. [m]
  double floor = 0;         ///< Lowest feet. [m]
  double ceiling = 0;       ///< Feet stay below; what is higher is open sky. [m]
  uint64_t zones = 0;       ///< With matter; all others are nothing but air.
  uint64_t bytes = 0;       ///< Of all air files.
  uint64_t nodes = 0;       ///< Of their octrees that are all free or mixed blocks.
  uint64_t free_cells = 0;  ///< In zones with matter, within their octrees.
};

/// Reads every air file once. Fails with kNotFound (the world was baked without air) or kBadFile.
[[nodiscard]] THRONG_API Result<AirSummary> air_summary(const World& world);

struct FlightConfig {
  int32_t avatar_class = 0;  ///< One that flies.
  int32_t workers = 0;       ///< Threads for making the finder, 0 for all cores.
};

/// How a leg of a way is gone.
enum class SegmentKind : uint8_t { kWalk, kTakeOff, kFly, kLand };

struct FlightQuery {
  Vec3d from,
      to;  ///< Feet. In the air, or on the ground within `vertical_tolerance` above or below. [m]
  double vertical_tolerance = 0.5;  ///< [m, >= 0]
  uint64_t max_nodes = UINT64_MAX;  ///< Boxes that may be looked at; nodes, of each way on foot.
  /// As SearchBudget::max_bytes, of each flight and of each way on foot. [bytes]
  uint64_t max_bytes = SearchBudget::kDefaultBytes;
  /// Set from any thread to give up. A search on foot is gone through with before it is looked at.
  const std::atomic<bool>* cancel = nullptr;
  /// Where no one flight leads there, look for ways that land, walk and take off again.
  bool by_turns = true;
  /// Where nothing leads there, find the way to what comes nearest. Linear in the boxes.
  bool nearest = true;
};

struct FlightPath {
  PathEnd end = PathEnd::kNoPlace;
  /// Feet, from the start to the goal. If that is unreachable: to the point of the air that comes
  /// nearest to it, or of the ground where nobody can take off. [m]
  std::vector<Vec3d> points;
  std::vector<SegmentKind> segments;  ///< One less than the points.
  double length = 0;                  ///< Of all legs. [m]
  /// What is in the straight way on to an unreachable goal: kLow where a body that is less tall
  /// would go on, or where it cannot take off, else kNarrow.
  Obstacle obstacle = Obstacle::kNone;
  uint64_t nodes = 0;                      ///< Boxes that the search looked at.
  SpentBudget spent = SpentBudget::kNone;  ///< What there was too little of, if it gave up.
};

struct FlightSummary {
  uint64_t boxes = 0;  ///< Cubes of legal air.
  uint64_t bytes = 0;  ///< Of them and what finds them.
  double seconds = 0;  ///< To make them.
};

/// Finds ways for one class that flies. The legal air as it was baked is shared by all copies; each
/// copy has its own obstacles and its own memory for searching: give every thread one. Queries do
/// not allocate once they are warm.
class THRONG_API FlightFinder {
 public:
  /// Reads every zone once. Fails with kNotFound (a world without air), kBadConfig (no such class,
  /// or it does not fly), kBadFile or kCancelled.
  [[nodiscard]] static Result<FlightFinder> make(const World& world, const FlightConfig& config,
                                                 Context& context);
  FlightFinder(const FlightFinder& other);
  FlightFinder& operator=(const FlightFinder& other);
  FlightFinder(FlightFinder&&) noexcept;
  FlightFinder& operator=(FlightFinder&&) noexcept;
  ~FlightFinder();

  /// A short way: over the ground where that is shorter, else from the ground straight up into the
  /// air, through it, and down again; a place under which nothing can take off is walked from. Air
  /// that hangs together with the goal's only over the ground is left for the ground in between,
  /// as few times as can be, where the first place of each ground is taken for it. The whole body
  /// passes. Ways through the air are taut, not always the shortest (docs/results.md).
  /// `path` is reused: its memory stays.
  void find(const FlightQuery& query, FlightPath& path);

  /// Nobody flies, takes off, lands, stands or walks where his body could touch the prism from now
  /// on; on the ground, as LiveGround has it, its bottom is above his step. Ends there are no
  /// places. Fails with kBadInput. Time: the boxes of air that it touches, and those of what it
  /// cuts off, up to 65 536.
  [[nodiscard]] Result<ChangeId> add_obstacle(const Prism& prism);
  /// The same for triangles, and only for those: a closed shell is hollow.
  [[nodiscard]] Result<ChangeId> add_obstacle(std::span<const Vec3d> corners,
                                              std::span<const std::array<uint32_t, 3>> triangles);
  /// Takes an obstacle away, for good or, as a door, until it is set again. False if there is none.
  bool remove(ChangeId change);
  bool set_active(ChangeId change, bool active);

  /// May the feet be there, in the air? Constant time.
  [[nodiscard]] bool is_legal(Vec3d feet) const;
  /// The n-th of a reproducible stream of points, uniform over the legal air. No point only if
  /// there is none.
  [[nodiscard]] std::optional<Vec3d> random_point(uint64_t seed, uint64_t n) const;

  /// Where feet at a place on the ground come into the air, straight up; nothing where matter is in
  /// the way.
  [[nodiscard]] std::optional<Vec3d> take_off(const Place& place) const;
  /// The ground under a point of the air, straight down to the lowest box of air and there the best
  /// place: the most clear of all, then the nearest to the box's axis [PACS00]. Nowhere if there is
  /// none.
  [[nodiscard]] Place landing(Vec3d feet) const;

  [[nodiscard]] FlightSummary summary() const;
  /// The legal air as it was baked, for the library itself; as old as the finder and its copies.
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
