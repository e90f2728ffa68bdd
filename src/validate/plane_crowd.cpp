// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "validate/plane_crowd.h"

#include <utility>

#include "throng/bake.h"

// The world is baked from polygons; velocities are differences of positions over a step.
namespace throng::validate {

Polygon box(double x0, double z0, double x1, double z1) {
  return {.outer = {{x0, z0}, {x1, z0}, {x1, z1}, {x0, z1}}, .holes = {}};
}

CrowdTuning tuning_of(const ValidationConfig& config) {
  CrowdTuning tuning;
  if (config.pushing) tuning.let_push();
  return tuning;
}

Result<World> bake_plane(const PlaneConfig& plane, const AvatarClass& body,
                         const ValidationConfig& config, Context& context) {
  const auto scene = create_plane_scene(plane);
  if (!scene) return scene.error();
  return bake_world(
      *scene, {.cell = kCell, .zone = 51.2, .classes = {body}, .workers = config.workers}, context);
}

Result<PlaneCrowd> PlaneCrowd::create(const World& world, Routing routing,
                                      const ValidationConfig& config, double dt) {
  auto crowd = Crowd::create(world, {.dt = dt,
                                     .seed = config.seed,
                                     .workers = config.workers,
                                     .routing = routing,
                                     .model = config.model,
                                     .tuning = tuning_of(config)});
  if (!crowd) return crowd.error();
  return PlaneCrowd(world, *std::move(crowd), dt);
}

Result<PlaneCrowd> PlaneCrowd::create(const PlaneConfig& plane, const AvatarClass& body,
                                      Routing routing, const ValidationConfig& config,
                                      Context& context) {
  const auto world = bake_plane(plane, body, config, context);
  if (!world) return world.error();
  return create(*world, routing, config);
}

Result<std::vector<AvatarId>> PlaneCrowd::add(std::span<const Point2> starts,
                                              std::span<const double> speeds, Context& context) {
  std::vector<AvatarSpawn> spawns;
  std::vector<size_t> index_of;
  for (size_t i = 0; i < starts.size(); ++i) {
    const Place place = world_.find_place(0, {starts[i].x, 0, starts[i].z}, 0.5);
    if (!place) continue;
    spawns.push_back({.place = place, .speed = speeds[i]});
    index_of.push_back(i);
  }
  const auto added = crowd_.add(spawns, context);
  if (!added) return added.error();
  std::vector<AvatarId> ids(starts.size());
  for (size_t k = 0; k < added->size(); ++k) {
    const AvatarId id = (*added)[k];
    if (!id) continue;
    ids[index_of[k]] = id;
    if (id.slot1 > id_of_slot_.size()) id_of_slot_.resize(id.slot1);
    id_of_slot_[id.slot1 - 1] = id;
  }
  observe(/*has_moved=*/false);
  return ids;
}

Result<std::vector<AvatarId>> PlaneCrowd::add_fitting(std::span<const Point2> starts, double speed,
                                                      Context& context) {
  auto ids = add(starts, std::vector<double>(starts.size(), speed), context);
  if (ids) std::erase_if(*ids, [](AvatarId id) { return !id; });
  return ids;
}

bool PlaneCrowd::set_goal(AvatarId id, Point2 goal) {
  const Place place = world_.find_place(0, {goal.x, 0, goal.z}, 0.5);
  if (!place) return false;
  crowd_.set_goals({&id, 1}, {&place, 1});
  return true;
}

void PlaneCrowd::observe(bool has_moved) {
  crowd_.read(states_);
  avatars_.clear();
  last_position_.resize(id_of_slot_.size());
  for (const AvatarState& state : states_) {
    Point2& last = last_position_[state.id];
    const Point2 now{state.position.x, state.position.z};
    AvatarMotion motion{.id = id_of_slot_[state.id],
                        .x = now.x,
                        .z = now.z,
                        .heading_x = state.heading_x,
                        .heading_z = state.heading_z};
    if (has_moved) {
      motion.vx = (now.x - last.x) / dt_;
      motion.vz = (now.z - last.z) / dt_;
    }
    last = now;
    avatars_.push_back(motion);
  }
}

void PlaneCrowd::step() {
  crowd_.step();
  observe(/*has_moved=*/true);
  if (++steps_ % 10 != 0) return;
  const CrowdCheck found = crowd_.check();
  faults_.overlaps += found.overlaps;
  faults_.wall_entries += found.wall_entries;
  ++checks_;
}

void PlaneCrowd::report(ValidationResult& result) const {
  result.faults.overlaps += faults_.overlaps;
  result.faults.wall_entries += faults_.wall_entries;
  result.checks += checks_;
  result.simulated += time();
}

}  // namespace throng::validate
