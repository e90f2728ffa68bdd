// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cmath>

#include "crowd/walk/walk_mode.h"
#include "world/place.h"
#include "world/tile_grid.h"

// Bodies that do not get on ask those in their path to stand aside, once in a second: the last
// resort where corridors are as wide as one body. The lower name has precedence, and those that
// stand aside ask on with the precedence of the one for which they do, as in the priority
// inheritance of [Okumura19]. Time: linear in all bodies, and a bounded number of searches.
namespace throng::crowd {
namespace {

constexpr int kBlockedShare = 13;   // [PathProgress::share] below this it asks: 0.1
constexpr float kBlocked = 2;       // [s] for which one has stood that does not get to its place
constexpr double kLine = 15;        // [m] of a path that is kept free
constexpr double kChain = 1.2;      // [m] between two bodies, that both block a path
constexpr double kMargin = 0.06;    // [m] kept to a path
constexpr double kGap = 0.02;       // [m] kept to those that stand
constexpr double kCrowdRange = 2;   // [m] around a body and the first that it asks:
constexpr int kCrowd = 5;           // more slow ones beside its path sort themselves otherwise
constexpr double kPassed = 1.5;     // [m] from a path: its body has passed
constexpr double kSquare = 2;       // [m] of the grid of slow bodies
constexpr float kSlowShare = 0.5f;  // of its speed: a body may block another
constexpr size_t kMaxAsked = 12;    // by one
constexpr int kMaxSearches = 32;    // in a second
constexpr uint16_t kLongest = 60;   // [s] that one stands aside
constexpr int kMaxDepth = 8;        // of those that stand aside for each other
constexpr uint32_t kNoBody = UINT32_MAX;

double square_between(const Body& body, double x, double z) {
  const double dx = x - body.x, dz = z - body.z;
  return dx * dx + dz * dz;
}

bool is_level(const Body& body, double y) { return std::fabs(body.y - y) < body.height; }

}  // namespace

// Its precedence: the name of that for which it stands aside in the end, and over how many others.
std::pair<uint32_t, int> WalkMode::precedence_of(uint32_t name) {
  int depth = 0;
  for (; depth < kMaxDepth; ++depth) {
    const StandsAside* one = yielding_.find(name);
    if (one == nullptr) break;
    name = one->for_name;
  }
  return {name, depth};
}

bool WalkMode::may_stand_aside(const Body& body) const {
  constexpr uint8_t kNever = Body::kExternal | Body::kMovedElsewhere | Body::kNeedsPath;
  return body.has(Body::kHasGoal) && (body.flags & kNever) == 0 && !body.leaves &&
         classes_[body.avatar_class]->takes_links && !takes_links_->uses_link(body);
}

// Its next `kLine` metres.
void WalkMode::write_line(const Body& body, PathLine& line) const {
  const Route& route = routes_[body.slot];
  const double whole = kLine / shared_.unit;
  line.clear(body.radius);
  line.add(body.x, body.z, body.y);
  for (size_t i = route.next; i < route.count && line.length() < whole; ++i) {
    const PathPoint& corner = route.corners[i];
    const double y = shared_.ground_of(body).feet(corner.level, {corner.x, corner.z});
    if (i == route.next) {
      line.add(body.local_target_x, body.local_target_z, y);
    } else {
      line.add(corner.x, corner.z, y);
    }
  }
}

// Those that have lost their reason or their path go on to their goals.
void WalkMode::end_standing_aside(std::span<Body> bodies) {
  Yielding& y = yielding_;
  const auto has_ended = [&](StandsAside& one) {
    if (shared_.names.generation(one.name) != one.generation) return true;
    const uint32_t index = y.index_of[one.name];
    if (index == kNoBody) return true;
    Body& body = bodies[index];
    if (!body.has(Body::kArrived) || !body.has(Body::kHasGoal))
      return true;  // It got another goal.
    const uint32_t other = one.for_name < y.index_of.size() ? y.index_of[one.for_name] : kNoBody;
    bool goes_on = one.has_ended != 0 || ++one.seconds > kLongest || other == kNoBody ||
                   shared_.names.generation(one.for_name) != one.for_generation;
    if (!goes_on) {
      const Body& first = bodies[other];
      const bool has_come = first.has(Body::kArrived) && y.find(one.for_name) == nullptr;
      goes_on = has_come || !first.has(Body::kHasGoal);
      if (!goes_on && !first.has(Body::kNeedsPath)) {
        write_line(first, y.lines[0]);
        const double passed = kPassed / shared_.unit + body.radius + first.radius;
        goes_on = y.lines[0].nearest(one.place.x, one.place.z, body.y, body.height).square >
                  passed * passed;
      }
    }
    if (!goes_on) return false;
    if (one.has_arrived == 0) body.clear(Body::kArrived);
    body.clear(Body::kLast);
    body.clear(Body::kContinues);
    body.flags |= Body::kNeedsPath;
    engine_.wake(body);
    return true;
  };
  // Whether one has ended may depend on others that are there still.
  y.asked.clear();
  for (StandsAside& one : y.all) {
    if (has_ended(one)) y.asked.push_back(one.name);
  }
  for (const uint32_t name : y.asked) y.erase(name);
}

// Once in a second, before bodies plan.
void WalkMode::order_aside() {
  if (!delays_ || !engine_.queues() || shared_.time % SharedState::kTimeUnits != 0 ||
      shared_.step % delays_->steps_between() != 0) {
    return;
  }
  find_blocked(engine_.bodies());
  if (!exchange_) return order_aside_among(engine_.bodies());
  const size_t own = gather_aside();
  find_blocked(engine_.bodies());
  order_aside_among(engine_.bodies());
  drop_gathered(own);
}

bool WalkMode::is_slow(const Body& body) {
  const float slow = kSlowShare * body.speed;
  return body.velocity.x * body.velocity.x + body.velocity.z * body.velocity.z < slow * slow;
}

void WalkMode::find_blocked(std::span<const Body> bodies) {
  yielding_.blocked.clear();
  for (size_t i = 0; i < bodies.size(); ++i) {
    const Body& body = bodies[i];
    if (progress_[body.slot].share < kBlockedShare && progress_[body.slot].left >= 0 &&
        may_change_route(body, routes_[body.slot])) {
      yielding_.blocked.push_back(static_cast<uint32_t>(i));
    }
  }
}

// With those that are blocked.
void WalkMode::order_aside_among(std::span<Body> bodies) {
  Yielding& y = yielding_;
  if (y.blocked.empty() && y.all.empty()) return;
  y.index_of.assign(shared_.names.names(), kNoBody);
  for (size_t i = 0; i < bodies.size(); ++i) {
    y.index_of[shared_.name_of(bodies[i])] = static_cast<uint32_t>(i);
  }
  y.reserve(kMaxDepth + 1, bodies.size());
  end_standing_aside(bodies);
  for (const StandsAside& one : y.all) {
    const Body& body = bodies[y.index_of[one.name]];
    const bool is_there =
        square_between(body, one.place.x, one.place.z) < double{1} * body.radius * body.radius;
    if (!is_there && engine_.stood(body.slot) >= kBlocked && !body.has(Body::kNeedsPath)) {
      y.blocked.push_back(y.index_of[one.name]);
    }
  }
  std::sort(y.blocked.begin(), y.blocked.end(), [&](uint32_t a, uint32_t b) {
    return precedence_and_name(bodies[a]) < precedence_and_name(bodies[b]);
  });
  y.slow.clear();
  const double square = kSquare / shared_.unit;
  for (size_t i = 0; i < bodies.size() && !y.blocked.empty(); ++i) {
    const Body& body = bodies[i];
    if (!is_slow(body)) continue;
    y.slow.emplace_back(Yielding::square_key(static_cast<int64_t>(body.x / square),
                                             static_cast<int64_t>(body.z / square)),
                        static_cast<uint32_t>(i));
  }
  std::sort(y.slow.begin(), y.slow.end());
  int searches = kMaxSearches;
  for (const uint32_t i : y.blocked) {
    if (searches <= 0) break;
    ask_aside(bodies, i, searches);
  }
}

// Slow bodies that touch the first line, in the order in which it meets them.
void WalkMode::find_on_line(std::span<const Body> bodies, uint32_t asker) {
  Yielding& y = yielding_;
  const PathLine& line = y.lines[0];
  const double square = kSquare / shared_.unit;
  y.squares.clear();
  for (size_t i = 1; i < line.points().size(); ++i) {
    const PathLine::Point &a = line.points()[i - 1], &b = line.points()[i];
    const auto parts = static_cast<int>(std::ceil((b.along - a.along) / (0.5 * square)));
    for (int k = 0; k <= parts; ++k) {
      const double part = parts > 0 ? double(k) / parts : 0;
      const auto column = static_cast<int64_t>((a.x + part * (b.x - a.x)) / square);
      const auto row = static_cast<int64_t>((a.z + part * (b.z - a.z)) / square);
      for (int64_t r = row - 1; r <= row + 1; ++r) {
        for (int64_t c = column - 1; c <= column + 1; ++c)
          y.squares.push_back(Yielding::square_key(c, r));
      }
    }
  }
  std::sort(y.squares.begin(), y.squares.end());
  y.squares.erase(std::unique(y.squares.begin(), y.squares.end()), y.squares.end());
  y.on_line.clear();
  for (const uint64_t key : y.squares) {
    y.for_slow_in(key, [&](uint32_t i) {
      const Body& body = bodies[i];
      if (i == asker) return;
      const auto nearest = line.nearest(body.x, body.z, body.y, body.height);
      const double range = line.radius() + body.radius + kGap / shared_.unit;
      if (nearest.square < range * range && nearest.along > 0) {
        y.on_line.emplace_back(nearest.along, i);
      }
    });
  }
  std::sort(y.on_line.begin(), y.on_line.end(), [&](const auto& a, const auto& b) {
    return std::pair(a.first, shared_.name_of(bodies[a.second])) <
           std::pair(b.first, shared_.name_of(bodies[b.second]));
  });
}

// Two that touch beside each other, at a corner, so that each is in the path of the other.
bool WalkMode::block_each_other(const Body& asker, const Body& body) {
  const double range = double{1} * asker.radius + body.radius + kGap / shared_.unit;
  if (square_between(asker, body.x, body.z) >= range * range) return false;
  PathLine& line = yielding_.lines[kMaxDepth];
  write_line(body, line);
  const auto nearest = line.nearest(asker.x, asker.z, asker.y, asker.height);
  return nearest.square < range * range && nearest.along > 0;
}

// Of those in its path, which walk ahead of it, and which come towards it or stand and are to go?
void WalkMode::sort_on_line(std::span<const Body> bodies, uint32_t asker) {
  Yielding& y = yielding_;
  const auto own = precedence_and_name(bodies[asker]);
  y.column.assign(1, asker);
  y.asked.clear();
  double reached = 0;
  int32_t last = bodies[asker].radius;
  for (const auto& [along, i] : y.on_line) {
    const Body& body = bodies[i];
    if (along - reached > kChain / shared_.unit + last + body.radius) break;
    reached = along;
    last = body.radius;
    const auto theirs = precedence_and_name(body);
    if (yielding_.find(shared_.name_of(body)) != nullptr && theirs < own)
      continue;  // It is about to go.
    // Does its next corner lie farther along this path?
    const auto target =
        y.lines[0].nearest(body.local_target_x, body.local_target_z, body.y, body.height);
    const double range = double{1} * y.lines[0].radius() + body.radius;
    const bool goes_on =
        !body.has(Body::kArrived) && target.square < range * range && target.along > along;
    if (goes_on && !(own < theirs && block_each_other(bodies[asker], body))) {
      y.column.push_back(i);
      continue;
    }
    if (!may_stand_aside(body) || (!body.has(Body::kArrived) && theirs < own)) break;
    y.asked.push_back(i);
    if (y.asked.size() == kMaxAsked) break;
  }
}

// Are there many slow bodies near it, beside the path?
bool WalkMode::is_in_crowd(std::span<const Body> bodies, const Body& body) const {
  const Yielding& y = yielding_;
  const double square = kSquare / shared_.unit, range = kCrowdRange / shared_.unit;
  const auto column = static_cast<int64_t>(body.x / square);
  const auto row = static_cast<int64_t>(body.z / square);
  int beside = 0;
  for (int64_t r = row - 1; r <= row + 1; ++r) {
    for (int64_t c = column - 1; c <= column + 1; ++c) {
      y.for_slow_in(Yielding::square_key(c, r), [&](uint32_t i) {
        const Body& other = bodies[i];
        if (!is_level(other, body.y) || square_between(other, body.x, body.z) >= range * range) {
          return;
        }
        const auto nearest = y.lines[0].nearest(other.x, other.z, other.y, other.height);
        const double touching = y.lines[0].radius() + other.radius;
        beside += nearest.square >= touching * touching ? 1 : 0;
      });
    }
  }
  return beside > kCrowd;
}

void WalkMode::ask_aside(std::span<Body> bodies, uint32_t asker, int& searches) {
  Yielding& y = yielding_;
  const Body& body = bodies[asker];
  write_line(body, y.lines[0]);
  find_on_line(bodies, asker);
  if (y.on_line.empty()) return;
  sort_on_line(bodies, asker);
  if (y.asked.empty() || is_in_crowd(bodies, body) || is_in_crowd(bodies, bodies[y.asked[0]]))
    return;
  // Where two fit side by side, many that come towards it are a lane: it ends by itself, and would
  // be broken up.
  constexpr size_t kLane = 3;
  if (y.asked.size() >= kLane && engine_.has_room_for_two(body) &&
      engine_.has_room_for_two(bodies[y.asked[0]])) {
    return;
  }
  // Also the paths of those for which it stands aside itself.
  size_t lines = 1;
  for (uint32_t name = shared_.name_of(body); lines < kMaxDepth; ++lines) {
    const StandsAside* one = y.find(name);
    if (one == nullptr || y.index_of[one->for_name] == kNoBody) break;
    name = one->for_name;
    write_line(bodies[y.index_of[name]], y.lines[lines]);
  }
  // The farthest first: it must go for the nearer ones.
  bool went = false;
  for (size_t k = y.asked.size(); k-- > 0 && searches > 0;) {
    --searches;
    went = send_aside(bodies, y.asked[k], asker, lines) || went;
  }
  if (went || searches <= 0 || y.find(shared_.name_of(body)) != nullptr) return;
  // None of them can: it stands aside itself, for the nearest.
  --searches;
  const uint32_t nearest = y.asked[0];
  if (y.find(shared_.name_of(bodies[nearest])) != nullptr) return;
  write_line(bodies[nearest], y.lines[0]);
  y.column.assign(1, nearest);
  (void)send_aside(bodies, asker, nearest, 1);
}

// A body goes to the nearest place beside the first `lines` paths.
bool WalkMode::send_aside(std::span<Body> bodies, uint32_t which, uint32_t asker, size_t lines) {
  Yielding& y = yielding_;
  Body& body = bodies[which];
  const double metre = 1 / shared_.unit;
  const auto is_beside = [&](const Stand& at) {
    for (size_t i = 0; i < lines; ++i) {
      const double range = y.lines[i].radius() + body.radius + kMargin * metre;
      if (y.lines[i].nearest(at.x, at.z, at.y, body.height).square < range * range) return false;
    }
    for (const StandsAside& one : y.all) {
      const Body& other = bodies[y.index_of[one.name]];
      if (one.name == shared_.name_of(body) || !is_level(other, at.y)) continue;
      const double range = other.radius + body.radius + kGap * metre;
      const double dx = one.place.x - at.x, dz = one.place.z - at.z;
      if (dx * dx + dz * dz < range * range) return false;
    }
    return true;
  };
  // Those that stand, and will not go.
  const auto is_free = [&](const Stand& at) {
    const auto blocks = [&](const Body& other) {
      const double range = other.radius + body.radius;
      return is_level(other, at.y) && square_between(other, at.x, at.z) < range * range;
    };
    for (const uint32_t i : y.column) {
      if (blocks(bodies[i])) return false;
    }
    return true;
  };
  // One that goes already to a good place keeps it.
  const StandsAside* old = y.find(shared_.name_of(body));
  const auto feet = [&](const PathPoint& at) {
    return Stand{at.x, at.z, shared_.ground_of(body).feet(at.level, {at.x, at.z}), at.level};
  };
  if (old != nullptr && old->has_ended == 0 && is_beside(feet(old->place))) return true;
  const StrideGround ground = stride_ground(body);
  if (!y.search.find(ground, body, is_free, is_beside, y.corners)) return false;
  const Body& first = bodies[asker];
  const bool has_arrived = old != nullptr ? old->has_arrived != 0 : body.has(Body::kArrived);
  y.put({.name = shared_.name_of(body),
         .generation = shared_.names.generation(shared_.name_of(body)),
         .for_name = shared_.name_of(first),
         .for_generation = shared_.names.generation(shared_.name_of(first)),
         .place = y.corners.back(),
         .has_arrived = static_cast<uint8_t>(has_arrived ? 1 : 0)});
  Route& route = routes_[body.slot];
  route.count = static_cast<uint8_t>(std::min(y.corners.size(), Route::kCorners));
  std::copy_n(y.corners.begin(), route.count, route.corners.begin());
  route.next = 0;
  route.by_link = 0;
  route.via = 0;
  route.whole = y.corners.size() <= Route::kCorners;
  head_to_corner(body, route, ground, following());
  body.flags |= Body::kArrived;
  body.clear(Body::kContinues);
  body.detour_angle = 0;
  engine_.wake(body);
  engine_.set_path_after(body.slot, 0);
  engine_.set_onward(body.slot, {});
  return true;
}

bool WalkMode::aside_is_sound() const {
  const world::WorldData& data = *data_of(shared_.world);
  const size_t names = shared_.names.names();
  const std::vector<StandsAside>& all = yielding_.all;
  for (size_t i = 0; i < all.size(); ++i) {
    const StandsAside& one = all[i];
    const world::GroundPoint at{one.place.x, one.place.z};
    if (one.name >= names || one.for_name >= names || one.for_name == one.name || at.x < 0 ||
        at.z < 0 || !world::in_grid(data, at) || (i > 0 && one.name <= all[i - 1].name)) {
      return false;
    }
    const auto tile =
        data.tile_levels(world::tile_along(at.cell_x()), world::tile_along(at.cell_z()));
    if (one.place.level < tile.first || one.place.level >= tile.last) return false;
  }
  return true;
}

// One that stands aside and has lost its path. False: it does not.
bool WalkMode::plan_aside(Body& body, Route& route, const StrideGround& ground, size_t worker) {
  if (!body.has(Body::kArrived)) return false;
  StandsAside* one = yielding_.find(shared_.name_of(body));
  if (one == nullptr || one->has_ended != 0) return false;
  Path& path = classes_[body.avatar_class]->paths[worker];
  find_path(body, {body.x, body.z, body.level}, one->place, ground, worker, path);
  const PathPoint goal = route.goal;
  route.goal = one->place;
  const bool is_found = path.links.empty() &&
                        use_path(*data_of(shared_.world), path, ground, following(), body, route);
  route.goal = goal;
  one->has_ended = is_found ? 0 : 1;
  return is_found;
}

}  // namespace throng::crowd
