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

// Turns at off-mesh links. A link is a corridor in which avatars cannot pass each other, and links
// that cross or share an end are one corridor. So they take turns in the order in which they came:
// none enters while another uses the corridor otherwise, or while its end is occupied. Those that
// wait stand aside of all links, so that those on them can land, and yield to them as avatars do
// that have arrived. For each that waits, but for sorting them: linear in those on other links.
namespace throng::crowd {
namespace {

constexpr double kMargin = 0.1;        // [m] between those that wait and one at an end
constexpr double kBrakingTime = 0.3;   // [s] within which one that comes to the start stops
constexpr double kSpread = 1.6;        // widest radii, times the root of how many wait
constexpr uint64_t kSightChecks = 16;  // decisions
constexpr double kEndMargin = 0.02;    // [m] around one that lands

bool same(const Stand& a, const PathPoint& b) {
  constexpr int32_t kRounded = 2;  // [units]
  return a.level == b.level && std::abs(a.x - b.x) <= kRounded && std::abs(a.z - b.z) <= kRounded;
}

}  // namespace

// Between the middles of a body of that radius that waits and of one at an end. [units]
int32_t LinkMode::room_of(int32_t radius) const {
  constexpr double kMax = 1 << 28;  // as wide as no body is
  return static_cast<int32_t>(
      std::min(kMax, double{1} * radius + taking_.widest + kMargin / shared_.unit));
}

bool LinkMode::begin_step() {
  if (!links_.empty()) uses_.resize(shared_.names.slots());
  for (Link& link : links_) link.waiting = {};
  lines_.clear();
  for (const uint32_t slot : users_) {
    const LinkUse& use = uses_[slot];
    const Link* link = find_link(use.link);
    if (use.state == LinkUse::kRides && link == nullptr) lines_.emplace_back(use.from, use.to);
    if (use.state != LinkUse::kWaits || link == nullptr) continue;
    ++links_[static_cast<size_t>(link - links_.data())].waiting[use.back != 0 ? 1 : 0];
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
  use.since = shared_.time;
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
  const LinkUse& use = uses_[body.slot];
  if (use.state == LinkUse::kGivesRoom) return true;
  const bool leads = leads_to_link(route);
  if (use.state == LinkUse::kWaits && !leads) return true;
  if (!leads || use.state == LinkUse::kEnters) return false;
  const PathPoint& start = route.corners[route.next];
  const auto sees = [&] {
    return ground.sees(body.level, body.point(), {start.x, start.z}, start.level, HUGE_VALF);
  };
  if (use.state == LinkUse::kWaits) {
    if (nth % kSightChecks != 0 || sees()) return true;
    body.flags |= Body::kNeedsPath;
    return false;
  }
  // The more wait, the farther from the start: they need not press.
  const double brakes =
      body.speed * std::max<double>(shared_.sub_dt(), kBrakingTime) / shared_.unit;
  const float square = near_square(start.x - body.x, start.z - body.z);
  const auto is_near = [&](double count) {
    const double range =
        room_of(body.radius) + brakes + kSpread * taking_.widest * std::sqrt(count);
    return square <= static_cast<float>(range * range);
  };
  if (!is_near(static_cast<double>(users_.size()))) return false;  // Few come to look at all links.
  uint32_t waiting = 0;
  for (const Link& link : links_) {
    if (same(link.from, start)) waiting += link.waiting[0];
    if (link.two_way && same(link.to, start)) waiting += link.waiting[1];
  }
  if (is_near(waiting) && sees() && !begin_to_wait(body, start, route.corners[route.next + 1u])) {
    body.flags |= Body::kNeedsPath;
  }
  return false;  // If it is its turn at once, it does not stop.
}

void LinkMode::begin_search(Body& body) { stop_standing(body, uses_[body.slot]); }

// One that searches in each step, because its goal moves or costs change, keeps its turn and the
// place where it waits, as long as it takes the same link; or goes on giving room, wherever its
// path leads.
void LinkMode::end_search(Body& body, const Route* found) {
  LinkUse& use = uses_[body.slot];
  if (use.state == LinkUse::kNone) return;
  const bool goes_on = found != nullptr && find_link(use.link) != nullptr;
  if (goes_on && use.state == LinkUse::kGivesRoom) return stand_aside_again(body, use);
  const bool stays = goes_on && found->by_link != 0 &&
                     same(use.from, found->corners[found->count - 2u]) &&
                     same(use.to, found->corners[found->count - 1u]);
  if (!stays) {
    use = {};
  } else if (use.state == LinkUse::kWaits && use.stands != 0) {
    stand_aside(body, use);
  }
}

void LinkMode::end_use(Body& body, LinkUse& use) const {
  stop_standing(body, use);
  use = {};
}

void LinkMode::stop_standing(Body& body, const LinkUse& use) const {
  if (use.state != LinkUse::kWaits || use.stands == 0) return;
  body.clear(Body::kLast);
  if (use.arrived == 0) body.clear(Body::kArrived);
}

// Would the body, if it stood there, be in the path of those on a link?
bool LinkMode::is_beside_a_link(const Body& body, const Stand& at) const {
  const double range = room_of(body.radius);
  const auto is_beside = [&](const Stand& from, const Stand& to) {
    const bool is_level = std::min(from.y, to.y) < at.y + body.height &&
                          at.y < std::max(from.y, to.y) + taking_.tallest;
    if (!is_level) return false;
    const double wx = double{1} * to.x - from.x, wz = double{1} * to.z - from.z;
    const double dx = double{1} * at.x - from.x, dz = double{1} * at.z - from.z;
    const double whole = wx * wx + wz * wz;
    const double part = whole > 0 ? std::clamp((dx * wx + dz * wz) / whole, 0.0, 1.0) : 0;
    const double away_x = dx - part * wx, away_z = dz - part * wz;
    return away_x * away_x + away_z * away_z < range * range;
  };
  return std::any_of(links_.begin(), links_.end(),
                     [&](const Link& link) { return is_beside(link.from, link.to); }) ||
         std::any_of(lines_.begin(), lines_.end(),
                     [&](const auto& line) { return is_beside(line.first, line.second); });
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
  if (!is_beside_a_link(body, body.stand())) return;
  const int32_t room = room_of(body.radius);
  const StrideGround ground(shared_.ground_of(body),
                            world::step_mm(shared_.body_class(body.avatar_class)));
  float least = HUGE_VALF;
  for (const double far : {1.05, 1.5, 2.0, 3.0}) {
    for (const auto& [dx, dz] : steer::kEighths) {
      const double to_x = use.from.x + far * room * dx, to_z = use.from.z + far * room * dz;
      if (!(to_x >= 0 && to_z >= 0 && to_x < INT32_MAX && to_z < INT32_MAX)) continue;
      const auto x = static_cast<int32_t>(to_x), z = static_cast<int32_t>(to_z);
      const float square = near_square(x - body.x, z - body.z);
      if (square >= least) continue;
      StrideGround::Landing landing;
      if (!ground.move(body.level, body.y, body.point(), {x, z}, landing)) continue;
      if (is_beside_a_link(body, {x, z, landing.y, landing.level})) continue;
      least = square;
      body.local_target_x = x;
      body.local_target_z = z;
    }
    if (least < HUGE_VALF) {
      walk_.engine().wake(body);
      return;
    }
  }
}

// It keeps its detour, as one on foot does that searches.
void LinkMode::stand_aside_again(Body& body, LinkUse& use) const {
  const float detour_angle = body.detour_angle;
  stand_aside(body, use);
  body.detour_angle = detour_angle;
}

void LinkMode::give_turn(Body& body, LinkUse& use) const {
  stop_standing(body, use);
  use.stands = 0;
  use.state = LinkUse::kEnters;
  use.since = shared_.time;
  body.clear(Body::kContinues);
  body.detour_angle = 0;
  // The start, or a corner before it.
  const Route& route = walk_.route(body.slot);
  const bool leads = route.by_link != 0 && route.next + 1 < route.count;
  body.local_target_x = leads ? route.corners[route.next].x : use.from.x;
  body.local_target_z = leads ? route.corners[route.next].z : use.from.z;
  walk_.engine().wake(body);
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

bool LinkMode::is_crossed(std::span<const Body> bodies, const Body& body, const Stand& from) const {
  const LinkUse& use = uses_[body.slot];
  const auto line_between = [&](const Body& of, const Stand& begin, const Stand& end) {
    constexpr double kRounded = 2;  // [units]
    return LinkLine{point_of(begin), point_of(end), (of.radius + kRounded) * shared_.unit, 0,
                    of.height * 1e-3};
  };
  const LinkLine line = line_between(body, from, use.to);
  for (size_t n = 0; n < users_.size(); ++n) {
    const LinkUse& other = uses_[users_[n]];
    if (other.state != LinkUse::kRides || (other.link == use.link && other.back == use.back)) {
      continue;
    }
    const Body& rider = bodies[bodies_[n]];
    if (meets(line, line_between(rider, rider.stand(), other.to))) return true;
  }
  return false;
}

bool LinkMode::blocks_end(const Body& other, const Body& body, const Stand& end) const {
  const auto margin = std::min(widest_, static_cast<int32_t>(kEndMargin / shared_.unit));
  return nearer_than(other.x - end.x, other.z - end.z,
                     int64_t{body.radius} + other.radius + margin) &&
         other.y < end.y + body.height && end.y < other.y + other.height;
}

// Of others that are on the link it does not matter where they are: they leave its end before.
bool LinkMode::end_is_free(std::span<const Body> bodies, const Body& body,
                           const LinkUse& use) const {
  const world::GroundPoint p{use.to.x, use.to.z};
  if (!shared_.ground_of(body).is_legal(use.to.level, world::in_tile(p.cell_x()),
                                        world::in_tile(p.cell_z()))) {
    return false;
  }
  const bool is_occupied = near_.any_near(use.to.x, use.to.z, [&](uint32_t i) {
    const Body& other = bodies[i];
    const bool same_link = other.on_link && uses_[other.slot].link == use.link;
    return !same_link && other.slot != body.slot && blocks_end(other, body, use.to);
  });
  return !is_occupied && !is_obstructed(body, use.from, use.to) &&
         !is_crossed(bodies, body, use.from);
}

// How each corridor is used, and in what order those that wait came to it.
void LinkMode::begin_turns() {
  std::fill(corridors_.begin(), corridors_.end(), Corridor{});
  order_.clear();
  for (uint32_t n = 0; n < users_.size(); ++n) {
    const LinkUse& use = uses_[users_[n]];
    const Link* link = find_link(use.link);
    if (link == nullptr) continue;
    if (use.state == LinkUse::kWaits) order_.push_back(n);
    if (use.state != LinkUse::kEnters && use.state != LinkUse::kRides) continue;
    Corridor& corridor = corridors_[link->corridor];
    if (corridor.link == 0) {
      corridor.link = use.link;
      corridor.back = use.back != 0;
    }
    // Links have been joined while they were used: first all leave them.
    const bool is_same = corridor.link == use.link && corridor.back == (use.back != 0);
    corridor.is_closed = corridor.is_closed || !is_same;
    corridor.is_entered = corridor.is_entered || use.state == LinkUse::kEnters;
  }
  std::sort(order_.begin(), order_.end(), [&](uint32_t a, uint32_t b) {
    const auto key = [&](uint32_t n) {
      const LinkUse& use = uses_[users_[n]];
      return std::tuple(find_link(use.link)->corridor, use.since, users_[n]);
    };
    return key(a) < key(b);
  });
}

void LinkMode::take_turns(std::span<Body> bodies) {
  begin_turns();
  for (const uint32_t n : order_) {
    Body& body = bodies[bodies_[n]];
    LinkUse& use = uses_[users_[n]];
    Corridor& corridor = corridors_[find_link(use.link)->corridor];
    // The first that waits for those that use the corridor otherwise closes it to all that came
    // later.
    const bool is_same = corridor.link == use.link && corridor.back == (use.back != 0);
    corridor.is_closed = corridor.is_closed || (corridor.link != 0 && !is_same);
    const bool is_open = !corridor.is_closed && !corridor.is_entered && !body.has(Body::kNeedsPath);
    if (is_open && end_is_free(bodies, body, use)) {
      give_turn(body, use);
      corridor = {.link = use.link, .back = use.back != 0, .is_entered = true, .is_closed = false};
    } else if (use.stands == 0) {
      stand_aside(body, use);
    }
  }
}

}  // namespace throng::crowd
