// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "throng/base.h"
#include "throng/surface.h"
#include "throng/world.h"

/// Paths: on foot, on changing ground, over nodes, through the air; flow fields; budgets of
/// searches.
namespace throng {

// ----
// Limits after which a search for a path stops without a result.

/// The part of a budget that a search exhausted.
enum class SpentBudget : uint8_t {
  kNone,
  kNodes,      ///< SearchBudget::max_nodes.
  kMemory,     ///< SearchBudget::max_bytes.
  kCancelled,  ///< SearchBudget::cancel was set.
};

/// The budget of a search. A plain number converts to `max_nodes`.
struct SearchBudget {
  /// Enough for every measured path over cities and landscapes, and small beside a machine's
  /// memory. [bytes]
  static constexpr uint64_t kDefaultBytes = uint64_t{256} << 20;

  // NOLINTNEXTLINE(google-explicit-constructor)
  SearchBudget(uint64_t nodes = UINT64_MAX, const std::atomic<bool>* stop = nullptr,
               uint64_t bytes = kDefaultBytes)
      : max_nodes(nodes), cancel(stop), max_bytes(bytes) {}

  uint64_t max_nodes;
  /// Set from any thread to stop; read every 64 nodes. May be null.
  const std::atomic<bool>* cancel;
  /// Limit of the memory of one query, beside what the finder holds of the world (corners, zones,
  /// labels). It counts what the query uses, not what earlier queries allocated, so the result is
  /// the same on every machine. [bytes]
  uint64_t max_bytes;

  /// Is the budget exhausted? Call it with 1, 2, 3 ... before each node is expanded.
  [[nodiscard]] bool is_spent(uint64_t nodes) const {
    return nodes > max_nodes || (cancel != nullptr && nodes % 64 == 1 && *cancel);
  }
  /// The same, with the memory of the search so far. [bytes]
  [[nodiscard]] bool is_spent(uint64_t nodes, uint64_t bytes) const {
    return bytes > max_bytes || is_spent(nodes);
  }
  /// Which part a search exhausted that stopped after so many nodes.
  [[nodiscard]] SpentBudget spent(uint64_t nodes) const {
    if (nodes > max_nodes) return SpentBudget::kNodes;
    return cancel != nullptr && *cancel ? SpentBudget::kCancelled : SpentBudget::kMemory;
  }
  /// The budget that is left after so many nodes.
  [[nodiscard]] SearchBudget after(uint64_t nodes) const {
    SearchBudget left = *this;
    left.max_nodes = nodes < max_nodes ? max_nodes - nodes : 0;
    return left;
  }
};

// ----
// Shortest paths for a class over the ground of a baked world.

/// What a PathFinder prepares so that queries are faster.
enum class PathSpeedup : uint8_t {
  kNone,  ///< Nothing: queries search.
  /// Hub labels of all corners: queries look paths up and do not search. For many queries. Labels
  /// take time and memory when the finder is made: about 10 kB per square metre of small worlds, 1
  /// kB of large ones (over some 2^23 cells). In large worlds a path may pass an obstacle on the
  /// wrong side; it is provably at most 2 % longer than the shortest (0.02 % on average over a
  /// city).
  kLabels,
  /// Paths inside each zone between the entrances of its borders, and labels of these entrances:
  /// for long paths over large worlds. A path between zones that do not touch is then the shortest
  /// that passes every obstacle on the same side, but it may pass one on the wrong side.
  kZones,
};

/// Settings for making a finder. A speedup or a slope cost that a finder does not have is refused
/// with kBadConfig.
struct PathConfig {
  int32_t avatar_class = 0;
  /// Not of PathFinder and FlightFinder. Cost of a metre on level tiles: 1 + slope_cost * rise.
  /// Rises are rounded up to 5, 10, 20, 35, 60 or 120 %; the gentlest class counts as level ground,
  /// the steepest holds all steeper slopes, too. Over nodes, on ground with an inclination a: 1 +
  /// slope_cost * (1 - cos a), so level ground 1, a wall 1 + slope_cost, a ceiling 1 + 2
  /// slope_cost. [0 to 1000]
  double slope_cost = 0;
  /// Of NodePathFinder: makes an overlay where there are many crossings (2^15), over which long
  /// paths are searched: it knows the costs of crossing squares of ground. Its paths are seldom
  /// much longer than the best. Making it takes as long as a few searches of the whole world.
  bool overlay = true;
  int32_t workers =
      0;  ///< Threads for making the finder, 0 for all cores; not of LiveGround. [>= 0]
  PathSpeedup speedup = PathSpeedup::kNone;  ///< Of PathFinder.
};

/// How a search ended.
enum class PathEnd {
  kReached,
  kUnreachable,      ///< No path on foot leads there.
  kNoPlace,          ///< `from` or `to` is no place of the class.
  kBudgetExhausted,  ///< The budget was exhausted: `spent` names the part.
};

/// How an avatar moves along a segment of a path.
enum class SegmentKind : uint8_t {
  kWalk,     ///< On the ground, or on the surface of one patch, straight by its parameters.
  kCross,    ///< Over nodes: straight through the air while the axis turns evenly. Over the edge of
             ///< a patch, where both points are (nearly) the same place by the parameters of two
             ///< patches; along a link over a hole; or out over an edge and then down.
  kOffMesh,  ///< Along an off-mesh link of LiveGround.
  kTakeOff,
  kFly,
  kLand,
};

/// A link that a path uses: it leads from the point before to `point`.
struct PathLink {
  uint32_t point = 0;
  LinkKind kind = LinkKind::kWalk;
  bool over_hole = false;  ///< Over a hole: between places that do not touch.
};

/// A path of any finder, or why there is none.
struct Path {
  PathEnd end = PathEnd::kNoPlace;
  /// Feet, from the start to the goal. They are places of level ground except over nodes and in the
  /// air, where `position` alone counts. If the goal is unreachable: to the reached place nearest
  /// to it (not of PathFinder, which then gives none).
  std::vector<Place> points;
  /// Over nodes: the place of each point, with its axis; else empty. In the air above the place of
  /// a drop it is nowhere, but has feet and axis.
  std::vector<NodePlace> node_places;
  std::vector<SegmentKind> segments;  ///< One fewer than the points.
  std::vector<PathLink> links;        ///< Over nodes and off-mesh links, in order of their points.
  std::vector<uint32_t> corridor;     ///< Over nodes: those from the start's to the goal's.
  /// Of all segments; along the ground's plane where a path is only on foot. [m]
  double length = 0;
  double cost = 0;  ///< Metres times their costs.
  /// Over nodes: cost of the search's path over crossings, before string pulling.
  double searched_cost = 0;
  /// What blocks the path to an unreachable goal, at its last point.
  Blocker blocked_by = Blocker::kNone;
  /// What the search expanded: intervals (0 with labels), points, air boxes, or crossings and
  /// boundary nodes of overlay cells.
  uint64_t nodes = 0;
  SpentBudget spent = SpentBudget::kNone;  ///< Which part of the budget was exhausted, if one was.

  /// From the feet to the head at a point. [unit]
  [[nodiscard]] Vec3d up(size_t point) const {
    return node_places.empty() ? Vec3d{0, 1, 0} : node_places[point].axis;
  }
};

/// Sizes of a PathFinder.
struct PathSummary {
  uint64_t rectangles = 0;
  uint64_t portals = 0;
  uint64_t corners = 0;
  uint64_t entrances = 0;  ///< Of zones; 0 without kZones.
  uint64_t labels = 0;     ///< 0 without kLabels.
  uint64_t bytes = 0;      ///< Of all.
  double seconds = 0;      ///< To make them.
};

/// Finds paths for one class. All copies share the ground; each copy has its own memory for
/// searching: give every thread one. No allocation once it is warm.
class THRONG_API PathFinder {
 public:
  /// Makes a finder. Reads every zone once. Fails with kBadConfig (no such class, a slope cost, or
  /// zones with too many corners for kZones), kBadFile (a zone cannot be used) or kCancelled.
  [[nodiscard]] static Result<PathFinder> create(const World& world, const PathConfig& config,
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

 private:
  friend struct Access;
  struct Shared;
  struct Scratch;
  explicit PathFinder(std::shared_ptr<const Shared> shared);

  std::shared_ptr<const Shared> state_;
  std::unique_ptr<Scratch> scratch_;
};

// ----
// The ground of a baked world for one class as it is now: with obstacles, doors, areas and area
// costs that have changed since the bake. Data is made when a query needs it, and a change
// discards only the tiles that it touches. Use it for large worlds that change; for many paths
// over a world that does not change, use a PathFinder.

/// An off-mesh link, see LiveGround::add_off_mesh_link.
struct OffMeshLink {
  Place from, to;
  double cost = 0;  ///< [m]
  bool two_way = true;
};

/// Names a change; 0 names none.
using ChangeId = uint32_t;

/// The ground of one class with changes. Obstacles only remove ground: an avatar can stand on a
/// crate only if it was baked. Changes and queries are for one thread at a time; copies are
/// independent. Results are the same on every machine.
class THRONG_API LiveGround {
 public:
  /// Makes the ground of a class; reads nothing yet. Fails with kBadConfig.
  [[nodiscard]] static Result<LiveGround> create(const World& world, const PathConfig& config);
  LiveGround(const LiveGround&);
  LiveGround& operator=(const LiveGround&);
  LiveGround(LiveGround&&) noexcept;
  LiveGround& operator=(LiveGround&&) noexcept;
  ~LiveGround();

  /// Puts up an obstacle: the class is illegal where its body, from body_bottom() up, could touch
  /// the prism. Fails with kBadInput. Time: the tiles that it touches.
  [[nodiscard]] Result<ChangeId> add_obstacle(const Prism& prism);
  /// The same for triangles. Only these are solid: a closed shell is hollow.
  [[nodiscard]] Result<ChangeId> add_obstacle(std::span<const Vec3d> corners,
                                              std::span<const std::array<uint32_t, 3>> triangles);
  /// Gives floors inside a prism an area kind; where several overlap, the last one counts.
  [[nodiscard]] Result<ChangeId> add_area(const Prism& prism, uint8_t kind);
  /// Adds an off-mesh link, which no move finds: over a ditch, up a ladder, by a lift. It leads
  /// from one place of the class to another, and back if `two_way`; what lies between is not
  /// tested. Its cost counts as metres and is at least its length in the plane. Fails with
  /// kBadInput.
  [[nodiscard]] Result<ChangeId> add_off_mesh_link(const OffMeshLink& off_mesh_link);
  /// Removes a change, or switches it off and on, as a door. False if there is none of this id.
  bool remove(ChangeId change);
  bool set_active(ChangeId change, bool active);
  /// Sets the cost of a metre on ground of an area kind; infinity closes it. All kinds begin with
  /// 1. Fails with kBadConfig. [kind 1 to 63, 0.01 to 10000 or infinity]
  [[nodiscard]] Result<void> set_area_cost(uint8_t kind, double cost);

  /// Is the place legal for the class now?
  [[nodiscard]] bool is_free(const Place& place);
  /// Finds a path of low cost; each segment is a legal move. The search goes over points on the
  /// borders of rectangles, and the path is pulled taut afterwards: on average within 1 % of the
  /// best. If no path leads to the goal (kUnreachable), `path` leads to the reached place nearest
  /// to it, and Path::blocked_by says what blocks it. Stops when the budget of points or memory is
  /// exhausted (Path::spent). No allocation once it is warm.
  void find(const Place& from, const Place& to, Path& path, const SearchBudget& budget = {});
  /// The same search in parts: call begin, then advance with some points per frame until it returns
  /// true. Stops where it would take more than SearchBudget::kDefaultBytes.
  void begin(const Place& from, const Place& to);
  bool advance(uint64_t max_nodes, Path& path);

 private:
  friend struct Access;
  struct State;
  explicit LiveGround(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

// ----
// Paths through the air of a baked world, from the ground and back to it.

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

/// Input of FlightFinder::find.
struct FlightQuery {
  /// Feet. In the air, or on the ground within `vertical_tolerance` above or below. [m]
  Vec3d from, to;
  double vertical_tolerance = 0.5;  ///< [m, >= 0]
  /// Counts air boxes, and for each path on foot its nodes. A search on foot ends before `cancel`
  /// is read.
  SearchBudget budget = {};
  /// If no single flight leads to the goal, search paths that land, walk and take off again.
  bool by_turns = true;
  /// If no path leads to the goal, find the path to the point that comes nearest. Linear in the air
  /// boxes.
  bool nearest = true;
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

 private:
  friend struct Access;
  struct Shared;
  struct Scratch;
  struct End;
  explicit FlightFinder(std::shared_ptr<const Shared> shared);

  bool locate(Vec3d at, double vertical_tolerance, End& end) const;
  void find_flight(const FlightQuery& query, Path& path);
  void find_by_turns(const FlightQuery& query, Path& path);
  size_t follow_route(const FlightQuery& query, const End& from, const End& to, Path& path);
  void find_nearest(const FlightQuery& query, Path& path);
  void find_nearest_on_foot(const FlightQuery& query, const Place& from, Path& path);
  PathEnd walk(const FlightQuery& query, const Place& from, const Place& to, Path& path);

  std::shared_ptr<const Shared> state_;
  std::unique_ptr<Scratch> scratch_;
};

// ----
// Paths over nodes, for every class and in particular for climbers: over walls and under ceilings.
// Source: [PACS00] 1.2.3; docs/design/006-nodes.md.

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
  [[nodiscard]] static Result<NodePathFinder> create(const Nodes& nodes, const PathConfig& config,
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
  /// is reused: its memory stays. Stops when the budget is exhausted. A path to an unreachable goal
  /// leads to the nearest reachable place, in three dimensions; if that is more than 25 m from the
  /// goal, or obstacles are up, to the nearest place in the block whose border comes nearest.
  void find(const NodePlace& from, const NodePlace& to, Path& path, double spacing = 0.25,
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

  std::shared_ptr<const Shared> state_;
  std::unique_ptr<Scratch> scratch_;
};

// ----
// Flow fields: the distance to the nearest of some goals from everywhere, by one search for all
// avatars that share these goals.

/// Settings for FlowField::create.
struct FlowConfig {
  /// Largest distance that is searched. [> 0, m]
  double max_distance = std::numeric_limits<double>::infinity();
};

/// Sizes of a flow field.
struct FlowSummary {
  uint64_t points = 0;  ///< Points on borders of rectangles that the search reached from the goals.
  uint64_t bytes = 0;
  double seconds = 0;  ///< To make it.
};

/// Distances to goals over points on the borders of rectangles, as LiveGround searches them. It
/// describes the ground at the time when it was made; if the ground changes, make another one.
/// Off-mesh links are ignored. Each copy has its own memory for queries; give every thread one.
class THRONG_API FlowField {
 public:
  /// Makes a field by one Dijkstra search. Goals that are no places of the class are ignored. Fails
  /// with kBadInput (no goal is left) or kCancelled.
  [[nodiscard]] static Result<FlowField> create(const LiveGround& ground,
                                                std::span<const Place> goals,
                                                const FlowConfig& config, Context& context);
  FlowField(const FlowField&);
  FlowField& operator=(const FlowField&);
  FlowField(FlowField&&) noexcept;
  FlowField& operator=(FlowField&&) noexcept;
  ~FlowField();

  /// Cost of the path to the nearest goal over the points: on average 1 to 2 % above the minimum.
  /// Infinite if no path leads there, or none within `max_distance`. [m]
  [[nodiscard]] double distance(const Place& place);
  /// The next local target: the farthest point of the path to the nearest goal to which a straight
  /// line leads. At last the goal itself; nowhere if no path leads there.
  [[nodiscard]] Place next(const Place& place);
  /// Finds the whole path to the nearest goal, pulled taut.
  void find_path(const Place& place, Path& path);

  [[nodiscard]] FlowSummary summary() const;

 private:
  struct State;
  explicit FlowField(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace throng
