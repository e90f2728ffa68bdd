// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <optional>

#include "core/access.h"
#include "core/hash.h"
#include "core/parallel.h"
#include "core/random.h"
#include "core/stopwatch.h"
#include "crowd/crowd_check.h"
#include "crowd/placement.h"
#include "crowd/walk/crowd_blocks.h"
#include "papers/wanderers/wander_step.h"
#include "throng/papers.h"
#include "world/place.h"

// A crowd without goals: places avatars, sorts them by block as they drift, and moves blocks of one
// colour in parallel. Source: [ML06] section 4. A step is linear in the avatars.
namespace throng {
namespace {

constexpr int32_t kBlockPixels = 32;
// Pixels of the map for each avatar above which small pages, allocated only around it, save memory:
// an avatar touches up to three pages of 512.
constexpr int64_t kPixelsPerAvatar = 2048;
constexpr double kMaxPixels = 1e12;  // 8 TB of addresses; only what is touched takes memory
constexpr double kMinUnits = 50;  // of a step: they are whole, so it is within 1.5 % of its length
constexpr uint64_t kGrain = 512;  // avatars that are worth another thread

// A direction, uniform over the circle, without trigonometry: a point of the disc, put on its rim.
std::pair<double, double> random_direction(uint64_t seed, uint64_t id) {
  for (uint64_t i = 0;; i += 2) {
    const double x = random_unit(seed, id, i) * 2 - 1, z = random_unit(seed, id, i + 1) * 2 - 1;
    const double square = x * x + z * z;
    if (square > 1 || square < 1e-4) continue;
    const double size = std::sqrt(square);
    return {x / size, z / size};
  }
}

}  // namespace

struct Wanderers::State {
  World world;
  WanderConfig config;
  AvatarClass body;
  crowd::CrowdGround ground;
  std::optional<crowd::CollisionMap> map;
  std::optional<crowd::CrowdBlocks> blocks;
  HugeArray<crowd::Avatar> avatars;  // by block
  HugeArray<crowd::Avatar> scratch;
  double unit = 0;  // metres
  int32_t sub_steps = 1;
  uint64_t step = 0;
  uint64_t sub_step = 0;
  int64_t drift = 0;   // units that an avatar can have moved since the last sort
  int64_t stride = 0;  // units that an avatar can move in a sub-step
  int64_t max_drift = 0;
};

Wanderers::Wanderers(std::unique_ptr<State> state) : state_(std::move(state)) {}
Wanderers::Wanderers(Wanderers&&) noexcept = default;
Wanderers& Wanderers::operator=(Wanderers&&) noexcept = default;
Wanderers::~Wanderers() = default;

Result<Wanderers> Wanderers::create(const World& world, const WanderConfig& config) {
  const auto bad = [](const std::string& what) {
    return Error{Errc::kBadConfig, "crowd: " + what};
  };
  if (!data_of(world)) return bad("there is no world");
  const world::WorldData& data = *data_of(world);
  if (config.avatar_class < 0 ||
      static_cast<size_t>(config.avatar_class) >= data.summary.classes.size()) {
    return Error{Errc::kNotFound, "crowd: class " + std::to_string(config.avatar_class) +
                                      " is not in this world, which has " +
                                      std::to_string(data.summary.classes.size())};
  }
  if (!(config.dt >= 1e-3 && config.dt <= 10)) return bad("dt must be 0.001 to 10 s");
  if (!(config.speed >= 0 && config.speed <= 1000)) return bad("speed must be 0 to 1000 m/s");
  if (config.workers < 0) return bad("workers must be 0 (all cores) or more");

  auto state = std::make_unique<State>();
  state->world = world;
  state->config = config;
  state->body = data.summary.classes[static_cast<size_t>(config.avatar_class)];
  const AvatarClass& body = state->body;
  auto ground = crowd::CrowdGround::create(data, config.avatar_class, world::step_mm(body));
  if (!ground) return ground.error();
  state->ground = std::move(*ground);

  const double cell = data.summary.cell;
  const auto pixel_cells = static_cast<int32_t>(std::ceil(2 * body.radius / cell - 1e-9));
  const auto body_mm = static_cast<int32_t>(std::ceil(body.height * 1000 - 1e-6));
  const auto [low, high] = state->ground.feet_range();
  const crowd::PixelGrid grid(pixel_cells);
  const int64_t pixels = int64_t{data.width / pixel_cells + 1} * (data.depth / pixel_cells + 1);
  const Pages pages = pixels / kPixelsPerAvatar < config.avatars ? Pages::kHuge : Pages::kSmall;
  const double planes = (static_cast<double>(high) - low) / (64 * crowd::CollisionMap::kSlab) + 2;
  if (static_cast<double>(pixels) * planes > kMaxPixels) {
    return Error{Errc::kLimit, "crowd: the world is too large and too high for a crowd of class " +
                                   body.name + "; bake it in parts"};
  }
  state->map.emplace(data.width, data.depth, grid, low, high, body_mm, pages);
  state->unit = cell / world::kUnitsPerCell;

  // No avatar moves further than a radius at a time.
  const double speed = config.speed > 0 ? config.speed : body.speed;
  const double length = speed * config.dt;
  state->sub_steps = std::max(1, static_cast<int32_t>(std::ceil(length / body.radius - 1e-9)));
  if (state->sub_steps > 10000)
    return bad("speed times dt is over 10000 radii; take shorter steps");
  const double units = length / state->sub_steps / state->unit;
  if (units < kMinUnits) {
    return bad("speed times dt is " + std::to_string(length * 1e3) + " mm, but steps below " +
               std::to_string(kMinUnits * state->unit * 1e3) +
               " mm are not exact in this world; take longer steps");
  }
  state->stride = static_cast<int64_t>(std::ceil(units)) + 1;
  // A mover reads one pixel further than it moves; two movers of one colour keep a block between
  // them.
  state->max_drift = (kBlockPixels / 2 - 2) * grid.units();
  state->blocks.emplace(data.width, data.depth, grid, kBlockPixels);

  const std::vector<crowd::Avatar> placed =
      crowd::place_avatars(state->ground, config.avatars, config.seed, *state->map);
  if (placed.size() < config.avatars) {
    return Error{Errc::kLimit, "crowd: " + std::to_string(placed.size()) + " avatars of class " +
                                   body.name + " fit in this world, " +
                                   std::to_string(config.avatars) +
                                   " were asked for; ask for fewer or take a larger world"};
  }
  state->avatars = HugeArray<crowd::Avatar>(placed.size());
  state->scratch = HugeArray<crowd::Avatar>(placed.size());
  std::copy(placed.begin(), placed.end(), state->avatars.data());
  for (crowd::Avatar& avatar : state->avatars.span()) {
    const auto [dx, dz] = random_direction(config.seed ^ 0x68656164, avatar.id);
    avatar.vx = static_cast<int32_t>(std::lround(dx * units));
    avatar.vz = static_cast<int32_t>(std::lround(dz * units));
  }
  state->drift = state->max_drift + 1;  // sort first
  return Wanderers(std::move(state));
}

WanderReport Wanderers::step() {
  State& s = *state_;
  const auto start = Clock::now();
  WanderReport report;
  report.step = ++s.step;
  std::atomic<uint64_t> moved{0}, wall{0}, avatar{0}, waited{0};
  papers::StepInput input{.ground = &s.ground,
                          .map = &*s.map,
                          .seed = s.config.seed,
                          .step_mm = world::step_mm(s.body),
                          .is_short = s.stride <= crowd::LevelLine::kBlock << world::kUnitBits,
                          .units_x = data_of(s.world)->width << world::kUnitBits,
                          .units_z = data_of(s.world)->depth << world::kUnitBits};
  for (int32_t i = 0; i < s.sub_steps; ++i) {
    if (s.drift + s.stride > s.max_drift) {
      const auto sort_start = Clock::now();
      s.blocks->sort(s.avatars, s.scratch, s.config.workers);
      s.drift = 0;
      report.seconds_sort += seconds_since(sort_start);
    }
    const auto move_start = Clock::now();
    input.step = ++s.sub_step;
    for (uint32_t turn = 0; turn < crowd::CrowdBlocks::kColours; ++turn) {
      // Each colour is first in turn.
      const auto& runs = s.blocks->runs((turn + static_cast<uint32_t>(input.step)) & 3);
      const uint64_t avatars_here = runs.empty() ? 1 : runs.back().last - runs.front().first;
      const size_t grain = std::max<size_t>(1, kGrain * runs.size() / avatars_here);
      parallel_ranges(runs.size(), grain, s.config.workers, [&](size_t begin, size_t end) {
        papers::StepCounts counts;
        papers::move_runs(input, s.avatars.data(), std::span(runs).subspan(begin, end - begin),
                          counts);
        moved.fetch_add(counts.moved, std::memory_order_relaxed);
        wall.fetch_add(counts.blocked_by_wall, std::memory_order_relaxed);
        avatar.fetch_add(counts.blocked_by_avatar, std::memory_order_relaxed);
        waited.fetch_add(counts.waited, std::memory_order_relaxed);
      });
    }
    s.drift += s.stride;
    report.seconds_move += seconds_since(move_start);
  }
  report.moved = moved;
  report.blocked_by_wall = wall;
  report.blocked_by_avatar = avatar;
  report.waited = waited;
  report.seconds_total = seconds_since(start);
  return report;
}

CrowdCheck Wanderers::check() const {
  const State& s = *state_;
  std::vector<crowd::CheckedBody> bodies;
  bodies.reserve(s.avatars.size());
  for (const crowd::Avatar& a : s.avatars.span()) {
    bodies.push_back({a.x, a.z, a.y, a.level, s.config.avatar_class, s.body.radius, s.body.height});
  }
  return crowd::check_bodies(s.world, bodies, {}, s.config.workers);
}

uint64_t Wanderers::state_hash() const {
  std::vector<crowd::Avatar> by_id(state_->avatars.size());
  for (const crowd::Avatar& avatar : state_->avatars.span()) by_id[avatar.id] = avatar;
  return hash_span(std::span<const crowd::Avatar>(by_id));
}

void Wanderers::read(std::vector<AvatarState>& out) const {
  const State& s = *state_;
  out.resize(s.avatars.size());
  const Vec3d origin = data_of(s.world)->summary.origin;
  const double radius =
      data_of(s.world)->summary.classes[static_cast<size_t>(s.config.avatar_class)].radius;
  for (const crowd::Avatar& avatar : s.avatars.span()) {
    AvatarState& state = out[avatar.id];
    state.id = avatar.id;
    state.avatar_class = s.config.avatar_class;
    state.radius = radius;
    state.position = {origin.x + (avatar.x + 0.5) * s.unit, avatar.y * 1e-3,
                      origin.z + (avatar.z + 0.5) * s.unit};
    const double size = std::hypot(avatar.vx, avatar.vz);
    state.heading_x = size > 0 ? avatar.vx / size : 0;
    state.heading_z = size > 0 ? avatar.vz / size : 1;
  }
}

uint32_t Wanderers::size() const { return static_cast<uint32_t>(state_->avatars.size()); }

uint64_t Wanderers::bytes() const {
  return (state_->avatars.size() + state_->scratch.size()) * sizeof(crowd::Avatar) +
         state_->ground.bytes() + state_->map->bytes() + state_->blocks->bytes();
}

}  // namespace throng
