// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "plain_crowd.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

#include "core/random.h"
#include "crowd/walk/precedence.h"
#include "crowd/walk/reaction.h"

// Neighbours by a grid, then the steps of the engine as loops over all bodies.
namespace throng::test {
namespace {

using steer::Plane;

constexpr float kArrivalRadius = 0.3f;                // [m]
constexpr float kMoveShares[] = {0.5f, 0.25f, 0.1f};  // Of the first choice, if none is clear.

int32_t wrapped(int32_t d, int32_t side) {
  if (side <= 0) return d;
  if (d > side / 2) return d - side;
  return d < -side / 2 ? d + side : d;
}

// As many cells as fit, each at least as wide as the sight.
struct Grid {
  Spot low;
  int64_t cell = 1;
  int32_t width = 1, depth = 1;
  std::vector<std::vector<uint32_t>> bodies;

  Grid(const std::vector<PlainBody>& all, int32_t sight, int32_t side) {
    Spot high{side, side};
    if (side <= 0) {
      low = high = all.empty() ? Spot{} : all[0].at;
      for (const PlainBody& b : all) {
        low = {std::min(low.x, b.at.x), std::min(low.z, b.at.z)};
        high = {std::max(high.x, b.at.x), std::max(high.z, b.at.z)};
      }
    }
    const int32_t across = std::max(high.x - low.x, high.z - low.z);
    width = depth = std::max(1, across / sight);
    // With fewer than 3 cells, the left and right neighbour are the same cell.
    if (side > 0 && width < 3) width = depth = 1;
    cell = std::max(across / width + 1, sight);
    bodies.resize(static_cast<size_t>(width * depth));
    for (uint32_t i = 0; i < all.size(); ++i) {
      bodies[at(column(all[i].at.x - low.x), column(all[i].at.z - low.z))].push_back(i);
    }
  }
  [[nodiscard]] int32_t column(int32_t d) const {
    return std::clamp(static_cast<int32_t>(d / cell), 0, width - 1);
  }
  [[nodiscard]] size_t at(int32_t x, int32_t z) const { return static_cast<size_t>(z * width + x); }
};

}  // namespace

int32_t PlainConfig::to_units(double metres) const {
  return static_cast<int32_t>(std::lround(metres / units.unit));
}

PlainCrowd::PlainCrowd(std::vector<PlainBody> bodies, const PlainConfig& config)
    : bodies_(std::move(bodies)), config_(config) {
  for (const PlainBody& b : bodies_) {
    max_radius_ = std::max(max_radius_, b.radius);
    max_stride_ = std::max(max_stride_, config.units.stride(b.speed));
  }
  near_.resize(bodies_.size());
  choices_.resize(bodies_.size());
  next_rest_of_.resize(bodies_.size());
  nears_goal_.resize(bodies_.size());
  if (config_.queues) config_.steering = crowd::queueing(config_.steering);
}

Spot PlainCrowd::between(Spot a, Spot b) const {
  return {wrapped(b.x - a.x, config_.side), wrapped(b.z - a.z, config_.side)};
}

Plane PlainCrowd::preferred_of(const PlainBody& body) const {
  if (is_paused(body)) return {};
  const Plane to_goal = config_.units.metres(body.goal.x - body.at.x, body.goal.z - body.at.z);
  const float dt = config_.units.dt;
  const float speed = steer::braking_speed(size_of(to_goal), config_.acceleration, dt, body.speed);
  return steer::preferred_towards(to_goal, speed, dt, body.turn);
}

int32_t PlainCrowd::sight() const {
  return std::max(config_.to_units(config_.sight), 2 * max_radius_ + 2 * max_stride_);
}

void PlainCrowd::sense() {
  // Bodies that can be touched within a step are neighbours, however short the sight.
  const float sight_square = static_cast<float>(sight()) * static_cast<float>(sight());
  const Grid grid(bodies_, sight(), config_.side);
  const bool repeats = config_.side > 0;
  for (uint32_t i = 0; i < bodies_.size(); ++i) {
    near_[i].clear();
    const int32_t cx = grid.column(bodies_[i].at.x - grid.low.x);
    const int32_t cz = grid.column(bodies_[i].at.z - grid.low.z);
    const int32_t ring = grid.width > 1 || !repeats ? 1 : 0;
    for (int32_t z = cz - ring; z <= cz + ring; ++z) {
      for (int32_t x = cx - ring; x <= cx + ring; ++x) {
        const bool inside = x >= 0 && z >= 0 && x < grid.width && z < grid.depth;
        if (!inside && !repeats) continue;
        for (const uint32_t j :
             grid.bodies[grid.at((x + grid.width) % grid.width, (z + grid.depth) % grid.depth)]) {
          const Spot at = between(bodies_[i].at, bodies_[j].at);
          if (j != i && crowd::near_square(at.x, at.z) < sight_square) near_[i].push_back({j, at});
        }
      }
    }
    std::sort(near_[i].begin(), near_[i].end(), [](const Near& a, const Near& b) {
      const float da = crowd::near_square(a.at.x, a.at.z), db = crowd::near_square(b.at.x, b.at.z);
      return da != db ? da < db : a.other < b.other;
    });
  }
}

// The choices by another steering model than `sampled`.
void PlainCrowd::prefer(uint32_t i) {
  const PlainBody& body = bodies_[i];
  std::vector<steer::Other> others;
  for (const Near& n : near_[i]) {
    if (others.size() == static_cast<size_t>(config_.steering.neighbours)) break;
    const PlainBody& other = bodies_[n.other];
    others.push_back({.at = config_.units.metres(n.at.x, n.at.z),
                      .velocity = other.velocity,
                      .radius = static_cast<float>(other.radius) * config_.units.unit,
                      .slot = n.other});
  }
  const steer::View view{
      .velocity = body.velocity,
      .preferred = preferred_of(body),
      .to_target = config_.units.metres(body.goal.x - body.at.x, body.goal.z - body.at.z),
      .stops = true,
      .fastest = body.speed,
      .radius = static_cast<float>(body.radius) * config_.units.unit,
      .slot = i,
      .others = others};
  choices_[i] =
      steer::candidates_about(steer::preferred_velocity(config_.model, view, config_.units.dt));
}

void PlainCrowd::steer_all() {
  plans_.assign(bodies_.size(), {});
  for (uint32_t i = 0; i < bodies_.size(); ++i) {
    if (config_.model != SteeringModel::kSampled) {
      prefer(i);
      continue;
    }
    const PlainBody& body = bodies_[i];
    steer::Situation situation{.velocity = body.velocity,
                               .preferred = preferred_of(body),
                               .fastest = body.speed,
                               .near = {},
                               .free_distance = {}};
    bool waits = false;
    float waiting_room = 0;
    for (const Near& n : near_[i]) {
      if (situation.near.size == static_cast<size_t>(config_.steering.neighbours)) break;
      const PlainBody& other = bodies_[n.other];
      // A body that has arrived yields to others, of which it assumes that they move as preferred.
      const bool yields = body.arrived >= 0 && other.arrived < 0;
      const auto contender = [](const PlainBody& b, uint32_t slot) {
        return crowd::Contender{b.at.x, b.at.z, b.goal.x, b.goal.z, b.radius, slot};
      };
      if (pushes(body) && body.arrived < 0 && other.arrived < 0 &&
          goes_first(contender(other, n.other), contender(body, i))) {
        waits = true;  // for the widest
        const auto room = static_cast<float>(body.radius + other.radius) * config_.units.unit;
        waiting_room = std::max(waiting_room, room);
        situation.preferred = crowd::preferred_of_waiting(
            config_.units.metres(body.goal.x - body.at.x, body.goal.z - body.at.z), body.speed,
            waiting_room);
      }
      const bool keeps_off =
          queues(body) && queues(other) && is_near(i, n) && order_of(n.other) < order_of(i);
      situation.near.add(
          config_.steering,
          {config_.units.metres(n.at.x, n.at.z), yields ? preferred_of(other) : other.velocity,
           static_cast<float>(body.radius + other.radius) * config_.units.unit +
               (keeps_off ? config_.queue.ahead_margin : 0),
           preferred_of(other)});
    }
    const Plane preferred = situation.preferred;
    situation.preferred = steer::following(config_.steering, situation);
    Plan& plan = plans_[i];
    plan.follows =
        steer::can_but_crawl(config_.deadlock_settings, preferred, situation.preferred, body.speed);
    if (config_.queues) queue_up(i, plan);
    bool open = steer::preferred_is_open(config_.steering, situation);
    if (!open && !waits && steer::is_opposed(config_.lanes, situation)) {
      steer::Lanes lanes(config_.lanes, preferred_of(body));
      for (const Near& n : near_[i]) {
        const PlainBody& other = bodies_[n.other];
        lanes.add(config_.units.metres(n.at.x, n.at.z),
                  config_.units.metres(other.goal.x - other.at.x, other.goal.z - other.at.z));
      }
      situation.preferred = lanes.preferred();
      situation.preferred = steer::following(config_.steering, situation);
      open = steer::preferred_is_open(config_.steering, situation);
    }
    choices_[i] = steer::choose_velocity(config_.steering, situation);
    // The preferred velocity comes first if it is open.
    if (open) {
      std::rotate(choices_[i].begin(), choices_[i].end() - 1, choices_[i].end());
      choices_[i][0] = situation.preferred;
    }
    if (config_.queues) {
      const bool walks_back = !queues(body) || pushes(body) || body.turn != 0;
      const Plane ahead = path_ahead(body);
      for (size_t c = open ? 1 : 0; c < choices_[i].size() && !walks_back; ++c) {
        Plane& v = choices_[i][c];
        if (v.x * ahead.x + v.z * ahead.z < 0) v = {};
      }
      make_room(i, plan, choices_[i][0]);
    }
    plan.choice = choices_[i][0];
    for (Plane& choice : choices_[i]) choice = reachable(body, choice);
  }
}

// Could both touch in this step, by their distance at its start?
bool PlainCrowd::can_touch(uint32_t i, const Near& n) const {
  const PlainBody &a = bodies_[i], &b = bodies_[n.other];
  const int64_t distance =
      int64_t{a.radius} + b.radius + config_.units.stride(a.speed) + config_.units.stride(b.speed);
  return crowd::nearer_than(n.at.x, n.at.z, distance);
}

void PlainCrowd::resolve_conflicts() {
  const size_t count = bodies_.size();
  std::vector<Spot> now(count);
  for (size_t i = 0; i < count; ++i) now[i] = bodies_[i].at;
  std::vector<uint8_t> decided(count, 0);
  const uint64_t every = crowd::steps_of_reaction(config_.reaction, config_.units.dt);
  // Goes on as before; first choice still possible; moves by its first choice.
  std::vector<uint8_t> keeping(count), first(count, 1), keeps(count, 0);
  for (uint32_t i = 0; i < count; ++i) {
    const PlainBody& b = bodies_[i];
    keeping[i] =
        b.keeps && !crowd::decides(every, steps_, i) &&
        !crowd::is_before({b.goal.x - b.at.x, b.goal.z - b.at.z}, config_.units.stride(b.speed)) &&
        !crowd::must_brake(config_.units.metres(b.goal.x - b.at.x, b.goal.z - b.at.z), b.speed,
                           config_.acceleration, every, config_.units.dt);
  }
  std::vector<uint8_t> asks(count, 0), decides(count, 0);
  yields_.assign(count, 0);
  in_stream_.assign(count, 0);
  std::vector<crowd::RoomRequest> requests(count);
  std::vector<crowd::Rest> rest(count);
  for (size_t i = 0; i < count; ++i) rest[i] = bodies_[i].rest;
  std::vector<std::optional<Spot>> proposed(count);
  const auto is_clear = [&](uint32_t i, uint32_t j, Spot a, Spot b) {
    const Spot d = between(a, b);
    return !crowd::nearer_than(d.x, d.z, int64_t{bodies_[i].radius} + bodies_[j].radius);
  };
  const auto order = [&](uint32_t i) { return std::pair(random_u64(config_.seed, i, steps_), i); };
  for (int32_t round = 0; round < config_.rounds; ++round) {
    for (uint32_t i = 0; i < count; ++i) {
      proposed[i].reset();
      if (decided[i] != 0) continue;
      const auto propose_move = [&](Spot move) {
        const Spot to{now[i].x + move.x, now[i].z + move.z};
        for (const Near& n : near_[i]) {
          if (can_touch(i, n) && !is_clear(i, n.other, to, now[n.other])) return false;
        }
        proposed[i] = to;
        return true;
      };
      const auto move_of = [&](Plane velocity) {
        return Spot{config_.units.displacement(velocity.x), config_.units.displacement(velocity.z)};
      };
      const auto propose = [&](Plane velocity) { return propose_move(move_of(velocity)); };
      if (keeping[i] != 0) {
        keeps[i] = propose(reachable(bodies_[i], bodies_[i].choice));
        if (keeps[i] != 0) continue;
        keeping[i] = 0;
        if (round > 0) first[i] = 0;
      }
      if (round == 0) {
        PlainBody& b = bodies_[i];
        const Plan& plan = plans_[i];
        b.follows = plan.follows;
        b.choice = plan.choice;
        asks[i] = plan.asks;
        rest[i] = plan.rest;
        yields_[i] = plan.yields;
        in_stream_[i] = plan.in_stream;
        if (plan.asks) requests[i] = plan.request;
        if (plan.creeps) first[i] = 0;
        decides[i] = 1;
      }
      if (first[i] != 0) first[i] = propose(choices_[i][0]);
      keeps[i] = first[i] != 0 && !plans_[i].asks;
      const Plan& plan = plans_[i];
      const bool creeps = decides[i] != 0 && plan.creeps;
      bool found = creeps ? std::any_of(plan.room.begin(), plan.room.end(), propose)
                          : std::any_of(choices_[i].begin(), choices_[i].end(), propose);
      for (const float share : kMoveShares) {
        const Spot best = move_of(creeps ? plan.room[0] : choices_[i][0]);
        const auto shorter = [&](int32_t move) {
          return static_cast<int32_t>(std::lrint(static_cast<float>(move) * share));
        };
        found = found || propose_move({shorter(best.x), shorter(best.z)});
      }
      if (creeps && !found) propose_move({});  // It stands.
    }
    for (uint32_t i = 0; i < count; ++i) {
      if (!proposed[i]) continue;
      const bool is_first = std::none_of(near_[i].begin(), near_[i].end(), [&](const Near& n) {
        return can_touch(i, n) && proposed[n.other] && order(n.other) > order(i) &&
               !is_clear(i, n.other, *proposed[i], *proposed[n.other]);
      });
      if (is_first) decided[i] = 1;
    }
    for (uint32_t i = 0; i < count; ++i) {
      if (proposed[i] && decided[i] != 0) now[i] = *proposed[i];
    }
  }
  for (size_t i = 0; i < count; ++i) keeps[i] = keeps[i] & decided[i];
  for (size_t i = 0; i < count; ++i) {
    bodies_[i].asks = asks[i] != 0;
    bodies_[i].request = requests[i];
    next_rest_of_[i] = rest[i];
    nears_goal_[i] = decides[i] != 0 && may_rest(bodies_[i]) ? 1 : 0;
  }
  settle(now, keeps);
}

void PlainCrowd::settle(const std::vector<Spot>& now, const std::vector<uint8_t>& keeps) {
  progress_ = 0;
  ++steps_;
  const crowd::StepUnits& units = config_.units;
  for (size_t i = 0; i < bodies_.size(); ++i) {
    PlainBody& body = bodies_[i];
    const Plane to_goal = units.metres(body.goal.x - body.at.x, body.goal.z - body.at.z);
    const Plane preferred = preferred_of(body);
    const float left = size_of(to_goal);
    const bool stood = stands(body);
    body.velocity = {units.velocity(now[i].x - body.at.x), units.velocity(now[i].z - body.at.z)};
    const float towards =
        left > 1e-6f ? (body.velocity.x * to_goal.x + body.velocity.z * to_goal.z) / left : 0;
    progress_ += towards / body.speed / static_cast<double>(bodies_.size());
    body.at = now[i];
    body.keeps = keeps[i] != 0;
    if (nears_goal_[i] != 0) settle_rest(body, next_rest_of_[i], left, units.dt);
    if (config_.queues) {
      if (stands(body) || stood || yields_[i] != 0) {
        body.yields =
            yields_[i] != 0 ? config_.queue.yield_time : std::max(body.yields - units.dt, 0.0f);
      }
      body.stream =
          in_stream_[i] != 0 ? config_.queue.stream_time : std::max(body.stream - units.dt, 0.0f);
      body.stood = stands(body) ? std::min(body.stood + units.dt, 60.0f) : 0;
    }
    if (config_.deadlock_avoidance) {
      const bool alone = std::none_of(near_[i].begin(), near_[i].end(), [&](const Near& n) {
        return can_touch(static_cast<uint32_t>(i), n);
      });
      const bool turns_aside = pushes(body) || (body.asks && body.request.order.name == i &&
                                                body.stood >= config_.queue.detour_stands);
      const float content =
          left > 1 && !alone && turns_aside
              ? steer::progress_felt(config_.deadlock_settings, towards / body.speed, body.follows)
              : 1;
      const float along = (body.velocity.x * preferred.x + body.velocity.z * preferred.z) /
                          (body.speed * body.speed);
      body.turn =
          steer::next_detour_angle(config_.deadlock_settings, body.turn, content, along, units.dt);
    }
    const Plane rest = units.metres(body.goal.x - body.at.x, body.goal.z - body.at.z);
    if (body.arrived < 0 && size_of(rest) < kArrivalRadius) body.arrived = time();
    if (config_.side <= 0) continue;
    for (int32_t Spot::*axis : {&Spot::x, &Spot::z}) {
      const int32_t shift = body.at.*axis < 0               ? config_.side
                            : body.at.*axis >= config_.side ? -config_.side
                                                            : 0;
      body.at.*axis += shift;
      body.goal.*axis += shift;
    }
  }
}

void PlainCrowd::step() {
  sense();
  steer_all();
  resolve_conflicts();
}

uint64_t PlainCrowd::overlaps() const {
  uint64_t found = 0;
  for (size_t i = 0; i < bodies_.size(); ++i) {
    for (size_t j = i + 1; j < bodies_.size(); ++j) {
      const Spot d = between(bodies_[i].at, bodies_[j].at);
      found += crowd::nearer_than(d.x, d.z, int64_t{bodies_[i].radius} + bodies_[j].radius);
    }
  }
  return found;
}

Spot next_goal(const PlainConfig& config, const PlainBody& body, uint64_t seed, uint32_t index,
               uint64_t turn) {
  const auto within_50_m = [&](uint64_t stream) {
    return config.to_units(100 * random_unit(seed, stream, turn) - 50);
  };
  return {body.at.x + within_50_m(2 * uint64_t{index}),
          body.at.z + within_50_m(2 * uint64_t{index} + 1)};
}

std::vector<PlainBody> random_bodies(const PlainConfig& config, uint32_t count, double area,
                                     uint64_t seed, int32_t& side) {
  side = config.to_units(std::sqrt(area * count));
  std::vector<PlainBody> bodies;
  for (uint64_t n = 0; bodies.size() < count; ++n) {
    PlainBody body;
    const auto below_side = [&](uint64_t k) {
      return static_cast<int32_t>(random_below(seed, ~uint64_t{0}, k, static_cast<uint64_t>(side)));
    };
    body.at = {below_side(2 * n), below_side(2 * n + 1)};
    const bool clear = std::none_of(bodies.begin(), bodies.end(), [&](const PlainBody& other) {
      return crowd::nearer_than(wrapped(other.at.x - body.at.x, side),
                                wrapped(other.at.z - body.at.z, side), 2 * int64_t{body.radius});
    });
    if (!clear) continue;
    body.goal = next_goal(config, body, seed, static_cast<uint32_t>(bodies.size()), 0);
    bodies.push_back(body);
  }
  return bodies;
}

std::vector<PlainBody> ring_bodies(const PlainConfig& config, uint32_t count, double radius,
                                   Spot middle) {
  constexpr double kApart = 1.2;  // [m]
  std::vector<PlainBody> bodies;
  for (int32_t ring = 0; bodies.size() < count; ++ring) {
    const double r = radius + kApart * ring;
    const auto fit = static_cast<uint32_t>(2 * std::numbers::pi * r / kApart);
    const uint32_t here = std::min(fit, count - static_cast<uint32_t>(bodies.size()));
    for (uint32_t k = 0; k < here; ++k) {
      const double angle = 2 * std::numbers::pi * (k + 0.37 * ring) / here;
      const Spot from{config.to_units(r * std::cos(angle)), config.to_units(r * std::sin(angle))};
      PlainBody body;
      body.at = {middle.x + from.x, middle.z + from.z};
      body.goal = {middle.x - from.x, middle.z - from.z};
      bodies.push_back(body);
    }
  }
  return bodies;
}

}  // namespace throng::test
