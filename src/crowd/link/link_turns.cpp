// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <tuple>

#include "crowd/link/link_mode.h"
#include "crowd/walk/step_units.h"
#include "steer/air.h"
#include "world/place.h"
#include "world/tile_grid.h"

// Turns at off-mesh links. A link is a corridor in which avatars cannot pass each other, so they
// take turns in the order in which they came: none enters while another comes towards it or while
// its end is occupied. Those that wait stand aside of all links, so that those on them can land,
// and yield to them as avatars do that have arrived. Constant time for each that waits, but for
// sorting them.
namespace throng::crowd {
namespace {

constexpr double kMargin = 0.1;        // [m] between those that wait and one at an end
constexpr double kBrakingTime = 0.3;   // [s] within which one that comes to the start stops
constexpr double kSpread = 1.6;        // widest radii, times the root of how many wait
constexpr uint64_t kSightChecks = 16;  // decisions
constexpr double kEndMargin = 0.02;    // [m] around one that lands
constexpr uint8_t kForward = 1, kBack = 2, kEntered = 4, kClosed = 8;  // of on_link_

bool same(const PathPoint& a, const PathPoint& b) {
  constexpr int32_t kRounded = 2;  // [units]
  return a.level == b.level && std::abs(a.x - b.x) <= kRounded && std::abs(a.z - b.z) <= kRounded;
}

}  // namespace

// Between the middles of a body that waits and of one at an end. [units]
int32_t LinkMode::room_of(const Body& body) const {
  constexpr double kMax = 1 << 28;  // as wide as no body is
  return static_cast<int32_t>(
      std::min(kMax, double{1} * body.radius + widest_ + kMargin / shared_.unit));
}

bool LinkMode::begin_step() {
  for (Link& link : links_) link.waiting = {};
  for (const uint32_t slot : users_) {
    const LinkUse& use = uses_[slot];
    if (use.state != LinkUse::kWaits) continue;
    const auto at = std::lower_bound(links_.begin(), links_.end(), use.link,
                                     [](const Link& link, EditId id) { return link.edit < id; });
    if (at != links_.end() && at->edit == use.link) ++at->waiting[use.back != 0 ? 1 : 0];
  }
  return !links_.empty() || !users_.empty();
}

// Of links with the same ends the cheapest, as finders choose it. False: none leads there.
bool LinkMode::begin_to_wait(Body& body, const PathPoint& start, const PathPoint& end) {
  const Link* best = nullptr;
  bool back = false;
  for (const Link& link : links_) {
    const bool leads = same(link.from, start) && same(link.to, end);
    const bool leads_back = link.two_way && same(link.to, start) && same(link.from, end);
    if ((!leads && !leads_back) || (best != nullptr && best->cost <= link.cost)) continue;
    best = &link;
    back = !leads;
  }
  if (best == nullptr) return false;
  const CrowdGround& ground = shared_.ground_of(body);
  const auto stand = [&](const PathPoint& at) {
    return Stand{at.x, at.z, ground.feet(at.level, {at.x, at.z}), at.level};
  };
  LinkUse& use = uses_[body.slot];
  use = {};
  use.from = stand(start);
  use.to = stand(end);
  use.since = shared_.sub_step;
  use.link = best->edit;
  use.state = LinkUse::kWaits;
  use.back = back ? 1 : 0;
  const double size = length(point_of(use.to) - point_of(use.from));
  use.factor = static_cast<float>(std::clamp(size / best->cost, 1e-3, 1.0));
  const std::lock_guard lock(adding_);
  came_.push_back(body.slot);
  return true;
}

bool LinkMode::plan_at_start(Body& body, const Route& route, const StrideGround& ground,
                             uint64_t nth) {
  if (!leads_to_link(route)) return false;
  const LinkUse& use = uses_[body.slot];
  const PathPoint& start = route.corners[route.next];
  const auto sees = [&] {
    return ground.sees(body.level, body.point(), {start.x, start.z}, start.level, HUGE_VALF);
  };
  if (use.state == LinkUse::kEnters) return false;
  if (use.state == LinkUse::kWaits) {
    if (nth % kSightChecks != 0 || sees()) return true;
    body.flags |= Body::kNeedsPath;
    return false;
  }
  // The more wait, the farther from the start: they need not press.
  uint32_t waiting = 0;
  for (const Link& link : links_) {
    if (same(link.from, start)) waiting += link.waiting[0];
    if (link.two_way && same(link.to, start)) waiting += link.waiting[1];
  }
  const double brakes =
      body.speed * std::max<double>(shared_.sub_dt(), kBrakingTime) / shared_.unit;
  const double range = room_of(body) + brakes + kSpread * widest_ * std::sqrt(double{1} * waiting);
  if (near_square(start.x - body.x, start.z - body.z) > static_cast<float>(range * range)) {
    return false;
  }
  if (sees() && !begin_to_wait(body, start, route.corners[route.next + 1u])) {
    body.flags |= Body::kNeedsPath;
  }
  return false;  // If it is its turn at once, it does not stop.
}

void LinkMode::forget(Body& body) { end_use(body, uses_[body.slot]); }

void LinkMode::end_use(Body& body, LinkUse& use) const {
  if (use.state == LinkUse::kWaits && use.stands != 0) {
    body.clear(Body::kLast);
    if (use.arrived == 0) body.clear(Body::kArrived);
  }
  use = {};
}

// Would a body that stands there be in the path of those on a link? In plan, whatever its height.
bool LinkMode::is_beside_a_link(int32_t x, int32_t z, int32_t range) const {
  return std::any_of(links_.begin(), links_.end(), [&](const Link& link) {
    const double wx = double{1} * link.to.x - link.from.x, wz = double{1} * link.to.z - link.from.z;
    const double dx = double{1} * x - link.from.x, dz = double{1} * z - link.from.z;
    const double whole = wx * wx + wz * wz;
    const double part = whole > 0 ? std::clamp((dx * wx + dz * wz) / whole, 0.0, 1.0) : 0;
    const double away_x = dx - part * wx, away_z = dz - part * wz;
    return away_x * away_x + away_z * away_z < double{1} * range * range;
  });
}

// It waits where it is, or, if one on a link needs the space, at the nearest place beside.
void LinkMode::stand_aside(Body& body, LinkUse& use) const {
  use.stands = 1;
  use.arrived = body.has(Body::kArrived) ? 1 : 0;
  body.flags |= Body::kArrived | Body::kLast;
  body.clear(Body::kContinues);
  body.detour_angle = 0;
  body.local_target_x = body.x;
  body.local_target_z = body.z;
  const int32_t room = room_of(body);
  if (!is_beside_a_link(body.x, body.z, room)) return;
  const StrideGround ground(shared_.ground_of(body),
                            world::step_mm(shared_.body_class(body.avatar_class)));
  float least = HUGE_VALF;
  for (const double far : {1.05, 1.5, 2.0, 3.0}) {
    for (const auto& [dx, dz] : steer::kEighths) {
      const double to_x = use.from.x + far * room * dx, to_z = use.from.z + far * room * dz;
      if (!(to_x >= 0 && to_z >= 0 && to_x < INT32_MAX && to_z < INT32_MAX)) continue;
      const auto x = static_cast<int32_t>(to_x), z = static_cast<int32_t>(to_z);
      const float square = near_square(x - body.x, z - body.z);
      if (square >= least || is_beside_a_link(x, z, room)) continue;
      StrideGround::Landing landing;
      if (!ground.move(body.level, body.y, body.point(), {x, z}, landing)) continue;
      least = square;
      body.local_target_x = x;
      body.local_target_z = z;
    }
    if (least < HUGE_VALF) return;
  }
}

void LinkMode::give_turn(Body& body, LinkUse& use) const {
  if (use.stands != 0) {
    body.clear(Body::kLast);
    if (use.arrived == 0) body.clear(Body::kArrived);
  }
  use.stands = 0;
  use.state = LinkUse::kEnters;
  use.since = shared_.sub_step;
  body.clear(Body::kContinues);
  body.detour_angle = 0;
  body.local_target_x = use.from.x;
  body.local_target_z = use.from.z;
}

bool LinkMode::is_obstructed(const Body& body, const Stand& from, const Stand& to) const {
  if (shared_.obstacle_grid.is_empty()) return false;
  const LinkLine line = line_of(body, from, to);
  const AirPosition middle{from.x + (to.x - from.x) / 2, from.z + (to.z - from.z) / 2, from.y};
  const double half = std::hypot(line.to.x - line.from.x, line.to.z - line.from.z) / 2;
  return shared_.obstacle_grid.any_near(
      middle, half + line.radius + shared_.unit,
      [&](const ObstacleGrid::Item& obstacle) { return meets(line, obstacle.solid.prism); });
}

// Of others that are on the link it does not matter where they are: they leave its end before.
bool LinkMode::end_is_free(std::span<const Body> bodies, const Body& body,
                           const LinkUse& use) const {
  const world::GroundPoint p{use.to.x, use.to.z};
  if (!shared_.ground_of(body).is_legal(use.to.level, world::in_tile(p.cell_x()),
                                        world::in_tile(p.cell_z()))) {
    return false;
  }
  const auto margin = std::min(widest_, static_cast<int32_t>(kEndMargin / shared_.unit));
  const bool is_occupied = near_.any_near(use.to.x, use.to.z, [&](uint32_t i) {
    const Body& other = bodies[i];
    const bool same_link = other.on_link && uses_[other.slot].link == use.link;
    return !same_link && other.slot != body.slot &&
           nearer_than(other.x - use.to.x, other.z - use.to.z,
                       int64_t{body.radius} + other.radius + margin) &&
           other.y < use.to.y + body.height && use.to.y < other.y + other.height;
  });
  return !is_occupied && !is_obstructed(body, use.from, use.to);
}

void LinkMode::take_turns(std::span<Body> bodies) {
  order_.clear();
  on_link_.resize(shared_.edits().edits.size() + 1);
  for (const uint32_t slot : users_) on_link_[uses_[slot].link] = 0;
  for (uint32_t n = 0; n < users_.size(); ++n) {
    const LinkUse& use = uses_[users_[n]];
    if (use.state == LinkUse::kWaits) order_.push_back(n);
    if (use.state != LinkUse::kEnters && use.state != LinkUse::kRides) continue;
    on_link_[use.link] |= use.back != 0 ? kBack : kForward;
    if (use.state == LinkUse::kEnters) on_link_[use.link] |= kEntered;
  }
  std::sort(order_.begin(), order_.end(), [&](uint32_t a, uint32_t b) {
    const auto key = [&](uint32_t n) {
      const LinkUse& use = uses_[users_[n]];
      return std::tuple(use.link, use.since, users_[n]);
    };
    return key(a) < key(b);
  });
  for (const uint32_t n : order_) {
    Body& body = bodies[bodies_[n]];
    LinkUse& use = uses_[users_[n]];
    uint8_t& on_link = on_link_[use.link];
    // The first that waits for those that come towards it closes the link to all that came later.
    if ((on_link & (use.back != 0 ? kForward : kBack)) != 0) on_link |= kClosed;
    const bool is_open = (on_link & (kClosed | kEntered)) == 0 && !body.has(Body::kNeedsPath);
    if (is_open && end_is_free(bodies, body, use)) {
      give_turn(body, use);
      on_link |= static_cast<uint8_t>(kEntered | (use.back != 0 ? kBack : kForward));
    } else if (use.stands == 0) {
      stand_aside(body, use);
    }
  }
}

}  // namespace throng::crowd
