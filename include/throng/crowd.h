// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "throng/avatar.h"
#include "throng/base.h"
#include "throng/path.h"
#include "throng/surface.h"
#include "throng/world.h"

/// Crowds: avatars that move in a world, the obstacles among them, and generators of avatars.
namespace throng {

// ----
// Obstacles of Edits, as a crowd has them: crates, barriers, doors, carts.

/// What an obstacle does now.
enum class ObstaclePhase : uint8_t {
  kOff,            ///< It is switched off.
  kWaitsToComeUp,  ///< It was requested, and waits for avatars to leave its volume.
  kUp,             ///< It blocks avatars.
  kWaitsToMove,    ///< It blocks avatars where it is, and waits until it can move.
};

/// The present state of an obstacle in a crowd.
struct ObstacleState {
  Prism prism;  ///< Where it is; while it waits to come up, where it will be.
  ObstaclePhase phase = ObstaclePhase::kOff;
  ObstacleKind kind = ObstacleKind::kStatic;
  ObstaclePolicy policy = ObstaclePolicy::kRefuseEntry;
  /// When it was last requested, in the crowd's time (steps times dt). Below 0: never, or switched
  /// off since. [s]
  double requested_at = -1;
  double up_at = -1;  ///< When it came up; below 0: it is not up. [s]
  /// Avatars inside, counted at the request and at the beginning of each step.
  uint32_t occupants = 0;

  /// Does it block avatars?
  [[nodiscard]] bool is_up() const {
    return phase == ObstaclePhase::kUp || phase == ObstaclePhase::kWaitsToMove;
  }
  /// Does it wait for avatars, to come up or to move?
  [[nodiscard]] bool waits() const {
    return phase == ObstaclePhase::kWaitsToComeUp || phase == ObstaclePhase::kWaitsToMove;
  }
};

// ----
// The crowd: avatars with goals that find paths through a baked world and avoid each other. No
// avatar enters a wall, and no two avatars ever overlap.

/// Names an avatar of a crowd; zero names none. An id is never given twice.
struct AvatarId {
  uint32_t slot1 = 0;       ///< Slot plus one.
  uint32_t generation = 0;  ///< Of the slot: how many avatars it has held.
  explicit operator bool() const { return slot1 != 0; }
  friend bool operator==(AvatarId, AvatarId) = default;
};

/// Place::level1 of places in the air.
inline constexpr uint32_t kAirLevel1 = UINT32_MAX;
/// A place in the air, as the start or the goal of an avatar that flies. Y is at the feet.
[[nodiscard]] inline Place air_place(Vec3d feet) { return {feet, kAirLevel1}; }

/// Names a region that many avatars head to, see Crowd::add_target. 0 names none.
using TargetId = uint16_t;

/// Names a watched region, see Crowd::watch_area. [0 to 63]
using WatchedArea = uint8_t;

/// An avatar has come into a watched region.
struct AreaEntry {
  AvatarId id;
  WatchedArea area = 0;
  friend bool operator==(const AreaEntry&, const AreaEntry&) = default;
};

/// How avatars get to their goals.
enum class Routing {
  kPaths,  ///< Along shortest paths over the ground, corner by corner.
  /// Straight towards the goal. Walls are avoided, but no path around them is searched.
  kStraight,
};

/// [CAACD]'s Mass, MaxSpeed and MaxForce, whose best set these are, for
/// SteeringModel::kCurvilinear. A crowd scales lengths to the body and times to the speed of each
/// avatar, so max_speed is its own speed; mass x max_speed by max_force is the time in which it
/// turns or stops.
struct CurvilinearTuning {
  double mass = 2.0;        ///< [0.01 to 1000]
  double max_speed = 0.4;   ///< [0.01 to 100]
  double max_force = 0.06;  ///< [0.001 to 1000]
  /// Of the threats, collisions come first, then what is critical, then alerts; otherwise, as
  /// printed, what comes nearest first.
  bool by_state = false;
};

/// How avatars in the air avoid others in a crowd of SteeringModel::kCurvilinear.
enum class FlyerAxes : uint8_t {
  kOurs,       ///< By trying velocities, as in the crowds of other models.
  kSide,       ///< By [CAACD], whose eq. 11 pushes to a side alone.
  kSideAndUp,  ///< The same, to a side and up or down.
};

/// Settings that trade quality of movement for time. The defaults were measured
/// (docs/design/008-engine.md); only studies of the engine change them.
struct CrowdTuning {
  double sight = 5;  ///< Avatars farther away are not avoided yet. [m, 1 to 50]
  /// An avatar that walks at its preferred velocity decides again after this time. In the steps
  /// between it keeps its velocity as long as no avatar and no wall blocks it. If a step is longer
  /// than this, all avatars decide in each step. Shorter times cost more and gain little. [s, 0 to
  /// 1]
  double reaction = 0.2;
  /// Largest number of steps that an avatar in low detail covers by one move; a small radius of the
  /// narrowest body lowers it. If a move covers more than one step, other avatars that could not be
  /// touched by it are ignored. Low detail: beyond all views, see Crowd::set_views. [1 to 16]
  int32_t low_detail_steps = 4;
  double low_detail_reaction = 0.4;  ///< `reaction` in low detail. [s, 0 to 10]
  int32_t rounds = 3;                ///< Conflict resolution rounds of a step. [1 to 100]
  /// An avatar that makes no progress tries a growing detour angle.
  bool deadlock_avoidance = true;
  /// Avatars on foot queue before narrow places and rest at their goals, instead of pushing and
  /// circling: docs/design/008-engine.md, "Queues". Only with SteeringModel::kSampled. Takes 80
  /// bytes an avatar.
  bool queues = true;
  /// Most change of velocity of an avatar on foot with a goal; to stop before others, and to keep
  /// to a lower speed at once, are exempt. It brakes before its goal. 0: no limit. Only with
  /// SteeringModel::kSampled. The default is 320 N by 80 kg. [m/s2, 0 to 1000]
  double acceleration = 4;
  /// Time between two checks for progress. Crowd::no_progress() returns the avatars that have a
  /// goal, have not arrived and have come less than 0.3 m further since the last check. 0: no
  /// checks. Never changes the steps. [s, 0 to 1e6]
  double no_progress_after = 0;
  /// Of SteeringModel::kCurvilinear alone.
  CurvilinearTuning curvilinear = {};
  /// Of SteeringModel::kCurvilinear alone. By [CAACD] a flyer knows walls, floors and obstacles
  /// only through its path and accepted moves, as its walkers do.
  FlyerAxes flyer_axes = FlyerAxes::kOurs;

  /// Avatars push instead of queueing, and nothing limits their acceleration.
  void let_push() {
    queues = false;
    acceleration = 0;
  }
};

/// How stairs slow a class: horizontal speeds divided by that on level ground, which is 1.34 m/s.
/// Source: [Weidmann93]; 0.61 m/s up, 0.694 m/s down. A slope without treads slows by the same
/// share of its gradient: not at all if it is level, as stairs if it rises by 0.17 in 0.29 m or
/// more. docs/design/016-slopes.md. [0.01 to 1]
struct SlopeFactors {
  double stairs_up = 0.61 / 1.34;
  double stairs_down = 0.694 / 1.34;
};

/// Settings for Crowd::create.
struct CrowdConfig {
  /// Length of a step. An avatar without others or walls near goes its speed times that, to 1 %
  /// over many steps, whatever the length. A step in which the fastest avatar would go farther than
  /// the smallest radius is divided, for all. [s, 0.001 to 1]
  double dt = 0.1;
  uint64_t seed = 1;
  int32_t workers = 0;  ///< Threads to use, 0 for all cores. Never changes the result. [>= 0]
  Routing routing = Routing::kPaths;
  /// How avatars on foot avoid each other. CrowdTuning::reaction and deadlock_avoidance
  /// apply to kSampled alone: other models decide in each step.
  SteeringModel model = SteeringModel::kSampled;
  /// Of finding paths: kLabels for small worlds and many long paths, kZones for large worlds.
  PathSpeedup speedup = PathSpeedup::kNone;
  /// SearchBudget::max_bytes of each search for a path. At the same time there are as many searches
  /// as workers, and four more for each class that flies. [bytes, >= 2^20]
  uint64_t search_bytes = SearchBudget::kDefaultBytes;
  /// Nodes of the same world. Avatars of classes that climb or have a `max_drop`, and do not fly,
  /// walk over them; without nodes these walk on level tiles, as others do.
  Nodes nodes = {};
  CrowdTuning tuning = {};  ///< Fine for most crowds as it is.
  /// Changes of the world at run time, which finders can share. At the beginning of `step`, `add`
  /// and `scatter` the crowd follows them: it makes the calls that have changed them since, one
  /// after the other, as if each were made then. So a door that was switched off and on again
  /// opens, and closes by its policy. Until then nothing in the crowd changes: obstacles(), check()
  /// and distance() do not know the calls. A crowd takes the present state of the edits in place of
  /// the calls if it has no avatars and sees the edits for the first time, or if it has missed more
  /// than 2000 calls: then an obstacle moves straight from where the crowd has it to where it is.
  ///
  /// While an obstacle is up, no avatar stands where its body, from body_bottom() up, could touch
  /// it (of triangles: the box around them). If bodies are in it when it is requested, it comes up
  /// before the first step that begins with no body in it; ObstaclePolicy says what happens until
  /// then. Paths lead around kStatic obstacles: an avatar whose path is cut gets another one or, if
  /// there is none, its goal is unreachable. Avatars on foot plan over areas with the costs that
  /// these have. Time of each call that changed an obstacle: linear in all avatars, and in the
  /// tiles that it touches with their obstacles. Edits that have not changed cost a step one
  /// comparison.
  ///
  /// With Routing::kPaths, avatars of classes that neither fly nor go over nodes take off-mesh
  /// links. They take a link in the order in which they came, in one direction at a time, and wait
  /// near the start while an avatar or an obstacle is at the end. Links that cross, share an end or
  /// lie so close that avatars on them could touch are used one at a time. On a link an avatar
  /// moves in a straight line, at its speed times length / cost, but not faster than its speed and
  /// not slower than a thousandth of it. Only other avatars stop it there: if the link is switched
  /// off it still arrives, an obstacle on the rest of the line waits for it, and a new goal or
  /// velocity applies from the end on. While an avatar stays at an end, no other one enters the
  /// link towards that end. An avatar that stays on ground that the line crosses stops those on the
  /// link. Classes that go over nodes take NodeConfig::off_mesh_links; flyers take none.
  Edits edits = {};
  /// PathConfig::slope_cost of avatars that walk or climb. [0 to 1000]
  double slope_cost = 0;
  /// Stairs and slopes slow avatars on foot that head to a goal. Paths do not depend on it.
  /// Avatars in the air, over nodes, on off-mesh links, and those that are externally controlled
  /// keep their speed. Time on level ground: a test of a flag for each avatar that decides.
  bool slow_on_slopes = true;
  /// By class; classes beyond the last entry have the default.
  std::vector<SlopeFactors> slope_factors = {};
  /// With Routing::kPaths, avatars on foot of classes that neither fly nor go over nodes take
  /// another route where one is clearly faster now: if they do not get on, or if their new path
  /// leads into a jam. They search up to about 50 m ahead, so an avatar keeps its goal and the
  /// place of its target to which it walks. docs/design/017-congestion.md. Time: a test for each
  /// avatar and step, and at most 32 searches a second and one for each 2000 avatars. Memory: 385
  /// bytes for each level of a tile, 8 for each avatar.
  bool avoid_jams = true;
};

/// An avatar to add.
struct AvatarSpawn {
  Place place = {};  ///< The feet: on the ground of the class, or an air_place if it flies.
  int32_t avatar_class = 0;
  /// Of the body, 0: the class's. Its distance to walls follows the class's radius. [m]
  double radius = 0;
  /// Desired speed on level ground, also its maximum. 0: the class's. [m/s, to 100, and to 1000
  /// radii a step]
  double speed = 0;
  /// For avatars that walk over nodes, in place of `place`. Nowhere: the place of the nodes that is
  /// nearest to `place`.
  NodePlace on_nodes = {};
};

/// A circle that is in view: avatars inside are simulated in full detail.
struct CrowdView {
  Vec3d position;      ///< Its centre. [m]
  double radius = 50;  ///< [m]
};

/// Memory of a crowd. [bytes]
struct CrowdMemory {
  uint64_t avatars = 0;  ///< Bodies, neighbours, ids, events.
  uint64_t paths = 0;    ///< The next corners of each avatar, or its path through the air.
  uint64_t ground = 0;   ///< The ground of the classes in use, and obstacles.
  [[nodiscard]] uint64_t total() const { return avatars + paths + ground; }
};

/// What one step did: counts of avatars, and wall-clock times.
struct CrowdReport {
  uint64_t step = 0;        ///< Number of the step just made, from 1.
  uint64_t avatars = 0;     ///< All in the crowd.
  uint64_t flying = 0;      ///< Of these, in the air, or in a take-off or landing.
  uint64_t climbing = 0;    ///< Of these, on nodes.
  uint64_t on_links = 0;    ///< Of these, on off-mesh links of Edits.
  uint64_t stood = 0;       ///< Avatars that did not move.
  uint64_t low_detail = 0;  ///< In low detail: beyond all views.
  uint64_t skipped = 0;     ///< Of these, not moved in this step; not in `stood`.
  /// Could have touched another avatar, so took part in conflict resolution.
  uint64_t contested = 0;
  uint64_t arrived = 0;  ///< Came within 0.3 m of their goals, or into their targets, in this step.
  uint64_t planned = 0;  ///< Searches for paths.
  uint64_t no_path = 0;  ///< Of these, found no path to the goal, which is dropped.
  /// Searches that stopped because they would have taken more than CrowdConfig::search_bytes: raise
  /// it. They count in no_path, or are detours that were not found.
  uint64_t out_of_memory = 0;
  uint64_t waiting = 0;  ///< Obstacles that wait for avatars to leave their volume.
  /// Searches for a route around a jam (CrowdConfig::avoid_jams); not in `planned`.
  uint64_t jam_searches = 0;
  uint64_t changed_route = 0;  ///< Of these, led to another route: avatars that took it.
  /// Air boxes, and nodes on foot, that searches for paths of flyers took in this step: at most
  /// 163 840 a simulated second, but up to 4096 in each sub-step. A search that needs more goes on
  /// in the next step.
  uint64_t flight_boxes = 0;
  // Of crowd_over_ranks.
  int32_t ranks = 1;          ///< That share the crowd.
  uint64_t most_avatars = 0;  ///< Avatars that one rank moves, at most.
  /// By the rank that sent most in this step: to each neighbour, and once to all. [bytes]
  uint64_t sent_bytes = 0;
  /// Mean speed towards the next corner, divided by the desired speed, on stairs and slopes by what
  /// that is there. [-1 to 1]
  double progress = 0;
  double seconds_plan = 0;    ///< Searching and following paths.
  double seconds_sort = 0;    ///< Finding which avatars are near each other.
  double seconds_steer = 0;   ///< Choosing velocities.
  double seconds_commit = 0;  ///< Conflict resolution, and the accepted moves.
  double seconds_settle = 0;  ///< Updates after the moves, for the next step.
  /// Obstacles that come up or move, and the flow fields around them.
  double seconds_obstacles = 0;
  double seconds_events = 0;  ///< Arrivals in targets, watched areas, no progress.
  double seconds_total = 0;   ///< Of the whole step: the sum of the above and a little more.
};

/// Avatars of a world, advanced step by step: each avatar senses, steers and proposes a move;
/// conflict resolution accepts the moves that cannot overlap. Sources: [CAACD] for the behaviour,
/// docs/design/008-engine.md for the engine and the proof that no two avatars overlap. Movable, not
/// copyable; several crowds can exist side by side. Use one from one thread at a time.
class THRONG_API Crowd {
 public:
  /// An empty crowd. Fails with kBadConfig.
  [[nodiscard]] static Result<Crowd> create(const World& world, const CrowdConfig& config);
  Crowd(Crowd&&) noexcept;
  Crowd& operator=(Crowd&&) noexcept;
  ~Crowd();

  /// Adds avatars in order. An avatar that cannot stand at its place, or would overlap another one
  /// there, is left out and gets no id. The first avatar of a class reads the ground of the class
  /// and makes its path finder. Without spawns it only makes the calls that changed the edits.
  /// Fails with kNotFound (class), kBadConfig (radius, speed), kBadFile, kCancelled; then none is
  /// added.
  [[nodiscard]] Result<std::vector<AvatarId>> add(std::span<const AvatarSpawn> spawns,
                                                  Context& context);
  /// Adds `count` equal avatars at random places, uniform over where the class can stand, or, if
  /// `like.place` is an air_place, over where it can fly. Fails as `add` does, and with kLimit and
  /// how many fit; then none is added.
  [[nodiscard]] Result<std::vector<AvatarId>> scatter(uint32_t count, const AvatarSpawn& like,
                                                      Context& context);
  /// Makes a class of avatars that follow a density map: as a class of the world, but ground of
  /// weight 0 is a wall to them, and a metre costs more where the weight is small: 1 for a weight
  /// above half of the largest, half a metre more for each time that it is halved, at most 3.
  /// Outside of the picture, and on floors above and below it, a metre costs 1. Returns the number
  /// of the class, which AvatarSpawn::avatar_class, places() and scatter() take;
  /// AvatarState::avatar_class stays that of the world. These avatars take no off-mesh links.
  /// Source: [TC00] 5. Time: the ground of the class. Fails with kBadInput (the map), kNotFound
  /// (class), kBadConfig (it flies or goes over nodes), kLimit (16 classes in all), and as `add`
  /// does.
  [[nodiscard]] Result<int32_t> add_density_class(int32_t avatar_class, const DensityGrid& map,
                                                  Context& context);
  /// Gives the map of such a class other weights. Avatars on ground that becomes weight 0 leave it
  /// by the shortest path over it; no other enters it. All avatars of the class search their paths
  /// again. Time: the ground of the class, and its flow fields. Fails with kNotFound (no such
  /// class) and kBadInput (another number of pixels).
  [[nodiscard]] Result<void> set_density(int32_t density_class, std::span<const uint8_t> weights);
  /// May an avatar of a class in use stand at a place of the ground now, apart from others?
  [[nodiscard]] bool may_stand(int32_t avatar_class, const Place& place) const;
  /// Removes avatars. Unknown ids are ignored.
  void remove(std::span<const AvatarId> ids);

  /// The state of an obstacle of CrowdConfig::edits, as the last step or `add` has left it: the
  /// crowd knows whether avatars let it come up or move yet, which the edits do not. One that was
  /// added since is kWaitsToComeUp, or kOff if it is switched off. Fails with kNotFound: there is
  /// no such edit (now), or it is no obstacle.
  [[nodiscard]] Result<ObstacleState> obstacle(EditId edit) const;
  /// All obstacles that are up, as the last step or `add` has left them. Their order depends on the
  /// calls alone.
  [[nodiscard]] std::vector<Prism> obstacles() const;
  /// The avatars that blocked waiting obstacles when the last step began, in order of slot. An
  /// avatar that cannot leave, because no path leads out or it is externally controlled, stays
  /// among them, and its obstacle waits until the caller moves or removes one of the two.
  [[nodiscard]] std::span<const AvatarId> blockers() const;

  /// Sets goals, one for each id: places of the avatar's class. An avatar that has arrived keeps
  /// its goal, and yields to others. If the goal is nowhere it stands, or hovers. An avatar that
  /// flies takes off and lands as its path requires, and its goal may be an air_place. A goal that
  /// is outside the world or not finite counts as nowhere. Unknown ids are ignored.
  void set_goals(std::span<const AvatarId> ids, std::span<const Place> goals);
  /// Sets goals of avatars that walk over nodes. Ids of others are ignored, too. A goal that the
  /// nodes do not have is unreachable.
  void set_goals(std::span<const AvatarId> ids, std::span<const NodePlace> goals);
  /// Makes a target: a region, the union of prisms, that many avatars can head to. One search
  /// outwards from it serves them all (FlowField). An avatar has arrived when its middle is inside,
  /// or within 0.3 m of the place inside to which its path leads. Fails with kBadInput (a bad
  /// prism), kBadConfig (Routing::kStraight), kLimit (65535 targets) or kCancelled. Time: the
  /// ground of all classes in use. Targets cannot be removed.
  [[nodiscard]] Result<TargetId> add_target(std::span<const Prism> areas, Context& context);
  /// Sends avatars to a target of this crowd instead of a goal, each to the nearest place of the
  /// target. An avatar of a class that flies walks if a path on foot leads there, and flies if none
  /// does. Unknown ids are ignored; if the crowd has no such target, nothing changes.
  void set_targets(std::span<const AvatarId> ids, TargetId target);
  /// Length of an avatar's path on foot to a target, on average 1 to 2 % above the shortest.
  /// Infinite if no path leads there, the avatar is in the air or on an off-mesh link, or the id or
  /// the target is unknown. [m]
  [[nodiscard]] double distance(AvatarId id, TargetId target) const;
  /// At most about `max_count` places inside a target where a class can stand, evenly spread. Fails
  /// as `add` does, and with kNotFound if there is no such target.
  [[nodiscard]] Result<std::vector<Place>> places(TargetId target, int32_t avatar_class,
                                                  size_t max_count, Context& context);
  /// Sets desired speeds, one for each id. An avatar keeps its speed if the new one is not a
  /// number, not above 0, above 100, or above 1000 of its radii per step: `add` refuses these.
  /// Unknown ids are ignored. [m/s, > 0 to 100]
  void set_speeds(std::span<const AvatarId> ids, std::span<const double> speeds);
  /// Gives avatars a Mass, MaxSpeed and MaxForce of their own, one set for each id, from the next
  /// step on until they are removed. Other avatars keep CrowdTuning::curvilinear. The speed in m/s
  /// stays: call set_speeds, too, to change it. An avatar keeps what it has if a value is out of
  /// its limits. Unknown ids are ignored. Saved with the crowd; no effect with another model.
  void set_curvilinear(std::span<const AvatarId> ids, std::span<const CurvilinearTuning> tunings);
  /// The values of one avatar, its own or the crowd's. Empty if the id is unknown.
  [[nodiscard]] std::optional<CurvilinearTuning> curvilinear(AvatarId id) const;

  /// Sets preferred velocities in place of goals: the avatars are externally controlled until they
  /// get a goal. A velocity longer than the avatar's speed is cut to it; one that is not finite, or
  /// above 1e150, counts as 0. Avatars still avoid each other and never overlap. Whatever it
  /// avoids, an avatar is never faster than its given velocity, except on an off-mesh link, where
  /// it moves on as others do, and over an edge of nodes, where it keeps a quarter of its speed.
  /// One that walks or flies and avoids nothing is within 1 unit (1/2048 of a cell, 1 mm of height)
  /// of where its velocities lead. An avatar that flies takes off when Y is above 0, and lands when
  /// Y is below 0 and there is ground. An avatar on nodes follows their surface. [m/s; Y: only for
  /// avatars that fly or walk over nodes]
  void set_velocities(std::span<const AvatarId> ids, std::span<const Vec3d> velocities);

  /// Sets the views. Without views, as at the beginning, all avatars are simulated in full detail.
  /// Low detail is coarser, but as safe: avatars never overlap, whatever the views. Flyers and
  /// externally controlled avatars are always in full detail. A view is left out if its position is
  /// not finite, or its radius below 0 or not a number. Time of a step: avatars times views.
  void set_views(std::span<const CrowdView> views);
  /// Advances all avatars by `dt`. No allocation once it is warm. Time: linear in the avatars.
  CrowdReport step();

  /// Counts overlaps and wall entries by exact tests that share nothing with the step.
  [[nodiscard]] CrowdCheck check() const;
  /// The sum over all avatars of the XXH3 of slot, position, level, velocity and state, but not
  /// orientation, on which no step depends. Same for any workers.
  [[nodiscard]] uint64_t state_hash() const;
  /// Reads all avatars in order of slot into `out` (resized). AvatarState::id is the slot.
  void read(std::vector<AvatarState>& out) const;
  /// Reads one avatar. Empty if the id is unknown.
  [[nodiscard]] std::optional<AvatarState> read(AvatarId id) const;
  /// The same, but also empty if another rank moves it (crowd_over_ranks): no message is sent, so
  /// ranks may call it differently. Commands for such an avatar are that rank's to carry out, so a
  /// place that depends on where it is need not be known here.
  [[nodiscard]] std::optional<AvatarState> read_here(AvatarId id) const;
  /// The avatars that arrived in the last step, in order of slot.
  [[nodiscard]] std::span<const AvatarId> arrived() const;
  /// The avatars whose goals were dropped in the last step because no path leads there, in order of
  /// slot.
  [[nodiscard]] std::span<const AvatarId> goal_unreachable() const;
  /// Watches the union of some prisms: from now on entered() returns each avatar whose middle comes
  /// into it. An avatar that is already inside is returned after the next step. Never changes the
  /// steps, and is not saved. Fails with kBadInput (a bad prism) or kLimit (64 areas).
  [[nodiscard]] Result<WatchedArea> watch_area(std::span<const Prism> prisms);
  /// The avatars that came into watched areas in the last step, in order of slot and area.
  [[nodiscard]] std::span<const AreaEntry> entered() const;
  /// The avatars without progress (CrowdTuning::no_progress_after) if the last step made a check,
  /// in order of slot.
  [[nodiscard]] std::span<const AvatarId> no_progress() const;
  /// Is the avatar in the crowd? False for a null id, and once it was removed.
  [[nodiscard]] bool is_alive(AvatarId id) const;
  /// Has the crowd nodes, so that avatars may lean (AvatarState::up)?
  [[nodiscard]] bool may_lean() const;
  /// May the feet of a class be at a point of the air now? False also if there was no avatar of the
  /// class yet or it does not fly.
  [[nodiscard]] bool may_fly(int32_t avatar_class, const Vec3d& feet) const;
  /// The n-th of a reproducible stream of points, uniform over the air where the class may fly now.
  /// Empty only if there is no such air: may_fly is false everywhere.
  [[nodiscard]] std::optional<Vec3d> random_air_point(int32_t avatar_class, uint64_t seed,
                                                      uint64_t n) const;

  /// Saves the whole state and the edits. A restored crowd makes the same steps, bit for bit, with
  /// any number of workers. In this machine's byte order; the format may change with every version.
  [[nodiscard]] std::vector<uint8_t> save() const;
  /// Restores a saved crowd. World and settings must be the same, except for `workers`. If nothing
  /// was ever changed in `config.edits`, they become those of the saved crowd, with the same ids;
  /// they stay empty if this fails. Else they must have been made by the same calls. Fails with
  /// kBadFile (truncated, corrupt, of another world, version or other edits), and as `add` does.
  [[nodiscard]] static Result<Crowd> restore(const World& world, const CrowdConfig& config,
                                             std::span<const uint8_t> saved, Context& context);
  [[nodiscard]] uint32_t size() const;  ///< Avatars in the crowd.
  /// Memory of the crowd itself, without path finders.
  [[nodiscard]] CrowdMemory memory() const;

 private:
  friend struct Access;
  struct State;
  explicit Crowd(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

/// An empty crowd of all ranks that mpirun has started together; of one process, what Crowd::create
/// makes. Every rank has opened the same world, gives the same settings and makes the same calls
/// with the same arguments in the same order. Each moves the avatars on its part of the plane, and
/// keeps only them. All that a crowd returns but memory() is as in one process, bit for bit, on all
/// ranks and for any number of them; what reads states gathers those of all avatars, once between
/// two steps. config.workers is per rank; 0 shares the cores of a machine among its
/// ranks. save() gathers the whole crowd on each rank. Classes that fly or go over nodes, and
/// off-mesh links, are for one process. Fails
/// as Crowd::create, with kBadConfig if the edits have off-mesh links, or if there are several
/// ranks and the library was built without MPI. If a rank dies, mpirun ends the others.
/// docs/design/019-ranks.md.
[[nodiscard]] THRONG_API Result<Crowd> crowd_over_ranks(const World& world,
                                                        const CrowdConfig& config);
/// Crowd::restore by all ranks, of what one process or any number of ranks have saved: every rank
/// gives all of it. Memory: at first each rank has all avatars. Fails as Crowd::restore and
/// crowd_over_ranks do.
[[nodiscard]] THRONG_API Result<Crowd> restore_over_ranks(const World& world,
                                                          const CrowdConfig& config,
                                                          std::span<const uint8_t> saved,
                                                          Context& context);

// ----
// Avatar generators: keep a crowd populated around a viewer's eye. Only what the eye sees, and a
// band around it, is simulated. Source: [TC00] 5.

/// A class of a mix that generators add.
struct GeneratorShare {
  int32_t avatar_class = 0;
  double share = 1;  ///< Of all that are added, together with the other shares. [> 0]
};

/// Settings for AvatarGenerators::create.
struct GeneratorConfig {
  Place home = {};  ///< Only ground that `avatar_class` can reach from here is populated.
  int32_t avatar_class = 0;
  /// Classes that are added, each where it can stand; empty: `avatar_class` alone.
  std::vector<GeneratorShare> mix = {};
  /// How avatars are spread, on both sides of the border of what is seen: `density` is the mean
  /// over that ground, and where the weight is 0 there are none. They follow the map
  /// (Crowd::add_density_class). Without pixels: evenly.
  DensityGrid map = {};
  double density = 0.05;  ///< Avatars per square metre of that ground. [1/m^2, > 0, <= 1]
  /// If not 0, in place of `density`: number of avatars on all of that ground, at most one per
  /// square metre. [>= 0]
  double people = 0;
  double radius = 100;           ///< Ground farther from the eye is not populated. [m, > 0]
  double band = 16;              ///< Width of the unseen band beside what is seen. [m, > 0]
  int32_t steps_per_query = 10;  ///< Steps between two queries of what is seen. [steps, > 0]
  /// Region of the eye: what is queried is what can be seen from the eye and from four points so
  /// far to its sides, and the answer holds until the eye is farther away than that. [m, >= 0]
  double region = 2;
  uint64_t seed = 1;
  int32_t workers = 0;  ///< Threads to use, 0 for all cores. Never changes the result. [>= 0]
};

/// Returns whether anything inside a box can be seen from the eye. It may return true for a hidden
/// box: then more is simulated. If it returns false for a visible box, avatars appear in view.
using Sight = std::function<bool(const Box3d&)>;

/// The same from any point.
using SightFrom = std::function<bool(const Vec3d& eye, const Box3d&)>;

/// State after an update.
struct GeneratorReport {
  double seen_area = 0;       ///< Area of the ground cells that are at least partly seen. [m^2]
  double band_area = 0;       ///< Area of the ground cells of the band. [m^2]
  uint32_t seen_avatars = 0;  ///< Avatars on seen cells. The target is density times area.
  uint32_t band_avatars = 0;
  uint32_t added = 0;    ///< In this update, none where it could be seen.
  uint32_t removed = 0;  ///< Likewise.
};

/// Keeps a crowd at a density in what an eye can see. Ground cells are level tiles. On cells of the
/// band, avatars are added or removed out of sight to keep the density; an avatar that arrives gets
/// a new goal, preferably on seen cells with few avatars. Movable, not copyable. The same calls
/// give the same crowd on any machine.
class THRONG_API AvatarGenerators {
 public:
  /// Makes the generators. Reads every zone once. Fails with kBadConfig, kNotFound (class),
  /// kBadInput (home is no place of the class), and as Graph::create does.
  [[nodiscard]] static Result<AvatarGenerators> create(const World& world,
                                                       const GeneratorConfig& config,
                                                       Context& context);
  AvatarGenerators(AvatarGenerators&&) noexcept;
  AvatarGenerators& operator=(AvatarGenerators&&) noexcept;
  ~AvatarGenerators();

  /// From now on cells are classified by this, from the whole region of the eye; without it, by
  /// `can_see`, from its point alone.
  void set_region_sight(SightFrom can_see_from);
  /// Removes all own avatars and populates what is seen and the band at once: call it first, and
  /// when the eye has jumped. Fails as Crowd::add does.
  [[nodiscard]] Result<GeneratorReport> populate(Crowd& crowd, Vec3d eye, const Sight& can_see,
                                                 Context& context);
  /// Adds and removes avatars: call it after each step of the crowd. The crowd must be the same
  /// each time, of the same world; avatars that others added are not touched. Fails as Crowd::add
  /// does. Time: linear in its avatars and in the cells within `radius`.
  [[nodiscard]] Result<GeneratorReport> update(Crowd& crowd, Vec3d eye, const Sight& can_see,
                                               Context& context);
  /// The avatars that the generators added and did not remove.
  [[nodiscard]] std::span<const AvatarId> members() const;
  /// Area of all ground that the class can reach from home. [m^2]
  [[nodiscard]] double area() const;

 private:
  struct State;
  explicit AvatarGenerators(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace throng
