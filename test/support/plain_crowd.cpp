// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "plain_crowd.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

#include "core/random.h"
#include "crowd/precedence.h"
#include "crowd/reaction.h"

namespace throng::test {
namespace {

using steer::Plane;

constexpr float kThere = 0.3f;  // [m] from its goal a body has arrived
constexpr float kShorter[] = {0.5f, 0.25f, 0.1f};

int32_t wrapped(int32_t d, int32_t side) {
  if (side <= 0) return d;
  if (d > side / 2) return d - side;
  return d < -side / 2 ? d + side : d;
}

// Cells as wide as one sees, as many as fit.
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
    // The cell to the left is then the one to the right, too.
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
    widest_ = std::max(widest_, b.radius);
    longest_ = std::max(longest_, config.units.stride(b.speed));
  }
  near_.resize(bodies_.size());
  choices_.resize(bodies_.size());
}

Spot PlainCrowd::between(Spot a, Spot b) const {
  return {wrapped(b.x - a.x, config_.side), wrapped(b.z - a.z, config_.side)};
}

Plane PlainCrowd::preferred_of(const PlainBody& body) const {
  const Plane way = config_.units.metres(body.goal.x - body.at.x, body.goal.z - body.at.z);
  return steer::preferred_towards(way, body.speed, config_.units.dt, body.turn);
}

void PlainCrowd::sense() {
  // Who could be touched within a step must be seen, however short the sight.
  const int32_t sight = std::max(config_.to_units(config_.sight), 2 * widest_ + 2 * longest_);
  const float most = static_cast<float>(sight) * static_cast<float>(sight);
  const Grid grid(bodies_, sight, config_.side);
  const bool repeats = config_.side > 0;
  for (uint32_t i = 0; i < bodies_.size(); ++i) {
    near_[i].clear();
    const int32_t cx = grid.column(bodies_[i].at.x - grid.low.x);
    const int32_t cz = grid.column(bodies_[i].at.z - grid.low.z);
    const int32_t reach = grid.width > 1 || !repeats ? 1 : 0;
    for (int32_t z = cz - reach; z <= cz + reach; ++z) {
      for (int32_t x = cx - reach; x <= cx + reach; ++x) {
        const bool inside = x >= 0 && z >= 0 && x < grid.width && z < grid.depth;
        if (!inside && !repeats) continue;
        for (const uint32_t j :
             grid.bodies[grid.at((x + grid.width) % grid.width, (z + grid.depth) % grid.depth)]) {
          const Spot at = between(bodies_[i].at, bodies_[j].at);
          if (j != i && near_square(at.x, at.z) < most) near_[i].push_back({j, at});
        }
      }
    }
    std::sort(near_[i].begin(), near_[i].end(), [](const Near& a, const Near& b) {
      const float da = near_square(a.at.x, a.at.z), db = near_square(b.at.x, b.at.z);
      return da != db ? da < db : a.other < b.other;
    });
  }
}

// By another model than ours.
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
      .way = config_.units.metres(body.goal.x - body.at.x, body.goal.z - body.at.z),
      .stops = true,
      .fastest = body.speed,
      .radius = static_cast<float>(body.radius) * config_.units.unit,
      .slot = i,
      .others = others};
  choices_[i] = steer::ways_about(steer::preferred_velocity(config_.model, view, config_.units.dt));
}

void PlainCrowd::steer_all() {
  follows_.assign(bodies_.size(), 0);
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
    for (const Near& n : near_[i]) {
      if (situation.near.size == static_cast<size_t>(config_.steering.neighbours)) break;
      const PlainBody& other = bodies_[n.other];
      // Who has arrived makes way for those who would pass, were he not there: they may stand.
      const bool makes_way = body.arrived >= 0 && other.arrived < 0;
      const auto bound = [](const PlainBody& b, uint32_t slot) {
        return Bound{b.at.x, b.at.z, b.goal.x, b.goal.z, b.radius, slot};
      };
      if (body.arrived < 0 && other.arrived < 0 &&
          goes_first(bound(other, n.other), bound(body, i))) {
        waits = true;
        situation.preferred = preferred_of_waiting(
            config_.units.metres(body.goal.x - body.at.x, body.goal.z - body.at.z), body.speed,
            static_cast<float>(body.radius + other.radius) * config_.units.unit);
      }
      situation.near.add(
          config_.steering,
          {config_.units.metres(n.at.x, n.at.z), makes_way ? preferred_of(other) : other.velocity,
           static_cast<float>(body.radius + other.radius) * config_.units.unit,
           preferred_of(other)});
    }
    const Plane preferred = situation.preferred;
    situation.preferred = steer::following(config_.steering, situation);
    follows_[i] =
        steer::can_but_crawl(config_.patience, preferred, situation.preferred, body.speed) ? 1 : 0;
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
    // Who meets nobody does as he wishes.
    if (open) {
      std::rotate(choices_[i].begin(), choices_[i].end() - 1, choices_[i].end());
      choices_[i][0] = situation.preferred;
    }
  }
}

// Who stood within this when the step began can be touched in it.
bool PlainCrowd::can_touch(uint32_t i, const Near& n) const {
  const PlainBody &a = bodies_[i], &b = bodies_[n.other];
  const int64_t reach =
      int64_t{a.radius} + b.radius + config_.units.stride(a.speed) + config_.units.stride(b.speed);
  return nearer_than(n.at.x, n.at.z, reach);
}

void PlainCrowd::commit() {
  const size_t count = bodies_.size();
  std::vector<Spot> now(count);
  for (size_t i = 0; i < count; ++i) now[i] = bodies_[i].at;
  std::vector<uint8_t> decided(count, 0);
  const uint64_t every = steps_of_reaction(config_.reaction, config_.units.dt);
  // Who goes on as he does; who still may do what he wants most, and does.
  std::vector<uint8_t> keeping(count), first(count, 1), keeps(count, 0);
  for (uint32_t i = 0; i < count; ++i) {
    const PlainBody& b = bodies_[i];
    keeping[i] = b.keeps && !decides(every, steps_, i) &&
                 !is_before({b.goal.x - b.at.x, b.goal.z - b.at.z}, config_.units.stride(b.speed));
  }
  std::vector<std::optional<Spot>> named(count);
  const auto is_clear = [&](uint32_t i, uint32_t j, Spot a, Spot b) {
    const Spot d = between(a, b);
    return !nearer_than(d.x, d.z, int64_t{bodies_[i].radius} + bodies_[j].radius);
  };
  const auto order = [&](uint32_t i) { return std::pair(random_u64(config_.seed, i, steps_), i); };
  for (int32_t round = 0; round < config_.rounds; ++round) {
    for (uint32_t i = 0; i < count; ++i) {
      named[i].reset();
      if (decided[i] != 0) continue;
      const auto consider_way = [&](Spot way) {
        const Spot to{now[i].x + way.x, now[i].z + way.z};
        for (const Near& n : near_[i]) {
          if (can_touch(i, n) && !is_clear(i, n.other, to, now[n.other])) return false;
        }
        named[i] = to;
        return true;
      };
      const auto way_of = [&](Plane velocity) {
        return Spot{config_.units.way(velocity.x), config_.units.way(velocity.z)};
      };
      const auto consider = [&](Plane velocity) { return consider_way(way_of(velocity)); };
      if (keeping[i] != 0) {
        keeps[i] = consider(bodies_[i].velocity);
        if (keeps[i] != 0) continue;
        keeping[i] = 0;
        if (round > 0) first[i] = 0;
      }
      if (round == 0) bodies_[i].follows = follows_[i] != 0;
      if (first[i] != 0) first[i] = consider(choices_[i][0]);
      keeps[i] = first[i];
      bool found = std::any_of(choices_[i].begin(), choices_[i].end(), consider);
      for (const float part : kShorter) {
        const Spot best = way_of(choices_[i][0]);
        const auto shorter = [&](int32_t way) {
          return static_cast<int32_t>(std::lrint(static_cast<float>(way) * part));
        };
        found = found || consider_way({shorter(best.x), shorter(best.z)});
      }
    }
    for (uint32_t i = 0; i < count; ++i) {
      if (!named[i]) continue;
      const bool mine = std::none_of(near_[i].begin(), near_[i].end(), [&](const Near& n) {
        return can_touch(i, n) && named[n.other] && order(n.other) > order(i) &&
               !is_clear(i, n.other, *named[i], *named[n.other]);
      });
      if (mine) decided[i] = 1;
    }
    for (uint32_t i = 0; i < count; ++i) {
      if (named[i] && decided[i] != 0) now[i] = *named[i];
    }
  }
  for (size_t i = 0; i < count; ++i) keeps[i] = keeps[i] & decided[i];
  settle(now, keeps);
}

void PlainCrowd::settle(const std::vector<Spot>& now, const std::vector<uint8_t>& keeps) {
  progress_ = 0;
  ++steps_;
  const StepUnits& units = config_.units;
  for (size_t i = 0; i < bodies_.size(); ++i) {
    PlainBody& body = bodies_[i];
    const Plane way = units.metres(body.goal.x - body.at.x, body.goal.z - body.at.z);
    const Plane preferred = preferred_of(body);
    const float left = size_of(way);
    body.velocity = {units.velocity(now[i].x - body.at.x), units.velocity(now[i].z - body.at.z)};
    const float towards =
        left > 1e-6f ? (body.velocity.x * way.x + body.velocity.z * way.z) / left : 0;
    progress_ += towards / body.speed / static_cast<double>(bodies_.size());
    body.at = now[i];
    body.keeps = keeps[i] != 0;
    if (config_.deadlock_avoidance) {
      const bool alone = std::none_of(near_[i].begin(), near_[i].end(), [&](const Near& n) {
        return can_touch(static_cast<uint32_t>(i), n);
      });
      const float content =
          left > 1 && !alone
              ? steer::progress_felt(config_.patience, towards / body.speed, body.follows)
              : 1;
      const float along = (body.velocity.x * preferred.x + body.velocity.z * preferred.z) /
                          (body.speed * body.speed);
      body.turn = steer::next_turn(config_.patience, body.turn, content, along, units.dt);
    }
    const Plane rest = units.metres(body.goal.x - body.at.x, body.goal.z - body.at.z);
    if (body.arrived < 0 && size_of(rest) < kThere) body.arrived = time();
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
  commit();
}

uint64_t PlainCrowd::overlaps() const {
  uint64_t found = 0;
  for (size_t i = 0; i < bodies_.size(); ++i) {
    for (size_t j = i + 1; j < bodies_.size(); ++j) {
      const Spot d = between(bodies_[i].at, bodies_[j].at);
      found += nearer_than(d.x, d.z, int64_t{bodies_[i].radius} + bodies_[j].radius);
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
      return nearer_than(wrapped(other.at.x - body.at.x, side),
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
