// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "crowd/climb/climb.h"
#include "crowd/climb/climber_engine.h"
#include "crowd/climb/climber_ground.h"
#include "crowd/fly/fly_mode.h"
#include "crowd/mode/mode.h"
#include "path/edits/edit_list.h"
#include "path/overlay/node_finder.h"

/// Avatars that walk over nodes: where they are placed, and how they find and follow their paths.
/// docs/design/013-climbers.md. A path costs a search over nodes; a step without one is constant
/// time.
namespace throng::crowd {

class ClimbMode final : public Mode {
 public:
  static constexpr size_t kRowBytes = sizeof(Climb);

  /// `fly` outlives it: climbers see what flies.
  ClimbMode(SharedState& shared, const MoveConfig& config, const FlyMode& fly);

  /// A body at its feet, to test whether it is in a region.
  [[nodiscard]] Body at_feet(const Body& body) const;
  /// Nowhere: it stops.
  void set_goal(Body& body, const NodePlace& goal);

  Result<void> open_class(size_t number, Context& context) override;
  void close_class(size_t number) override;
  [[nodiscard]] bool put(NewAvatar& avatar, const AvatarSpawn& spawn) const override;
  Result<bool> begin_draws(const AvatarSpawn& like) override;
  [[nodiscard]] bool draw(NewAvatar& avatar, const AvatarSpawn& like, uint64_t n) const override;
  void add(const NewAvatar& avatar) override;
  [[nodiscard]] BodyExtent extent_of(const Body& body, double radius) const override;
  void fit(const BodyExtent& all, float fastest) override;
  void set_goal(Body& body, const Place& goal) override;
  void set_target(Body& body) override;
  void set_velocity(Body& body, const Vec3d& velocity) override;
  void step(std::span<Body> bodies, EngineCounts& counts, EngineTimes& times) override;
  void sync_obstacle(CrowdObstacle& obstacle, size_t number, bool is_new) override;
  void forget_obstacle(const CrowdObstacle& obstacle) override;
  void cut_paths(std::span<const uint32_t> slots, std::span<Body> bodies) override;
  void add_blockers(std::span<const uint32_t> slots, std::span<const Body> bodies,
                    BlockerPairs& found) const override;
  [[nodiscard]] bool is_inside(const Body& body, const ObstacleGrid::Item& obstacle) const override;
  [[nodiscard]] bool must_leave(const Body& body, const Prism& obstacle) const override;
  [[nodiscard]] bool leads_out(const Body& body, std::span<const uint32_t> slots) const override;
  void end_leaving(Body& body) override;
  void areas_changed(std::span<Body> bodies) override;
  [[nodiscard]] AvatarState state_of(const Body& body) const override;
  [[nodiscard]] double height_of(const Body& body) const override { return body.height * 1e-3; }
  void check(std::span<const Body> bodies, CrowdCheck& found) const override;
  [[nodiscard]] uint64_t hash(const Body& body, uint64_t hash) const override;
  void add_memory(CrowdMemory& memory) const override;
  [[nodiscard]] size_t row_count() const override { return climbs_.size(); }
  void save(std::vector<uint8_t>& out) const override;
  const uint8_t* restore(const uint8_t* saved, size_t rows) override;
  [[nodiscard]] bool is_sound(const Body& body) const override;
  [[nodiscard]] bool is_in_place(const Body& body) const override;

 private:
  struct OfClass {
    OfClass(const World& world, const Nodes& nodes, const path::NodeFinder& finder, size_t workers,
            int32_t number)
        : finders(workers, finder),
          areas(workers, path::AppliedEdits(path::AppliedEdits::Which::kAreas)),
          paths(workers),
          ground(world, nodes, finders[0], number) {}
    std::vector<path::NodeFinder> finders;  // one a worker
    std::vector<path::AppliedEdits> areas;  // by finder
    std::vector<Path> paths;
    ClimberGround ground;
  };
  void follow_areas(OfClass& parts);
  [[nodiscard]] OfClass& of(const Body& body) const { return *classes_[body.avatar_class]; }
  /// The place nearest to a place on the ground; none if there is none near.
  [[nodiscard]] NodePlace place_near(size_t number, const Place& place) const;
  [[nodiscard]] bool put_on_nodes(NewAvatar& avatar, const NodePlace& place) const;
  [[nodiscard]] Climb climb_at(const NewAvatar& avatar) const;
  void head_to(Body& body, const NodePlace& goal);
  void stop(Body& body);
  [[nodiscard]] bool meets(const Body& body, const AirObstacle& shape,
                           const path::Solid& solid) const;
  [[nodiscard]] bool meets(const Body& body, const Prism& prism) const;

  // climb_plan.cpp
  void plan(Body& body, Climb& climb, int32_t worker);
  void search(Body& body, Climb& climb, int32_t worker);
  [[nodiscard]] NodePlace place_of(const Body& body, const Climb& climb) const;
  void head_to_target_place(const Body& body, Climb& climb) const;
  void turn_aside(Body& body, Climb& climb, int32_t worker);
  void follow_velocity(const Body& body, Climb& climb, int32_t worker);
  bool step_aside(Body& body, Climb& climb, int32_t worker, double beside);

  // climb_leaving.cpp
  /// True: its path is not followed.
  bool plan_exit(Body& body, Climb& climb, int32_t worker);
  void find_exit_over_nodes(Body& body, Climb& climb, int32_t worker);

  // climb_check.cpp
  [[nodiscard]] bool is_enclosed(const Body& body) const;

  const FlyMode& fly_;
  ClimberEngine engine_;
  std::vector<std::unique_ptr<OfClass>> classes_;  // null: not in use, or not over nodes
  std::vector<Climb> climbs_;                      // by slot; empty, if there is no climber
  bool had_costs_ = false;                         // Areas cost more when they last changed.
};

}  // namespace throng::crowd
