// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "crowd/walk/walk_mode.h"

#include <algorithm>
#include <cmath>

#include "core/parallel.h"
#include "crowd/mode/finder_changes.h"
#include "crowd/mode/leaving.h"
#include "crowd/mode/saved_rows.h"
#include "path/edits/blocked_cells.h"
#include "world/place.h"
#include "world/tile_grid.h"

// Walkers of a crowd: the contract of modes but for paths (walk_plan.cpp) and for leaving obstacles
// (walk_leaving.cpp).
namespace throng::crowd {

static_assert(sizeof(Route) == 16 + 12 * Route::kCorners);

WalkMode::WalkMode(SharedState& shared, const MoveConfig& config)
    : Mode(shared),
      engine_(config, data_of(shared.world)->width, data_of(shared.world)->depth,
              shared.classes.size()),
      classes_(shared.classes.size()) {
  if (!shared.config.avoid_jams || shared.config.routing != Routing::kPaths) return;
  delays_ = std::make_unique<DelayMap>(data_of(shared.world)->level_count, shared.config.dt);
}

StrideGround WalkMode::stride_ground(const Body& body) const {
  return {shared_.ground_of(body), world::step_mm(shared_.body_class(body.avatar_class))};
}

void WalkMode::reserve(size_t bodies, size_t rows) {
  routes_.reserve(rows);
  progress_.reserve(rows);
  engine_.level_speeds().reserve(rows);
  engine_.reserve_rows(rows);
  engine_.reserve(bodies);
}

// Of every class: also those over nodes have a ground, from which targets take their places.
Result<void> WalkMode::open_class(size_t number, Context& context) {
  auto made = std::make_unique<OfClass>();
  const CrowdConfig& config = shared_.config;
  const bool has_paths = config.routing == Routing::kPaths && !shared_.climbs(number);
  const auto workers = static_cast<size_t>(worker_count(config.workers));
  made->follows_density = shared_.density_of(number) != nullptr;
  if (has_paths && !made->follows_density) {
    auto finder = path::MeshFinder::create(shared_.world,
                                           {.avatar_class = static_cast<int32_t>(number),
                                            .workers = config.workers,
                                            .speedup = config.speedup},
                                           context);
    if (!finder) return finder.error();
    made->finders.assign(workers, *finder);
  }
  if (has_paths) {
    made->paths.resize(workers);
    made->compared.resize(workers);
    made->repairs.resize(workers);
  }
  made->flies = shared_.flies(number);
  made->takes_links = has_paths && !made->flies;
  some_fly_ = some_fly_ || made->flies;
  classes_[number] = std::move(made);
  if (has_paths && plans_by_cost(*classes_[number])) make_lives(number);
  engine_.set_ground(number, StrideGround(shared_.classes[number]->ground,
                                          world::step_mm(shared_.body_class(number))));
  engine_.set_turning_radius(number, static_cast<float>(shared_.body_class(number).turning_radius));
  return {};
}

void WalkMode::close_class(size_t number) { classes_[number].reset(); }

bool WalkMode::put(NewAvatar& avatar, const AvatarSpawn& spawn) const {
  const auto point = world::ground_point(*data_of(shared_.world), spawn.place);
  if (!point) return false;
  Body& body = avatar.body;
  const CrowdGround& ground = shared_.ground_of(body);
  body.x = static_cast<int32_t>(point->x);
  body.z = static_cast<int32_t>(point->z);
  body.level = spawn.place.level1 - 1;
  if (!ground.is_legal(body.level, world::in_tile(point->cell_x()),
                       world::in_tile(point->cell_z()))) {
    return false;
  }
  body.y = ground.feet(body.level, *point);
  return true;
}

Result<bool> WalkMode::begin_draws(const AvatarSpawn& like) {
  const auto number = static_cast<size_t>(like.avatar_class);
  std::optional<StandingDraw>& standing = classes_[number]->standing;
  if (!standing) standing.emplace(shared_.classes[number]->ground, shared_.config.seed);
  return !standing->is_empty();
}

bool WalkMode::draw(NewAvatar& avatar, const AvatarSpawn& /*like*/, uint64_t n) const {
  Body& body = avatar.body;
  const StandingDraw::Stand stand = classes_[body.avatar_class]->standing->draw(n);
  body.x = static_cast<int32_t>(stand.point.x);
  body.z = static_cast<int32_t>(stand.point.z);
  body.level = stand.level;
  body.y = shared_.ground_of(body).feet(stand.level, stand.point);
  return true;
}

// A row that was another avatar's stays until a goal replaces it.
void WalkMode::add(const NewAvatar& avatar) {
  fit_rows();
  engine_.clear_rows(avatar.body.slot);
}

void WalkMode::fit_rows() {
  routes_.resize(shared_.names.slots());
  progress_.resize(shared_.names.slots());
  engine_.level_speeds().resize(shared_.names.slots());
  engine_.fit_rows(shared_.names.slots());
}

void WalkMode::fit(const BodyExtent& all, float fastest) {
  engine_.expect_height(all.tallest);
  engine_.fit(all.widest, fastest, shared_.sub_dt());
}

void WalkMode::set_goal(Body& body, const Place& goal) {
  body.flags = 0;
  const auto point = world::ground_point(*data_of(shared_.world), goal);
  if (!point) return;
  Route& route = routes_[body.slot];
  engine_.set_path_after(body.slot, 0);
  engine_.set_onward(body.slot, {});
  engine_.wake(body);
  yielding_.erase(shared_.name_of(body));
  progress_[body.slot] = {};
  route = {};
  route.goal = {static_cast<int32_t>(point->x), static_cast<int32_t>(point->z), goal.level1 - 1};
  body.local_target_x = route.goal.x;
  body.local_target_z = route.goal.z;
  body.flags = shared_.config.routing == Routing::kPaths ? Body::kHasGoal | Body::kNeedsPath
                                                         : Body::kHasGoal | Body::kLast;
}

void WalkMode::set_target(Body& body) {
  routes_[body.slot] = {};
  progress_[body.slot] = {};
  engine_.set_path_after(body.slot, 0);
  engine_.set_onward(body.slot, {});
  engine_.wake(body);
  yielding_.erase(shared_.name_of(body));
  body.local_target_x = body.x;
  body.local_target_z = body.z;
}

void WalkMode::set_velocity(Body& body, const Vec3d& velocity) {
  yielding_.erase(shared_.name_of(body));
  control(body, {velocity.x, 0, velocity.z});
}

void WalkMode::step(std::span<Body> /*bodies: its engine's*/, EngineCounts& counts,
                    EngineTimes& times) {
  const auto plan_all = [this](std::span<Body> bodies, int32_t worker) { plan(bodies, worker); };
  const auto plan_none = [](std::span<Body> /*bodies*/, int32_t /*worker*/) {};
  links_are_used_ = takes_links_->begin_step();
  if (delays_) begin_watching();
  order_aside();
  engine_.set_orientations(shared_.orientations);
  const bool has_plans =
      shared_.config.routing == Routing::kPaths || some_fly_ || shared_.some_leave;
  if (exchange_) exchange_->begin();
  engine_.step(this_step(),
               has_plans ? CrowdEngine::Before(plan_all) : CrowdEngine::Before(plan_none), counts,
               times, exchange_.get());
  if (exchange_) exchange_->end();
  for (const uint32_t slot : engine_.arrived()) {
    if (!takes_off_->is_at_link(slot)) shared_.arrived.push_back(shared_.id_of(slot));
  }
}

void WalkMode::ground_changed() {
  for (const auto& parts : classes_) {
    if (parts) parts->standing.reset();
  }
}

void WalkMode::density_changed(size_t number) {
  OfClass& parts = *classes_[number];
  for (path::GroundFinder& live : parts.lives) live.set_density(shared_.density_of(number));
  Context context;
  parts.flows.clear();
  const auto ok = find_flows(number, context);
  THRONG_ASSERT(ok);  // Nothing cancels it.
  for (Body& body : bodies()) {
    const bool searches = body.avatar_class == number && body.has(Body::kHasGoal) && !body.leaves &&
                          !body.has(Body::kMovedElsewhere);
    if (searches && shared_.config.routing == Routing::kPaths) body.flags |= Body::kNeedsPath;
  }
}

// All avatars on foot search again.
void WalkMode::areas_changed(std::span<Body> bodies) {
  if (shared_.config.routing != Routing::kPaths) return;
  for (size_t c = 0; c < classes_.size(); ++c) {
    if (!classes_[c]) continue;
    OfClass& parts = *classes_[c];
    if (!plans_by_cost(parts) && parts.lives.empty()) continue;
    make_lives(c);
    for (size_t w = 0; w < parts.lives.size(); ++w) {
      parts.areas[w].follow(shared_.edits(), parts.lives[w]);
    }
  }
  flows_are_old_ = true;
  for (Body& body : bodies) {
    if (body.has(Body::kHasGoal) && !body.has(Body::kMovedElsewhere) && !body.leaves) {
      body.flags |= Body::kNeedsPath;
    }
  }
}

void WalkMode::sync_obstacle(CrowdObstacle& obstacle, size_t number, bool is_new) {
  if (shared_.config.routing != Routing::kPaths) return;
  if (obstacle.has_cells) make_lives(number);
  flows_are_old_ = true;
  sync_change(classes_[number]->lives, obstacle, is_new, obstacle.of_class[number].change);
}

void WalkMode::forget_obstacle(const CrowdObstacle& obstacle) {
  flows_are_old_ = true;
  for (size_t c = 0; c < classes_.size(); ++c) {
    if (classes_[c]) remove_change(classes_[c]->lives, obstacle.of_class[c].change);
  }
}

// Avatars whose paths lead over cells that some obstacles have just blocked.
void WalkMode::cut_paths(std::span<const uint32_t> slots, std::span<Body> bodies) {
  if (shared_.config.routing != Routing::kPaths) return;
  const world::WorldData& data = *data_of(shared_.world);
  double widest_class = 0;
  for (const AvatarClass& avatar : data.summary.classes) {
    widest_class = std::max(widest_class, path::taking_reach(avatar));
  }
  std::vector<PlanBox> boxes;
  for (const uint32_t slot : slots) {
    const CrowdObstacle& obstacle = shared_.obstacles.at(slot);
    if (obstacle.kind != ObstacleKind::kStatic) continue;
    PlanBox box{1e300, 1e300, -1e300, -1e300};
    const double around = widest_class + data.summary.cell;
    for (const auto& [x, z] : obstacle.place.corners) {
      box = {std::min(box.x0, x - around), std::min(box.z0, z - around),
             std::max(box.x1, x + around), std::max(box.z1, z + around)};
    }
    const Vec3d& origin = data.summary.origin;
    boxes.push_back({(box.x0 - origin.x) / shared_.unit, (box.z0 - origin.z) / shared_.unit,
                     (box.x1 - origin.x) / shared_.unit, (box.z1 - origin.z) / shared_.unit});
  }
  if (boxes.empty()) return;
  parallel_ranges(bodies.size(), 4096, shared_.config.workers, [&](size_t begin, size_t end) {
    for (Body& body : bodies.subspan(begin, end - begin)) {
      if (!body.has(Body::kHasGoal) || body.has(Body::kNeedsPath) ||
          body.has(Body::kMovedElsewhere) || body.leaves) {
        continue;
      }
      const bool is_cut = std::any_of(boxes.begin(), boxes.end(), [&](const PlanBox& box) {
        return leads_through(body, routes_[body.slot], box);
      });
      if (is_cut) body.flags |= Body::kNeedsPath;
    }
  });
}

void WalkMode::add_blockers(std::span<const uint32_t> slots, std::span<const Body> bodies,
                            BlockerPairs& found) const {
  const BlockerPairs here = shared_.obstacles.blockers(slots, bodies, shared_.config.workers);
  found.insert(found.end(), here.begin(), here.end());
}

bool WalkMode::is_inside(const Body& body, const ObstacleGrid::Item& obstacle) const {
  const AvatarClass& avatar = shared_.body_class(body.avatar_class);
  const auto bottom = static_cast<int32_t>(std::floor(body_bottom(avatar) * 1000));
  const AirPosition feet{body.x, body.z, body.y + bottom};
  return obstacle.shape.holds(feet, avatar.radius, body.height - bottom);
}

AvatarState WalkMode::state_of(const Body& body) const {
  const Vec3d& origin = shared_.origin();
  const double unit = shared_.unit;
  const Orientation& orientation = shared_.orientations[body.slot];
  return {.id = shared_.name_of(body),
          .avatar_class = static_cast<int32_t>(shared_.baked_class(body.avatar_class)),
          .position = {origin.x + (body.x + 0.5) * unit, body.y * 1e-3,
                       origin.z + (body.z + 0.5) * unit},
          .radius = body.radius * unit,
          .heading_x = orientation.x(),
          .heading_z = orientation.z(),
          .velocity = {body.velocity.x, 0, body.velocity.z},
          .mode = MoveMode::kWalk};
}

void WalkMode::add_memory(CrowdMemory& memory) const {
  memory.avatars += engine_.bytes();
  // As many of each.
  memory.paths += routes_.capacity() * kRowBytes;
  if (delays_) memory.ground += delays_->bytes();
  memory.paths += yielding_.all.capacity() * sizeof(StandsAside) +
                  yielding_.index_of.capacity() * sizeof(uint32_t);
}

void WalkMode::save(std::vector<uint8_t>& out) const {
  put_rows(out, routes_.data(), routes_.size());
  put_rows(out, progress_.data(), progress_.size());
  put_rows(out, engine_.level_speeds().data(), engine_.level_speeds().size());
  engine_.save_rows(routes_.size(), out);
}

const uint8_t* WalkMode::restore(const uint8_t* saved, size_t rows) {
  saved = take_rows(take_rows(saved, rows, routes_), rows, progress_);
  saved = take_rows(saved, rows, engine_.level_speeds());
  return engine_.restore_rows(saved, rows);
}

bool WalkMode::is_sound(const Body& body) const {
  constexpr float kMaxSpeed = 100;  // [m/s] that Crowd::add takes
  const float level_speed = engine_.level_speed(body);
  if (body.slowed && !(level_speed >= body.speed && level_speed <= kMaxSpeed)) return false;
  if (!body.has(Body::kHasGoal) || body.climbs) return true;
  const uint32_t levels = data_of(shared_.world)->level_count;
  if (!engine_.has_sound_rows(body)) return false;
  const Route& route = routes_[body.slot];
  if (!progress_[body.slot].is_sound()) return false;
  if (route.by_link != 0 && route.count < 2) return false;
  if (route.via != 0 && (route.via >= route.count || route.via <= route.next)) return false;
  if (route.count > Route::kCorners || (route.count > 0 && route.next >= route.count)) return false;
  for (size_t i = 0; i < route.count; ++i) {
    const PathPoint& corner = route.corners[i];
    if (corner.level >= levels || corner.x < 0 || corner.z < 0) return false;
  }
  return route.goal.level < levels && route.goal.x >= 0 && route.goal.z >= 0;
}

}  // namespace throng::crowd
