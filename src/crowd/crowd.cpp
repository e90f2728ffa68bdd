// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "throng/crowd.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <string>

#include "core/access.h"
#include "core/check_class.h"
#include "core/hash.h"
#include "core/parallel.h"
#include "core/stopwatch.h"
#include "crowd/crowd_check.h"
#include "crowd/crowd_state.h"
#include "crowd/standing_map.h"
#include "throng/avatar.h"
#include "world/node_data.h"
#include "world/place.h"
#include "world/tile_grid.h"

// The public face of a crowd: configuration, avatars and their goals, the order of a step's parts,
// and reports. What classes, targets, obstacles, flyers and climbers need lies in the files beside.
namespace throng {
namespace {

constexpr double kMinDt = 1e-3, kMaxDt = 1;              // [s]
constexpr uint64_t kMinSearchBytes = uint64_t{1} << 20;  // of each search
constexpr double kMaxSpeed = 100;                        // [m/s]
constexpr double kMaxRadius = 100;                       // [m]
constexpr double kMaxBodyHeight = 65;                    // [m]
constexpr int32_t kMaxSubSteps = 1000;
constexpr uint64_t kAirDraws = 0x616972;  // random stream

Error bad_config(const std::string& what) { return {Errc::kBadConfig, "crowd: " + what}; }

// As far as known from outside: worlds that were never written have no hash.
bool is_same_world(const Nodes& nodes, const World& world) {
  const WorldSummary &a = data_of(data_of(nodes)->world)->summary, &b = data_of(world)->summary;
  return a.hash == b.hash && a.cell == b.cell && a.origin == b.origin &&
         a.classes.size() == b.classes.size() &&
         data_of(data_of(nodes)->world)->level_count == data_of(world)->level_count;
}

}  // namespace

Crowd::Crowd(std::unique_ptr<State> state) : state_(std::move(state)) {}
Crowd::Crowd(Crowd&&) noexcept = default;
Crowd& Crowd::operator=(Crowd&&) noexcept = default;
Crowd::~Crowd() = default;

Result<Crowd> Crowd::create(const World& world, const CrowdConfig& config) {
  if (!data_of(world)) return bad_config("there is no world");
  if (!(config.dt >= kMinDt && config.dt <= kMaxDt)) {
    return bad_config("dt must be 0.001 to 1 s");
  }
  if (config.search_bytes < kMinSearchBytes) {
    return bad_config("search_bytes must be 1048576 (1 MiB) or more");
  }
  if (config.workers < 0) return bad_config("workers must be 0 (all cores) or more");
  if (!(config.tuning.sight >= 1 && config.tuning.sight <= 50))
    return bad_config("sight must be 1 to 50 m");
  if (!(config.tuning.reaction >= 0 && config.tuning.reaction <= 1)) {
    return bad_config("reaction must be 0 to 1 s");
  }
  if (!(config.tuning.rounds >= 1 && config.tuning.rounds <= 100))
    return bad_config("rounds must be 1 to 100");
  if (!(config.tuning.low_detail_reaction >= 0 && config.tuning.low_detail_reaction <= 10)) {
    return bad_config("low_detail_reaction must be 0 to 10 s");
  }
  if (!(config.tuning.low_detail_steps >= 1 && config.tuning.low_detail_steps <= 16)) {
    return bad_config("low_detail_steps must be 1 to 16");
  }
  if (!(config.tuning.no_progress_after >= 0 && config.tuning.no_progress_after <= 1e6)) {
    return bad_config("no_progress_after must be 0 to 1000000 s");
  }
  if (!(config.slope_cost >= 0 && config.slope_cost <= 1000)) {
    return bad_config("slope_cost must be 0 to 1000");
  }
  if (config.speedup == PathSpeedup::kOnDemand) {
    return bad_config("it searches the whole ground: PathSpeedup::kOnDemand is not for crowds");
  }
  if (data_of(config.nodes) != nullptr && !is_same_world(config.nodes, world)) {
    return bad_config("the nodes are of another world");
  }
  const world::WorldData& data = *data_of(world);
  const double unit = data.summary.cell / world::kUnitsPerCell;
  const crowd::MoveConfig move{.units = {static_cast<float>(unit), static_cast<float>(config.dt)},
                               .sight = static_cast<float>(config.tuning.sight),
                               .rounds = config.tuning.rounds,
                               .deadlock_avoidance = config.tuning.deadlock_avoidance,
                               .reaction = static_cast<float>(config.tuning.reaction),
                               .seed = config.seed,
                               .workers = config.workers,
                               .model = config.model};
  const size_t classes = data.summary.classes.size();
  crowd::CrowdEngine engine(move, data.width, data.depth, classes);
  crowd::FlyerEngine flyers(move, classes);
  crowd::ClimberEngine climbers(move, classes);
  auto state = std::make_unique<State>(world, config, std::move(engine), std::move(flyers),
                                       std::move(climbers));
  state->classes.resize(classes);
  return Crowd(std::move(state));
}

void Crowd::State::find_bodies() const {
  if (!where_is_old) return;
  std::fill(where.begin(), where.end(), kNoBody);
  const std::span<const crowd::Body> bodies = engine.bodies();
  for (size_t i = 0; i < bodies.size(); ++i) where[bodies[i].slot] = static_cast<uint32_t>(i);
  where_is_old = false;
}

crowd::Body* Crowd::State::body(AvatarId id) const {
  if (!id || id.slot1 > generation.size() || generation[id.slot1 - 1] != id.generation) {
    return nullptr;
  }
  find_bodies();
  const uint32_t i = where[id.slot1 - 1];
  return i == kNoBody ? nullptr : &engine.bodies()[i];
}

Result<void> Crowd::State::open_class(int32_t number, Context& context) {
  if (auto ok = check_class(data_of(world)->summary.classes, number, "crowd"); !ok) return ok;
  std::unique_ptr<ClassParts>& parts = classes[static_cast<size_t>(number)];
  if (parts) return {};
  auto made = std::make_unique<ClassParts>();
  const int32_t step_height = world::step_mm(body_class(number));
  auto ground = crowd::CrowdGround::make(*data_of(world), number, step_height);
  if (!ground) return ground.error();
  made->ground = std::move(*ground);
  const bool over_nodes = is_climber_class(number);
  if (config.routing == Routing::kPaths && !over_nodes) {
    auto finder = path::MeshFinder::create(
        world, {.avatar_class = number, .workers = config.workers, .speedup = config.speedup},
        context);
    if (!finder) return finder.error();
    made->finders.assign(static_cast<size_t>(worker_count(config.workers)), *finder);
    made->paths.resize(made->finders.size());
    made->repairs.resize(made->finders.size());
  }
  if (auto ok = open_air(number, *made, context); !ok) return ok;
  if (over_nodes) {
    if (auto ok = open_nodes(number, *made, context); !ok) return ok;
  }
  parts = std::move(made);
  if (parts->nodes) {
    climbers.set_ground(static_cast<size_t>(number), &*parts->nodes);
    climbs.resize(generation.size());
  }
  if (parts->air) {
    flyers.set_air(static_cast<size_t>(number), &*parts->air, body_class(number).radius);
    flights.resize(generation.size());
  }
  if (has_costs() && config.routing == Routing::kPaths && !over_nodes) {
    make_lives(static_cast<size_t>(number));
  }
  obstacles.open_class(static_cast<size_t>(number), parts->ground);
  for (uint32_t slot = 0; slot < obstacles.all().size(); ++slot) {
    sync_paths(slot, static_cast<size_t>(number));
  }
  engine.set_ground(static_cast<size_t>(number), crowd::StrideGround(parts->ground, step_height));
  if (auto ok = find_flows(number, context); !ok) {
    obstacles.close_class(static_cast<size_t>(number));
    parts.reset();
    return ok;
  }
  return {};
}

double Crowd::State::radius_of(const AvatarSpawn& spawn) const {
  return spawn.radius > 0 ? spawn.radius : body_class(spawn.avatar_class).radius;
}

Result<crowd::Body> Crowd::State::body_of(const AvatarSpawn& spawn) const {
  const AvatarClass& avatar = body_class(spawn.avatar_class);
  const double radius = radius_of(spawn);
  const double speed = spawn.speed > 0 ? spawn.speed : avatar.speed;
  if (!(spawn.radius >= 0 && radius <= std::min(kMaxRadius, 4000 * 2048 * unit / 2))) {
    return bad_config("radius must be 0 (the class's) to 100 m, and at most 4000 cells");
  }
  if (!(spawn.speed >= 0 && speed <= kMaxSpeed)) {
    return bad_config("speed must be 0 (the class's) to 100 m/s");
  }
  if (avatar.height > kMaxBodyHeight) {
    return bad_config("class " + avatar.name + " is higher than 65 m");
  }
  crowd::Body body;
  body.speed = static_cast<float>(speed);
  body.radius = static_cast<int32_t>(std::ceil(radius / unit - 1e-9));
  body.height = static_cast<uint16_t>(std::ceil(avatar.height * 1000 - 1e-6));
  body.avatar_class = static_cast<uint8_t>(spawn.avatar_class);
  if (speed * config.dt > kMaxSubSteps * radius) {
    return bad_config("speed times dt is over 1000 radii; take shorter steps");
  }
  return body;
}

// No body moves further than the smallest radius at a time, so none passes through another.
void Crowd::State::make_room(const crowd::Body& body) {
  int32_t wide = body.radius, narrow = body.radius, tall = body.height;
  if (body.climbs) {  // It leans, so the cylinder that encloses it changes.
    const crowd::ClimberGround& ground = *classes[body.avatar_class]->nodes;
    const double radius = climbs[body.slot].radius;
    wide = ground.widest(radius);
    tall = ground.tallest(radius);
    narrow = static_cast<int32_t>(std::ceil(radius / unit - 1e-9));
    engine.expect_height(tall);
  }
  if (wide <= widest && body.speed <= fastest && narrow >= narrowest && tall <= tallest) return;
  tallest = std::max(tallest, tall);
  widest = std::max(widest, wide);
  narrowest = std::min(narrowest, narrow);
  fastest = std::max(fastest, body.speed);
  const double displacement = fastest * config.dt / unit;
  const double max_displacement =
      std::min(narrowest, crowd::CrowdEngine::kLongestStep - 16);  // and what is rounded
  sub_steps = std::clamp(static_cast<int32_t>(std::ceil(displacement / max_displacement - 1e-9)), 1,
                         1 << 20);
  engine.fit(widest, fastest, static_cast<float>(config.dt / sub_steps));
  flyers.fit(widest, fastest, tallest, static_cast<float>(config.dt / sub_steps));
  climbers.fit(widest, fastest, tallest, static_cast<float>(config.dt / sub_steps));
}

void Crowd::State::reserve(size_t more) {
  const size_t slots = generation.size() + more - std::min(more, free_slots.size());
  const size_t room = crowd::grown(generation.capacity(), slots);
  generation.reserve(room);
  routes.reserve(room);
  where.reserve(room);
  engine.reserve(engine.bodies().size() + more);
}

AvatarId Crowd::State::add(crowd::Body body, const crowd::Climb& climb) {
  find_bodies();
  if (free_slots.empty()) {
    body.slot = static_cast<uint32_t>(generation.size());
    generation.push_back(1);
    routes.emplace_back();
    where.push_back(kNoBody);
  } else {
    body.slot = free_slots.back();
    free_slots.pop_back();
  }
  if (!flights.empty() || air_of(body) != nullptr) {
    flights.resize(generation.size());
    flights[body.slot] = {};
  }
  if (!climbs.empty() || body.climbs) {
    climbs.resize(generation.size());
    climbs[body.slot] = climb;
  }
  where[body.slot] = static_cast<uint32_t>(engine.bodies().size());
  if (body.slot < inside.size()) inside[body.slot] = 0;
  if (body.slot < checked_at.size()) checked_at[body.slot] = kNeverChecked;
  make_room(body);
  engine.add(body);
  return id_of(body.slot);
}

Result<std::vector<AvatarId>> Crowd::add(std::span<const AvatarSpawn> spawns, Context& context) {
  follow_edits();
  State& s = *state_;
  std::vector<crowd::Body> bodies;
  int32_t widest = s.widest;
  for (const AvatarSpawn& spawn : spawns) {
    if (auto ok = s.open_class(spawn.avatar_class, context); !ok) return ok.error();
    auto body = s.body_of(spawn);
    if (!body) return body.error();
    bodies.push_back(*body);
    const auto& nodes = s.classes[static_cast<size_t>(spawn.avatar_class)]->nodes;
    widest = std::max(widest, nodes ? nodes->widest(s.radius_of(spawn)) : body->radius);
  }
  crowd::StandingMap map(s.engine.bodies(), widest, spawns.size());
  s.reserve(spawns.size());
  std::vector<AvatarId> ids(spawns.size());
  for (size_t i = 0; i < spawns.size(); ++i) {
    crowd::Body& body = bodies[i];
    if (spawns[i].place.level1 == kAirLevel1) {
      if (!s.put_in_air(body, spawns[i].place.position)) continue;
      if (map.add_if_clear(body)) ids[i] = s.add(body);
      continue;
    }
    if (s.classes[static_cast<size_t>(spawns[i].avatar_class)]->nodes) {
      const NodePlace place = spawns[i].on_nodes
                                  ? spawns[i].on_nodes
                                  : s.place_on_nodes(spawns[i].avatar_class, spawns[i].place);
      crowd::Climb climb;
      if (!s.put_on_nodes(body, climb, place, s.radius_of(spawns[i]))) continue;
      if (map.add_if_clear(body)) ids[i] = s.add(body, climb);
      continue;
    }
    const auto point = world::ground_point(*data_of(s.world), spawns[i].place);
    if (!point) continue;
    const crowd::CrowdGround& ground =
        s.classes[static_cast<size_t>(spawns[i].avatar_class)]->ground;
    body.x = static_cast<int32_t>(point->x);
    body.z = static_cast<int32_t>(point->z);
    body.level = spawns[i].place.level1 - 1;
    if (!ground.is_legal(body.level, world::in_tile(point->cell_x()),
                         world::in_tile(point->cell_z())))
      continue;
    body.y = ground.feet(body.level, *point);
    if (map.add_if_clear(body)) ids[i] = s.add(body);
  }
  return ids;
}

Result<std::vector<AvatarId>> Crowd::scatter(uint32_t count, const AvatarSpawn& like,
                                             Context& context) {
  follow_edits();
  State& s = *state_;
  if (auto ok = s.open_class(like.avatar_class, context); !ok) return ok.error();
  const auto body = s.body_of(like);
  if (!body) return body.error();
  ClassParts& parts = *s.classes[static_cast<size_t>(like.avatar_class)];
  const bool in_air = like.place.level1 == kAirLevel1;
  if (in_air && !parts.air) {
    return bad_config("class " + s.body_class(like.avatar_class).name +
                      " does not fly here: say `flies = true` in the classes' file, and bake the "
                      "world with it");
  }
  const double radius = s.radius_of(like);
  const int32_t widest = parts.nodes ? parts.nodes->widest(radius) : body->radius;
  if (!parts.standing) parts.standing.emplace(parts.ground, s.config.seed);
  crowd::StandingMap map(s.engine.bodies(), std::max(s.widest, widest), count);
  std::vector<crowd::Body> placed;
  std::vector<crowd::Climb> climbs(parts.nodes ? 1 : 0);  // of those placed, and one to try
  placed.reserve(count);
  // Until nine draws of ten fail over a while.
  uint64_t failed = 0, drawn = 0;
  const auto draw = [&](crowd::Body& here) {
    if (in_air) {
      const auto point =
          parts.flight_finders[0].random_point(s.config.seed ^ kAirDraws, s.scattered++);
      return point && s.put_in_air(here, *point);
    }
    if (parts.nodes) {
      const NodePlace place = s.draw_on_nodes(like.avatar_class, s.scattered++);
      return place && s.put_on_nodes(here, climbs.back(), place, radius);
    }
    const crowd::StandingDraw::Stand stand = parts.standing->draw(s.scattered++);
    here.x = static_cast<int32_t>(stand.point.x);
    here.z = static_cast<int32_t>(stand.point.z);
    here.level = stand.level;
    here.y = parts.ground.feet(stand.level, stand.point);
    return true;
  };
  while (placed.size() < count && (in_air || parts.nodes || !parts.standing->is_empty())) {
    crowd::Body here = *body;
    if (draw(here) && map.add_if_clear(here)) {
      placed.push_back(here);
      if (parts.nodes) climbs.emplace_back();
    } else {
      ++failed;
    }
    if (++drawn % 4096 != 0) continue;
    if (failed > 4096 * 99 / 100) break;
    failed = 0;
  }
  if (placed.size() < count) {
    return Error{Errc::kLimit, "crowd: " + std::to_string(placed.size()) + " avatars of class " +
                                   s.body_class(like.avatar_class).name +
                                   " find room at random places, " + std::to_string(count) +
                                   " were asked for; ask for fewer or take a larger world"};
  }
  s.reserve(count);
  std::vector<AvatarId> ids;
  ids.reserve(count);
  for (size_t i = 0; i < placed.size(); ++i) {
    ids.push_back(parts.nodes ? s.add(placed[i], climbs[i]) : s.add(placed[i]));
  }
  return ids;
}

void Crowd::remove(std::span<const AvatarId> ids) {
  State& s = *state_;
  for (const AvatarId id : ids) {
    crowd::Body* body = s.body(id);
    if (body == nullptr) continue;
    crowd::Body& last = s.engine.bodies().back();
    s.where[last.slot] = s.where[body->slot];
    s.where[body->slot] = kNoBody;
    ++s.generation[body->slot];
    s.free_slots.push_back(body->slot);
    *body = last;
    s.engine.shrink(s.engine.bodies().size() - 1);
  }
}

void Crowd::set_goals(std::span<const AvatarId> ids, std::span<const Place> goals) {
  THRONG_ASSERT(ids.size() == goals.size());
  State& s = *state_;
  for (size_t i = 0; i < ids.size(); ++i) {
    crowd::Body* body = s.body(ids[i]);
    if (body == nullptr) continue;
    body->target = 0;
    body->detour_angle = 0;
    if (s.air_of(*body) != nullptr) {
      s.set_goal_of_flyer(*body, goals[i]);
      continue;
    }
    if (body->climbs) {
      if (!goals[i]) {
        s.stop_climber(*body);
      } else {
        s.set_goal_of_climber(*body, s.place_on_nodes(body->avatar_class, goals[i]));
      }
      continue;
    }
    body->flags = 0;
    const auto point = world::ground_point(*data_of(s.world), goals[i]);
    if (!point) continue;
    crowd::Route& route = s.routes[body->slot];
    route = {};
    route.goal = {static_cast<int32_t>(point->x), static_cast<int32_t>(point->z),
                  goals[i].level1 - 1};
    body->local_target_x = route.goal.x;
    body->local_target_z = route.goal.z;
    body->flags = s.config.routing == Routing::kPaths
                      ? crowd::Body::kHasGoal | crowd::Body::kNeedsPath
                      : crowd::Body::kHasGoal | crowd::Body::kLast;
  }
}

void Crowd::set_goals(std::span<const AvatarId> ids, std::span<const NodePlace> goals) {
  THRONG_ASSERT(ids.size() == goals.size());
  State& s = *state_;
  for (size_t i = 0; i < ids.size(); ++i) {
    crowd::Body* body = s.body(ids[i]);
    if (body == nullptr || !body->climbs) continue;
    body->target = 0;
    body->detour_angle = 0;
    if (!goals[i]) {
      s.stop_climber(*body);
    } else {
      s.set_goal_of_climber(*body, goals[i]);
    }
  }
}

void Crowd::set_velocities(std::span<const AvatarId> ids, std::span<const Vec3d> velocities) {
  THRONG_ASSERT(ids.size() == velocities.size());
  for (size_t i = 0; i < ids.size(); ++i) {
    crowd::Body* body = state_->body(ids[i]);
    if (body == nullptr) continue;
    const Vec3d& v = velocities[i];
    const bool may_fly = state_->air_of(*body) != nullptr;
    const double up = may_fly || body->climbs ? v.y : 0;
    double size = std::sqrt(v.x * v.x + up * up + v.z * v.z);
    if (!std::isfinite(size)) size = INFINITY;
    const double part = size > body->speed ? body->speed / size : 1;
    body->flags = (body->flags & crowd::Body::kFlying) | crowd::Body::kExternal;
    body->target = 0;
    body->detour_angle = 0;
    body->preferred =
        part > 0 ? steer::Plane{static_cast<float>(v.x * part), static_cast<float>(v.z * part)}
                 : steer::Plane{};
    if (may_fly) {
      state_->flights[body->slot].preferred_up = part > 0 ? static_cast<float>(up * part) : 0;
    }
    if (body->climbs) {
      crowd::Climb& climb = state_->climbs[body->slot];
      climb.external = {body->preferred.x, part > 0 ? static_cast<float>(up * part) : 0,
                        body->preferred.z};
      climb.detour = 0;
    }
  }
}

// Follows paths, and finds those that are missing.
void Crowd::State::plan(std::span<crowd::Body> bodies, int32_t worker,
                        std::atomic<uint64_t>& planned) {
  const auto metre = static_cast<float>(1 / unit);
  const uint64_t step_now = sub_step - 1;
  uint64_t asked = 0;
  for (crowd::Body& body : bodies) {
    if (body.has(crowd::Body::kFlying) || body.steps == 0) continue;
    const ClassParts& parts = *classes[body.avatar_class];
    if (body.leaves) {
      plan_exit(body);
      continue;
    }
    if (parts.air && (body.has(crowd::Body::kHasGoal) || body.has(crowd::Body::kExternal)) &&
        plan_on_foot(body, flights[body.slot], worker, planned)) {
      body.clear(crowd::Body::kContinues);
      continue;
    }
    if (!body.has(crowd::Body::kHasGoal) || body.has(crowd::Body::kContinues) ||
        config.routing == Routing::kStraight)
      continue;
    crowd::Route& route = routes[body.slot];
    const crowd::StrideGround ground(parts.ground, world::step_mm(body_class(body.avatar_class)));
    if (!body.has(crowd::Body::kNeedsPath)) {
      crowd::follow(body, route, ground, (step_now + body.slot) / engine.steps_of_reaction(body),
                    metre);
    }
    if (!body.has(crowd::Body::kNeedsPath)) continue;
    ++asked;
    if (plan_path(body, route, ground, worker)) continue;
    // A target that cannot be walked to may be flown to.
    const bool takes_off = parts.air && body.target != 0 && take_off(body, flights[body.slot]);
    if (!takes_off) drop_goal(body);
  }
  if (asked > 0) planned.fetch_add(asked, std::memory_order_relaxed);
}

void Crowd::set_views(std::span<const CrowdView> views) {
  const Vec3d& origin = data_of(state_->world)->summary.origin;
  state_->views.clear();
  for (const CrowdView& v : views) {
    state_->views.push_back({static_cast<float>(v.position.x - origin.x),
                             static_cast<float>(v.position.z - origin.z),
                             static_cast<float>(v.position.y), static_cast<float>(v.radius)});
  }
}

CrowdReport Crowd::step() {
  const auto start = Clock::now();
  follow_edits();
  State& s = *state_;
  CrowdReport report;
  report.step = ++s.step;
  report.avatars = s.engine.bodies().size();
  s.arrived.clear();
  s.goal_unreachable.clear();
  s.out_of_memory = 0;
  // A copy, because what settles is taken out of the list.
  const std::span<const uint32_t> waiting = s.obstacles.waiting();
  report.waiting = s.settle_obstacles(std::vector(waiting.begin(), waiting.end()), &s.blockers);
  s.renew_flows();
  report.seconds_obstacles = seconds_since(start);
  crowd::EngineCounts counts;
  crowd::EngineTimes times;
  std::atomic<uint64_t> planned{0};
  const crowd::CrowdEngine::Before before = [&](std::span<crowd::Body> bodies, int32_t worker) {
    s.plan(bodies, worker, planned);
  };
  s.engine.set_detail({.views = s.views,
                       .steps = s.config.tuning.low_detail_steps,
                       .reaction = static_cast<float>(s.config.tuning.low_detail_reaction),
                       .narrowest = s.narrowest});
  const bool has_paths = s.config.routing == Routing::kPaths || !s.flights.empty() || s.some_leave;
  for (int32_t i = 0; i < s.sub_steps; ++i) {
    s.engine.step(s.sub_step++, has_paths ? before : crowd::CrowdEngine::Before(), counts, times);
    for (const uint32_t slot : s.engine.arrived()) {
      // An avatar that only reached where it takes off has not arrived.
      if (s.flights.empty() || s.flights[slot].to_link == 0) s.arrived.push_back(s.id_of(slot));
    }
    if (!s.flights.empty()) s.fly(counts, times, planned);
    if (!s.climbs.empty()) s.move_climbers(counts, times, planned);
  }
  s.where_is_old = true;
  if (!s.flights.empty() || !s.climbs.empty()) {
    for (const crowd::Body& body : s.engine.bodies()) {
      report.flying += body.flies() ? 1 : 0;
      report.climbing += body.climbs ? 1 : 0;
    }
  }
  const auto events_start = Clock::now();
  s.arrive_in_targets();
  s.find_events();
  for (std::vector<AvatarId>* ids : {&s.arrived, &s.goal_unreachable}) {
    std::sort(ids->begin(), ids->end(), [](AvatarId a, AvatarId b) { return a.slot1 < b.slot1; });
  }
  report.seconds_events = seconds_since(events_start);
  const auto moves = std::max<double>(1, static_cast<double>(report.avatars) * s.sub_steps);
  report.stood = counts.stood / static_cast<uint64_t>(s.sub_steps);
  report.contested = counts.contested;
  report.low_detail = counts.low_detail / static_cast<uint64_t>(s.sub_steps);
  report.skipped = counts.skipped / static_cast<uint64_t>(s.sub_steps);
  report.arrived = s.arrived.size();
  report.planned = planned;
  report.no_path = s.goal_unreachable.size();
  report.out_of_memory = s.out_of_memory;
  report.progress = static_cast<double>(counts.progress) * 1e-6 / moves;
  report.seconds_plan = times.plan;
  report.seconds_sort = times.sort;
  report.seconds_steer = times.steer;
  report.seconds_commit = times.resolve;
  report.seconds_settle = times.settle;
  report.seconds_total = seconds_since(start);
  return report;
}

CrowdCheck Crowd::check() const {
  const State& s = *state_;
  std::vector<crowd::CheckedBody> bodies;
  bodies.reserve(s.engine.bodies().size());
  for (const crowd::Body& b : s.engine.bodies()) {
    const double height = b.climbs ? b.height * 1e-3 : s.body_class(b.avatar_class).height;
    bodies.push_back(
        {b.x, b.z, b.y, b.level, b.avatar_class, b.radius * s.unit, height, b.flies(), b.climbs});
  }
  CrowdCheck found = crowd::check_bodies(s.world, bodies, obstacles(), s.config.workers);
  if (!s.climbs.empty()) {
    found.wall_entries += s.count_off_nodes();
    found.obstacle_entries += s.count_climbers_inside();
  }
  return found;
}

uint64_t Crowd::state_hash() const {
  const State& s = *state_;
  s.find_bodies();
  std::vector<crowd::Body> by_slot;
  for (const uint32_t i : s.where) {
    if (i == kNoBody) continue;
    crowd::Body body = s.engine.bodies()[i];
    body.state = crowd::Body::kFree;  // of the step, not of the avatar
    body.steps = 0;
    by_slot.push_back(body);
  }
  uint64_t hash = hash_bytes(by_slot.data(), by_slot.size() * sizeof(crowd::Body));
  if (!s.flights.empty()) {
    std::vector<crowd::Flight> flights;
    for (const crowd::Body& body : by_slot) flights.push_back(s.flights[body.slot]);
    hash = hash_bytes(flights.data(), flights.size() * sizeof(crowd::Flight), hash);
  }
  if (!s.climbs.empty()) {
    std::vector<crowd::Climb> climbs;
    for (const crowd::Body& body : by_slot) climbs.push_back(s.climbs[body.slot]);
    hash = hash_bytes(climbs.data(), climbs.size() * sizeof(crowd::Climb), hash);
  }
  return hash;
}

AvatarState Crowd::State::state_of(const crowd::Body& b) const {
  const Vec3d origin = data_of(world)->summary.origin;
  if (b.climbs) {
    const crowd::Climb& climb = climbs[b.slot];
    const Vec3d displacement = unleaned({b.velocity.x, climb.rise, b.velocity.z}, climb.axis);
    const double size = std::hypot(displacement.x, displacement.z);
    return {.id = b.slot,
            .avatar_class = b.avatar_class,
            .position = climb.feet,
            .radius = climb.radius,
            .heading_x = size > 0 ? displacement.x / size : 0,
            .heading_z = size > 0 ? displacement.z / size : 1,
            .mode = MoveMode::kClimb,
            .up = climb.axis};
  }
  const double size = std::hypot(b.velocity.x, b.velocity.z);
  return {.id = b.slot,
          .avatar_class = b.avatar_class,
          .position = {origin.x + (b.x + 0.5) * unit, b.y * 1e-3, origin.z + (b.z + 0.5) * unit},
          .radius = b.radius * unit,
          .heading_x = size > 0 ? b.velocity.x / size : 0,
          .heading_z = size > 0 ? b.velocity.z / size : 1,
          .mode = b.flies() ? MoveMode::kFly : MoveMode::kWalk};
}

void Crowd::read(std::vector<AvatarState>& out) const {
  const State& s = *state_;
  s.find_bodies();
  out.clear();
  for (const uint32_t i : s.where) {
    if (i != kNoBody) out.push_back(s.state_of(s.engine.bodies()[i]));
  }
}

std::optional<AvatarState> Crowd::read(AvatarId id) const {
  const crowd::Body* body = state_->body(id);
  return body == nullptr ? std::nullopt : std::optional(state_->state_of(*body));
}

bool Crowd::may_lean() const { return data_of(state_->config.nodes) != nullptr; }

std::span<const AvatarId> Crowd::arrived() const { return state_->arrived; }
std::span<const AvatarId> Crowd::goal_unreachable() const { return state_->goal_unreachable; }
const path::FlightFinder* Crowd::State::flight_finder(int32_t avatar_class) const {
  if (avatar_class < 0 || static_cast<size_t>(avatar_class) >= classes.size()) return nullptr;
  const auto& parts = classes[static_cast<size_t>(avatar_class)];
  return parts && parts->air ? &parts->flight_finders[0] : nullptr;
}

bool Crowd::may_fly(int32_t avatar_class, const Vec3d& feet) const {
  const path::FlightFinder* finder = state_->flight_finder(avatar_class);
  return finder != nullptr && finder->is_legal(feet);
}

std::optional<Vec3d> Crowd::random_air_point(int32_t avatar_class, uint64_t seed,
                                             uint64_t n) const {
  const path::FlightFinder* finder = state_->flight_finder(avatar_class);
  return finder == nullptr ? std::nullopt : finder->random_point(seed, n);
}

bool Crowd::is_alive(AvatarId id) const { return state_->body(id) != nullptr; }
uint32_t Crowd::size() const { return static_cast<uint32_t>(state_->engine.bodies().size()); }

CrowdMemory Crowd::memory() const {
  const State& s = *state_;
  CrowdMemory memory;
  memory.avatars = s.engine.bytes() + s.flyers.bytes() + s.climbers.bytes() +
                   (s.generation.capacity() + s.where.capacity() + s.free_slots.capacity()) * 4 +
                   s.inside.capacity() * sizeof(uint64_t) +
                   s.checked_at.capacity() * sizeof(s.checked_at[0]);
  memory.paths = s.routes.capacity() * sizeof(crowd::Route) +
                 s.flights.capacity() * sizeof(crowd::Flight) +
                 s.climbs.capacity() * sizeof(crowd::Climb);
  for (const auto& parts : s.classes) memory.ground += parts ? parts->ground.bytes() : 0;
  memory.ground += s.obstacles.bytes();
  return memory;
}

}  // namespace throng
