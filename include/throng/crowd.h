// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "throng/avatar_state.h"
#include "throng/base.h"
#include "throng/context.h"
#include "throng/crowd_obstacle.h"
#include "throng/nodes.h"
#include "throng/path.h"
#include "throng/prism.h"
#include "throng/result.h"
#include "throng/steering_model.h"
#include "throng/world.h"

/// The crowd: avatars with goals that find their ways through a baked world and avoid each other,
/// never into a wall and never into each other.
namespace throng {

/// Names an avatar of a crowd; zero names none. An id is never given twice.
struct AvatarId {
  uint32_t slot1 = 0;  ///< Slot plus one.
  uint32_t generation = 0;
  explicit operator bool() const { return slot1 != 0; }
  friend bool operator==(AvatarId, AvatarId) = default;
};

class FlightFinder;

/// Place::level1 of places in the air.
inline constexpr uint32_t kAirLevel1 = UINT32_MAX;
/// A place in the air, for a crowd's avatars who fly: to begin at, or to be bound for. Y: the feet.
[[nodiscard]] inline Place air_place(Vec3d feet) { return {feet, kAirLevel1}; }

/// A region that many are bound for, see Crowd::add_target. 0 is none.
using TargetId = uint16_t;

/// A region that is watched, see Crowd::watch_area. [0 to 63]
using WatchedArea = uint8_t;

/// Somebody came into a region that is watched.
struct AreaEntry {
  AvatarId id;
  WatchedArea area = 0;
  friend bool operator==(const AreaEntry&, const AreaEntry&) = default;
};

/// How avatars get from where they are to their goals.
enum class Routing {
  kPaths,     ///< Shortest ways over the ground, corner by corner.
  kStraight,  ///< Straight on; walls are avoided, not gone around.
};

struct CrowdConfig {
  double dt = 0.1;  ///< Length of a step. [s, 0.001 to 1]
  uint64_t seed = 1;
  int32_t workers = 0;  ///< Threads to use, 0 for all cores. Never changes the result. [>= 0]
  Routing routing = Routing::kPaths;
  /// How those on foot avoid each other. `reaction` and `deadlock_avoidance` are of kSampled alone:
  /// others decide in each step.
  SteeringModel model = SteeringModel::kSampled;
  bool labels = false;  ///< PathConfig::labels: for small worlds and many long ways.
  bool zones = false;   ///< PathConfig::zones: for large worlds and long ways.
  /// SearchBudget::max_bytes of each search for a path. As many as there are workers may run at a
  /// time. [bytes, >= 2^20]
  uint64_t search_bytes = SearchBudget::kDefaultBytes;
  double sight = 5;  ///< Who is farther away is not avoided yet. [m, 1 to 50]
  /// Whoever does what he wants most decides anew that often; in the steps between he goes on as he
  /// does, if nobody and no wall is in his way. Steps that are longer decide in each. Shorter times
  /// cost more and gain little. [s, 0 to 1]
  double reaction = 0.2;
  /// Beyond all views (set_views) everybody takes as many steps at once as the narrowest body's
  /// radius allows, at most so many; if that is more than one, he looks at nobody before he could
  /// touch him. [1 to 16]
  int32_t low_detail_steps = 4;
  double low_detail_reaction = 0.4;  ///< `reaction` there. [s, 0 to 10]
  int32_t rounds = 3;                ///< In which claims are settled, a step. [1 to 100]
  bool deadlock_avoidance = true;    ///< Who does not get on turns aside by and by.
  /// Who has a goal, has not arrived, and has not come 0.3 m further between two looks, so many
  /// seconds apart, is told by stuck(). 0: nobody looks. Never changes what happens. [s, 0 to 1e6]
  double no_progress_after = 0;
  /// Of the same world. Classes that climb or let themselves down over edges, and do not fly, go
  /// over them; without nodes they walk on level tiles as others do.
  Nodes nodes = {};
};

/// Someone to add.
struct AvatarSpawn {
  Place place = {};  ///< Feet on the ground of the class, or air_place if it flies.
  int32_t avatar_class = 0;
  double radius = 0;  ///< Of the body, 0 for the class's. Walls are kept away by the class's. [m]
  double speed = 0;   ///< Wished, and the most, 0 for the class's. [m/s]
  /// For who goes over nodes, instead of `place`; nowhere: the nodes' place nearest to `place`.
  NodePlace on_nodes = {};
};

/// From where a crowd is looked at: whoever is within is simulated in full.
struct CrowdView {
  Vec3d position;
  double radius = 50;  ///< [m]
};

/// What a crowd holds. [bytes]
struct CrowdMemory {
  uint64_t avatars = 0;  ///< Bodies, who is near whom, ids, events.
  uint64_t paths = 0;    ///< The next corners of each, or his way through the air.
  uint64_t ground = 0;   ///< Of the classes in use, and obstacles.
  [[nodiscard]] uint64_t total() const { return avatars + paths + ground; }
};

/// What one step did.
struct CrowdReport {
  uint64_t step = 0;        ///< Number of the step just made, from 1.
  uint64_t avatars = 0;     ///< All there are.
  uint64_t flying = 0;      ///< Of these, in the air, or on the way up or down.
  uint64_t climbing = 0;    ///< Of these, over nodes.
  uint64_t stood = 0;       ///< Did not move.
  uint64_t low_detail = 0;  ///< Beyond all views.
  uint64_t skipped = 0;     ///< Of these, stood because it was not their turn; not in `stood`.
  uint64_t contested = 0;   ///< Could have touched somebody, so went through the rounds.
  uint64_t arrived = 0;  ///< Came within 0.3 m of their goals, or into their targets, in this step.
  uint64_t planned = 0;  ///< Got a way, or another one.
  uint64_t no_path = 0;  ///< Of these, found that none leads to the goal: it is dropped.
  /// Searches that gave up because they would have taken more than CrowdConfig::search_bytes, which
  /// is to be raised: among no_path, or of a detour that was not found.
  uint64_t out_of_memory = 0;
  uint64_t waiting = 0;       ///< Obstacles in whose way somebody stands.
  double progress = 0;        ///< Mean speed towards the next corner by the wished one. [-1 to 1]
  double seconds_plan = 0;    ///< Finding and following paths.
  double seconds_sort = 0;    ///< Which avatars are near which.
  double seconds_steer = 0;   ///< Choosing velocities.
  double seconds_commit = 0;  ///< Settling which proposed moves are made, and making them.
  double seconds_settle = 0;  ///< What the moves change for the next step.
  double seconds_obstacles = 0;  ///< Those that come up or move, and the flows around them.
  double seconds_events = 0;     ///< Arrivals in targets, watched areas, no progress.
  double seconds_total = 0;      ///< Of the whole step: the sum of these and a little more.
};

/// Sense, steer, claim, commit. Sources: [CAACD] for what avatars do, docs/design/008-engine.md for
/// how, and why nobody ever touches anybody. Movable, not copyable; two crowds can live side by
/// side. One thread at a time.
class THRONG_API Crowd {
 public:
  /// An empty crowd. Fails with kBadConfig.
  [[nodiscard]] static Result<Crowd> create(const World& world, const CrowdConfig& config);
  Crowd(Crowd&&) noexcept;
  Crowd& operator=(Crowd&&) noexcept;
  ~Crowd();

  /// Adds avatars in order; who could not stand at his place, or would touch somebody there, is
  /// left out and gets no id. The first of a class reads its ground and makes its path finder.
  /// Fails with kNotFound (class), kBadConfig (radius, speed), kBadFile, kCancelled; then nobody
  /// was added.
  [[nodiscard]] Result<std::vector<AvatarId>> add(std::span<const AvatarSpawn> spawns,
                                                  Context& context);
  /// Adds `count` avatars alike at random places, uniform over where the class can stand, or, if
  /// `like.place` is an air_place, over where it can fly. Fails as `add` does, and with kLimit and
  /// how many fit; then nobody was added.
  [[nodiscard]] Result<std::vector<AvatarId>> scatter(uint32_t count, const AvatarSpawn& like,
                                                      Context& context);
  /// Takes avatars away. Ids of nobody are left out.
  void remove(std::span<const AvatarId> ids);

  /// Puts up an obstacle: nobody stands where a body of his class could touch it, its bottom above
  /// his step, until it is removed. It comes up at once or, as a door that closes, before the first
  /// step at whose beginning no body is in it; what happens until then, ObstaclePolicy says. Ways
  /// of kStatic ones lead around them; whose way is cut asks for another, and whoever has none
  /// left is stranded. Fails with kBadInput. Time: all avatars, and the cells that it touches.
  [[nodiscard]] Result<ObstacleId> add_obstacle(
      const Prism& prism, ObstacleKind kind = ObstacleKind::kStatic,
      ObstaclePolicy policy = ObstaclePolicy::kRefuseEntry);
  /// Where it is to be: by a small step at a time, as it waits while anybody stands within the
  /// convex hull of here and there: avatars may enter that, whatever the policy. The last order
  /// counts. Fails with kBadInput, kNotFound.
  [[nodiscard]] Result<void> move_obstacle(ObstacleId id, const Prism& prism);
  /// A door: true closes it, by its policy; false opens it at once, or ends its closing. False for
  /// ids of none.
  bool set_obstacle_active(ObstacleId id, bool active);
  bool remove_obstacle(ObstacleId id);
  /// Fails with kNotFound.
  [[nodiscard]] Result<ObstacleState> obstacle(ObstacleId id) const;
  /// All that are up, in order of slot.
  [[nodiscard]] std::vector<Prism> obstacles() const;
  /// Who stood in the way of obstacles that wait when the last step began, in order of slot: also
  /// of those that no way leads out, or that the caller drives, and which keep an obstacle open.
  [[nodiscard]] std::span<const AvatarId> blockers() const;

  /// Where they are bound for, one for each id: places of their class. An avatar keeps to its goal
  /// when it has arrived, and makes way. Nowhere: it stands, or hovers. Who flies takes off and
  /// lands as his way asks for; his goal may be an air_place. Ids of nobody are left out.
  void set_goals(std::span<const AvatarId> ids, std::span<const Place> goals);
  /// The same for avatars who go over nodes; ids of others are left out, too.
  void set_goals(std::span<const AvatarId> ids, std::span<const NodePlace> goals);
  /// Makes a region, the union of prisms, that many can be bound for: one search outwards from it
  /// serves all ([FlowField]). Whoever's middle is inside has arrived. Fails with kBadInput (a
  /// prism that is none), kBadConfig (Routing::kStraight), kLimit (65535 targets) or kCancelled.
  /// Time: the ground of all classes that are in use. Targets stay.
  [[nodiscard]] Result<TargetId> add_target(std::span<const Prism> areas, Context& context);
  /// Whom are bound for a target, each for where he is nearest, instead of a goal; who can fly does
  /// where no way on foot leads there. Ids of nobody are left out. [target: of this crowd]
  void set_targets(std::span<const AvatarId> ids, TargetId target);
  /// How far it is on foot from where an avatar is to a target: in the mean 1 to 2 % above the
  /// least. Infinite where no way leads there, it is in the air, or there is no such avatar. [m]
  [[nodiscard]] double distance(AvatarId id, TargetId target) const;
  /// Up to some `most` places inside a target where a class can stand, evenly spread. Fails as
  /// `add` does.
  [[nodiscard]] Result<std::vector<Place>> places(TargetId target, int32_t avatar_class,
                                                  size_t max_count, Context& context);
  /// Wished speeds from now on, one for each id. Ids of nobody are left out. [m/s, > 0 to 100]
  void set_speeds(std::span<const AvatarId> ids, std::span<const double> speeds);

  /// Velocities wished by the caller instead of goals, until a goal is set; longer ones than an
  /// avatar's speed are cut. Avoidance and the rule of no overlaps stay. Who flies takes off when Y
  /// is above 0, and lands when it is below and there is ground. Who goes over nodes goes to where
  /// that leads him. [m/s; Y: only of who flies or goes over nodes]
  void set_velocities(std::span<const AvatarId> ids, std::span<const Vec3d> velocities);

  /// From where the crowd is looked at from now on; nowhere, as at the beginning: all are simulated
  /// in full. Who is far is coarser, and as safe: whatever the views, nobody ever touches anybody.
  /// Flyers and who is driven are always near. Time of a step: avatars times views.
  void set_views(std::span<const CrowdView> views);
  /// One step. No allocation once it is warm. Time: linear in the avatars.
  CrowdReport step();

  /// Overlaps and walls entered, found by an independent look.
  [[nodiscard]] CrowdCheck check() const;
  /// XXH3 of all avatars in order of slot: position, level, velocity, state. Same for any workers.
  [[nodiscard]] uint64_t state_hash() const;
  /// All avatars in order of their slots, into `out` (resized). AvatarState::id is the slot.
  void read(std::vector<AvatarState>& out) const;
  /// One avatar; none if there is no such.
  [[nodiscard]] std::optional<AvatarState> read(AvatarId id) const;
  /// Who arrived in the last step, in order of slot.
  [[nodiscard]] std::span<const AvatarId> arrived() const;
  /// Whose goals were dropped in the last step, because no way leads there, in order of slot.
  [[nodiscard]] std::span<const AvatarId> goal_unreachable() const;
  /// Tells from now on who comes into the union of some prisms, with his middle; who is inside
  /// already comes in with the next step. Watching never changes what happens, and is not saved.
  /// Fails with kBadInput (a prism that is none) or kLimit (64 areas).
  [[nodiscard]] Result<WatchedArea> watch_area(std::span<const Prism> prisms);
  /// Who came into watched areas in the last step, in order of slot and area.
  [[nodiscard]] std::span<const AreaEntry> entered() const;
  /// Who was stuck when somebody last looked, if that was in the last step, in order of slot.
  [[nodiscard]] std::span<const AvatarId> no_progress() const;
  [[nodiscard]] bool is_alive(AvatarId id) const;
  /// Has it nodes, so that some may lean (AvatarState::up)?
  [[nodiscard]] bool may_lean() const;
  /// By which a class finds its ways through the air, to ask or to copy; null if nobody has been of
  /// the class yet, it does not fly, or the world has no air.
  [[nodiscard]] const FlightFinder* flight_finder(int32_t avatar_class) const;

  /// All that the next steps depend on. Whoever restores it goes on as this crowd would, step by
  /// step to the bit, with any number of workers. For this machine's order of bytes; [format] may
  /// change with every version.
  [[nodiscard]] std::vector<uint8_t> save() const;
  /// A crowd as it was saved, in the same world with the same settings but for the workers. Fails
  /// with kBadFile (cut, corrupt, of another world or version), and as `add` does.
  [[nodiscard]] static Result<Crowd> restore(const World& world, const CrowdConfig& config,
                                             std::span<const uint8_t> saved, Context& context);
  [[nodiscard]] uint32_t size() const;
  /// Memory held by the crowd itself, without path finders.
  [[nodiscard]] CrowdMemory memory() const;

 private:
  struct State;
  explicit Crowd(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace throng
