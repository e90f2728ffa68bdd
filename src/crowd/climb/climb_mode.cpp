// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "crowd/climb/climb_mode.h"

#include <algorithm>
#include <cmath>

#include "core/parallel.h"
#include "crowd/climb/climb_path.h"
#include "crowd/fly/air_blockers.h"
#include "crowd/mode/finder_changes.h"
#include "crowd/mode/saved_rows.h"

// Climbers of a crowd: the contract of modes but for paths (climb_plan.cpp), for leaving obstacles
// (climb_leaving.cpp), and for checks (climb_check.cpp).
namespace throng::crowd {
namespace {

constexpr double kNodeRadius = 0.5;       // [m] from a place to the place on nodes that it stands
                                          // for
constexpr uint64_t kPlaces = 0x706c6163;  // random stream

}  // namespace

ClimbMode::ClimbMode(SharedState& shared, const MoveConfig& config, const FlyMode& fly)
    : Mode(shared),
      fly_(fly),
      engine_(config, shared.classes.size()),
      classes_(shared.classes.size()) {
  engine_.set_obstacles(&shared.obstacle_grid);
}

Result<void> ClimbMode::open_class(size_t number, Context& context) {
  if (!shared_.climbs(number)) return {};
  const auto of = static_cast<int32_t>(number);
  const CrowdConfig& config = shared_.config;
  auto finder = path::NodeFinder::create(
      config.nodes,
      {.avatar_class = of, .slope_cost = config.slope_cost, .workers = config.workers}, context);
  if (!finder) return finder.error();
  classes_[number] = std::make_unique<OfClass>(
      shared_.world, config.nodes, *finder, static_cast<size_t>(worker_count(config.workers)), of);
  follow_areas(*classes_[number]);
  engine_.set_ground(number, &classes_[number]->ground);
  climbs_.resize(shared_.names.slots());
  return {};
}

void ClimbMode::follow_areas(OfClass& parts) {
  for (size_t w = 0; w < parts.finders.size(); ++w) {
    parts.areas[w].follow(shared_.edits(), parts.finders[w]);
  }
  had_costs_ = had_costs_ || shared_.edits().has_costs(path::EditList::kNoKinds);
}

// All climbers search again, if metres cost something else now.
void ClimbMode::areas_changed(std::span<Body> bodies) {
  const bool differ = had_costs_ || shared_.edits().has_costs(path::EditList::kNoKinds);
  for (const auto& parts : classes_) {
    if (parts) follow_areas(*parts);
  }
  had_costs_ = shared_.edits().has_costs(path::EditList::kNoKinds);
  if (!differ) return;
  for (Body& body : bodies) {
    if (body.climbs && body.has(Body::kHasGoal) && !body.leaves) body.flags |= Body::kNeedsPath;
  }
}

void ClimbMode::close_class(size_t number) { classes_[number].reset(); }

NodePlace ClimbMode::place_near(size_t number, const Place& place) const {
  if (!place || place.level1 == kAirLevel1) return {};
  return classes_[number]->finders[0].find_place(place.position, kNodeRadius);
}

bool ClimbMode::put(NewAvatar& avatar, const AvatarSpawn& spawn) const {
  return put_on_nodes(
      avatar, spawn.on_nodes ? spawn.on_nodes : place_near(avatar.body.avatar_class, spawn.place));
}

bool ClimbMode::put_on_nodes(NewAvatar& avatar, const NodePlace& place) const {
  Body& body = avatar.body;
  const ClimberGround& ground = of(body).ground;
  const auto pose = ground.pose(place.node1, place.s, place.t);
  const auto cylinder = pose ? ground.cylinder_of(*pose, avatar.radius) : std::nullopt;
  if (!cylinder || engine_.is_blocked(ground, *cylinder, *pose, avatar.radius)) return false;
  avatar.on_nodes = place;
  body.x = cylinder->low.x;
  body.z = cylinder->low.z;
  body.y = cylinder->low.y;
  body.radius = cylinder->radius;
  body.height = static_cast<uint16_t>(cylinder->height);
  body.level = 0;
  body.flags = Body::kMovedElsewhere;
  body.climbs = true;
  return true;
}

Result<bool> ClimbMode::begin_draws(const AvatarSpawn& /*like*/) { return true; }

bool ClimbMode::draw(NewAvatar& avatar, const AvatarSpawn& like, uint64_t n) const {
  const NodePlace place =
      shared_.config.nodes.random_place(like.avatar_class, shared_.config.seed ^ kPlaces, n);
  return place && put_on_nodes(avatar, place);
}

void ClimbMode::add(const NewAvatar& avatar) {
  if (climbs_.empty() && !avatar.body.climbs) return;
  climbs_.resize(shared_.names.slots());
  climbs_[avatar.body.slot] = avatar.body.climbs ? climb_at(avatar) : Climb{};
}

// As put_on_nodes found it.
Climb ClimbMode::climb_at(const NewAvatar& avatar) const {
  const NodePlace& place = avatar.on_nodes;
  const auto pose = of(avatar.body).ground.pose(place.node1, place.s, place.t);
  THRONG_ASSERT(pose);
  Climb climb;
  climb.at.node1 = place.node1;
  climb.at.s = place.s;
  climb.at.t = place.t;
  climb.feet = pose->feet;
  climb.axis = pose->axis;
  climb.radius = avatar.radius;
  return climb;
}

// It leans, so the cylinder that encloses it changes.
BodyExtent ClimbMode::extent_of(const Body& body, double radius) const {
  const ClimberGround& ground = of(body).ground;
  return {ground.widest(radius), static_cast<int32_t>(std::ceil(radius / shared_.unit - 1e-9)),
          ground.tallest(radius)};
}

void ClimbMode::fit(const BodyExtent& all, float fastest) {
  engine_.fit(all.widest, fastest, all.tallest, shared_.sub_dt());
}

void ClimbMode::set_goal(Body& body, const Place& goal) {
  if (!goal) return stop(body);
  head_to(body, place_near(body.avatar_class, goal));
}

void ClimbMode::set_goal(Body& body, const NodePlace& goal) {
  if (!goal) return stop(body);
  head_to(body, goal);
}

void ClimbMode::set_target(Body& body) {
  if (body.climbs) head_to(body, {});
}

void ClimbMode::head_to(Body& body, const NodePlace& goal) {
  Climb& climb = climbs_[body.slot];
  const bool exists = of(body).ground.pose(goal.node1, goal.s, goal.t).has_value();
  climb.goal_node1 = exists ? goal.node1 : 0;
  climb.goal_s = goal.s;
  climb.goal_t = goal.t;
  climb.detour = 0;
  climb.waited = 0;
  climb.turns_aside = 0;
  climb.station = climb.station_count = 0;
  body.flags = Body::kMovedElsewhere | Body::kHasGoal | Body::kNeedsPath;
}

void ClimbMode::stop(Body& body) {
  body.flags &= Body::kMovedElsewhere;
  Climb& climb = climbs_[body.slot];
  if (climb.is_on_ground()) clear_path(climb);
}

void ClimbMode::set_velocity(Body& body, const Vec3d& velocity) {
  const Vec3d cut = control(body, velocity);
  Climb& climb = climbs_[body.slot];
  climb.external = {body.preferred.x, static_cast<float>(cut.y), body.preferred.z};
  climb.detour = 0;
}

void ClimbMode::step(std::span<Body> bodies, EngineCounts& counts, EngineTimes& times) {
  if (climbs_.empty()) return;
  const auto before = [this](Body& body, Climb& climb, int32_t worker) {
    plan(body, climb, worker);
  };
  engine_.set_orientations(shared_.orientations);
  engine_.step(shared_.sub_step, bodies, climbs_, fly_.flights(), before, counts, times);
  for (const uint32_t slot : engine_.arrived()) shared_.arrived.push_back(shared_.id_of(slot));
}

void ClimbMode::sync_obstacle(CrowdObstacle& obstacle, size_t number, bool is_new) {
  if (!classes_[number]) return;
  sync_change(classes_[number]->finders, obstacle, is_new, obstacle.of_class[number].node_change);
}

void ClimbMode::forget_obstacle(const CrowdObstacle& obstacle) {
  for (size_t c = 0; c < classes_.size(); ++c) {
    if (classes_[c]) remove_change(classes_[c]->finders, obstacle.of_class[c].node_change);
  }
}

// Climbers whose paths cross what became active.
void ClimbMode::cut_paths(std::span<const uint32_t> slots, std::span<Body> bodies) {
  if (climbs_.empty()) return;
  for (Body& body : bodies) {
    if (!body.climbs || !body.has(Body::kHasGoal) || body.has(Body::kNeedsPath) || body.leaves) {
      continue;
    }
    const Climb& climb = climbs_[body.slot];
    const ClimberGround& ground = of(body).ground;
    path::BodyRoom around;  // all that it occupies, whichever direction it faces
    around.turns_far = true;
    around.top = shared_.body_class(body.avatar_class).height;
    around.radius = climb.radius;
    bool is_cut = false;
    Vec3d last = climb.feet;
    for (size_t i = climb.at.next; i < climb.count && !is_cut; ++i) {
      const ClimbPoint& point = climb.points[i];
      const auto pose = ground.pose(point.node1, point.s, point.t);
      if (!pose) continue;  // in the air: between two that are not
      around.feet = (last + pose->feet) * 0.5;
      around.spread = length(pose->feet - last) / 2;
      last = pose->feet;
      is_cut = std::any_of(slots.begin(), slots.end(), [&](uint32_t slot) {
        const CrowdObstacle& obstacle = shared_.obstacles.all()[slot];
        return obstacle.kind == ObstacleKind::kStatic && may_touch(around, {obstacle.place, {}});
      });
    }
    if (is_cut) body.flags |= Body::kNeedsPath;
  }
}

void ClimbMode::add_blockers(std::span<const uint32_t> slots, std::span<const Body> bodies,
                             BlockerPairs& found) const {
  if (climbs_.empty()) return;
  AirBlockers blockers(shared_, slots);
  if (blockers.is_empty()) return;
  for (uint32_t i = 0; i < bodies.size(); ++i) {
    if (bodies[i].climbs) blockers.add(bodies[i], i, bodies[i].radius * shared_.unit, found);
  }
}

bool ClimbMode::meets(const Body& body, const AirObstacle& shape, const path::Solid& solid) const {
  const Climb& climb = climbs_[body.slot];
  return engine_.meets_obstacle(of(body).ground, {feet_of(body), body.radius, body.height},
                                {climb.feet, climb.axis}, climb.radius, shape, solid);
}

bool ClimbMode::meets(const Body& body, const Prism& prism) const {
  return meets(body, AirObstacle(prism, shared_.origin(), shared_.unit), {prism, {}});
}

bool ClimbMode::is_inside(const Body& body, const ObstacleGrid::Item& obstacle) const {
  return meets(body, obstacle.shape, obstacle.solid);
}

// Not those of which only the cylinder is inside.
bool ClimbMode::must_leave(const Body& body, const Prism& obstacle) const {
  return meets(body, obstacle);
}

AvatarState ClimbMode::state_of(const Body& body) const {
  const Climb& climb = climbs_[body.slot];
  const Orientation& orientation = shared_.orientations[body.slot];
  return {.id = shared_.name_of(body),
          .avatar_class = body.avatar_class,
          .position = climb.feet,
          .radius = climb.radius,
          .heading_x = orientation.x(),
          .heading_z = orientation.z(),
          .velocity = {body.velocity.x, climb.rise, body.velocity.z},
          .mode = MoveMode::kClimb,
          .up = climb.axis};
}

Body ClimbMode::at_feet(const Body& body) const {
  Body there = body;
  const Vec3d& origin = shared_.origin();
  const Vec3d& feet = climbs_[body.slot].feet;
  there.x = static_cast<int32_t>(std::floor((feet.x - origin.x) / shared_.unit));
  there.z = static_cast<int32_t>(std::floor((feet.z - origin.z) / shared_.unit));
  there.y = static_cast<int32_t>(std::lrint(feet.y * 1000));
  return there;
}

uint64_t ClimbMode::hash(const Body& body, uint64_t hash) const {
  return hash_row(climbs_, body.slot, hash);
}

void ClimbMode::add_memory(CrowdMemory& memory) const {
  memory.avatars += engine_.bytes();
  memory.paths += climbs_.capacity() * kRowBytes;
}

void ClimbMode::save(std::vector<uint8_t>& out) const {
  put_rows(out, climbs_.data(), climbs_.size());
}

const uint8_t* ClimbMode::restore(const uint8_t* saved, size_t rows) {
  return take_rows(saved, rows, climbs_);
}

bool ClimbMode::is_sound(const Body& body) const { return !body.climbs || !climbs_.empty(); }

}  // namespace throng::crowd
