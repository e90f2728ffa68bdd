// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "crowd/crowd_engine.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <mutex>
#include <utility>

#include "core/parallel.h"
#include "core/random.h"
#include "core/stopwatch.h"
#include "crowd/sense_kernel.h"
#include "steer/sampled_kernel.h"

// docs/design/008-engine.md. Whoever can touch nobody within the step takes what he wants at once;
// only the others go through the rounds.
namespace throng {
namespace {

using steer::Plane;

constexpr size_t kGrain = 256;  // bodies that are worth handing to another thread
constexpr std::array<float, 3> kShorter = {0.5f, 0.25f, 0.1f};
constexpr float kThere = 0.3f;  // [m] from its goal a body has arrived
constexpr uint16_t kNever = UINT16_MAX;

float size_of(Plane p) { return std::sqrt(p.x * p.x + p.z * p.z); }

// Do two bodies clash that stand at these places?
bool clash(const Body& a, const Body& at_a, const Body& b, const Body& at_b) {
  return nearer_than(at_a.x - at_b.x, at_a.z - at_b.z, int64_t{a.radius} + b.radius) &&
         at_a.y < at_b.y + b.height && at_b.y < at_a.y + a.height;
}

// The nearest so many, in order of distance and then of slot.
struct Nearest {
  size_t most;
  size_t size = 0;
  std::array<float, steer::kMostNear> square;
  std::array<uint32_t, steer::kMostNear> entry;

  void add(float far, uint32_t who, const Body* bodies) {
    const auto before = [&](size_t n) {  // does the n-th stay before `who`?
      return square[n] < far || (square[n] == far && bodies[entry[n]].slot < bodies[who].slot);
    };
    if (size == most && before(size - 1)) return;
    size_t n = size < most ? size++ : size - 1;
    for (; n > 0 && !before(n - 1); --n) {
      square[n] = square[n - 1];
      entry[n] = entry[n - 1];
    }
    square[n] = far;
    entry[n] = who;
  }
};

}  // namespace

void EngineCounts::add(const EngineCounts& other) {
  contested += other.contested;
  open += other.open;
  stood += other.stood;
  arrived += other.arrived;
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
  wish_all(before);
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

void CrowdEngine::wish_all(const Before& before) {
  const size_t pieces = (size_ + kGrain - 1) / kGrain;
  parallel_for_worker(pieces, config_.workers, [&](size_t piece, int32_t worker) {
    const size_t begin = piece * kGrain;
    const std::span<Body> bodies{bodies_.data() + begin, std::min(kGrain, size_ - begin)};
    if (before) before(bodies, worker);
    for (Body& b : bodies) {
      if (b.has(Body::kDriven)) continue;
      b.wish = b.has(Body::kHasGoal)
                   ? steer::wish_towards(config_.units.metres(b.aim_x - b.x, b.aim_z - b.z),
                                         b.speed, config_.units.dt, b.turn)
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
      const uint32_t here = grid_->square(bodies_[i]);
      if (here != square) {
        square = here;
        around = grid_->around(square);
        size_t most = kSeenSpare;
        for (const auto& p : around) most += p.last - p.first;
        if (worker.squares.size() < most) {
          worker.squares.resize(most * 2);
          worker.entries.resize(most * 2);
        }
      }
      decide(static_cast<uint32_t>(i), worker, around);
    }
  });
  for (const Worker& worker : workers_) counts.add(worker.counts);
}

// Sense, steer, and name a place if nobody can object.
void CrowdEngine::decide(uint32_t i, Worker& worker, const NeighbourGrid::Around& around) {
  Body& body = bodies_[i];
  const Places places{grid_->x(), grid_->z(), grid_->y()};
  const auto sight = static_cast<float>(sight_);
  const Eye eye{.x = body.x,
                .z = body.z,
                .y = body.y,
                .most = sight * sight,
                .tall = body.height + 2 * kMostRise};
  size_t seen = 0;
  for (const auto& p : around) {
    if (p.first == p.last) continue;
    seen += find_seen(places, p.first, p.last, eye, &worker.squares[seen], &worker.entries[seen]);
  }
  // Nobody farther away can be touched; the exact test follows.
  const auto touch =
      static_cast<float>(body.radius + config_.units.stride(body.speed) + widest_ + longest_ + 1) *
      1.0001f;
  const auto first_other = static_cast<uint32_t>(worker.others.size());
  Nearest nearest{
      .most = static_cast<size_t>(config_.steering.neighbours), .square = {}, .entry = {}};
  for (size_t n = 0; n < seen; ++n) {
    const uint32_t j = worker.entries[n];
    if (j == i) continue;
    const Body& other = bodies_[j];
    if (worker.squares[n] < touch * touch) {
      const int64_t reach = int64_t{body.radius} + other.radius + config_.units.stride(body.speed) +
                            config_.units.stride(other.speed);
      const int32_t rise = body.y - other.y;
      const bool near = rise < other.height + 2 * kMostRise && -rise < body.height + 2 * kMostRise;
      if (near && nearer_than(other.x - body.x, other.z - body.z, reach))
        worker.others.push_back(j);
    }
    if (std::abs(places.y[j] - body.y) < body.height)
      nearest.add(worker.squares[n], j, bodies_.data());
  }

  steer::Situation situation{.velocity = body.velocity,
                             .wish = body.wish,
                             .fastest = body.speed,
                             .near = {},
                             .free_way = {}};
  for (size_t n = 0; n < nearest.size; ++n) {
    const Body& other = bodies_[nearest.entry[n]];
    // Who has arrived makes way for those who would pass, were he not there: they may stand.
    const bool makes_way = body.has(Body::kArrived) && !other.has(Body::kArrived);
    situation.near.add(config_.steering,
                       {config_.units.metres(other.x - body.x, other.z - body.z),
                        makes_way ? other.wish : other.velocity,
                        static_cast<float>(body.radius + other.radius) * config_.units.unit});
  }
  const StrideGround& ground = grounds_[body.avatar_class];
  const float look = body.speed * config_.steering.wall_horizon;
  const auto look_cells = static_cast<int32_t>(look / config_.units.unit) / kUnitsPerCell + 1;
  const GroundPoint from = body.point();
  situation.has_walls = ground.may_have_walls(body.level, from.cell_x(), from.cell_z(), look_cells);
  steer::Fan fan;
  if (situation.has_walls) {
    fan = steer::fan_around(body.wish);
    situation.free_way[0] =
        ground.free_way(body.level, from, fan[0], look / config_.units.unit) * config_.units.unit;
  }
  const bool open = steer::wish_is_open_fast(config_.steering, situation);
  const bool alone = first_other == worker.others.size();
  Body& place = spare_[i];
  body.state = Body::kFree;
  place.round = 0;
  if (open && alone) {
    ++worker.counts.open;
    if (try_place(body, body.x + config_.units.way(body.wish.x),
                  body.z + config_.units.way(body.wish.z), place)) {
      return;
    }
  }
  if (situation.has_walls) {
    for (size_t k = 1; k < steer::kDirections; ++k) {
      situation.free_way[k] =
          ground.free_way(body.level, from, fan[k], look / config_.units.unit) * config_.units.unit;
    }
  }
  steer::Trials trials;
  steer::Costs costs;
  steer::costs_of_fast(config_.steering, situation, trials, costs);
  Contest contest;
  contest.ways = 0;
  const auto add_way = [&](Plane v) {
    contest.way[contest.ways++] = {config_.units.way(v.x), config_.units.way(v.z)};
  };
  Plane best = body.wish;
  if (open) add_way(body.wish);
  while (contest.ways < steer::kChoices) {
    const Plane choice = steer::take_best_fast(trials, costs);
    if (contest.ways == 0) best = choice;
    add_way(choice);
  }
  for (const float part : kShorter) add_way({best.x * part, best.z * part});
  if (alone) {
    for (const Contest::Way& way : contest.way) {
      if (try_place(body, body.x + way.x, body.z + way.z, place)) return;
    }
    body.state = Body::kUndecided;  // walls all around: it stays
    return;
  }
  ++worker.counts.contested;
  body.state = Body::kUndecided;
  contest.body = i;
  contest.first = first_other;
  contest.last = static_cast<uint32_t>(worker.others.size());
  worker.contests.push_back(contest);
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
  for (const Worker& worker : workers_) {
    parallel_ranges(worker.contests.size(), kGrain / 4, config_.workers,
                    [&](size_t begin, size_t end) {
                      for (size_t c = begin; c < end; ++c) act(worker.contests[c], worker);
                    });
  }
}

// By induction nobody ever touches anybody: a place that is named is clear of where all stand who
// could touch it, and it is taken only if it is clear of what those before him named, whether or
// not they take it.
void CrowdEngine::commit(uint64_t step) {
  for (int32_t r = 1; r <= config_.rounds; ++r) {
    const auto round = static_cast<uint8_t>(r);
    for_contests([&](const Contest& c, const Worker& worker) {
      if (bodies_[c.body].state == Body::kUndecided) name(c, worker, round);
    });
    for_contests([&](const Contest& c, const Worker& worker) {
      if (spare_[c.body].round != round || !holds(c, worker, round, step)) return;
      bodies_[c.body].state = Body::kDecided;
    });
  }
}

// The first of his ways that is open and clear of where everybody stands now.
void CrowdEngine::name(const Contest& contest, const Worker& worker, uint8_t round) {
  const Body& body = bodies_[contest.body];
  Body place;
  for (uint32_t w = 0; w < contest.ways; ++w) {
    if (!try_place(body, body.x + contest.way[w].x, body.z + contest.way[w].z, place)) continue;
    bool clear = true;
    for (uint32_t n = contest.first; clear && n < contest.last; ++n) {
      const uint32_t j = worker.others[n];
      const Body& other = bodies_[j];
      clear = !clash(body, place, other, other.state == Body::kDecided ? spare_[j] : other);
    }
    if (!clear) continue;
    Body& named = spare_[contest.body];
    named.x = place.x;
    named.z = place.z;
    named.y = place.y;
    named.level = place.level;
    named.round = round;
    return;
  }
}

bool CrowdEngine::holds(const Contest& contest, const Worker& worker, uint8_t round,
                        uint64_t step) const {
  const Body& body = bodies_[contest.body];
  const auto order = [&](const Body& b) {
    return std::pair(random_u64(config_.seed, b.slot, step), b.slot);
  };
  const auto mine = order(body);
  for (uint32_t n = contest.first; n < contest.last; ++n) {
    const uint32_t j = worker.others[n];
    if (spare_[j].round == round && clash(body, spare_[contest.body], bodies_[j], spare_[j]) &&
        order(bodies_[j]) > mine) {
      return false;
    }
  }
  return true;
}

void CrowdEngine::settle_all(EngineCounts& counts) {
  std::mutex adding;
  parallel_ranges(size_, 4 * kGrain, config_.workers, [&](size_t begin, size_t end) {
    EngineCounts here;
    for (size_t i = begin; i < end; ++i) {
      Body& b = bodies_[i];
      const Plane way = config_.units.metres(b.aim_x - b.x, b.aim_z - b.z);
      const Body& place = spare_[i];
      const bool moves = b.state != Body::kUndecided && (place.x != b.x || place.z != b.z);
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
      if (!b.has(Body::kHasGoal) || b.has(Body::kDriven)) continue;
      const float left = size_of(way);
      const float towards = left > 1e-6f ? (b.velocity.x * way.x + b.velocity.z * way.z) / left : 0;
      here.progress += std::lrint(towards / b.speed * 1e6f);
      const bool near_goal = left <= 1 && b.has(Body::kLast);
      const float content = near_goal ? 1 : towards / b.speed;
      if (config_.patient) {
        b.turn = steer::next_turn(config_.patience, b.turn, content, config_.units.dt);
      }
      b.waited = content < config_.patience.content
                     ? static_cast<uint16_t>(std::min<int32_t>(b.waited + 1, kNever))
                     : uint16_t{0};
      const Plane rest = config_.units.metres(b.aim_x - b.x, b.aim_z - b.z);
      if (b.has(Body::kLast) && !b.has(Body::kArrived) && size_of(rest) < kThere) {
        b.flags |= Body::kArrived | Body::kJustArrived;
        ++here.arrived;
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
             (worker.squares.capacity() + worker.entries.capacity() + worker.others.capacity()) * 4;
  }
  return bytes;
}

}  // namespace throng
