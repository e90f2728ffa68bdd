// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "crowd/ground/body.h"
#include "crowd/ground/obstacle_grid.h"
#include "crowd/mode/engine_counts.h"
#include "crowd/mode/shared_state.h"
#include "crowd/obstacles/obstacle_set.h"
#include "throng/avatar.h"
#include "throng/base.h"
#include "throng/crowd.h"
#include "throng/surface.h"
#include "throng/world.h"

/// The contract of the modes in which avatars move: WalkMode, LinkMode, FlyMode,
/// ClimbMode.
namespace throng::crowd {

/// An avatar that is to be added.
struct NewAvatar {
  Body body;
  double radius = 0;   // its own [m]
  NodePlace on_nodes;  // where a climber stands
};

/// What a body occupies at most, however it moves. [units, units, mm]
struct BodyExtent {
  int32_t widest = 0, narrowest = INT32_MAX, tallest = 0;
};

/// (obstacle, index of the body), in order.
using BlockerPairs = std::vector<std::pair<uint32_t, uint32_t>>;

/// How avatars of some classes move: what is known of these classes, a table by slot, and an
/// engine. Each class in use has one mode, which the crowd looks up once: climb for those over
/// nodes, fly for those with air, else link. Calls for one avatar go to the mode of its class.
/// Those that say "of any class", and those for a class, an obstacle or the whole crowd, go to all
/// modes, in the order walk, link, fly, climb. What each has:
/// - Walk has the ground and the flow fields of every class, and its engine holds all bodies.
/// - Link has a WalkMode: its avatars are walkers but on off-mesh links.
/// - Fly has a WalkMode: on foot its avatars are walkers, and it decides when they take off.
/// - Climb is alone: its avatars never walk on level tiles.
/// The engines call their own mode without this contract, so what is virtual here is never called
/// for each avatar of a step.
class Mode {
 public:
  explicit Mode(SharedState& shared) : shared_(shared) {}
  Mode(const Mode&) = delete;
  Mode& operator=(const Mode&) = delete;
  virtual ~Mode() = default;

  // Classes, of which the shared state holds the ground.

  /// Takes a class into use; of any class: nothing if its avatars never have this mode. Fails as
  /// Crowd::add does; then nothing was taken.
  virtual Result<void> open_class(size_t number, Context& context) = 0;
  /// Reverts open_class, of any class.
  virtual void close_class(size_t number) = 0;

  // New avatars, of classes in use.

  /// Puts an avatar where it is to be added. False: it may not be there.
  [[nodiscard]] virtual bool put(NewAvatar& avatar, const AvatarSpawn& spawn) const = 0;
  /// To be called before draw. False: there is no place. Fails with kBadConfig: it never has this
  /// mode.
  virtual Result<bool> begin_draws(const AvatarSpawn& like) = 0;
  /// Puts an avatar at the n-th random place of a stream. False: it may not be there.
  [[nodiscard]] virtual bool draw(NewAvatar& avatar, const AvatarSpawn& like, uint64_t n) const = 0;
  /// Makes the row of an avatar of any class, which was given its slot.
  virtual void add(const NewAvatar& avatar) = 0;
  /// `radius`: the body's own. [m]
  [[nodiscard]] virtual BodyExtent extent_of(const Body& body, double radius) const;
  /// No body of any class is larger or faster. [m/s]
  virtual void fit(const BodyExtent& all, float fastest) = 0;

  // What an avatar is to do. The caller resets its target and its detour.

  /// Nowhere: it stops.
  virtual void set_goal(Body& body, const Place& goal) = 0;
  /// Heads to Body::target. Of any class.
  virtual void set_target(Body& body) = 0;
  virtual void set_velocity(Body& body, const Vec3d& velocity) = 0;

  // The step.

  /// Plans, and moves all bodies that have this mode now. Adds to the shared state's arrived,
  /// goal_unreachable and counts of searches. WalkMode may reorder the bodies.
  virtual void step(std::span<Body> bodies, EngineCounts& counts, EngineTimes& times) = 0;

  // Changes of the world.

  /// Obstacles have blocked cells of the grounds, or freed some.
  virtual void ground_changed() {}
  /// The costs of ground, or the off-mesh links, have changed.
  virtual void areas_changed(std::span<Body> bodies);
  /// Updates the path finders of any class to an obstacle that paths avoid. `is_new`: its
  /// place is not the one that they know.
  virtual void sync_obstacle(CrowdObstacle& obstacle, size_t number, bool is_new) = 0;
  /// Path finders of all classes forget it.
  virtual void forget_obstacle(const CrowdObstacle& obstacle) = 0;
  /// Bodies whose paths lead through obstacles that became active or close need another path.
  virtual void cut_paths(std::span<const uint32_t> slots, std::span<Body> bodies) = 0;

  // Bodies that block obstacles, and leave them. docs/design/008-engine.md, "Obstacles".

  /// Adds the bodies with this mode that may be where obstacles would appear or pass.
  virtual void add_blockers(std::span<const uint32_t> slots, std::span<const Body> bodies,
                            BlockerPairs& found) const = 0;
  /// Is such a body really inside?
  [[nodiscard]] virtual bool is_inside(const Body& body,
                                       const ObstacleGrid::Item& obstacle) const = 0;
  /// Does such a body leave an obstacle that closes there?
  [[nodiscard]] virtual bool must_leave(const Body& body, const Prism& obstacle) const;
  /// Does the path of a body that has one lead out of obstacles soon, and never back? False: it
  /// plans an exit.
  [[nodiscard]] virtual bool leads_out(const Body& body, std::span<const uint32_t> slots) const = 0;
  /// A body is out of what it had to leave, and heads to its goal again.
  virtual void end_leaving(Body& body) = 0;

  // Reports.

  [[nodiscard]] virtual AvatarState state_of(const Body& body) const = 0;
  /// The body's own. [m]
  [[nodiscard]] virtual double height_of(const Body& body) const;
  /// Counts what check_bodies cannot know.
  virtual void check(std::span<const Body> bodies, CrowdCheck& found) const;
  /// Continues the hash of a body, which is of any class, with its row.
  [[nodiscard]] virtual uint64_t hash(const Body& body, uint64_t hash) const;
  virtual void add_memory(CrowdMemory& memory) const = 0;

  // Saved crowds: the rows of all slots, or none if no class in use ever had this mode.

  [[nodiscard]] virtual size_t row_count() const = 0;
  virtual void save(std::vector<uint8_t>& out) const = 0;
  /// Takes rows from what was saved, and returns what is behind them. Before any class is opened.
  virtual const uint8_t* restore(const uint8_t* saved, size_t rows) = 0;
  /// Can the row of a body, which is of any class, be read without reading out of bounds? The
  /// shared state's step is that of the saved crowd.
  [[nodiscard]] virtual bool is_sound(const Body& body) const = 0;
  /// Once its class is open: may a body, which is of any class, be where it is?
  [[nodiscard]] virtual bool is_in_place(const Body& body) const;

 protected:
  /// What all modes do in set_velocity. Returns the velocity, cut to the body's speed.
  static Vec3d control(Body& body, const Vec3d& velocity);

  SharedState& shared_;
};

}  // namespace throng::crowd
