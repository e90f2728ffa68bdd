// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "crowd/crowd_engine.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <mutex>
#include <utility>

#include "core/parallel.h"
#include "core/random.h"
#include "core/stopwatch.h"
#include "crowd/first_come.h"
#include "crowd/reaction.h"
#include "crowd/sense_kernel.h"
#include "steer/sampled_kernel.h"

// docs/design/008-engine.md. Whoever can touch nobody within the step takes what he wants at once;
// only the others go through the rounds.
namespace throng {
namespace {

using steer::Plane;

constexpr size_t kGrain = 256;  // bodies that are worth handing to another thread
constexpr std::array<float, 3> kShorter = {0.5f, 0.25f, 0.1f};
constexpr float kThere = 0.3f;               // [m] from its goal a body has arrived
constexpr uint64_t kSides = 0x51de5;         // stream of chance
constexpr float kClose = 0.1f;               // [m] to its corner a body turns to no side
constexpr float kAtOnce = 0.3f;              // [s] Who goes straight meets nobody within.
constexpr size_t kFarAhead = 6, kAhead = 3;  // bodies, whose ground is asked for
constexpr float kEnough = 14;                // bodies, to find the nearest among

// Do two bodies clash that stand at these places?
bool clash(const Body& a, const Body& at_a, const Body& b, const Body& at_b) {
  return nearer_than(at_a.x - at_b.x, at_a.z - at_b.z, int64_t{a.radius} + b.radius) &&
         at_a.y < at_b.y + b.height && at_b.y < at_a.y + a.height;
}

// On its last leg, and not there yet?
bool is_bound(const Body& body) {
  constexpr uint8_t kAll =
      Body::kHasGoal | Body::kLast | Body::kArrived | Body::kDriven | Body::kFlying;
  // A region has room for many.
  return body.target == 0 && (body.flags & kAll) == (Body::kHasGoal | Body::kLast);
}

// A square of so many cells to each side holds all that is looked at.
int32_t cells_of(float look) { return static_cast<int32_t>(look) / kUnitsPerCell + 1; }

// Bound for a corner, not for its goal yet?
bool turns_corner(const Body& body) {
  constexpr uint8_t kAll = Body::kHasGoal | Body::kLast | Body::kDriven | Body::kFlying;
  return (body.flags & kAll) == Body::kHasGoal;
}

// Turned aside by his patience where not only others are in the way?
bool is_held_up(const Body& body) {
  return body.turn != 0 && (!body.has(Body::kLast) || body.near_wall);
}

Bound bound(const Body& body) {
  return {body.x, body.z, body.aim_x, body.aim_z, body.radius, body.slot};
}

}  // namespace

void EngineCounts::add(const EngineCounts& other) {
  contested += other.contested;
  stood += other.stood;
  progress += other.progress;
}

CrowdEngine::CrowdEngine(const EngineConfig& config, int32_t width, int32_t depth, size_t classes)
    : config_(config), grounds_(classes), width_(width), depth_(depth) {
  workers_.resize(static_cast<size_t>(worker_count(config.workers)));
}

void CrowdEngine::set_ground(size_t avatar_class, const StrideGround& ground) {
  grounds_[avatar_class] = ground;
}

void CrowdEngine::fit(int32_t widest, float fastest, float dt) {
  config_.units.dt = dt;
  widest_ = widest;
  longest_ = config_.units.stride(fastest);
  every_ = throng::steps_of_reaction(config_.reaction, dt);
  // Who could be touched within a step must be seen, however short the sight.
  const auto sight = static_cast<int32_t>(std::lround(config_.sight / double{config_.units.unit}));
  sight_ = std::max(sight, 2 * widest_ + 2 * longest_);
  if (bodies_.size() > 0) grid_.emplace(width_, depth_, sight_, bodies_.size());
}

void CrowdEngine::reserve(size_t bodies) {
  if (bodies <= bodies_.size()) return;
  HugeArray<Body> larger(bodies);
  std::copy_n(bodies_.data(), size_, larger.data());
  bodies_ = std::move(larger);
  spare_ = HugeArray<Body>(bodies);
  grid_.emplace(width_, depth_, sight_, bodies);
}

void CrowdEngine::add(const Body& body) {
  highest_ = std::max<int32_t>(highest_, body.height);
  if (size_ == bodies_.size()) reserve(std::max<size_t>(1024, 2 * size_));
  bodies_[size_++] = body;
}

void CrowdEngine::step(uint64_t step, const Before& before, EngineCounts& counts, Times& times) {
  if (size_ == 0) return;
  auto start = Clock::now();
  const auto lap = [&](double& seconds) {
    seconds += seconds_since(start);
    start = Clock::now();
  };
  wish_all(step, before);
  lap(times.plan);
  grid_->sort({bodies_.data(), size_}, {spare_.data(), size_}, config_.workers);
  std::swap(bodies_, spare_);
  lap(times.sort);
  decide_all(counts);
  lap(times.steer);
  commit(step);
  lap(times.commit);
  settle_all(counts);
  lap(times.settle);
}

// Does it go on as it did in the last step?
bool CrowdEngine::keeps(const Body& body, uint64_t step) const {
  return body.has(Body::kKeeps) && !body.has(Body::kDriven) && !body.has(Body::kLost) &&
         !body.has(Body::kFlying) && !decides(every_, step, body.slot) &&
         !is_before({body.aim_x - body.x, body.aim_z - body.z}, config_.units.stride(body.speed));
}

void CrowdEngine::wish_all(uint64_t step, const Before& before) {
  constexpr float kSide = 2;  // [s] that one keeps to a side
  const auto window = step / static_cast<uint64_t>(std::lround(kSide / config_.units.dt));
  // To the right, if nothing but others is in the way. Before a wall or a corner that would press a
  // crowd against it: there, to either side by chance.
  const auto turn = [&](const Body& b) {
    if (!is_held_up(b)) return b.turn;
    if (size_of(config_.units.metres(b.aim_x - b.x, b.aim_z - b.z)) < kClose) return 0.0f;
    const bool left = (random_u64(config_.seed ^ kSides, b.slot, window) & 1) != 0;
    return left ? -b.turn : b.turn;
  };
  const size_t pieces = (size_ + kGrain - 1) / kGrain;
  parallel_for_worker(pieces, config_.workers, [&](size_t piece, int32_t worker) {
    const size_t begin = piece * kGrain;
    const std::span<Body> bodies{bodies_.data() + begin, std::min(kGrain, size_ - begin)};
    for (Body& b : bodies) {
      if (!keeps(b, step)) b.clear(Body::kKeeps);
    }
    if (before) before(bodies, worker);
    for (Body& b : bodies) {
      if (b.has(Body::kDriven) || b.has(Body::kFlying)) continue;
      b.wish = b.has(Body::kHasGoal)
                   ? steer::wish_towards(config_.units.metres(b.aim_x - b.x, b.aim_z - b.z),
                                         b.speed, config_.units.dt, turn(b))
                   : Plane{};
    }
  });
}

void CrowdEngine::decide_all(EngineCounts& counts) {
  for (Worker& worker : workers_) {
    worker.others.clear();
    worker.contests.clear();
    worker.counts = {};
  }
  const size_t pieces = (size_ + kGrain - 1) / kGrain;
  parallel_for_worker(pieces, config_.workers, [&](size_t piece, int32_t w) {
    Worker& worker = workers_[static_cast<size_t>(w)];
    NeighbourGrid::Around around;
    uint32_t square = UINT32_MAX;
    const size_t end = std::min(size_, (piece + 1) * kGrain);
    for (size_t i = piece * kGrain; i < end; ++i) {
      prefetch_ground(i);
      const uint32_t here = grid_->square(bodies_[i]);
      if (bodies_[i].has(Body::kKeeps) && keep_on(static_cast<uint32_t>(i), worker, here)) continue;
      if (here != square) {
        square = here;
        around = grid_->around(square);
      }
      decide(static_cast<uint32_t>(i), worker, around);
    }
  });
  for (const Worker& worker : workers_) counts.add(worker.counts);
}

// Asks for the ground under those who decide next.
void CrowdEngine::prefetch_ground(size_t i) const {
  if (i + kFarAhead < size_) {
    const Body& body = bodies_[i + kFarAhead];
    grounds_[body.avatar_class].prefetch_level(body.level);
  }
  if (i + kAhead < size_) {
    const Body& body = bodies_[i + kAhead];
    grounds_[body.avatar_class].prefetch_cell(body.level, body.point());
  }
}

// Makes the lists as long as those around may need. Returns how many these are.
size_t CrowdEngine::fit_lists(const NeighbourGrid::Around& around, Worker& worker) const {
  size_t around_us = 0;
  for (const auto& p : around) around_us += p.last - p.first;
  if (worker.squares.size() < around_us + kSeenSpare) {
    for (auto* entries : {&worker.entries, &worker.touched}) {
      entries->resize(2 * (around_us + kSeenSpare));
    }
    worker.squares.resize(worker.entries.size());
  }
  return around_us;
}

// Nobody farther away than this can be touched; the exact test follows. [units]
float CrowdEngine::touch_of(const Body& body) const {
  const int32_t stride = config_.units.stride(body.speed);
  return static_cast<float>(body.radius + stride + widest_ + longest_ + 1) * 1.0001f;
}

// Appends whom the body could touch to `others`.
void CrowdEngine::list_touched(const Body& body, const SeenLists& lists, Worker& worker) const {
  const int32_t stride = config_.units.stride(body.speed);
  for (size_t n = 0; n < lists.touches; ++n) {
    const uint32_t j = lists.touched[n];
    const Body& other = bodies_[j];
    const int64_t reach =
        int64_t{body.radius} + other.radius + stride + config_.units.stride(other.speed);
    const int32_t rise = body.y - other.y;
    const bool near = rise < other.height + 2 * kMostRise && -rise < body.height + 2 * kMostRise;
    if (near && nearer_than(other.x - body.x, other.z - body.z, reach)) worker.others.push_back(j);
  }
}

// Takes in what it steers by, and if wanted lists whom it could touch.
void CrowdEngine::sense(uint32_t i, Worker& worker, const NeighbourGrid::Around& around,
                        bool lists_others) {
  const Body& body = bodies_[i];
  const size_t around_us = fit_lists(around, worker);
  const Places places{grid_->x(), grid_->z(), grid_->y()};
  const float touch = touch_of(body);
  // In a dense crowd the nearest are near: if enough are within less, nobody farther matters.
  const float sight = static_cast<float>(sight_) * static_cast<float>(sight_);
  const float across = grid_->width() * NeighbourGrid::kAround;
  const float enough =
      across * across * kEnough / (3 * static_cast<float>(around_us));  // 3 of the circle's pi
  const auto wanted = static_cast<size_t>(config_.steering.neighbours);
  Eye eye{.x = body.x,
          .z = body.z,
          .y = body.y,
          .self = i,
          .most = std::min(sight, enough),
          .tall = body.height,
          .touch = lists_others ? touch * touch : 0,
          .touch_tall = std::max<int32_t>(body.height, highest_) + 2 * kMostRise};
  SeenLists lists;
  const auto look = [&] {
    lists = {worker.squares.data(), worker.entries.data(), worker.touched.data()};
    find_seen(places, around, eye, lists);
  };
  look();
  if (lists.seen < wanted && eye.most < sight) {
    eye.most = sight;
    look();
  }
  list_touched(body, lists, worker);
  size_t nearest = keep_nearest(lists, wanted);
  if (nearest > wanted) {  // Some are equally far: of these the first slots.
    const auto key = [&](uint32_t j) {
      return std::pair(near_square(bodies_[j].x - body.x, bodies_[j].z - body.z), bodies_[j].slot);
    };
    std::sort(lists.entries, lists.entries + nearest,
              [&](uint32_t a, uint32_t b) { return key(a) < key(b); });
    nearest = wanted;
  }
  steer::Situation& situation = worker.situation;
  situation.velocity = body.velocity;
  situation.wish = body.wish;
  situation.fastest = body.speed;
  situation.near.size = 0;
  const bool may_wait = is_bound(body), turns = turns_corner(body);
  worker.waits = false;
  for (size_t n = 0; n < nearest; ++n) {
    const Body& other = bodies_[lists.entries[n]];
    const Plane apart = config_.units.metres(other.x - body.x, other.z - body.z);
    const float room = static_cast<float>(body.radius + other.radius) * config_.units.unit;
    if (may_wait && is_bound(other) && goes_first(bound(other), bound(body))) {
      worker.waits = true;
      situation.wish = wish_of_waiting(
          config_.units.metres(body.aim_x - body.x, body.aim_z - body.z), body.speed, room);
    }
    if (turns && turns_corner(other) &&
        gives_way(bound(other), bound(body), size_of(apart), room,
                  size_of(other.velocity) / other.speed)) {
      worker.waits = true;
      const float back = -0.5f * body.speed / size_of(apart);
      situation.wish = {apart.x * back, apart.z * back};
    }
    // Who has arrived makes way for those who would pass, were he not there: they may stand.
    const bool makes_way = body.has(Body::kArrived) && !other.has(Body::kArrived);
    situation.near.add(config_.steering,
                       {apart, makes_way ? other.wish : other.velocity, room, other.wish});
  }
  situation.wish = steer::following_fast(config_.steering, situation);
}

// Can the body do as it wishes? Else, can it if it wishes otherwise? Its wish is what it then is.
bool CrowdEngine::find_open_wish(uint32_t i, Worker& worker, const NeighbourGrid::Around& around) {
  const Body& body = bodies_[i];
  if (!worker.waits && go_straight(body, worker.situation)) return true;
  const auto is_open = [&] {
    look_ahead(body, worker.situation);
    return steer::wish_is_open_fast(config_.steering, worker.situation);
  };
  return is_open() || (!worker.waits && take_lane(i, worker, around) && is_open());
}

// Who was turned aside by a jam at a door goes through as soon as he can.
bool CrowdEngine::go_straight(const Body& body, steer::Situation& situation) const {
  if (!is_held_up(body)) return false;
  const Plane turned = situation.wish;
  situation.wish =
      steer::wish_towards(config_.units.metres(body.aim_x - body.x, body.aim_z - body.z),
                          body.speed, config_.units.dt, 0);
  situation.wish = steer::following_fast(config_.steering, situation);
  look_ahead(body, situation);
  steer::SampledSettings at_once = config_.steering;
  at_once.horizon = kAtOnce;
  if (steer::wish_is_open_fast(at_once, situation)) return true;
  situation.wish = turned;
  return false;
}

// True if the wish is another one now.
bool CrowdEngine::take_lane(uint32_t i, Worker& worker, const NeighbourGrid::Around& around) {
  const Body& body = bodies_[i];
  steer::Situation& situation = worker.situation;
  if (!steer::is_opposed(config_.lanes, situation)) return false;
  const Eye eye{.x = body.x,
                .z = body.z,
                .y = body.y,
                .self = i,
                .most = static_cast<float>(sight_) * static_cast<float>(sight_),
                .tall = body.height,
                .touch = 0,
                .touch_tall = 0};
  SeenLists lists{worker.squares.data(), worker.entries.data(), worker.touched.data()};
  find_seen({grid_->x(), grid_->z(), grid_->y()}, around, eye, lists);
  steer::Lanes lanes(config_.lanes, body.wish);
  for (size_t n = 0; n < lists.seen; ++n) {
    const Body& other = bodies_[lists.entries[n]];
    const bool is_led = other.has(Body::kDriven) || !other.has(Body::kHasGoal);
    lanes.add(
        config_.units.metres(other.x - body.x, other.z - body.z),
        is_led ? other.wish : config_.units.metres(other.aim_x - other.x, other.aim_z - other.z));
  }
  situation.wish = lanes.wish();
  situation.wish = steer::following_fast(config_.steering, situation);
  return true;
}

// Who can but stand between walls makes room for others.
Plane CrowdEngine::if_blocked(Plane way, const steer::Situation& situation) const {
  const bool stands = way.x == 0 && way.z == 0;
  return stands && situation.has_walls ? steer::making_room(config_.room, situation) : way;
}

// A way that is free as far as one looks has no end that would matter.
float CrowdEngine::metres(float way, float look) const {
  return way < look ? way * config_.units.unit : std::numeric_limits<float>::infinity();
}

// Is there a wall near, and how far is it to one along the wish?
void CrowdEngine::look_ahead(const Body& body, steer::Situation& situation) const {
  const StrideGround& ground = grounds_[body.avatar_class];
  const float look = wall_look(body);
  situation.has_walls = !ground.is_open_around(body.level, body.point(), cells_of(look));
  if (!situation.has_walls) return;
  const Plane ahead = steer::fan_around(situation.wish)[0];
  situation.free_way[0] = metres(ground.free_way(body.level, body.point(), ahead, look), look);
}

// How far is it in all directions? Only for those whose wish is not open.
void CrowdEngine::look_around(const Body& body, steer::Situation& situation) const {
  if (!situation.has_walls) return;
  const StrideGround& ground = grounds_[body.avatar_class];
  const float look = wall_look(body);
  const auto rise = static_cast<int32_t>(look * config_.units.unit * 1000);  // 45 degrees
  const steer::Fan fan = steer::fan_around(situation.wish);
  WallWindow window;
  switch (ground.look_around(body.level, body.y, body.point(), cells_of(look), rise, window)) {
    case StrideGround::Around::kOpen:
      situation.has_walls = false;
      break;
    case StrideGround::Around::kWalls:
      find_free_ways(window, fan, look, situation.free_way);
      for (float& way : situation.free_way) way = metres(way, look);
      break;
    case StrideGround::Around::kSteps:
      for (size_t k = 1; k < steer::kDirections; ++k) {
        situation.free_way[k] =
            metres(ground.free_way(body.level, body.point(), fan[k], look), look);
      }
  }
}

void CrowdEngine::find_ways(const steer::Situation& situation, bool open, Contest& contest) {
  steer::Trials trials;
  steer::Costs costs;
  steer::costs_of_fast(config_.steering, situation, trials, costs);
  contest.ways = 0;
  contest.has_all = true;
  contest.keeps = false;
  const auto add_way = [&](Plane v) {
    v = if_blocked(v, situation);
    contest.way[contest.ways++] = {config_.units.way(v.x), config_.units.way(v.z)};
  };
  Plane best = situation.wish;
  if (open) add_way(best);
  while (contest.ways < steer::kChoices) {
    const Plane choice = steer::take_best_fast(trials, costs);
    if (contest.ways == 0) best = choice;
    add_way(choice);
  }
  for (const float part : kShorter) add_way({best.x * part, best.z * part});
}

// Names the place that a body comes to if it goes on as it did. False, and nothing is changed, if
// that is not free.
bool CrowdEngine::keep_on(uint32_t i, Worker& worker, uint32_t square) {
  Body& body = bodies_[i];
  Body& place = spare_[i];
  place.round = 0;
  place.flags = Body::kKeeps;
  Contest contest;
  contest.body = i;
  contest.ways = 1;
  contest.has_all = false;
  contest.keeps = true;
  contest.way[0] = {config_.units.way(body.velocity.x), config_.units.way(body.velocity.z)};
  if (!try_place(body, body.x + contest.way[0].x, body.z + contest.way[0].z, place)) return false;
  const float touch = touch_of(body);
  const NeighbourGrid::Around around = grid_->around(square, touch <= grid_->width() ? 1 : 2);
  fit_lists(around, worker);
  const Eye eye{.x = body.x,
                .z = body.z,
                .y = body.y,
                .self = i,
                .most = 0,
                .tall = 0,
                .touch = touch * touch,
                .touch_tall = std::max<int32_t>(body.height, highest_) + 2 * kMostRise};
  SeenLists lists{worker.squares.data(), worker.entries.data(), worker.touched.data()};
  find_seen({grid_->x(), grid_->z(), grid_->y()}, around, eye, lists);
  contest.first = static_cast<uint32_t>(worker.others.size());
  list_touched(body, lists, worker);
  contest.last = static_cast<uint32_t>(worker.others.size());
  if (contest.first == contest.last) {
    body.state = Body::kFree;
    return true;
  }
  if (!is_clear(contest, worker, place, /*somebody_moved=*/false)) {
    worker.others.resize(contest.first);
    return false;
  }
  ++worker.counts.contested;
  body.state = Body::kUndecided;
  worker.contests.push_back(contest);
  return true;
}

// Sense, steer, and name a place if nobody can object.
void CrowdEngine::decide(uint32_t i, Worker& worker, const NeighbourGrid::Around& around) {
  Body& body = bodies_[i];
  Body& place = spare_[i];
  place.round = 0;
  place.flags = 0;
  if (body.has(Body::kFlying)) {
    body.state = Body::kShut;
    return;
  }
  Contest contest;
  contest.body = i;
  contest.first = static_cast<uint32_t>(worker.others.size());
  sense(i, worker, around, true);
  contest.last = static_cast<uint32_t>(worker.others.size());
  const bool alone = contest.first == contest.last;
  const bool open = find_open_wish(i, worker, around);
  worker.counts.contested += alone ? 0 : 1;
  // The best of his ways is enough as long as nobody objects to it.
  if (!open) look_around(body, worker.situation);
  const Plane best =
      open ? worker.situation.wish
           : if_blocked(steer::best_fast(config_.steering, worker.situation), worker.situation);
  contest.ways = 1;
  contest.has_all = false;
  contest.keeps = false;
  contest.way[0] = {config_.units.way(best.x), config_.units.way(best.z)};
  bool named = try_place(body, body.x + contest.way[0].x, body.z + contest.way[0].z, place) &&
               (alone || is_clear(contest, worker, place, /*somebody_moved=*/false));
  if (!named) {
    if (open) look_around(body, worker.situation);
    find_ways(worker.situation, open, contest);
  }
  if (named) place.flags = Body::kKeeps;
  // Known only where one had to look.
  body.near_wall = (!open || !named) && worker.situation.has_walls;
  if (!alone) {
    body.state = Body::kUndecided;
    worker.contests.push_back(contest);
    return;
  }
  for (uint32_t w = 0; !named && w < contest.ways; ++w) {
    named = try_place(body, body.x + contest.way[w].x, body.z + contest.way[w].z, place);
  }
  body.state = named ? Body::kFree : Body::kShut;
}

// Where a body would stand after a step, if the ground lets it.
bool CrowdEngine::try_place(const Body& body, int32_t x, int32_t z, Body& place) const {
  StrideGround::Landing landing;
  if (!grounds_[body.avatar_class].move(body.level, body.y, body.point(), {x, z}, landing)) {
    return false;
  }
  if (std::abs(landing.y - body.y) > kMostRise) return false;
  place.x = x;
  place.z = z;
  place.y = landing.y;
  place.level = landing.level;
  return true;
}

template <class Do>
void CrowdEngine::for_contests(Do act) {
  constexpr size_t kPiece = 64;
  for (Worker& owner : workers_) {
    const size_t count = owner.contests.size();
    parallel_for_worker((count + kPiece - 1) / kPiece, config_.workers,
                        [&](size_t piece, int32_t worker) {
                          const size_t last = std::min(count, (piece + 1) * kPiece);
                          for (size_t c = piece * kPiece; c < last; ++c) {
                            act(owner.contests[c], owner, workers_[static_cast<size_t>(worker)]);
                          }
                        });
  }
}

// By induction nobody ever touches anybody: a place that is named is clear of where all stand who
// could touch it, and it is taken only if it is clear of what those before him named, whether or
// not they take it.
void CrowdEngine::commit(uint64_t step) {
  for (int32_t r = 1; r <= config_.rounds; ++r) {
    const auto round = static_cast<uint8_t>(r);
    for_contests([&](Contest& c, const Worker& owner, Worker& scratch) {
      if (bodies_[c.body].state == Body::kUndecided) name(c, owner, scratch, round);
    });
    for_contests([&](const Contest& c, const Worker& owner, Worker&) {
      if (spare_[c.body].round != round || !holds(c, owner, round, step)) return;
      bodies_[c.body].state = Body::kDecided;
    });
  }
}

// Is a place clear of where everybody stands now?
bool CrowdEngine::is_clear(const Contest& contest, const Worker& owner, const Body& place,
                           bool somebody_moved) const {
  for (uint32_t n = contest.first; n < contest.last; ++n) {
    const uint32_t j = owner.others[n];
    const Body& other = bodies_[j];
    const bool moved = somebody_moved && other.state == Body::kDecided;
    if (clash(bodies_[contest.body], place, other, moved ? spare_[j] : other)) return false;
  }
  return true;
}

// The first of his ways that is open and clear.
void CrowdEngine::name(Contest& contest, const Worker& owner, Worker& scratch, uint8_t round) {
  const Body& body = bodies_[contest.body];
  Body place;
  const auto try_way = [&](uint32_t w) {
    if (!try_place(body, body.x + contest.way[w].x, body.z + contest.way[w].z, place) ||
        !is_clear(contest, owner, place, /*somebody_moved=*/true)) {
      return false;
    }
    Body& named = spare_[contest.body];
    named.x = place.x;
    named.z = place.z;
    named.y = place.y;
    named.level = place.level;
    named.round = round;
    return true;
  };
  uint32_t tried = 0;
  for (; tried < contest.ways; ++tried) {
    if (try_way(tried)) return;
    spare_[contest.body].clear(Body::kKeeps);  // It comes to do what it did not want first.
  }
  if (contest.has_all) return;
  if (contest.keeps) tried = 0;  // What it decides now it has not tried.
  // What it steers by is as it was when the step began. Others read `scratch.others` meanwhile.
  const NeighbourGrid::Around around = grid_->around(grid_->square(body));
  sense(contest.body, scratch, around, /*lists_others=*/false);
  const bool open = find_open_wish(contest.body, scratch, around);
  look_around(body, scratch.situation);
  find_ways(scratch.situation, open, contest);
  for (; tried < contest.ways; ++tried) {
    if (try_way(tried)) return;
  }
}

bool CrowdEngine::holds(const Contest& contest, const Worker& owner, uint8_t round,
                        uint64_t step) const {
  const Body& body = bodies_[contest.body];
  const auto order = [&](const Body& b) {
    return std::pair(random_u64(config_.seed, b.slot, step), b.slot);
  };
  const auto mine = order(body);
  for (uint32_t n = contest.first; n < contest.last; ++n) {
    const uint32_t j = owner.others[n];
    if (spare_[j].round == round && clash(body, spare_[contest.body], bodies_[j], spare_[j]) &&
        order(bodies_[j]) > mine) {
      return false;
    }
  }
  return true;
}

void CrowdEngine::settle_all(EngineCounts& counts) {
  arrived_.clear();
  std::mutex adding;
  parallel_ranges(size_, 4 * kGrain, config_.workers, [&](size_t begin, size_t end) {
    EngineCounts here;
    for (size_t i = begin; i < end; ++i) {
      Body& b = bodies_[i];
      if (b.has(Body::kFlying)) continue;
      const Plane way = config_.units.metres(b.aim_x - b.x, b.aim_z - b.z);
      const Body& place = spare_[i];
      const bool is_alone = b.state == Body::kFree || b.state == Body::kShut;
      const bool may_move = b.state == Body::kFree || b.state == Body::kDecided;
      const bool moves = may_move && (place.x != b.x || place.z != b.z);
      if (moves) {
        b.velocity = {config_.units.velocity(place.x - b.x), config_.units.velocity(place.z - b.z)};
        b.x = place.x;
        b.z = place.z;
        b.y = place.y;
        b.level = place.level;
      } else {
        b.velocity = {};
        ++here.stood;
      }
      b.clear(Body::kKeeps);
      if (may_move) b.flags = static_cast<uint8_t>(b.flags | (place.flags & Body::kKeeps));
      if (!b.has(Body::kHasGoal) || b.has(Body::kDriven)) continue;
      const float left = size_of(way);
      const float towards = left > 1e-6f ? (b.velocity.x * way.x + b.velocity.z * way.z) / left : 0;
      here.progress += std::lrint(towards / b.speed * 1e6f);
      const bool near_goal = left <= 1 && b.has(Body::kLast);
      // Nobody is in the way of who is alone, so there is nobody to be turned away from.
      const float content = near_goal || is_alone ? 1 : towards / b.speed;
      if (config_.patient) {
        const float along =
            (b.velocity.x * b.wish.x + b.velocity.z * b.wish.z) / (b.speed * b.speed);
        b.turn = steer::next_turn(config_.patience, b.turn, content, along, config_.units.dt);
      }
      const Plane rest = config_.units.metres(b.aim_x - b.x, b.aim_z - b.z);
      if (b.has(Body::kLast) && !b.has(Body::kArrived) && size_of(rest) < kThere) {
        b.flags |= Body::kArrived;
        const std::lock_guard lock(adding);
        arrived_.push_back(b.slot);
      }
    }
    const std::lock_guard lock(adding);
    counts.add(here);
  });
}

uint64_t CrowdEngine::bytes() const {
  uint64_t bytes = 2 * bodies_.size() * sizeof(Body) + (grid_ ? grid_->bytes() : 0);
  for (const Worker& worker : workers_) {
    bytes += worker.contests.capacity() * sizeof(Contest) +
             (worker.squares.capacity() + worker.entries.capacity() + worker.touched.capacity() +
              worker.others.capacity()) *
                 4;
  }
  return bytes;
}

}  // namespace throng
