// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cmath>

#include "core/stopwatch.h"
#include "crowd/link/link_mode.h"
#include "crowd/walk/step_units.h"
#include "world/place.h"
#include "world/tile_grid.h"

// The step of avatars on off-mesh links. Walkers have moved clear of where these are; then they
// move one after the other in order of slots, each along its straight line as far as no cylinder of
// another body is in it. Linear in all bodies while a link is used, else nothing.
namespace throng::crowd {
namespace {

constexpr std::array<double, 4> kParts = {1, 0.5, 0.25, 0.1};  // of a step
constexpr double kTurnTime = 10;  // [s] to get to the start, then it is another's turn

bool overlaps_with(const Body& a, const Stand& at, const Body& b) {
  return nearer_than(at.x - b.x, at.z - b.z, int64_t{a.radius} + b.radius) &&
         at.y < b.y + b.height && b.y < at.y + a.height;
}

}  // namespace

void LinkMode::add_users() {
  std::sort(came_.begin(), came_.end());
  merged_.resize(users_.size() + came_.size());
  std::merge(users_.begin(), users_.end(), came_.begin(), came_.end(), merged_.begin());
  users_.swap(merged_);
  users_.erase(std::unique(users_.begin(), users_.end()), users_.end());
  came_.clear();
}

// Of those that use links, and of what is near them and near the ends that they wait for.
void LinkMode::find_users(std::span<Body> bodies) {
  constexpr uint32_t kNone = UINT32_MAX;
  add_users();
  is_user_.assign(shared_.names.slots(), false);
  for (const uint32_t slot : users_) is_user_[slot] = true;
  bodies_.assign(users_.size(), kNone);
  for (uint32_t i = 0; i < bodies.size(); ++i) {
    if (!is_user_[bodies[i].slot]) continue;
    const auto at = std::lower_bound(users_.begin(), users_.end(), bodies[i].slot);
    bodies_[static_cast<size_t>(at - users_.begin())] = i;
  }
  size_t kept = 0;
  for (size_t n = 0; n < users_.size(); ++n) {
    LinkUse& use = uses_[users_[n]];
    if (bodies_[n] == kNone) use = {};  // It was removed.
    if (use.state != LinkUse::kNone && use.state != LinkUse::kRides && bodies[bodies_[n]].leaves) {
      Body& body = bodies[bodies_[n]];
      end_use(body, use);
      body.flags |= Body::kNeedsPath;
    }
    if (use.state == LinkUse::kNone) continue;
    users_[kept] = users_[n];
    bodies_[kept++] = bodies_[n];
  }
  users_.resize(kept);
  bodies_.resize(kept);
  if (users_.empty()) return;
  // Where all bodies are narrow, those that are asked for room may be farther from an end.
  const auto width = std::max(int64_t{4} * widest_ + 8, int64_t{room_of(widest_)});
  near_.begin(static_cast<int32_t>(std::min(width, int64_t{1} << 30)));
  for (size_t n = 0; n < users_.size(); ++n) {
    const LinkUse& use = uses_[users_[n]];
    const Body& body = bodies[bodies_[n]];
    const bool rides = use.state == LinkUse::kRides;
    near_.add_point(rides ? body.x : use.to.x, rides ? body.z : use.to.z);
    if (use.state == LinkUse::kEnters) near_.add_point(use.from.x, use.from.z);
  }
  near_.find(bodies);
}

void LinkMode::step(std::span<Body> bodies, EngineCounts& counts, EngineTimes& times) {
  if (users_.empty() && came_.empty()) return;
  const auto start = Clock::now();
  find_users(bodies);
  for (size_t n = 0; n < users_.size(); ++n) {
    if (uses_[users_[n]].state == LinkUse::kRides) ride(bodies, bodies_[n], counts);
  }
  for (size_t n = 0; n < users_.size(); ++n) {
    LinkUse& use = uses_[users_[n]];
    if (use.state == LinkUse::kEnters) enter(bodies, bodies[bodies_[n]], use);
  }
  take_turns(bodies);
  end_giving_room(bodies);
  ask_for_room(bodies);
  std::erase_if(users_, [&](uint32_t slot) { return uses_[slot].state == LinkUse::kNone; });
  add_users();
  times.resolve += seconds_since(start);
}

// One whose turn it is leaves the ground once it is at the start and the end is free.
void LinkMode::enter(std::span<const Body> bodies, Body& body, LinkUse& use) const {
  // It has lost its path, or its link, and searches again.
  if (body.has(Body::kNeedsPath) || find_link(use.link) == nullptr) return;
  const auto near = static_cast<int64_t>(kEntryRadius / shared_.unit);
  const StrideGround ground(shared_.ground_of(body),
                            world::step_mm(shared_.body_class(body.avatar_class)));
  StrideGround::Landing landing;
  const bool is_at_start =
      nearer_than(body.x - use.from.x, body.z - use.from.z, near) &&
      ground.move(body.level, body.y, body.point(), {use.from.x, use.from.z}, landing) &&
      landing.level == use.from.level;
  if (!is_at_start || !end_is_free(bodies, body, use) ||
      is_obstructed(body, body.stand(), use.to) || is_crossed(bodies, body, body.stand())) {
    const double left =
        std::hypot(double{1} * use.from.x - body.x, double{1} * use.from.z - body.z) * shared_.unit;
    if (shared_.seconds_since(use.since) <= kTurnTime + left / body.speed) return;
    use.state = LinkUse::kWaits;
    use.since = shared_.time;
    return;
  }
  use.from = body.stand();
  use.along = 0;
  use.state = LinkUse::kRides;
  body.on_link = true;
  body.flags = (body.flags & (Body::kHasGoal | Body::kArrived)) | Body::kMovedElsewhere;
  body.detour_angle = 0;
  head_to_end(body);
}

void LinkMode::ride(std::span<Body> bodies, uint32_t index, EngineCounts& counts) {
  Body& body = bodies[index];
  LinkUse& use = uses_[body.slot];
  const double dt = shared_.sub_dt(), speed = double{body.speed} * use.factor;
  const double size = length(point_of(use.to) - point_of(use.from));
  const Stand before = body.stand();
  const auto is_clear = [&](const Stand& at) {
    return !near_.any_near(before.x, before.z, [&](uint32_t j) {
      return j != index && overlaps_with(body, at, bodies[j]);
    });
  };
  // In parts that rise no more than the lowest body is high, so that it passes through none.
  const double rise = std::fabs(double{1} * use.to.y - use.from.y);
  const auto displace = [&](double along) {
    const Stand at = along >= size ? use.to : stand_at(use, along / size);
    const double parts = size > 0 ? std::floor(rise * (along - use.along) / size / lowest_) + 1 : 1;
    for (double part = 1; part < parts; ++part) {
      const double there = use.along + (along - use.along) * part / parts;
      if (!is_clear(stand_at(use, there / size))) return false;
    }
    if (!is_clear(at)) return false;
    counts.progress += std::lrint((along - use.along) / (double{body.speed} * dt) * 1e6);
    use.along = along;
    body.x = at.x;
    body.z = at.z;
    body.y = at.y;
    return true;
  };
  const bool moves = std::any_of(kParts.begin(), kParts.end(), [&](double part) {
    return displace(std::min(size, use.along + part * speed * dt));
  });
  if (!moves) ++counts.stood;
  const auto velocity = [&](int32_t displacement) {
    return static_cast<float>(displacement * (shared_.unit / dt));
  };
  body.velocity = {velocity(body.x - before.x), velocity(body.z - before.z)};
  if (!body.has(Body::kExternal)) {
    const double rate = size > 0 ? speed / size * shared_.unit : 0;
    body.preferred = {static_cast<float>((use.to.x - use.from.x) * rate),
                      static_cast<float>((use.to.z - use.from.z) * rate)};
  }
  const float sub_dt = shared_.sub_dt();
  Turning(shared_.orientations, sub_dt).turn(body, sub_dt);
  if (use.along >= size) land(body, use);
}

// It walks again. The ground may have changed since it planned, and the rest of its path with it.
void LinkMode::land(Body& body, LinkUse& use) const {
  body.level = use.to.level;
  body.on_link = false;
  body.flags &= Body::kHasGoal | Body::kExternal | Body::kArrived;
  if (body.has(Body::kHasGoal)) body.flags |= Body::kNeedsPath;
  body.clear(Body::kLast);
  body.local_target_x = body.x;
  body.local_target_z = body.z;
  if (body.has(Body::kExternal)) forget_rest(body);
  // An obstacle that closes there lets it out.
  const world::GroundPoint at = body.point();
  if (!shared_.ground_of(body).is_legal(body.level, world::in_tile(at.cell_x()),
                                        world::in_tile(at.cell_z()))) {
    body.leaves = true;
    shared_.some_leave = true;
  }
  use = {};
}

}  // namespace throng::crowd
