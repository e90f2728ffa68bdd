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
#include "core/random_direction.h"
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

Error bad(const std::string& what) { return {Errc::kBadConfig, "crowd: " + what}; }

}  // namespace

struct Wanderers::State {
  // The avatars of one class, and where they are sorted.
  struct Group {
    int32_t avatar_class = 0;
    uint32_t count = 0;
    AvatarClass body;
    crowd::CrowdGround ground;
    int32_t body_mm = 0;
    double units = 0;  // that an avatar moves in a sub-step
    std::optional<crowd::CrowdBlocks> blocks;
    HugeArray<crowd::Avatar> avatars;  // by block
    HugeArray<crowd::Avatar> scratch;
    int64_t stride = 0;  // units that an avatar can move in a sub-step
    int64_t drift = 0;   // and since the last sort
  };

  World world;
  WanderConfig config;
  std::vector<Group> groups;
  std::optional<crowd::CollisionMap> map;
  double unit = 0;  // metres
  int32_t sub_steps = 1;
  uint64_t step = 0;
  uint64_t sub_step = 0;
  int64_t max_drift = 0;

  Result<void> make_groups();
  Result<void> make_map();
  Result<void> make_strides();
  Result<void> place();
  void move(Group& group, uint32_t colour, papers::StepCounts& counts);
};

Wanderers::Wanderers(std::unique_ptr<State> state) : state_(std::move(state)) {}
Wanderers::Wanderers(Wanderers&&) noexcept = default;
Wanderers& Wanderers::operator=(Wanderers&&) noexcept = default;
Wanderers::~Wanderers() = default;

Result<Wanderers> Wanderers::create(const World& world, const WanderConfig& config) {
  if (!data_of(world)) return bad("there is no world");
  if (!(config.dt >= 1e-3 && config.dt <= 10)) return bad("dt must be 0.001 to 10 s");
  if (!(config.speed >= 0 && config.speed <= 1000)) return bad("speed must be 0 to 1000 m/s");
  if (config.workers < 0) return bad("workers must be 0 (all cores) or more");

  auto state = std::make_unique<State>();
  state->world = world;
  state->config = config;
  if (auto ok = state->make_groups(); !ok) return ok.error();
  if (auto ok = state->make_map(); !ok) return ok.error();
  if (auto ok = state->make_strides(); !ok) return ok.error();
  if (auto ok = state->place(); !ok) return ok.error();
  return Wanderers(std::move(state));
}

Result<void> Wanderers::State::make_groups() {
  const world::WorldData& data = *data_of(world);
  std::vector<WanderGroup> all{{config.avatar_class, config.avatars}};
  all.insert(all.end(), config.also.begin(), config.also.end());
  if (all.size() > static_cast<size_t>(kMaxAvatarClasses)) {
    return bad("a crowd has at most 16 groups of avatars");
  }
  uint64_t sum = 0;
  for (const WanderGroup& asked : all) {
    if (asked.avatar_class < 0 ||
        static_cast<size_t>(asked.avatar_class) >= data.summary.classes.size()) {
      return Error{Errc::kNotFound, "crowd: class " + std::to_string(asked.avatar_class) +
                                        " is not in this world, which has " +
                                        std::to_string(data.summary.classes.size())};
    }
    sum += asked.avatars;
    if (sum > UINT32_MAX) return bad("at most 4294967295 avatars have numbers");
    const AvatarClass& body = data.summary.classes[static_cast<size_t>(asked.avatar_class)];
    auto ground = crowd::CrowdGround::create(data, asked.avatar_class, world::step_mm(body));
    if (!ground) return ground.error();
    groups.push_back({.avatar_class = asked.avatar_class,
                      .count = asked.avatars,
                      .body = body,
                      .ground = std::move(*ground),
                      .body_mm = static_cast<int32_t>(std::ceil(body.height * 1000 - 1e-6)),
                      .blocks = {},
                      .avatars = {},
                      .scratch = {}});
  }
  return {};
}

// One map for all: its pixels are as wide as the widest body.
Result<void> Wanderers::State::make_map() {
  const world::WorldData& data = *data_of(world);
  const double cell = data.summary.cell;
  double radius = 0;
  int32_t body_mm = 0, low = INT32_MAX, high = INT32_MIN;
  uint64_t avatars = 0;
  for (const Group& group : groups) {
    radius = std::max(radius, group.body.radius);
    body_mm = std::max(body_mm, group.body_mm);
    const auto [lowest, highest] = group.ground.feet_range();
    low = std::min(low, lowest);
    high = std::max(high, highest);
    avatars += group.count;
  }
  const auto pixel_cells = static_cast<int32_t>(std::ceil(2 * radius / cell - 1e-9));
  const crowd::PixelGrid grid(pixel_cells);
  const int64_t pixels = int64_t{data.width / pixel_cells + 1} * (data.depth / pixel_cells + 1);
  const Pages pages =
      static_cast<uint64_t>(pixels / kPixelsPerAvatar) < avatars ? Pages::kHuge : Pages::kSmall;
  const double planes = (static_cast<double>(high) - low) / (64 * crowd::CollisionMap::kSlab) + 2;
  if (static_cast<double>(pixels) * planes > kMaxPixels) {
    return Error{Errc::kLimit, "crowd: the world is too large and too high for a crowd of class " +
                                   groups[0].body.name + "; bake it in parts"};
  }
  map.emplace(data.width, data.depth, grid, low, high, body_mm, pages);
  unit = cell / world::kUnitsPerCell;
  // A mover reads one pixel further than it moves; two movers of one colour keep a block between
  // them.
  max_drift = (kBlockPixels / 2 - 2) * grid.units();
  for (Group& group : groups) {
    group.blocks.emplace(data.width, data.depth, grid, kBlockPixels);
    group.drift = max_drift + 1;  // sort first
  }
  return {};
}

// No avatar moves further than a radius at a time.
Result<void> Wanderers::State::make_strides() {
  const auto length_of = [&](const Group& group) {
    return (config.speed > 0 ? config.speed : group.body.speed) * config.dt;
  };
  for (const Group& group : groups) {
    const double radii = length_of(group) / group.body.radius;
    sub_steps = std::max(sub_steps, static_cast<int32_t>(std::ceil(std::min(radii, 1e6) - 1e-9)));
  }
  if (sub_steps > 10000) return bad("speed times dt is over 10000 radii; take shorter steps");
  for (Group& group : groups) {
    group.units = length_of(group) / sub_steps / unit;
    if (group.units < kMinUnits) {
      return bad("speed times dt is " + std::to_string(length_of(group) * 1e3) +
                 " mm, but steps below " + std::to_string(kMinUnits * unit * sub_steps * 1e3) +
                 " mm are not exact in this world; take longer steps");
    }
    group.stride = static_cast<int64_t>(std::ceil(group.units)) + 1;
  }
  return {};
}

Result<void> Wanderers::State::place() {
  uint32_t first = 0;
  for (size_t g = 0; g < groups.size(); ++g) {
    Group& group = groups[g];
    std::vector<crowd::Avatar> placed = crowd::place_avatars(
        group.ground, group.body_mm, group.count, config.seed + (uint64_t{g} << 32), *map);
    if (placed.size() < group.count) {
      return Error{Errc::kLimit, "crowd: " + std::to_string(placed.size()) + " avatars of class " +
                                     group.body.name + " fit in this world, " +
                                     std::to_string(group.count) +
                                     " were asked for; ask for fewer or take a larger world"};
    }
    group.avatars = HugeArray<crowd::Avatar>(placed.size());
    group.scratch = HugeArray<crowd::Avatar>(placed.size());
    for (crowd::Avatar& avatar : placed) {
      avatar.id += first;
      const auto [dx, dz] = random_direction(config.seed ^ 0x68656164, avatar.id);
      avatar.vx = static_cast<int32_t>(std::lround(dx * group.units));
      avatar.vz = static_cast<int32_t>(std::lround(dz * group.units));
    }
    std::copy(placed.begin(), placed.end(), group.avatars.data());
    first += group.count;
  }
  return {};
}

// The avatars of one class in the blocks of one colour.
void Wanderers::State::move(Group& group, uint32_t colour, papers::StepCounts& counts) {
  const papers::StepInput input{
      .ground = &group.ground,
      .map = &*map,
      .seed = config.seed,
      .step = sub_step,
      .step_mm = world::step_mm(group.body),
      .body_mm = group.body_mm,
      .is_short = group.stride <= crowd::LevelLine::kBlock << world::kUnitBits,
      .units_x = data_of(world)->width << world::kUnitBits,
      .units_z = data_of(world)->depth << world::kUnitBits};
  const auto& runs = group.blocks->runs(colour);
  const uint64_t avatars_here = runs.empty() ? 1 : runs.back().last - runs.front().first;
  const size_t grain = std::max<size_t>(1, kGrain * runs.size() / avatars_here);
  std::atomic<uint64_t> moved{0}, wall{0}, avatar{0}, waited{0};
  parallel_ranges(runs.size(), grain, config.workers, [&](size_t begin, size_t end) {
    papers::StepCounts found;
    papers::move_runs(input, group.avatars.data(), std::span(runs).subspan(begin, end - begin),
                      found);
    moved.fetch_add(found.moved, std::memory_order_relaxed);
    wall.fetch_add(found.blocked_by_wall, std::memory_order_relaxed);
    avatar.fetch_add(found.blocked_by_avatar, std::memory_order_relaxed);
    waited.fetch_add(found.waited, std::memory_order_relaxed);
  });
  counts.moved += moved;
  counts.blocked_by_wall += wall;
  counts.blocked_by_avatar += avatar;
  counts.waited += waited;
}

WanderReport Wanderers::step() {
  State& s = *state_;
  const auto start = Clock::now();
  WanderReport report;
  report.step = ++s.step;
  papers::StepCounts counts;
  for (int32_t i = 0; i < s.sub_steps; ++i) {
    const auto sort_start = Clock::now();
    for (State::Group& group : s.groups) {
      if (group.drift + group.stride <= s.max_drift) continue;
      group.blocks->sort(group.avatars, group.scratch, s.config.workers);
      group.drift = 0;
    }
    report.seconds_sort += seconds_since(sort_start);
    const auto move_start = Clock::now();
    ++s.sub_step;
    for (uint32_t turn = 0; turn < crowd::CrowdBlocks::kColours; ++turn) {
      // Each colour is first in turn.
      const uint32_t colour = (turn + static_cast<uint32_t>(s.sub_step)) & 3;
      for (State::Group& group : s.groups) s.move(group, colour, counts);
    }
    for (State::Group& group : s.groups) group.drift += group.stride;
    report.seconds_move += seconds_since(move_start);
  }
  report.moved = counts.moved;
  report.blocked_by_wall = counts.blocked_by_wall;
  report.blocked_by_avatar = counts.blocked_by_avatar;
  report.waited = counts.waited;
  report.seconds_total = seconds_since(start);
  return report;
}

CrowdCheck Wanderers::check() const {
  const State& s = *state_;
  std::vector<crowd::CheckedBody> bodies;
  bodies.reserve(size());
  for (const State::Group& group : s.groups) {
    for (const crowd::Avatar& a : group.avatars.span()) {
      bodies.push_back(
          {a.x, a.z, a.y, a.level, group.avatar_class, group.body.radius, group.body.height});
    }
  }
  return crowd::check_bodies(s.world, bodies, {}, s.config.workers);
}

uint64_t Wanderers::state_hash() const {
  std::vector<crowd::Avatar> by_id(size());
  for (const State::Group& group : state_->groups) {
    for (const crowd::Avatar& avatar : group.avatars.span()) by_id[avatar.id] = avatar;
  }
  return hash_span(std::span<const crowd::Avatar>(by_id));
}

void Wanderers::read(std::vector<AvatarState>& out) const {
  const State& s = *state_;
  out.resize(size());
  const Vec3d origin = data_of(s.world)->summary.origin;
  for (const State::Group& group : s.groups) {
    for (const crowd::Avatar& avatar : group.avatars.span()) {
      AvatarState& state = out[avatar.id];
      state.id = avatar.id;
      state.avatar_class = group.avatar_class;
      state.radius = group.body.radius;
      state.position = {origin.x + (avatar.x + 0.5) * s.unit, avatar.y * 1e-3,
                        origin.z + (avatar.z + 0.5) * s.unit};
      const double size = std::hypot(avatar.vx, avatar.vz);
      state.heading_x = size > 0 ? avatar.vx / size : 0;
      state.heading_z = size > 0 ? avatar.vz / size : 1;
    }
  }
}

uint32_t Wanderers::size() const {
  uint32_t count = 0;
  for (const State::Group& group : state_->groups) count += group.count;
  return count;
}

uint64_t Wanderers::bytes() const {
  uint64_t bytes = state_->map->bytes();
  for (const State::Group& group : state_->groups) {
    bytes += (group.avatars.size() + group.scratch.size()) * sizeof(crowd::Avatar) +
             group.ground.bytes() + group.blocks->bytes();
  }
  return bytes;
}

}  // namespace throng
