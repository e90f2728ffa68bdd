// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <limits>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "core/hash.h"
#include "core/parallel.h"
#include "core/random.h"
#include "core/random_direction.h"
#include "core/stopwatch.h"
#include "papers/slices/slice_ground.h"
#include "throng/papers.h"
#include "world/place.h"

// A crowd on slices. In a sub-step no body moves further than a cell. Square blocks of cells in
// four colours, those of one colour a block apart, move in parallel; within a block bodies move in
// a fixed order, so every move sees where all others are, and the result is the same for any
// threads.
namespace throng {
namespace {

using papers::CellBox;
using papers::SliceBody;
using papers::SliceGround;

constexpr int32_t kUnitBits = 12;
constexpr double kUnits = 1 << kUnitBits;  // of a position, in a cell
constexpr int32_t kColours = 4;
constexpr int32_t kMinBlock = 64;  // [cells]
constexpr double kMinUnits = 50;   // of a sub-step: they are whole
constexpr double kMaxSubSteps = 10000;
constexpr uint64_t kRandomTries = 30;  // for a place, before the first free one is taken
constexpr uint64_t kHeadings = 0x736c69636564, kPlaces = 0x736c696365;  // random streams

struct Walker {
  int64_t x = 0, z = 0;    // [units]
  int32_t feet = 0;        // [mm]
  int32_t vx = 0, vz = 0;  // [units a sub-step]
  uint32_t id = 0;
};
static_assert(sizeof(Walker) == 32);

struct Kind {
  uint32_t last = 0;  // ids of its avatars are below, and not below that of the kind before
  SliceBody body;
  int64_t radius = 0;  // [units]
  double stride = 0;   // of a sub-step [units]
};

struct Block {
  uint32_t first, last;
};

struct Counts {
  uint64_t moved = 0, wall = 0, avatar = 0, waited = 0;
};

enum class Move { kDone, kWall, kAvatar };

CellBox cells_of(int64_t x, int64_t z, int64_t radius) {
  const auto cell = [](int64_t at) { return static_cast<int32_t>(at >> kUnitBits); };
  return {cell(x - radius), cell(z - radius), cell(x + radius - 1), cell(z + radius - 1)};
}

Error bad(const std::string& what) { return {Errc::kBadConfig, "slices: " + what}; }

Result<void> check(const DepthSlices& slices, const SliceWanderConfig& config) {
  if (slices.slices.empty() || slices.width < 1 || slices.depth < 1 ||
      !(slices.cell >= SliceConfig::kMinCell && slices.cell <= SliceConfig::kMaxCell)) {
    return bad("there are none to walk on");
  }
  if (config.groups.empty() || config.groups.size() > static_cast<size_t>(kMaxAvatarClasses)) {
    return bad("a crowd needs 1 to 16 groups of avatars");
  }
  if (!(config.dt >= 1e-3 && config.dt <= 10)) return bad("dt must be 0.001 to 10 s");
  if (config.workers < 0) return bad("workers must be 0 (all cores) or more");
  uint64_t sum = 0;
  for (const SliceGroup& group : config.groups) {
    const AvatarClass& c = group.avatar;
    sum += group.count;
    if (sum > UINT32_MAX) return bad("at most 4294967295 avatars have numbers");
    if (auto ok = check_classes({&c, 1}); !ok) return ok.error();
    const double height = c.height * 1000;
    if (height + 0.5 < slices.avatar_height) {
      return bad(
          fmt::format("class {} is {} m tall, the slices were cut for {} m and more; cut "
                      "them with --avatar-height {}",
                      c.name, c.height, slices.avatar_height / 1000.0, c.height));
    }
    if (height + 2000 * c.step_height > DepthSlices::kMaxBody) {
      return bad(
          fmt::format("class {} is {} m tall; slices serve bodies up to {} m, less two steps",
                      c.name, c.height, DepthSlices::kMaxBody / 1000));
    }
    if (c.flies || goes_over_nodes(c)) {
      return bad(
          fmt::format("class {} flies, climbs or drops; on slices bodies only walk", c.name));
    }
  }
  return {};
}

}  // namespace

struct SliceWanderers::State {
  State(DepthSlices slices, SliceWanderConfig a_config)
      : ground(std::move(slices)), config(std::move(a_config)) {}

  SliceGround ground;
  SliceWanderConfig config;
  std::vector<Kind> kinds;
  std::vector<Walker> walkers, scratch;  // by block
  int32_t block = kMinBlock;             // side [cells]
  size_t half_x = 0, half_z = 0;         // blocks of a colour
  std::vector<uint32_t> first;
  std::array<std::vector<Block>, kColours> blocks;  // that hold bodies
  uint64_t sub_steps = 1;
  uint64_t step = 0, sub_step = 0;

  [[nodiscard]] size_t index_of_kind(const Walker& w) const {
    size_t kind = 0;
    while (w.id >= kinds[kind].last) ++kind;
    return kind;
  }
  [[nodiscard]] const Kind& kind_of(const Walker& w) const { return kinds[index_of_kind(w)]; }
  Result<void> make_kinds();
  void make_blocks();
  bool place(Walker& w, size_t slice, int32_t x, int32_t z);
  uint64_t place_all();
  [[nodiscard]] size_t block_of(const Walker& w) const;
  void sort();
  Move try_move(Walker& w, const Kind& kind);
  void move(Walker& w, Counts& counts);
};

Result<void> SliceWanderers::State::make_kinds() {
  const double cell = ground.slices().cell;
  double longest = 0;
  for (const SliceGroup& group : config.groups)
    longest = std::max(longest, group.avatar.speed * config.dt);
  if (!(longest / cell <= kMaxSubSteps))
    return bad("speed times dt is over 10000 cells; take shorter steps");
  sub_steps = std::max<uint64_t>(1, static_cast<uint64_t>(std::ceil(longest / cell - 1e-9)));
  uint32_t last = 0;
  for (const SliceGroup& group : config.groups) {
    const AvatarClass& c = group.avatar;
    last += group.count;
    const double stride = c.speed * config.dt / static_cast<double>(sub_steps) / cell * kUnits;
    if (stride < kMinUnits) {
      return bad(
          fmt::format("class {} moves {:.3f} mm at a time, but below {:.3f} mm moves are not "
                      "exact with these cells; take longer steps",
                      c.name, stride / kUnits * cell * 1000, kMinUnits / kUnits * cell * 1000));
    }
    const auto mm = [](double metres) {
      return static_cast<int32_t>(std::ceil(metres * 1000 - 1e-6));
    };
    kinds.push_back({.last = last,
                     .body = {.height = mm(c.height), .step = world::step_mm(c) + 1},
                     .radius = static_cast<int64_t>(std::ceil(c.radius / cell * kUnits - 1e-6)),
                     .stride = stride});
  }
  return {};
}

void SliceWanderers::State::make_blocks() {
  int64_t widest = 0;
  for (const Kind& kind : kinds) widest = std::max(widest, kind.radius);
  // A body is up to so many cells outside of the block in which it was sorted, and reads one more.
  const int64_t outside = (widest >> kUnitBits) + 2 + static_cast<int64_t>(sub_steps);
  while (block < 4 * outside) block *= 2;
  half_x = static_cast<size_t>(ground.slices().width / block / 2 + 1);
  half_z = static_cast<size_t>(ground.slices().depth / block / 2 + 1);
}

size_t SliceWanderers::State::block_of(const Walker& w) const {
  const auto x = static_cast<size_t>(w.x >> kUnitBits) / static_cast<size_t>(block);
  const auto z = static_cast<size_t>(w.z >> kUnitBits) / static_cast<size_t>(block);
  const size_t colour = (z & 1) * 2 + (x & 1);
  return (colour * half_z + z / 2) * half_x + x / 2;
}

void SliceWanderers::State::sort() {
  first.assign(kColours * half_x * half_z + 1, 0);
  for (const Walker& w : walkers) ++first[block_of(w) + 1];
  for (size_t i = 1; i < first.size(); ++i) first[i] += first[i - 1];
  for (size_t colour = 0; colour < kColours; ++colour) {
    blocks[colour].clear();
    for (size_t i = colour * half_x * half_z; i < (colour + 1) * half_x * half_z; ++i) {
      if (first[i] < first[i + 1]) blocks[colour].push_back({first[i], first[i + 1]});
    }
  }
  for (const Walker& w : walkers) scratch[first[block_of(w)]++] = w;
  walkers.swap(scratch);
}

// Puts a body in the middle of a cell, on what `slice` shows there.
bool SliceWanderers::State::place(Walker& w, size_t slice, int32_t x, int32_t z) {
  const Kind& kind = kind_of(w);
  const DepthSlice& shown = ground.slices().slices[slice];
  const size_t cell = ground.cell(x, z);
  if (shown.depths[cell] == DepthSlice::kNone) return false;
  w.x = (int64_t{x} << kUnitBits) + (1 << (kUnitBits - 1));
  w.z = (int64_t{z} << kUnitBits) + (1 << (kUnitBits - 1));
  const CellBox box = cells_of(w.x, w.z, kind.radius);
  // Only surfaces that a body of this height reads.
  const int32_t surface = shown.surface(cell);
  if (!ground.holds(box) || ground.slice_above(surface + kind.body.height) != slice) return false;
  const std::optional<int32_t> feet = ground.feet_after(surface, box, box, kind.body);
  if (!feet) return false;
  w.feet = *feet;
  const size_t read = ground.slice_above(*feet + kind.body.height);
  if (!ground.is_free(read, box)) return false;
  ground.set(read, box, true);
  return true;
}

// Gives each a random place, or the next one that is left; returns how many have one.
uint64_t SliceWanderers::State::place_all() {
  const DepthSlices& slices = ground.slices();
  const uint64_t cells = uint64_t(slices.width) * uint64_t(slices.depth);
  const uint64_t all = cells * slices.slices.size();
  std::vector<uint64_t> next(kinds.size(), 0);  // by class: all before it were tried
  const auto try_at = [&](Walker& w, uint64_t at) {
    const uint64_t cell = at % cells;
    return place(w, at / cells, static_cast<int32_t>(cell % uint64_t(slices.width)),
                 static_cast<int32_t>(cell / uint64_t(slices.width)));
  };
  for (uint32_t id = 0; id < kinds.back().last; ++id) {
    Walker w{.id = id};
    bool placed = false;
    for (uint64_t k = 0; k < kRandomTries && !placed; ++k) {
      placed = try_at(w, random_below(config.seed ^ kPlaces, id, k, all));
    }
    uint64_t& from = next[index_of_kind(w)];
    for (; !placed && from < all; ++from) placed = try_at(w, from);
    if (!placed) return id;
    const auto [dx, dz] = random_direction(config.seed ^ kHeadings, id);
    const double stride = kind_of(w).stride;
    w.vx = static_cast<int32_t>(std::lround(dx * stride));
    w.vz = static_cast<int32_t>(std::lround(dz * stride));
    walkers.push_back(w);
  }
  return kinds.back().last;
}

Move SliceWanderers::State::try_move(Walker& w, const Kind& kind) {
  const int64_t x = w.x + w.vx, z = w.z + w.vz;
  const CellBox from = cells_of(w.x, w.z, kind.radius), to = cells_of(x, z, kind.radius);
  if (from == to) {
    w.x = x;
    w.z = z;
    return Move::kDone;
  }
  const CellBox swept = papers::box_of(from, to);
  if (!ground.holds(swept)) return Move::kWall;
  const std::optional<int32_t> feet = ground.feet_after(w.feet, swept, to, kind.body);
  if (!feet) return Move::kWall;
  const size_t read = ground.slice_above(w.feet + kind.body.height);
  ground.set(read, from, false);
  const bool is_free = ground.is_free(read, swept);
  ground.set(read, is_free ? to : from, true);
  if (!is_free) return Move::kAvatar;
  w.x = x;
  w.z = z;
  w.feet = *feet;
  return Move::kDone;
}

// Straight on; if that is blocked, a quarter turn to a random side; if that is blocked too, it
// waits, turned.
void SliceWanderers::State::move(Walker& w, Counts& counts) {
  const Kind& kind = kind_of(w);
  const Move straight = try_move(w, kind);
  if (straight == Move::kDone) {
    ++counts.moved;
    return;
  }
  ++(straight == Move::kWall ? counts.wall : counts.avatar);
  const bool left = (random_u64(config.seed, w.id, sub_step) & 1) != 0;
  const int32_t vx = left ? -w.vz : w.vz;
  w.vz = left ? w.vx : -w.vx;
  w.vx = vx;
  ++(try_move(w, kind) == Move::kDone ? counts.moved : counts.waited);
}

SliceWanderers::SliceWanderers(std::unique_ptr<State> state) : state_(std::move(state)) {}
SliceWanderers::SliceWanderers(SliceWanderers&&) noexcept = default;
SliceWanderers& SliceWanderers::operator=(SliceWanderers&&) noexcept = default;
SliceWanderers::~SliceWanderers() = default;

Result<SliceWanderers> SliceWanderers::create(DepthSlices slices, const SliceWanderConfig& config) {
  if (auto ok = throng::check(slices, config); !ok) return ok.error();
  auto state = std::make_unique<State>(std::move(slices), config);
  if (auto ok = state->make_kinds(); !ok) return ok.error();
  state->make_blocks();
  const uint64_t placed = state->place_all();
  if (placed < state->kinds.back().last) {
    return Error{Errc::kLimit, fmt::format("slices: {} avatars fit, {} were asked for; ask for "
                                           "fewer or take a larger model",
                                           placed, state->kinds.back().last)};
  }
  state->scratch.resize(state->walkers.size());
  return SliceWanderers(std::move(state));
}

WanderReport SliceWanderers::step() {
  State& s = *state_;
  const auto start = Clock::now();
  WanderReport report;
  report.step = ++s.step;
  s.sort();
  report.seconds_sort = seconds_since(start);
  std::atomic<uint64_t> moved{0}, wall{0}, avatar{0}, waited{0};
  for (uint64_t i = 0; i < s.sub_steps; ++i) {
    ++s.sub_step;
    for (uint64_t turn = 0; turn < kColours; ++turn) {
      // Each colour is first in turn.
      const std::span<const Block> blocks = s.blocks[(turn + s.sub_step) % kColours];
      parallel_ranges(blocks.size(), 1, s.config.workers, [&](size_t begin, size_t end) {
        Counts counts;
        for (const Block& block : blocks.subspan(begin, end - begin)) {
          for (uint32_t n = block.first; n < block.last; ++n) s.move(s.walkers[n], counts);
        }
        moved.fetch_add(counts.moved, std::memory_order_relaxed);
        wall.fetch_add(counts.wall, std::memory_order_relaxed);
        avatar.fetch_add(counts.avatar, std::memory_order_relaxed);
        waited.fetch_add(counts.waited, std::memory_order_relaxed);
      });
    }
  }
  report.moved = moved;
  report.blocked_by_wall = wall;
  report.blocked_by_avatar = avatar;
  report.waited = waited;
  report.seconds_total = seconds_since(start);
  report.seconds_move = report.seconds_total - report.seconds_sort;
  return report;
}

// Not by the bits, and each surface by a search of its own through the slices.
CrowdCheck SliceWanderers::check() const {
  const State& s = *state_;
  const DepthSlices& slices = s.ground.slices();
  CrowdCheck found;
  std::vector<Walker> by_row;  // rows as deep as the widest pair
  int64_t widest = 0;
  for (const Walker& w : s.walkers) {
    const Kind& kind = s.kind_of(w);
    const int32_t head = w.feet + kind.body.height;
    size_t read = slices.slices.size() - 1;
    while (read > 0 && slices.slices[read].height < head) --read;
    const CellBox box = cells_of(w.x, w.z, kind.radius);
    bool stands = s.ground.holds(box), is_on_floor = false;
    for (int32_t z = box.z0; z <= box.z1 && stands; ++z) {
      for (int32_t x = box.x0; x <= box.x1 && stands; ++x) {
        const size_t cell = s.ground.cell(x, z);
        const DepthSlice& slice = slices.slices[read];
        stands = slice.depths[cell] != DepthSlice::kNone && slice.surface(cell) <= w.feet &&
                 w.feet - slice.surface(cell) < kind.body.step;
        is_on_floor = is_on_floor || (stands && slice.surface(cell) == w.feet);
      }
    }
    found.wall_entries += stands && is_on_floor ? 0 : 1;
    by_row.push_back(w);
    widest = std::max(widest, kind.radius);
  }
  const auto row_of = [&](const Walker& w) { return w.z / (2 * widest); };
  const auto is_before = [&](const Walker& a, const Walker& b) {
    return std::pair(row_of(a), a.x) < std::pair(row_of(b), b.x);
  };
  std::sort(by_row.begin(), by_row.end(), is_before);
  const auto overlaps = [&](const Walker& a, const Walker& b) {
    const Kind &of_a = s.kind_of(a), &of_b = s.kind_of(b);
    const int64_t dx = b.x - a.x, dz = b.z - a.z, room = of_a.radius + of_b.radius;
    return dx * dx + dz * dz < room * room && a.feet < b.feet + of_b.body.height &&
           b.feet < a.feet + of_a.body.height;
  };
  for (size_t i = 0; i < by_row.size(); ++i) {
    const Walker& a = by_row[i];
    const auto compare = [&](size_t j, int64_t row) {
      for (; j < by_row.size() && row_of(by_row[j]) == row; ++j) {
        if (by_row[j].x - a.x >= 2 * widest) break;
        found.overlaps += overlaps(a, by_row[j]) ? 1 : 0;
      }
    };
    compare(i + 1, row_of(a));
    const Walker corner{.x = a.x - 2 * widest, .z = (row_of(a) + 1) * 2 * widest};
    const auto next = std::lower_bound(by_row.begin(), by_row.end(), corner, is_before);
    compare(static_cast<size_t>(next - by_row.begin()), row_of(a) + 1);
  }
  return found;
}

uint64_t SliceWanderers::state_hash() const {
  std::vector<Walker> by_id(state_->walkers.size());
  for (const Walker& w : state_->walkers) by_id[w.id] = w;
  return hash_span(std::span<const Walker>(by_id));
}

void SliceWanderers::read(std::vector<AvatarState>& out) const {
  const State& s = *state_;
  const DepthSlices& slices = s.ground.slices();
  const double unit = slices.cell / kUnits;
  out.assign(s.walkers.size(), {});
  for (const Walker& w : s.walkers) {
    AvatarState& state = out[w.id];
    const size_t kind = s.index_of_kind(w);
    state.id = w.id;
    state.avatar_class = static_cast<int32_t>(kind);
    state.radius = s.config.groups[kind].avatar.radius;
    state.position = {slices.origin_x + static_cast<double>(w.x) * unit, w.feet * 1e-3,
                      slices.origin_z + static_cast<double>(w.z) * unit};
    const double size = std::sqrt(double(w.vx) * w.vx + double(w.vz) * w.vz);
    state.heading_x = size > 0 ? w.vx / size : 0;
    state.heading_z = size > 0 ? w.vz / size : 1;
  }
}

uint32_t SliceWanderers::size() const { return static_cast<uint32_t>(state_->walkers.size()); }

uint64_t SliceWanderers::bytes() const {
  return state_->ground.bytes() +
         (state_->walkers.size() + state_->scratch.size()) * sizeof(Walker);
}

const DepthSlices& SliceWanderers::slices() const { return state_->ground.slices(); }

}  // namespace throng
