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
#include <variant>
#include <vector>

#include "throng/base.h"
#include "throng/surface.h"
#include "throng/world.h"

/// Paths: on foot, over nodes, through the air, around run-time obstacles; flow fields; budgets of
/// searches.
namespace throng {

// ----
// Limits after which a search for a path stops without a result.

/// The part of a budget that a search exhausted.
enum class SpentBudget : uint8_t {
  kNone,       ///< The search has ended by itself.
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

  uint64_t max_nodes;  ///< Limit of the nodes that are expanded (Path::nodes).
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
  /// The part that is exhausted, of a search that stopped after so many nodes.
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

/// What a PathFinder prepares so that queries are faster. Only on the ground.
enum class PathSpeedup : uint8_t {
  kNone,  ///< The rectangles of the whole ground: queries search over them.
  /// Hub labels of all corners: queries look paths up and do not search. For many queries. Labels
  /// take time and memory when the finder is made: about 10 kB per square metre of small worlds, 1
  /// kB of large ones (over some 2^23 cells). In large worlds a path may pass an obstacle on the
  /// wrong side; it is provably at most 2 % longer than the shortest (0.02 % on average over a
  /// city).
  kLabels,
  /// Paths inside each zone between the entrances of its borders, and labels of these entrances:
  /// for long paths over large worlds. Between zones that do not touch, a path may pass an obstacle
  /// on the wrong side; no path that passes every obstacle on the same side as it is shorter.
  kZones,
  /// Nothing, not even the ground: data is made where a query needs it. For few queries in large
  /// worlds, or for worlds that change often. Paths are as short as with kNone.
  kOnDemand,
};

/// What a PathFinder searches.
enum class PathSpace : uint8_t {
  kOfClass,  ///< kAir if the class flies, kNodes if it climbs or drops, else kGround.
  kGround,   ///< Level tiles, on foot.
  kNodes,    ///< The nodes of all surfaces.
  kAir,      ///< The air, and the ground for walks between flights.
};

/// An off-mesh link, see Edits::add_off_mesh_link. A link of the bake (NodeOffMeshLink) is another
/// type, because files hold it for one class and without a cost: that is its length.
struct OffMeshLink {
  Place from = {}, to = {};  ///< Where a class can stand.
  double cost = 0;           ///< What it costs to take it, as metres of ground. [m, > 0]
  bool two_way = true;
  /// Ends on nodes, as on a wall, instead of `from` and `to`. A link that has one is only for
  /// classes over nodes.
  NodePlace from_on_nodes = {}, to_on_nodes = {};
};

/// A picture seen from above whose brightness says how many people walk where: [TC00] 5.
struct DensityGrid {
  double x0 = 0, z0 = 0, x1 = 0, z1 = 0;  ///< Corners of the picture. [m, x0 < x1, z0 < z1]
  double low = -1e6, high = 1e6;          ///< Heights of the floors to which it applies. [m]
  int32_t width = 0, height = 0;          ///< [pixels, 1 to 16384]
  std::vector<uint8_t> weights;           ///< Row by row, Z grows downwards; 0: none.
};

/// Names an edit; 0 names none. An id is never given twice.
using EditId = uint32_t;

/// How an obstacle affects paths. Avatars of crowds avoid both kinds as walls.
enum class ObstacleKind : uint8_t {
  kStatic,  ///< Paths lead around it: a crate, a door.
  /// Paths, flow fields and what blocks a path ignore it: a cart, which is elsewhere by the time
  /// that an avatar comes there.
  kKinematic,
};

/// What a crowd does with an obstacle that is requested where avatars stand.
enum class ObstaclePolicy : uint8_t {
  /// It closes: from the request on no avatar enters its volume, paths lead around it, and avatars
  /// inside walk out: along their paths if these lead out soon, else by the shortest path. It comes
  /// up as soon as no body is inside.
  kRefuseEntry,
  /// It waits until no body is inside; until then avatars walk in and out.
  kWait,
};

namespace path {
struct EditList;  // Internal.
}

/// Changes of a world at run time, in one list for all finders and crowds: obstacles, doors, area
/// kinds and their costs, off-mesh links. Copies of a handle share the list. A PathFinder that was
/// made with one applies each edit before its next query; a Crowd before its next step, and before
/// avatars are added, in the order of the calls (CrowdConfig::edits). In the air only obstacles
/// count: areas and links do not apply. Edits add no ground: an avatar can stand on a crate only if
/// it was baked. No edit may be made while another thread uses a handle of the same list, or a
/// finder or a crowd that has one. The list never shrinks: a removed edit leaves about 330 bytes.
class THRONG_API Edits {
 public:
  /// An empty list, which no other handle has.
  Edits();

  /// Adds an obstacle: a class cannot stand where its body could touch the prism; on the ground
  /// the body counts from body_bottom() up. Finders know only those that are kStatic. A crowd lets
  /// it come up by its policy once no body is inside (Crowd::obstacle says whether it has). Fails
  /// with kBadInput. Time: constant. Later, once for each finder and crowd: on the ground and in
  /// the air the next query takes time for what the obstacle touches, over nodes time linear in all
  /// active edits; the next step of a crowd takes time for what the obstacle touches, and time
  /// linear in all avatars.
  [[nodiscard]] Result<EditId> add_obstacle(const Prism& prism,
                                            ObstacleKind kind = ObstacleKind::kStatic,
                                            ObstaclePolicy policy = ObstaclePolicy::kRefuseEntry);
  /// The same for triangles. Only these are solid: a closed shell is hollow. Crowds take the box
  /// around them.
  [[nodiscard]] Result<EditId> add_obstacle(std::span<const Vec3d> corners,
                                            std::span<const std::array<uint32_t, 3>> triangles,
                                            ObstacleKind kind = ObstacleKind::kStatic,
                                            ObstaclePolicy policy = ObstaclePolicy::kRefuseEntry);
  /// Moves an obstacle to a new place, also one that is switched off. Finders know it there at
  /// once. In a crowd it waits while an avatar stands within the convex hull of the old and the new
  /// place, so move it by small distances; avatars may enter the hull, whatever the policy. If it
  /// still waits for an earlier move, that one is dropped. Fails with kBadInput (a bad prism, or
  /// the obstacle is of triangles) and kNotFound (no obstacle has this id).
  [[nodiscard]] Result<void> move_obstacle(EditId obstacle, const Prism& prism);
  /// Gives what lies inside a prism an area kind: cells of level tiles and, over nodes, squares of
  /// curved ground of about a quarter of a metre, each by its middle. Where several overlap, the
  /// last one counts. Not in the air. Fails with kBadInput or kBadConfig.
  [[nodiscard]] Result<EditId> add_area(const Prism& prism, uint8_t kind);
  /// Adds an off-mesh link, which no move finds: over a ditch, up a ladder, by a lift. It leads
  /// from one place to another, and back if `two_way`; what lies between is not tested. Its cost
  /// counts as metres and may be less than its length. For classes that can stand at both ends, on
  /// the ground or over nodes, and avatars of crowds that walk; not in the air, and not for
  /// climbers of crowds. Fails with kBadInput.
  [[nodiscard]] Result<EditId> add_off_mesh_link(const OffMeshLink& link);
  /// Removes an edit, or switches it off and on, as a door: in a crowd true closes it by its
  /// policy, false opens it at once or ends its closing. False if there is none of this id.
  bool remove(EditId edit);
  bool set_active(EditId edit, bool active);
  /// Sets the cost of a metre on ground of an area kind, which the bake or an area gave; infinity
  /// closes it: no path begins, leads or ends there. All kinds begin with 1. Over nodes, only areas
  /// of Edits have kinds. Fails with kBadConfig. [kind 1 to 63, 0.01 to 10000 or infinity]
  [[nodiscard]] Result<void> set_area_cost(uint8_t kind, double cost);

  /// Rises with every change of the list.
  [[nodiscard]] uint64_t version() const;

 private:
  friend struct Access;
  std::shared_ptr<path::EditList> state_;
};

/// Settings of a PathFinder. A speedup or a cost (of slopes, narrow or low ground) that its space
/// does not have is refused with kBadConfig; other settings of another space are ignored.
struct PathConfig {
  int32_t avatar_class = 0;
  /// On the ground, cost of a metre on level tiles: 1 + slope_cost * rise. Rises are rounded up to
  /// 5, 10, 20, 35, 60 or 120 %, but up to 5 % counts as level ground, and anything steeper than
  /// the last as that. Only with PathSpeedup kNone or kOnDemand. Over nodes, on ground with an
  /// inclination a: 1 + slope_cost * (1 - cos a), so level ground 1, a wall 1 + slope_cost, a
  /// ceiling 1 + 2 slope_cost. Not in the air. [0 to 1000]
  double slope_cost = 0;
  /// Over nodes: additional cost of a metre where nodes promise no more width than the body's
  /// radius; less where they promise more, in proportion, to 0 at their largest width, the last
  /// edge of NodeBins. Avatars then keep to wide ground. [0 to 1000]
  double narrow_cost = 0;
  /// Over nodes: the same for the free height, between the body's own and that of the tallest class
  /// (the last edge of NodeBins). [0 to 1000]
  double low_cost = 0;
  /// Over nodes, if there are 2^15 crossings or more: makes an overlay, which has the costs of
  /// crossing squares of ground, and searches long paths over it. Such a path is seldom much longer
  /// than the best. Making the overlay takes as long as a few searches of the whole world.
  bool overlay = true;
  int32_t workers = 0;  ///< Threads for making the finder, 0 for all cores. [>= 0]
  PathSpeedup speedup = PathSpeedup::kNone;
  /// With kOnDemand: ground that queries have made counts to SearchBudget::max_bytes as well. What
  /// takes more than half of that is forgotten before the next query.
  bool counts_ground = false;
  PathSpace space = PathSpace::kOfClass;
  Nodes nodes = {};  ///< Over nodes: the ones to use. Empty: those in the world's folder.
  Edits edits = {};  ///< Changes of the world that paths follow.
};

/// How a search ended.
enum class PathEnd {
  kReached,          ///< At the goal.
  kUnreachable,      ///< No path leads to the goal.
  kNoPlace,          ///< `from` or `to` is no place of the class.
  kBudgetExhausted,  ///< The budget was exhausted: `spent` names the part.
};

/// How an avatar moves along a segment of a path.
enum class SegmentKind : uint8_t {
  kWalk,  ///< On the ground; over nodes, on one patch, in a straight line of its parameters.
  /// Over nodes, between two patches: in a straight line through the air, while the axis turns
  /// evenly. The patches meet there (both points are nearly the same), or the path takes a link
  /// over a hole. On a drop link: horizontally out over the edge, then straight down.
  kCross,
  kOffMesh,  ///< Along an off-mesh link of Edits; over nodes, as kCross.
  kTakeOff,  ///< Straight up, from the ground into the air.
  kFly,      ///< Through the air.
  kLand,     ///< Straight down, from the air to the ground.
};

/// A link that a path uses: it leads from the point before to `point`.
struct PathLink {
  uint32_t point = 0;  ///< Index into Path::points, at least 1.
  LinkKind kind = LinkKind::kWalk;
  bool over_hole = false;  ///< Over a hole: between places that do not touch.
};

/// A path of any finder, or why there is none.
struct Path {
  PathEnd end = PathEnd::kNoPlace;
  /// Feet, from the start to the goal. They are places of level ground except over nodes and in the
  /// air, where `position` alone counts. If the goal is unreachable, they lead to the reachable
  /// place nearest to it; on the ground and in the air only with PathQuery::nearest.
  std::vector<Place> points;
  /// Over nodes: the place of each point, with its axis; else empty. The point of a drop link that
  /// is in the air, above the landing, has feet and axis, but node1 is 0.
  std::vector<NodePlace> node_places;
  std::vector<SegmentKind> segments;  ///< One fewer than the points.
  std::vector<PathLink> links;        ///< Over nodes and off-mesh links, in order of their points.
  std::vector<uint32_t> corridor;     ///< Over nodes: all from the start to the goal.
  /// Of all segments; of a path that is only on foot, as seen from above, off-mesh links included.
  /// [m]
  double length = 0;
  double cost = 0;  ///< Metres of the length times their costs, and the costs of off-mesh links.
  /// Over nodes: cost of the search's path over crossings, before string pulling.
  double searched_cost = 0;
  /// What blocks the path to an unreachable goal: what a straight line from its last point to the
  /// goal meets first. An edit that cuts the path is kObstacle or kClosed.
  Blocker blocked_by = Blocker::kNone;
  /// With kObstacle, an obstacle that does; with kClosed, the area, or 0 if the bake gave the kind.
  /// Else 0.
  EditId blocked_by_edit = 0;
  /// What the search expanded: intervals (0 with labels), points, air boxes, or crossings and
  /// boundary nodes of overlay cells.
  uint64_t nodes = 0;
  SpentBudget spent = SpentBudget::kNone;  ///< Which part of the budget was exhausted, if one was.

  /// From the feet to the head at a point. [unit]
  [[nodiscard]] Vec3d up(size_t point) const {
    return node_places.empty() ? Vec3d{0, 1, 0} : node_places[point].axis;
  }
};

/// Sizes of a PathFinder; 0 for what it does not have.
struct PathSummary {
  uint64_t rectangles = 0;  ///< Of the ground.
  uint64_t portals = 0;     ///< Between rectangles.
  uint64_t corners = 0;     ///< Around which the shortest paths turn.
  uint64_t entrances = 0;   ///< Of zones, with kZones.
  uint64_t labels = 0;      ///< With kLabels or kZones.
  uint64_t blocks = 0;      ///< Over nodes: squares of patches where the class can stand.
  uint64_t crossings = 0;   ///< Over nodes: connections between blocks.
  uint64_t boxes = 0;       ///< Legal boxes of the air.
  uint64_t bytes = 0;       ///< Of all.
  double seconds = 0;       ///< To make them.
};

/// An end of a path: a position, near which a place is looked for, or a place.
using PathPoint = std::variant<Vec3d, Place, NodePlace>;

/// Input of PathFinder::find.
struct PathQuery {
  PathPoint from, to;
  /// How far from an end that is a position its place may be: straight above or below; over nodes,
  /// in any direction. [m, >= 0]
  double tolerance = 0.5;
  /// Over nodes: largest distance between points of the path on curved ground; smaller values
  /// count as 0.01. [m, >= 0.01]
  double spacing = 0.25;
  /// In the air: if no single flight leads to the goal, search paths that land, walk and take off
  /// again.
  bool by_turns = true;
  /// If no path leads to the goal, find the path to what is reachable and nearest to it, heights
  /// counted, and what blocks it there. It costs a look around the goal and one more search. On the
  /// ground, all that is reachable is searched if it is not known beforehand what is connected:
  /// where obstacles cut the goal off, while an off-mesh link is in force, with kOnDemand, and with
  /// a slope cost. That takes up to a second in a city. Over nodes the setting is ignored: it is
  /// always done.
  bool nearest = false;
  SearchBudget budget = {};
};

/// Finds paths for one class: on foot, over nodes or through the air, as the class does. All copies
/// share what was made of the world; each has its own memory for searching and follows the edits by
/// itself: give every thread one. No allocation once it is warm. Results are the same on every
/// machine and for any number of threads.
class THRONG_API PathFinder {
 public:
  /// Makes a finder. Reads every zone once, except with kOnDemand. Fails with kBadConfig (no such
  /// class, or a setting that its space does not have), kBadInput (an empty world), kNotFound (no
  /// air), kBadFile (no nodes, or a zone cannot be used) or kCancelled.
  [[nodiscard]] static Result<PathFinder> create(const World& world, const PathConfig& config,
                                                 Context& context);
  PathFinder(const PathFinder& other);
  PathFinder& operator=(const PathFinder& other);
  PathFinder(PathFinder&&) noexcept;
  PathFinder& operator=(PathFinder&&) noexcept;
  ~PathFinder();

  /// Finds a path and says why there is none. `path` is reused: its memory stays.
  ///
  /// On the ground, where nothing but length counts: the shortest any-angle path over all cells
  /// that are legal now, around obstacles too; no legal path is shorter by more than 1/1000 of a
  /// cell per corner. If the places are connected, one is found; where legal cells side by side lie
  /// more than a step height apart, it may go from portal to portal and be a little longer. With
  /// labels there is no search, unless an obstacle cuts the path. Where areas or slopes cost more
  /// or an off-mesh link is in force: a search over points on the borders of rectangles, pulled
  /// taut afterwards, on average within 1 % of the best.
  ///
  /// Over nodes: A* over the middles of the lines along which nodes touch, or over the overlay if
  /// the path is long, then string pulling within the nodes of the corridor. If the goal is
  /// unreachable, the path leads to the reachable place nearest to it; if edits are in force, or
  /// that place is more than 25 m from the goal, only to about the nearest.
  ///
  /// In the air: over the ground where that is shorter, else straight up, through the air and
  /// straight down; from a place where it cannot take off, it walks to one where it can. If the air
  /// at both ends is connected only over the ground, the path lands and walks in between, as few
  /// times as possible. The whole body passes everywhere. Flights are taut, but not always the
  /// shortest (docs/results.md).
  ///
  /// When the budget is exhausted the search stops (Path::spent). Between queries a finder keeps up
  /// to 64 MiB of search memory.
  void find(const PathQuery& query, Path& path);
  void find(const Place& from, const Place& to, Path& path, const SearchBudget& budget = {});
  /// The same query in parts, for slices over frames: call begin, then advance with some nodes a
  /// frame until it returns true. A call expands at most `max_nodes`: on the ground, over nodes,
  /// and in the air, with its walks, alike. Until then `path` has no points, and counts what was
  /// expanded. The path is that of find, whatever the slices; on the ground, a path to a goal that
  /// is reached is that of find with kOnDemand. PathQuery::budget is that of the whole query;
  /// `cancel` is read by each call, too. Finding the ends, string pulling and rows of the overlay
  /// that obstacles have changed are not counted, and each is done in one go. Floods to a take-off
  /// count for calls, not for the budget. After another query in between, it begins again: use a
  /// copy for that. It also begins again if edits change what it may have seen, but not for
  /// kinematic obstacles, nor for static ones where the class has no place, nor for areas while all
  /// kinds cost 1, nor for costs of kinds that no ground has. With kOnDemand it is not known which
  /// kinds there are: a cost counts if searched ground has it, and if it is the first or the last
  /// that differs from 1, or changes the least of all. This happens four times at most, also if
  /// edits were applied for is_free, find_node_place, random_point, take_off or landing. Then it
  /// goes on over the world as it was when it last began, so that it ends even if a crate moves in
  /// each frame; what has come up since may cut the path. From then until it has ended, these five
  /// answer for the world of that time, too. Once it has ended, or without begin, advance returns
  /// true and nothing is found.
  void begin(const PathQuery& query);
  bool advance(uint64_t max_nodes, Path& path);

  /// Could a path begin or end there now? Until a query in parts has ended that no longer follows
  /// edits (begin): in the world of that query. `tolerance` as in PathQuery. [m]
  [[nodiscard]] bool is_free(const PathPoint& end, double tolerance = 0.5);
  /// The place of the class on nodes nearest to a position in three dimensions, or nowhere if none
  /// is within `search_radius` or the finder has no nodes. [m, m]
  [[nodiscard]] NodePlace find_node_place(const Vec3d& position, double search_radius);
  /// The n-th of a reproducible stream of points: in the air uniform over the legal air, else over
  /// the baked places of the class, whatever the edits. Empty only if there is none.
  [[nodiscard]] std::optional<Vec3d> random_point(uint64_t seed, uint64_t n);

  /// In the air: the point straight above a place on the ground at which the feet enter the air and
  /// a take-off ends. Empty if a solid blocks the take-off, or the finder is not for the air.
  [[nodiscard]] std::optional<Vec3d> take_off(const Place& place);
  /// In the air: the place on the ground where a flyer at `feet` lands. The descent is straight
  /// down to the lowest air box, and leads to the place to which the leaf there is linked, if the
  /// world has such links (AirLinks) and no edit blocks it. Else, of the places below this box, the
  /// one with the largest clearance is taken, of several the nearest to the box's axis [PACS00].
  /// Nowhere if there is none, or the finder is not for the air.
  [[nodiscard]] Place landing(const Vec3d& feet);

  /// Sizes of what was made, and the time that it took. Time: constant.
  [[nodiscard]] PathSummary summary() const;

 private:
  friend struct Access;
  struct State;
  explicit PathFinder(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

/// What a class may rely on all along a path over nodes: the worst of what they promise at its
/// places. Every class in `classes` may stand everywhere on it. On links between places that do not
/// touch, and on off-mesh links, which are not tested, only the class's own body counts, and the
/// width is 0. Run-time obstacles do not count. Nothing if the path has no places on nodes. Time:
/// linear in the segments times the nodes and cells of their patches.
[[nodiscard]] THRONG_API NodeClearance clearance_along(const Nodes& nodes, int32_t avatar_class,
                                                       const Path& path);

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

/// The free air boxes of the octree, for all classes together, between the lowest height of feet
/// and the ceiling; of zones without solids there are none. Of `area`, if it has an extent in x,
/// those whose middle lies over it. Source: [PACS00] 1.2.3.7. Reads every air file once. Fails with
/// kNotFound (the world was baked without air) or kBadFile. [m]
[[nodiscard]] THRONG_API Result<std::vector<Box3d>> air_boxes(const World& world,
                                                              const Box3d& area = {});

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

/// Distances to goals over points on the borders of rectangles of the ground. It describes the
/// ground and its edits at the time when it was made; if they change, make another one. Off-mesh
/// links count as in paths. Each copy has its own memory for queries; give every thread one.
class THRONG_API FlowField {
 public:
  /// Makes a field by one Dijkstra search over the ground of a finder's class. Goals that are no
  /// places of the class are ignored. Fails with kBadConfig (max_distance), kBadInput (no goal is
  /// left) or kCancelled.
  [[nodiscard]] static Result<FlowField> create(const PathFinder& finder,
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
  /// line leads. Where the path takes an off-mesh link, that is its start; from places within a
  /// cell of it, it is the link's end. At last the goal itself; nowhere if no path leads there.
  [[nodiscard]] Place next(const Place& place);
  /// Finds the whole path to the nearest goal, pulled taut.
  void find_path(const Place& place, Path& path);

  /// Sizes of what was made, and the time that it took. Time: constant.
  [[nodiscard]] FlowSummary summary() const;

 private:
  struct State;
  explicit FlowField(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace throng
