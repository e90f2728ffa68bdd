// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "validate/room.h"

#include <utility>

#include "throng/bake.h"

namespace throng::validate {

AvatarClass walker() {
  AvatarClass body;
  body.name = "walker";
  body.radius = 0.19;
  return body;
}

Polygon box(double x0, double z0, double x1, double z1) {
  return {.outer = {{x0, z0}, {x1, z0}, {x1, z1}, {x0, z1}}, .holes = {}};
}

Result<Room> Room::build(const PlaneConfig& plane, const AvatarClass& body, Routing ways,
                         const ValidationConfig& config, Context& context) {
  const auto scene = make_plane_scene(plane);
  if (!scene) return scene.error();
  auto world = bake_world(
      *scene, {.cell = kCell, .zone = 51.2, .classes = {body}, .workers = config.workers}, context);
  if (!world) return world.error();
  auto crowd = Crowd::create(*world, {.dt = kStep,
                                      .seed = config.seed,
                                      .workers = config.workers,
                                      .ways = ways,
                                      .model = config.model});
  if (!crowd) return crowd.error();
  return Room(*std::move(world), *std::move(crowd));
}

Result<std::vector<AvatarId>> Room::place(std::span<const Spot> spots,
                                          std::span<const double> speeds, Context& context) {
  std::vector<AvatarSpawn> spawns;
  std::vector<size_t> whose;
  for (size_t i = 0; i < spots.size(); ++i) {
    const Place place = world_.find_place(0, {spots[i].x, 0, spots[i].z}, 0.5);
    if (!place) continue;
    spawns.push_back({.place = place, .speed = speeds[i]});
    whose.push_back(i);
  }
  const auto added = crowd_.add(spawns, context);
  if (!added) return added.error();
  std::vector<AvatarId> ids(spots.size());
  for (size_t k = 0; k < added->size(); ++k) {
    const AvatarId id = (*added)[k];
    if (!id) continue;
    ids[whose[k]] = id;
    if (id.slot1 > id_of_slot_.size()) id_of_slot_.resize(id.slot1);
    id_of_slot_[id.slot1 - 1] = id;
  }
  look(/*has_moved=*/false);
  return ids;
}

Result<std::vector<AvatarId>> Room::stand(std::span<const Spot> spots, double speed,
                                          Context& context) {
  auto ids = place(spots, std::vector<double>(spots.size(), speed), context);
  if (ids) std::erase_if(*ids, [](AvatarId id) { return !id; });
  return ids;
}

bool Room::send(AvatarId id, Spot goal) {
  const Place place = world_.find_place(0, {goal.x, 0, goal.z}, 0.5);
  if (!place) return false;
  crowd_.set_goals({&id, 1}, {&place, 1});
  return true;
}

void Room::look(bool has_moved) {
  crowd_.read(states_);
  seen_.clear();
  last_.resize(id_of_slot_.size());
  for (const AvatarState& state : states_) {
    Spot& last = last_[state.id];
    const Spot now{state.position.x, state.position.z};
    Seen seen{.id = id_of_slot_[state.id], .x = now.x, .z = now.z};
    if (has_moved) {
      seen.vx = (now.x - last.x) / kStep;
      seen.vz = (now.z - last.z) / kStep;
    }
    last = now;
    seen_.push_back(seen);
  }
}

void Room::step() {
  crowd_.step();
  look(/*has_moved=*/true);
  if (++steps_ % 10 != 0) return;
  const CrowdCheck found = crowd_.check();
  faults_.overlaps += found.overlaps;
  faults_.wall_entries += found.wall_entries;
  ++looks_;
}

void Room::report(ValidationResult& result) const {
  result.faults.overlaps += faults_.overlaps;
  result.faults.wall_entries += faults_.wall_entries;
  result.looks += looks_;
  result.simulated += time();
}

}  // namespace throng::validate
