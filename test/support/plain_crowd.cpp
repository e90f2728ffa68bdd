// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "plain_crowd.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "core/random.h"

namespace throng::test {
namespace {

using steer::Plane;

constexpr double kThere = 0.3;  // [m] from its goal a body has arrived
constexpr double kShorter[] = {0.5, 0.25, 0.1};

double squared(Plane p) { return p.x * p.x + p.z * p.z; }
double size_of(Plane p) { return std::sqrt(squared(p)); }

double wrapped(double d, double side) {
  if (side <= 0) return d;
  if (d > side / 2) return d - side;
  return d < -side / 2 ? d + side : d;
}

// Cells as wide as one sees, as many as fit.
struct Grid {
  Plane low;
  double cell = 1;
  int32_t width = 1, depth = 1;
  std::vector<std::vector<uint32_t>> bodies;

  Grid(const std::vector<PlainBody>& all, double sight, double side) {
    Plane high{side, side};
    if (side <= 0) {
      low = high = all.empty() ? Plane{} : all[0].at;
      for (const PlainBody& b : all) {
        low = {std::min(low.x, b.at.x), std::min(low.z, b.at.z)};
        high = {std::max(high.x, b.at.x), std::max(high.z, b.at.z)};
      }
    }
    const double across = std::max(high.x - low.x, high.z - low.z);
    width = depth = std::max(1, static_cast<int32_t>(across / sight));
    // The cell to the left is then the one to the right, too.
    if (side > 0 && width < 3) width = depth = 1;
    cell = std::max(across / width, sight);
    bodies.resize(static_cast<size_t>(width * depth));
    for (uint32_t i = 0; i < all.size(); ++i) {
      bodies[at(column(all[i].at.x - low.x), column(all[i].at.z - low.z))].push_back(i);
    }
  }
  [[nodiscard]] int32_t column(double d) const {
    return std::clamp(static_cast<int32_t>(d / cell), 0, width - 1);
  }
  [[nodiscard]] size_t at(int32_t x, int32_t z) const { return static_cast<size_t>(z * width + x); }
};

}  // namespace

PlainCrowd::PlainCrowd(std::vector<PlainBody> bodies, const PlainConfig& config)
    : bodies_(std::move(bodies)), config_(config) {
  for (const PlainBody& b : bodies_) {
    widest_ = std::max(widest_, b.radius);
    fastest_ = std::max(fastest_, b.speed);
  }
  near_.resize(bodies_.size());
  choices_.resize(bodies_.size());
}

Plane PlainCrowd::between(Plane a, Plane b) const {
  return {wrapped(b.x - a.x, config_.side), wrapped(b.z - a.z, config_.side)};
}

Plane PlainCrowd::wish_of(const PlainBody& body) const {
  const Plane way{body.goal.x - body.at.x, body.goal.z - body.at.z};
  const double left = size_of(way);
  if (left < 1e-9) return {};
  const double speed = std::min(body.speed, left / config_.dt);
  return steer::turned_right({way.x / left * speed, way.z / left * speed}, body.turn);
}

void PlainCrowd::sense() {
  // Who could be touched within a step must be seen, however short the sight.
  const double sight = std::max(config_.sight, 2 * widest_ + 2 * fastest_ * config_.dt);
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
          const Plane at = between(bodies_[i].at, bodies_[j].at);
          if (j != i && squared(at) < sight * sight) near_[i].push_back({j, at});
        }
      }
    }
    std::sort(near_[i].begin(), near_[i].end(), [](const Near& a, const Near& b) {
      const double da = squared(a.at), db = squared(b.at);
      return da != db ? da < db : a.other < b.other;
    });
  }
}

void PlainCrowd::steer_all() {
  std::vector<steer::Neighbour> seen;
  for (uint32_t i = 0; i < bodies_.size(); ++i) {
    const PlainBody& body = bodies_[i];
    seen.clear();
    for (const Near& n : near_[i]) {
      const PlainBody& other = bodies_[n.other];
      // Who has arrived makes way for those who would pass, were he not there: they may stand.
      const bool makes_way = body.arrived >= 0 && other.arrived < 0;
      seen.push_back(
          {n.at, makes_way ? wish_of(other) : other.velocity, body.radius + other.radius});
    }
    choices_[i] =
        steer::choose_velocity(config_.steering, body.velocity, wish_of(body), body.speed, seen);
  }
}

void PlainCrowd::commit() {
  const size_t count = bodies_.size();
  std::vector<Plane> now(count);
  for (size_t i = 0; i < count; ++i) now[i] = bodies_[i].at;
  std::vector<uint8_t> decided(count, 0);
  std::vector<std::optional<Plane>> named(count);
  // Who stood within this when the step began can be touched in it.
  const auto can_touch = [&](uint32_t i, const Near& n) {
    const double reach = bodies_[i].radius + bodies_[n.other].radius +
                         (bodies_[i].speed + bodies_[n.other].speed) * config_.dt;
    return squared(n.at) < reach * reach;
  };
  const auto is_clear = [&](uint32_t i, uint32_t j, Plane a, Plane b) {
    const double radii = bodies_[i].radius + bodies_[j].radius;
    return squared(between(a, b)) >= radii * radii;
  };
  const auto order = [&](uint32_t i) { return random_u64(config_.seed, i, steps_); };
  for (int32_t round = 0; round < config_.rounds; ++round) {
    for (uint32_t i = 0; i < count; ++i) {
      named[i].reset();
      if (decided[i] != 0) continue;
      const auto consider = [&](Plane velocity) {
        const Plane to{now[i].x + velocity.x * config_.dt, now[i].z + velocity.z * config_.dt};
        for (const Near& n : near_[i]) {
          if (can_touch(i, n) && !is_clear(i, n.other, to, now[n.other])) return false;
        }
        named[i] = to;
        return true;
      };
      bool found = std::any_of(choices_[i].begin(), choices_[i].end(), consider);
      for (const double part : kShorter) {
        const Plane best = choices_[i][0];
        found = found || consider({best.x * part, best.z * part});
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
  settle(now);
}

void PlainCrowd::settle(const std::vector<Plane>& now) {
  progress_ = 0;
  ++steps_;
  for (size_t i = 0; i < bodies_.size(); ++i) {
    PlainBody& body = bodies_[i];
    const Plane way{body.goal.x - body.at.x, body.goal.z - body.at.z};
    const double left = size_of(way);
    body.velocity = {(now[i].x - body.at.x) / config_.dt, (now[i].z - body.at.z) / config_.dt};
    const double towards =
        left > 1e-9 ? (body.velocity.x * way.x + body.velocity.z * way.z) / left : 0;
    progress_ += towards / body.speed / static_cast<double>(bodies_.size());
    body.at = now[i];
    if (config_.patient) {
      const double content = left > 1 ? towards / body.speed : 1;
      body.turn = steer::next_turn(config_.patience, body.turn, content, config_.dt);
    }
    const Plane rest{body.goal.x - body.at.x, body.goal.z - body.at.z};
    if (body.arrived < 0 && squared(rest) < kThere * kThere) body.arrived = time();
    if (config_.side <= 0) continue;
    for (double Plane::*axis : {&Plane::x, &Plane::z}) {
      const double shift = body.at.*axis < 0               ? config_.side
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
      // 1 nm: of the torus, where a place just before the border is moved by its side.
      const double radii = bodies_[i].radius + bodies_[j].radius - (config_.side > 0 ? 1e-9 : 0);
      found += squared(between(bodies_[i].at, bodies_[j].at)) < radii * radii;
    }
  }
  return found;
}

Plane next_goal(const PlainBody& body, uint64_t seed, uint32_t index, uint64_t turn) {
  return {body.at.x + 100 * random_unit(seed, 2 * uint64_t{index}, turn) - 50,
          body.at.z + 100 * random_unit(seed, 2 * uint64_t{index} + 1, turn) - 50};
}

std::vector<PlainBody> random_bodies(uint32_t count, double area, uint64_t seed, double& side) {
  side = std::sqrt(area * count);
  std::vector<PlainBody> bodies;
  for (uint64_t n = 0; bodies.size() < count; ++n) {
    PlainBody body;
    body.at = {side * random_unit(seed, ~uint64_t{0}, 2 * n),
               side * random_unit(seed, ~uint64_t{0}, 2 * n + 1)};
    const bool clear = std::none_of(bodies.begin(), bodies.end(), [&](const PlainBody& other) {
      const Plane d{wrapped(other.at.x - body.at.x, side), wrapped(other.at.z - body.at.z, side)};
      return squared(d) < 4 * body.radius * body.radius;
    });
    if (!clear) continue;
    body.goal = next_goal(body, seed, static_cast<uint32_t>(bodies.size()), 0);
    bodies.push_back(body);
  }
  return bodies;
}

std::vector<PlainBody> ring_bodies(uint32_t count, double radius) {
  constexpr double kApart = 1.2;  // [m]
  std::vector<PlainBody> bodies;
  for (int32_t ring = 0; bodies.size() < count; ++ring) {
    const double r = radius + kApart * ring;
    const auto fit = static_cast<uint32_t>(2 * std::numbers::pi * r / kApart);
    const uint32_t here = std::min(fit, count - static_cast<uint32_t>(bodies.size()));
    for (uint32_t k = 0; k < here; ++k) {
      const double angle = 2 * std::numbers::pi * (k + 0.37 * ring) / here;
      PlainBody body;
      body.at = {r * std::cos(angle), r * std::sin(angle)};
      body.goal = {-body.at.x, -body.at.z};
      bodies.push_back(body);
    }
  }
  return bodies;
}

}  // namespace throng::test
