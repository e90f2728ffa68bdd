// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "throng/avatar.h"
#include "throng/base.h"
#include "throng/picture.h"
#include "throng/scene.h"
#include "throng/world.h"

/// Algorithms as papers print them: slices of a world, wanderers, and CAACD with its experiment.
namespace throng {

// ----
// Slices: horizontal cuts of a whole world, each with the highest surface below it in every cell.
// Source: [ML06], algorithms 2 and 3, with the readings of docs/algorithms.md.

/// Settings for slice_scene.
struct SliceConfig {
  static constexpr double kMinCell = 0.01, kMaxCell = 1000;  ///< [m]

  double avatar_height = 1.75;  ///< Of the smallest avatar. [m, > 0]
  double resolution = 0.1;      ///< Largest loss of headroom. [m, >= 0.001]
  double cell = 0.1;            ///< Side of a cell. [m, kMinCell to kMaxCell]
  int32_t workers = 0;  ///< Threads to use, 0 for all cores. Never changes the result. [>= 0]
};

/// A slice that was kept. Heights are whole millimetres.
struct Slice {
  int32_t height = 0;  ///< Height of the cut. [mm]
  /// Highest surface below, per cell; the far plane if there is none. [mm]
  std::vector<int32_t> surface;
};

/// All kept slices, highest first. Cell (x, z) is index z * width + x and covers
/// [origin_x + x * cell, origin_x + (x + 1) * cell] and likewise in z.
struct SliceSet {
  int32_t width = 0;                   ///< Cells along X.
  int32_t depth = 0;                   ///< Cells along Z.
  double cell = 0;                     ///< Side of a cell. [m]
  double origin_x = 0;                 ///< [m]
  double origin_z = 0;                 ///< [m]
  int32_t far_plane = 0;               ///< eq. 2: min_y - resolution. [mm]
  int32_t avatar_height = 0;           ///< Of the smallest avatar. [mm]
  int32_t resolution = 0;              ///< [mm]
  int32_t taken = 0;                   ///< Slices cut, kept or not.
  std::vector<int32_t> taken_heights;  ///< [mm], highest first
  std::vector<Slice> kept;
};

/// Cuts a scene into slices by one sweep over columns of spans. Time: spans + cells x slices cut.
/// Fails with kBadConfig, kBadInput (no triangles), kLimit (grid too large), kCancelled.
[[nodiscard]] THRONG_API Result<SliceSet> slice_scene(const Scene& scene, const SliceConfig& config,
                                                      Context& context);

/// A slice as [ML06] section 3.3 stores it.
struct DepthSlice {
  static constexpr uint16_t kNone = 65535;  ///< No surface, or one that is deeper than 65.534 m.
  int32_t height = 0;                       ///< Height of the cut. [mm]
  std::vector<uint16_t> depths;             ///< Of the highest surface below it, per cell. [mm]
  /// Height of the surface in a cell whose depth is not kNone. [mm]
  [[nodiscard]] int32_t surface(size_t cell) const { return height - depths[cell]; }
};

/// Slices with 16 bits a cell, highest first, cells as in SliceSet. Where a floor lies deeper below
/// a kept slice than 16 bits can say, and the next slice does not serve it, extra slices stand
/// between the two: a body whose height and two steps are at most kMaxBody may make the same moves
/// as on the SliceSet.
struct DepthSlices {
  static constexpr int32_t kMaxBody = 20000;  ///< [mm]
  int32_t width = 0;                          ///< Cells along X.
  int32_t depth = 0;                          ///< Cells along Z.
  double cell = 0;                            ///< Side of a cell. [m]
  double origin_x = 0;                        ///< [m]
  double origin_z = 0;                        ///< [m]
  int32_t far_plane = 0;                      ///< [mm]
  int32_t avatar_height = 0;                  ///< Of the smallest avatar. [mm]
  int32_t resolution = 0;                     ///< [mm]
  int32_t taken = 0;                          ///< Slices cut, kept or not.
  int32_t extra = 0;                          ///< Of the slices, those added for their depth.
  std::vector<DepthSlice> slices;
  [[nodiscard]] uint64_t bytes() const { return slices.size() * 2 * uint64_t(width) * depth; }
};

/// The slices with 16 bits a cell. Time: linear in cells x slices. Fails with kLimit above 16 GiB.
[[nodiscard]] THRONG_API Result<DepthSlices> store_depths(const SliceSet& slices);
/// Writes `path`, whole or not at all. Fails with kIo, and kLimit above 2 GB.
[[nodiscard]] THRONG_API Result<void> save_slices(const DepthSlices& slices,
                                                  const std::string& path);
/// Reads what save_slices wrote. Fails with kIo (missing) or kBadFile: no slices, damaged, of
/// another version.
[[nodiscard]] THRONG_API Result<DepthSlices> load_slices(const std::string& path);
/// Does the file begin as one of save_slices does?
[[nodiscard]] THRONG_API bool is_slice_file(const std::string& path);

/// Draws one slice as [ML06] figures 9 and 10 do: darker is higher.
[[nodiscard]] THRONG_API Image draw_slice(const DepthSlices& slices, size_t index);

// ----
// A crowd on the slices themselves, by [ML06] algorithm 1: for comparison with the level tiles, on
// which all other crowds walk.

/// What one step of wanderers did.
struct WanderReport {
  uint64_t step = 0;  ///< Number of the step just made, from 1.
  uint64_t moved = 0;
  uint64_t blocked_by_wall = 0;  ///< The straight move was illegal.
  uint64_t blocked_by_avatar = 0;
  uint64_t waited = 0;      ///< Neither the straight nor the turned move was free.
  double seconds_sort = 0;  ///< Wall clock, as all three.
  double seconds_move = 0;
  double seconds_total = 0;
};

/// Avatars of one class, for SliceWanderers::create.
struct SliceGroup {
  AvatarClass avatar;
  uint32_t count = 1000;
};

/// Settings for SliceWanderers::create.
struct SliceWanderConfig {
  std::vector<SliceGroup> groups;  ///< Ids in their order; all are added, or none. [1 to 16]
  double dt = 0.1;                 ///< Length of a step. [s, 0.001 to 10]
  uint64_t seed = 1;
  int32_t workers = 0;  ///< Threads to use, 0 for all cores. Never changes the result. [>= 0]
};

/// Wanderers on slices: straight on; left or right at random when blocked. A body covers the cells
/// that its bounding square touches, all of which it may enter by algorithm 1 (slice_move.h says
/// what the printed one lacks); no other body is in any of them. Its feet are on the highest
/// surface that it covers. Of a class: height, radius, step height and speed. Source: [ML06]
/// section 4. Movable, not copyable.
class THRONG_API SliceWanderers {
 public:
  /// Makes the avatars where they can stand without overlap. Fails with kLimit and how many fit,
  /// kBadConfig.
  [[nodiscard]] static Result<SliceWanderers> create(DepthSlices slices,
                                                     const SliceWanderConfig& config);
  SliceWanderers(SliceWanderers&&) noexcept;
  SliceWanderers& operator=(SliceWanderers&&) noexcept;
  ~SliceWanderers();

  /// Advances all avatars by `dt`. Time: avatars x cells that a body covers.
  WanderReport step();
  /// Tests the present positions against the slices and each other, without the step's own data.
  /// All counts must be 0.
  [[nodiscard]] CrowdCheck check() const;
  /// XXH3 of all avatars in order of id. Same for any workers.
  [[nodiscard]] uint64_t state_hash() const;
  /// Reads all avatars in order of id into `out` (resized).
  void read(std::vector<AvatarState>& out) const;
  [[nodiscard]] uint32_t size() const;
  [[nodiscard]] uint64_t bytes() const;  ///< Memory of slices, occupancy and avatars.
  [[nodiscard]] const DepthSlices& slices() const;

 private:
  struct State;
  explicit SliceWanderers(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

// ----
// A crowd of wanderers: avatars without goals that walk straight on and turn at random when
// blocked. They never enter a wall and never overlap. For avatars with goals see throng/crowd.h.

/// Wanderers of one class more.
struct WanderGroup {
  int32_t avatar_class = 0;  ///< Index into the world's classes.
  uint32_t avatars = 0;
};

/// Settings for Wanderers::create.
struct WanderConfig {
  uint32_t avatars = 1000;   ///< All are added, or none.
  int32_t avatar_class = 0;  ///< Class of the avatars, index into the world's classes.
  double dt = 0.1;           ///< Length of a step. [s, 0.001 to 10]
  double speed = 0;          ///< Walking speed of all, 0 for the class's own. [m/s, >= 0]
  uint64_t seed = 1;
  int32_t workers = 0;  ///< Threads to use, 0 for all cores. Never changes the result. [>= 0]
  /// More avatars, of other heights, widths and steps; their ids follow, group by group. [<= 15]
  std::vector<WanderGroup> also{};
};

/// Wanderers: straight on; left or right at random when blocked. Source: [ML06] section 4, [TC00]
/// 3. Movable, not copyable; several crowds can exist side by side.
class THRONG_API Wanderers {
 public:
  /// Makes the avatars at places where they can stand without overlap. Fails with kLimit and how
  /// many fit, kNotFound (class), kBadConfig.
  [[nodiscard]] static Result<Wanderers> create(const World& world, const WanderConfig& config);
  Wanderers(Wanderers&&) noexcept;
  Wanderers& operator=(Wanderers&&) noexcept;
  ~Wanderers();

  /// Advances all avatars by `dt`. No allocation after the first step. Time: linear in the avatars.
  WanderReport step();
  /// Tests the present positions against the world and each other, without the step's own data. All
  /// counts must be 0. Time: about linear in the avatars.
  [[nodiscard]] CrowdCheck check() const;
  /// XXH3 of all avatars in order of id: position, level, heading. Same for any workers.
  [[nodiscard]] uint64_t state_hash() const;
  /// Reads all avatars in order of id into `out` (resized).
  void read(std::vector<AvatarState>& out) const;
  [[nodiscard]] uint32_t size() const;
  [[nodiscard]] uint64_t bytes() const;  ///< Memory held by the crowd itself.

 private:
  struct State;
  explicit Wanderers(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};
}  // namespace throng

namespace throng::caacd {

// ----
// Curvilinear avoidance between avatars: pure functions from one body and its neighbours to a
// steering force. They need no world, no clock and no memory, so any crowd may call them: one of
// SteeringModel::kCurvilinear does. Y is up; walkers have equal y. Units are
// the caller's, but must agree; the paper's time unit is one frame. Only arithmetic and sqrt are
// used, so results are the same bytes on every machine. Coordinates, speeds and settings must be
// finite and below 1e100. Source: [CAACD] II and III, as docs/algorithms.md reads them.

/// Radii of the concentric protection fields of one body, or of a pair. [>= 0, ascending]
struct Fields {
  double repulsive = 0;   ///< Two bodies nearer than this collide.
  double precaution = 0;  ///< What comes nearer than this is critical.
  double alert = 0;       ///< What comes nearer than this is a threat.
};

/// The fields of a pair of bodies: the sums of their radii, r = A_r + B_r.
[[nodiscard]] THRONG_API Fields joint_fields(const Fields& a, const Fields& b);

/// The state of a pair: by the field of the pair in which their distance lies.
enum class State : uint8_t { kTolerable, kAlert, kCritical, kCollision };

/// The state of a pair at a distance. A bound belongs to the inner state: d <= r_rep is a
/// collision.
[[nodiscard]] THRONG_API State state_at(double distance, const Fields& joint);

/// An avatar as the functions below see it: oneself or another one.
struct Body {
  Vec3d position;
  Vec3d velocity;
  Vec3d forward{1, 0, 0};  ///< Heading, also while it stands. [unit length]
  Fields fields;
  uint32_t id = 0;  ///< Breaks ties; unique among neighbours.
};

/// A fixed circle. Its solid part ends at its repulsive field.
struct Obstacle {
  Vec3d position;
  Fields fields;
};

/// How eq. 10 measures the length of a vector.
enum class Length : uint8_t {
  kTrue,  ///< Its length.
  /// lambda1 max + lambda2 (sum - max) of the absolute coordinates, lambda1 + lambda2 = 1. In a
  /// plane it is at most sqrt(lambda1^2 + lambda2^2) of the true length; it is at least the minimum
  /// of lambda1, 1 / sqrt 2 and, off a plane, (1 + lambda2) / sqrt 3 of it.
  kMaxAndSum,
};

/// What makes an avatar avoid another one. For obstacles the probe alone decides.
enum class Trigger : uint8_t {
  kNever,   ///< For comparison: no avatar avoids anything.
  kThreat,  ///< Any critical or alert threat: [CAACD] III.A, last paragraph.
  kNear,    ///< Such a threat inside the alert field; farther ones are tolerable: [CAACD] II.
  kZones,   ///< Such a threat whose probe meets one's own: [CAACD] II, figure 7.
};

/// What makes one threat more urgent than another.
enum class Order : uint8_t {
  kTime,  ///< As printed: the earlier nearest approach, then the smaller distance.
  /// Its future work: a collision before what is critical, and that before an alert; then as
  /// printed. Two bodies collide that touch now or will at their nearest approach.
  kState,
};

/// The axes along which eq. 11 pushes.
enum class Axes : uint8_t { kSide, kSideAndUp };

/// Settings of the model. The first three are the paper's Mass/MaxSpeed/MaxForce, of which it names
/// 2.0/0.4/0.06 the best; it prints no values for the others, which are ours:
/// docs/design/007-caacd.md.
struct Model {
  double mass = 2.0;        ///< [> 0]
  double max_speed = 0.4;   ///< [length / time, > 0]
  double max_force = 0.06;  ///< [mass length / time^2, > 0]
  double horizon = 60;      ///< T3: a nearest approach later than this is no threat. [time, > 0]
  double lambda1 = 0.75;    ///< Of eq. 10, see Length; lambda2 is 1 - lambda1. [0.5 to 1]
  double lambda3 = 0.5;     ///< Share of max_speed in eq. 12 and 13. [0 to 1]
  /// Psi: distance from the target at which braking begins. [length, > 0]
  double deceleration = 30;
  double probe_time = 0;  ///< The length of a probe is A_pre + speed x probe_time. [time, >= 0]
  Length length = Length::kTrue;
  Trigger trigger = Trigger::kNear;
  Axes axes = Axes::kSide;
  Order order = Order::kTime;
};

/// Checks the settings. Fails with kBadConfig and the setting that is out of its limits.
[[nodiscard]] THRONG_API Result<void> check_model(const Model& model);

/// The nearest approach of two straight courses, eq. 1 to 6.
struct Approach {
  double speed = 0;  ///< R_s, eq. 2: the relative speed.
  /// A_tau, eq. 6: time until the nearest approach, negative if the courses diverge. 0 if R_s is 0:
  /// parallel courses have no nearest approach, so the present distance counts.
  double time = 0;
};
/// The nearest approach of `other` to `self`.
[[nodiscard]] THRONG_API Approach nearest_approach(const Body& self, const Body& other);

/// Position of a body after a time, eq. 7 and 8.
[[nodiscard]] THRONG_API Vec3d position_at(const Body& body, double time);

/// The length of B_Rcp = A_cp - B_cp (eq. 9) by eq. 10, measured as model.length says.
[[nodiscard]] THRONG_API double convergence_distance(Vec3d relative, const Model& model);

/// A body or obstacle whose course comes too near.
struct Threat {
  static constexpr uint32_t kObstacle = UINT32_MAX;  ///< The `id` of all obstacles.
  /// kAlert or kCritical, with Order::kState also kCollision; kTolerable if there is no threat.
  State state = State::kTolerable;
  double time = std::numeric_limits<double>::infinity();      ///< A_tau.
  double distance = std::numeric_limits<double>::infinity();  ///< B_d.
  uint32_t id = kObstacle;  ///< Body::id of the threat; kObstacle for an obstacle.
  Vec3d now;                ///< B_p.
  Vec3d self_then;          ///< A_cp.
  Vec3d other_then;         ///< B_cp.
};

/// The threat that `other` is to `self`: critical if B_d <= r_pre, alert if B_d <= r_alert, both
/// with A_tau in [0, T3) and by model.trigger; else tolerable.
[[nodiscard]] THRONG_API Threat threat_of(const Body& self, const Body& other, const Model& model);

/// The threat that an obstacle is to `self`: critical as soon as the probe overlaps its precaution
/// field, if it lies ahead or around.
[[nodiscard]] THRONG_API Threat threat_of(const Body& self, const Obstacle& obstacle,
                                          const Model& model);

/// Is `a` more urgent than `b`? The worse state is, if `order` says so; then the smaller A_tau,
/// then the smaller B_d, then the smaller id.
[[nodiscard]] THRONG_API bool more_urgent(const Threat& a, const Threat& b,
                                          Order order = Order::kTime);

/// The most urgent threat. A body in `others` with the id of `self` is ignored, as are bodies
/// farther away than `search_radius`.
[[nodiscard]] THRONG_API Threat greatest_threat(const Body& self, std::span<const Body> others,
                                                std::span<const Obstacle> obstacles,
                                                const Model& model, double search_radius = 1e150);

/// Distance beyond which no body is a threat to `self`, if none is faster than model.max_speed and
/// none has an alert field larger than `alert`.
[[nodiscard]] THRONG_API double threat_radius(const Body& self, double alert, const Model& model);

/// Length of a body's probe: a rectangle as wide as the repulsive field, from the position along
/// the heading.
[[nodiscard]] THRONG_API double probe_length(const Body& body, const Model& model);

/// Do two probes overlap? Heights are ignored.
[[nodiscard]] THRONG_API bool probes_meet(const Body& a, const Body& b, const Model& model);

/// Does the probe of `body` overlap a disc? Heights are ignored.
[[nodiscard]] THRONG_API bool probe_overlaps(const Body& body, Vec3d centre, double radius,
                                             const Model& model);

/// The horizontal unit vector to the right of a heading.
[[nodiscard]] THRONG_API Vec3d right_of(Vec3d forward);

/// The lateral force, eq. 11: along the side axis (and the up axis for flyers), away from where the
/// threat will be. If that product is 0, the other is dead ahead or behind: to the right of one
/// ahead, to the left of one behind; if both are in one point, to the right for the smaller id.
[[nodiscard]] THRONG_API Vec3d lateral_avoidance(const Body& self, const Threat& threat,
                                                 const Model& model);

/// The forward force. Below lambda3 x max_speed by eq. 12: on. From there on by eq. 13: faster if
/// the other will pass behind, slower if it will pass in front.
[[nodiscard]] THRONG_API Vec3d forward_avoidance(const Body& self, const Threat& threat,
                                                 const Model& model);

/// The avoidance force, eq. 14, at most max_force long.
[[nodiscard]] THRONG_API Vec3d avoidance(const Body& self, const Threat& threat,
                                         const Model& model);

/// The force of path amendment: it turns towards `target` at full speed. From psi before the place
/// to stop, which is `stop_before` ahead of the target, it brakes evenly. At most max_force long.
[[nodiscard]] THRONG_API Vec3d path_amendment(const Body& self, Vec3d target, double stop_before,
                                              const Model& model);

/// The new velocity, eq. 15 with the mass that the text and its experiments have: v + steer / mass
/// x dt, at most max_speed long.
[[nodiscard]] THRONG_API Vec3d steered(Vec3d velocity, Vec3d steer, double dt, const Model& model);

/// The heading of a velocity, or `before` if the velocity is (nearly) zero.
[[nodiscard]] THRONG_API Vec3d heading_of(Vec3d velocity, Vec3d before);

/// An acceleration as curvilinear motion: a_t along the heading changes the speed, a_n across it
/// the direction.
struct Curvilinear {
  double tangential = 0;   ///< Negative when braking.
  double centripetal = 0;  ///< [>= 0]
};
/// Splits an acceleration into its parts along and across a heading.
[[nodiscard]] THRONG_API Curvilinear curvilinear(Vec3d forward, Vec3d acceleration);

/// Does `a` go first when both head to one place? The nearer one does, then the smaller id.
[[nodiscard]] THRONG_API bool goes_first(const Body& a, Vec3d target_a, const Body& b,
                                         Vec3d target_b);

// ----
// The experiment of [CAACD] section V: avatars walk to random targets on a plane with circular
// obstacles, and collisions of pairs are counted. Lengths are the paper's "float units", time is
// in frames; coordinates are x and z, y is 0.

/// Settings of a random space. The paper gives none of these numbers; they are ours:
/// docs/design/007-caacd.md.
struct SpaceConfig {
  int32_t avatars = 50;          ///< [1 to 2000]
  double side = 400;             ///< Starts and targets lie in a square of this side. [> 0]
  Fields fields{5, 7.5, 12};     ///< Of every avatar. [> 0, ascending]
  int32_t obstacles = 6;         ///< [0 to 1000]
  double min_obstacle = 8;       ///< Smallest repulsive radius of an obstacle. [> 0]
  double largest_obstacle = 24;  ///< [>= min_obstacle]
  double obstacle_precaution =
      5;                       ///< Precaution radius less repulsive radius, of an obstacle. [>= 0]
  double obstacle_alert = 15;  ///< Alert radius less repulsive radius. [>= obstacle_precaution]
  uint64_t seed = 1;
};

/// A space: avatars, their targets and obstacles. targets[i] belongs to bodies[i], whose id is i.
struct Space {
  std::vector<Body> bodies;
  std::vector<Vec3d> targets;
  std::vector<Obstacle> obstacles;
};

/// Makes a random space: obstacles, starts (no two in each other's precaution field), headings,
/// speeds and targets. Starts and targets lie outside of all alert fields of obstacles. The same
/// seed gives the same places for every model. Fails with kBadConfig, or with kLimit if they do not
/// fit.
[[nodiscard]] THRONG_API Result<Space> random_space(const SpaceConfig& config, const Model& model);

/// What an avatar does now.
enum class Activity : uint8_t {
  kTravelling,  ///< To its target.
  kAvoiding,    ///< Its greatest threat.
  kArriving,    ///< Braking, within psi of its target.
  kWaiting,     ///< Until another avatar has left the place to which both head.
  kArrived,     ///< It stands.
};

/// Counts of a run so far.
struct Counts {
  int64_t frames = 0;               ///< Calls of Simulation::step.
  int64_t collisions = 0;           ///< Entries of a pair into r_rep.
  int64_t obstacle_collisions = 0;  ///< Entries of an avatar into an obstacle's r_rep.
  int64_t arrived = 0;              ///< Avatars that stand at their targets now.
  int64_t waiting = 0;              ///< Avatars that wait for another one to leave now.
  double walked = 0;                ///< Summed over avatars. [length]
};

/// The paper's Mass/MaxSpeed/MaxForce.
struct ParameterSet {
  double mass = 2.0;
  double max_speed = 0.4;
  double max_force = 0.06;
  friend bool operator==(const ParameterSet&, const ParameterSet&) = default;
};

/// One run of the experiment. Each frame takes all forces from the state of the frame before,
/// applies eq. 15, and updates positions, arrivals and collisions. Movable, not copyable.
class THRONG_API Simulation {
 public:
  /// Begins a run. Fails with kBadConfig (model, dt) or kBadInput (not finite, sizes differ, ids
  /// not in order).
  [[nodiscard]] static Result<Simulation> create(Space space, const Model& model, double dt = 1);
  Simulation(Simulation&&) noexcept;
  Simulation& operator=(Simulation&&) noexcept;
  ~Simulation();

  /// Advances by one frame of `dt`. Time: quadratic in the bodies.
  void step();
  /// Is each avatar at its target, or standing still while it waits?
  [[nodiscard]] bool finished() const;

  // One entry per avatar, by id; valid as long as the simulation, and changed by step and send.
  [[nodiscard]] std::span<const Body> bodies() const;
  [[nodiscard]] std::span<const Vec3d> targets() const;
  [[nodiscard]] std::span<const Activity> activities() const;
  /// The greatest threat of each avatar in the last step, from the state before it. Without a
  /// threat its state is kTolerable, as it is for avatars that had arrived and before the first
  /// step.
  [[nodiscard]] std::span<const Threat> threats() const;

  /// The obstacles of the space; they never change.
  [[nodiscard]] std::span<const Obstacle> obstacles() const;
  /// Counts since the run began.
  [[nodiscard]] const Counts& counts() const;
  /// The settings that it was created with.
  [[nodiscard]] const Model& model() const;
  /// Gives an avatar a Mass, MaxSpeed and MaxForce of its own, from the next step on. Fails with
  /// kNotFound (no such body) or kBadConfig.
  [[nodiscard]] Result<void> set_parameters(uint32_t id, const ParameterSet& set);
  /// The values of an avatar: its own, or those of model(). [id: of a body]
  [[nodiscard]] ParameterSet parameters(uint32_t id) const;
  /// Hash of all positions and velocities, bit by bit.
  [[nodiscard]] uint64_t state_hash() const;
  /// Gives an avatar a new target. Fails with kNotFound (no such body) or kBadInput. Time:
  /// quadratic in the bodies.
  [[nodiscard]] Result<void> send(uint32_t id, Vec3d target);

 private:
  struct Run;
  explicit Simulation(std::unique_ptr<Run> run);
  std::unique_ptr<Run> run_;
};

/// The name of a set as the paper writes it: "2.0/0.4/0.06".
[[nodiscard]] THRONG_API std::string name_of(const ParameterSet& set);
/// A model with the set's mass, speed and force.
[[nodiscard]] THRONG_API Model with_set(Model model, const ParameterSet& set);

/// The sets that the paper names: the two bad ones, then the best one.
[[nodiscard]] THRONG_API std::vector<ParameterSet> named_sets();

/// A grid over the paper's ranges: masses 1, 1.5, 2; speeds 0.4 to 1.2 by 0.2; forces 0.02, 0.06,
/// 0.10, 0.20. It contains the named sets. The paper does not say which sets it ran.
[[nodiscard]] THRONG_API std::vector<ParameterSet> grid_sets();

/// The number of collisions that the paper reports at most, by the number of avatars.
struct Reported {
  int32_t bad = 0;     ///< Figure 10: 1.0/1.0/0.06 and 1.0/0.8/0.06.
  int32_t others = 0;  ///< Figure 11: all other sets.
};
/// The paper's numbers of collisions for a number of avatars.
[[nodiscard]] THRONG_API Reported reported_collisions(int32_t avatars);

/// Settings of a study: one run for each set, number of avatars and seed.
struct StudyConfig {
  std::vector<ParameterSet> sets = named_sets();
  std::vector<int32_t> avatars = {};  ///< Numbers of avatars. [each 1 to 2000]
  int32_t seeds = 30;                 ///< [1 to 100000]
  int64_t frames = 3000;              ///< A run ends here, or when all have arrived. [1 to 10^7]
  Model model = {};                   ///< All but mass, max_speed and max_force.
  SpaceConfig space = {};             ///< All but avatars; seeds count up from space.seed.
  double dt = 1;                      ///< [frames, 0.001 to 1000]
  int32_t workers = 0;  ///< Threads, 0 for all cores. Never changes the result. [>= 0]
};

/// Results of one set with one number of avatars, over all seeds.
struct StudyCell {
  double mean = 0;       ///< Collisions per run.
  double deviation = 0;  ///< Standard deviation over seeds, n - 1; 0 for one seed.
  int64_t min_collisions = 0;
  int64_t max_collisions = 0;
  double obstacle_mean = 0;  ///< Entries into obstacles per run.
  double arrived = 0;        ///< Share of the avatars, at the end. [0 to 1]
  double waiting = 0;        ///< Share of the avatars, at the end. [0 to 1]
  double frames = 0;         ///< Mean.
  double walked = 0;         ///< Mean per avatar. [length]
};

/// cells[set * avatars.size() + count].
struct Study {
  std::vector<ParameterSet> sets;
  std::vector<int32_t> avatars;
  std::vector<StudyCell> cells;
  uint64_t hash = 0;  ///< Hash of the last states of all runs, in order.
  [[nodiscard]] const StudyCell& at(size_t set, size_t count) const {
    return cells[set * avatars.size() + count];
  }
};

/// Runs a study, several runs in parallel. Fails with kBadConfig, kLimit (the avatars do not fit),
/// kCancelled.
[[nodiscard]] THRONG_API Result<Study> run_study(const StudyConfig& config, Context& context);

// ----
// Pictures of the plane of the experiment.

/// Settings for draw_simulation.
struct PictureConfig {
  double side = 400;     ///< The square from (0, 0) that is shown. [> 0]
  int32_t width = 1200;  ///< [px, 400 to 8000]
  std::string title = {};
};

/// Draws the present state as [CAACD] figure 9 does: obstacles, avatars with their fields, headings
/// and probes, and targets. trails[i], if given, holds the earlier positions of avatar i. Fails
/// with kBadConfig.
[[nodiscard]] THRONG_API Result<Image> draw_simulation(const Simulation& simulation,
                                                       std::span<const std::vector<Vec3d>> trails,
                                                       const PictureConfig& config);

}  // namespace throng::caacd
