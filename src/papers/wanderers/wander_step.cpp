// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "papers/wanderers/wander_step.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdlib>
#include <span>

#include "core/arrays/prefetch.h"
#include "core/random.h"
#include "crowd/ground/plan_steps.h"
#include "world/tile_grid.h"

// A run is moved in groups, and a group in passes, so that no pass waits for memory or mispredicts
// a branch: what nearly all avatars need is computed without one, and those that need more are put
// on a list for the next pass. The passes are three stages: while one group is in its last, the
// next is in its second and the one after that in its first, and what a stage prefetches arrives
// before the next. The order in which moves are accepted (group, pass, place in the group) depends
// on the run alone, because only the last stage reads or writes what groups share.
namespace throng::papers {
namespace {

constexpr size_t kGroup = 64;
constexpr int32_t kAheadAvatar = 128;  // avatars between the prefetch of one and its use
constexpr int32_t kAheadLevel = 48;    // the same for the line of a level
constexpr int32_t kMaxFlatStep = 2;    // longest flat step [cells]

// Numbers of avatars of a group.
class List {
 public:
  // Appends if `condition`, without a branch. There is always space for one more.
  void add_if(bool condition, uint16_t n) {
    at_[size_] = n;
    size_ += condition;
  }
  void clear() { size_ = 0; }
  [[nodiscard]] size_t size() const { return size_; }
  [[nodiscard]] std::span<const uint16_t> span() const { return {at_.data(), size_}; }

 private:
  std::array<uint16_t, kGroup> at_;  // not zeroed: this is made twice a group
  size_t size_ = 0;
};

// A flat step into another pixel.
struct Proposal {
  uint32_t from;   // pixel
  uint32_t level;  // on which it ends
  uint16_t direction_index;
  uint16_t n;
};

using Pixels = crowd::CollisionMap::Pixels;

class Group {
 public:
  explicit Group(const StepInput& in) : in_(in) {}

  // The three stages: each avatar, or each of a list, makes one step, or is put on another list. Up
  // to `readable`, avatars may be read ahead of their turn.
  void start_all(crowd::Avatar* avatars, size_t size, const crowd::Avatar* readable) {
    avatars_ = avatars;
    proposals_size_ = prefetched_ = walls_ = 0;
    for (List* list : {&undecided_, &uneven_, &slopes_, &walks_}) list->clear();
    prefetch_levels_ahead(size, readable - 1);
    plan_all(size);
    prefetch_walk_levels();
    prefetch_pixels();
  }
  void start(crowd::Avatar* avatars, const List& todo) {
    avatars_ = avatars;
    plan(todo.span());
    prefetch_walk_levels();
    prefetch_pixels();
  }
  void prefetch_cells() {
    plan_by_cells();
    prefetch_pixels();
    prefetch_ground_cells();
  }
  void finish(List& blocked) {
    proposal(blocked);
    sort_uneven();
    climb(blocked);
    walk_on(blocked);
  }
  [[nodiscard]] crowd::Avatar* avatars() const { return avatars_; }
  [[nodiscard]] uint64_t walls() const { return walls_; }

 private:
  void prefetch_levels_ahead(size_t size, const crowd::Avatar* last_readable) const;
  void plan_all(size_t size);
  void plan(std::span<const uint16_t> todo);
  void prefetch_walk_levels() const;
  void plan_by_cells();
  bool move_or_propose(const Pixels& pixels, crowd::Avatar& a, bool condition, uint32_t level,
                       uint16_t n, size_t& proposed);
  void prefetch_pixels();
  void prefetch_ground_cells() const;
  void proposal(List& blocked);
  void sort_uneven();
  void climb(List& blocked);
  void walk_on(List& blocked);

  const StepInput& in_;
  crowd::Avatar* avatars_ = nullptr;
  std::array<Proposal, kGroup> proposals_;
  std::array<crowd::CollisionMap::Slices, kGroup> slices_;  // of the proposed moves
  size_t proposals_size_ = 0;
  size_t prefetched_ = 0;  // proposed moves whose pixels were prefetched
  List undecided_;         // not within flat blocks
  List uneven_;            // not flat: these go on one of the next two
  List slopes_;
  List walks_;
  uint64_t walls_ = 0;  // met
};

// All of a group.
std::span<const uint16_t> all_of_group() {
  static constexpr auto kAll = [] {
    std::array<uint16_t, kGroup> all{};
    for (size_t n = 0; n < kGroup; ++n) all[n] = static_cast<uint16_t>(n);
    return all;
  }();
  return kAll;
}

// All ones if true.
int32_t mask(bool condition) { return -static_cast<int32_t>(condition); }

// True if all cells of a box between two cells are set and lie on one tile of 64 rows. False for
// boxes longer than kMaxFlatStep.
[[gnu::always_inline]] inline bool box_is_set(const uint64_t* rows, int32_t x0, int32_t z0,
                                              int32_t x1, int32_t z1) {
  const bool near = (static_cast<uint32_t>((x0 ^ x1) | (z0 ^ z1)) < 64) &
                    (static_cast<uint32_t>(x1 - x0 + kMaxFlatStep) <= 2 * kMaxFlatStep) &
                    (static_cast<uint32_t>(z1 - z0 + kMaxFlatStep) <= 2 * kMaxFlatStep);
  // Of two cells that are at most two apart, the middle one is all that lies between.
  const uint64_t common =
      rows[world::in_tile(z0)] & rows[world::in_tile((z0 + z1) >> 1)] & rows[world::in_tile(z1)];
  const uint64_t all = (common >> world::in_tile(x0)) & (common >> world::in_tile((x0 + x1) >> 1)) &
                       (common >> world::in_tile(x1)) & static_cast<uint64_t>(near);
  return all != 0;
}

// A flat step that `condition` is one: an avatar that stays in its pixel moves at once, for no
// other can be in conflict; the others propose a move. Returns whether it moved. Arithmetic instead
// of branches: the direction of an avatar is as good as random, and a mispredicted branch costs 20
// cycles.
[[gnu::always_inline]] inline bool Group::move_or_propose(const Pixels& pixels, crowd::Avatar& a,
                                                          bool condition, uint32_t level,
                                                          uint16_t n, size_t& proposed) {
  const int32_t x = a.x, z = a.z, vx = a.vx, vz = a.vz;
  const int32_t px = pixels.grid.pixel(x >> world::kUnitBits),
                pz = pixels.grid.pixel(z >> world::kUnitBits);
  const int32_t dx = pixels.grid.pixel((x + vx) >> world::kUnitBits) - px;
  const int32_t dz = pixels.grid.pixel((z + vz) >> world::kUnitBits) - pz;
  const bool stays = (dx | dz) == 0;
  proposals_[proposed] = {pixels.number(px, pz), level,
                          static_cast<uint16_t>(crowd::CollisionMap::direction_index(dx, dz)), n};
  proposed += condition & !stays;
  const bool goes = condition & stays;
  a.x = x + (vx & mask(goes));
  a.z = z + (vz & mask(goes));
  return goes;
}

void Group::prefetch_levels_ahead(size_t size, const crowd::Avatar* last_readable) const {
  const crowd::LevelLine* lines = in_.ground->lines();
  for (const crowd::Avatar* a = avatars_; a < avatars_ + size; ++a) {
    throng::prefetch(a + kAheadAvatar);
    throng::prefetch(&lines[std::min(a + kAheadLevel, last_readable)->level]);
  }
}

// The line of their level alone decides most of them.
void Group::plan_all(size_t size) {
  const Pixels pixels = in_.map->pixels();
  if (!in_.is_short || !crowd::can_plan(pixels.grid, in_.ground->records().size()))
    return plan(all_of_group().first(size));
  const crowd::PlannedSteps planned =
      crowd::plan_steps(in_.ground->lines(), pixels.grid, avatars_, size);
  const uint64_t here = ~uint64_t{0} >> (kGroup - size);
  for (uint64_t bits = here & ~(planned.stays | planned.leaves); bits != 0; bits &= bits - 1) {
    undecided_.add_if(true, static_cast<uint16_t>(std::countr_zero(bits)));
  }
  size_t proposed = 0;
  for (uint64_t bits = planned.leaves; bits != 0; bits &= bits - 1) {
    const auto n = static_cast<uint16_t>(std::countr_zero(bits));
    move_or_propose(pixels, avatars_[n], true, avatars_[n].level, n, proposed);
  }
  proposals_size_ = proposed;
}

void Group::plan(std::span<const uint16_t> todo) {
  const crowd::LevelLine* lines = in_.ground->lines();
  const Pixels pixels = in_.map->pixels();
  size_t proposed = 0;
  for (const uint16_t n : todo) {
    crowd::Avatar& a = avatars_[n];
    const bool is_flat =
        in_.is_short & lines[a.level].box_is_flat(a.x >> world::kUnitBits, a.z >> world::kUnitBits,
                                                  (a.x + a.vx) >> world::kUnitBits,
                                                  (a.z + a.vz) >> world::kUnitBits);
    undecided_.add_if(!is_flat, n);
    move_or_propose(pixels, a, is_flat, a.level, n, proposed);
  }
  proposals_size_ = proposed;
}

void Group::prefetch_walk_levels() const {
  for (const uint16_t n : undecided_.span()) {
    const crowd::Avatar& a = avatars_[n];
    const int32_t x = (a.x + a.vx) >> world::kUnitBits, z = (a.z + a.vz) >> world::kUnitBits;
    in_.ground->prefetch_level(a.level, a.z >> world::kUnitBits, z);
    in_.ground->prefetch_tile(world::tile_along(x), world::tile_along(z));
  }
}

// Flat blocks over the edge of the tile, and flat cells that do not fill a block.
void Group::plan_by_cells() {
  const Pixels pixels = in_.map->pixels();
  size_t proposed = proposals_size_;
  for (const uint16_t n : undecided_.span()) {
    crowd::Avatar& a = avatars_[n];
    const int32_t x0 = a.x >> world::kUnitBits, z0 = a.z >> world::kUnitBits;
    const int32_t x1 = (a.x + a.vx) >> world::kUnitBits, z1 = (a.z + a.vz) >> world::kUnitBits;
    const uint32_t beyond =
        in_.is_short ? in_.ground->line(a.level).cross(x0, z0, x1, z1) : crowd::LevelLine::kNone;
    const bool crosses = beyond != crowd::LevelLine::kNone;
    const bool is_flat = crosses | box_is_set(in_.ground->flat(a.level), x0, z0, x1, z1);
    uneven_.add_if(!is_flat, n);
    const uint32_t level = crosses ? beyond : a.level;
    const bool goes = move_or_propose(pixels, a, is_flat, level, n, proposed);
    a.level = goes ? level : a.level;
  }
  proposals_size_ = proposed;
}

void Group::prefetch_pixels() {
  const crowd::CollisionMap& map = *in_.map;
  for (; prefetched_ < proposals_size_; ++prefetched_) {
    const Proposal& c = proposals_[prefetched_];
    slices_[prefetched_] = map.slices(avatars_[c.n].y, in_.body_mm);
    map.prefetch(slices_[prefetched_], c.from, c.direction_index);
  }
}

void Group::proposal(List& blocked) {
  crowd::CollisionMap& map = *in_.map;
  for (size_t i = 0; i < proposals_size_; ++i) {
    const Proposal& c = proposals_[i];
    crowd::Avatar& a = avatars_[c.n];
    const bool moved = map.move_by_one(slices_[i], c.from, c.direction_index);
    a.x += a.vx & mask(moved);
    a.z += a.vz & mask(moved);
    a.level = moved ? c.level : a.level;
    blocked.add_if(!moved, c.n);
  }
}

// A level from which no other can be reached inside the tile: the ground that world/walk.h expects,
// so that the compiler removes all that cannot happen.
struct LoneLevel {
  using Level = uint32_t;
  const uint64_t* legal;
  [[nodiscard]] bool is_legal(Level, int32_t x, int32_t z) const {
    return ((legal[z] >> x) & 1) != 0;
  }
  [[nodiscard]] int32_t sample(Level, int32_t, int32_t) const { return 0; }
  [[nodiscard]] bool step_safe(Level) const { return true; }
  template <class Visit>
  void for_tile(int32_t, int32_t, int32_t, int32_t, Visit) const {}
};

// Puts the body at `to` if no other is there.
bool try_move(const StepInput& in, crowd::Avatar& a, world::GroundPoint to, uint32_t level,
              int32_t y) {
  crowd::CollisionMap& map = *in.map;
  const crowd::CollisionMap::Mark old_mark = map.mark(a.point(), a.y, in.body_mm);
  const crowd::CollisionMap::Mark mark = map.mark(to, y, in.body_mm);
  if (!(mark == old_mark)) {
    map.clear(old_mark);
    if (!map.is_free(mark)) {
      map.set(old_mark);
      return false;
    }
    map.set(mark);
  }
  a.x = static_cast<int32_t>(to.x);
  a.z = static_cast<int32_t>(to.z);
  a.y = y;
  a.level = level;
  return true;
}

world::GroundPoint target(const crowd::Avatar& a) {
  return {int64_t{a.x} + a.vx, int64_t{a.z} + a.vz};
}

void Group::prefetch_ground_cells() const {
  for (const uint16_t n : uneven_.span()) {
    const crowd::Avatar& a = avatars_[n];
    const int32_t x = (a.x + a.vx) >> world::kUnitBits, z = (a.z + a.vz) >> world::kUnitBits;
    in_.ground->prefetch_cell(a.level, x, z);
    in_.ground->prefetch_levels(world::tile_along(x), world::tile_along(z));
    in_.map->prefetch(a.point(), a.y);
  }
}

// Separates slopes, where every cell in range is legal, from walls, steps and edges of tiles.
void Group::sort_uneven() {
  const crowd::CrowdGround& ground = *in_.ground;
  for (const uint16_t n : uneven_.span()) {
    const crowd::Avatar& a = avatars_[n];
    const int32_t x0 = a.x >> world::kUnitBits, z0 = a.z >> world::kUnitBits;
    const int32_t x1 = (a.x + a.vx) >> world::kUnitBits, z1 = (a.z + a.vz) >> world::kUnitBits;
    const crowd::CrowdGround::Walk level = ground.walk(a.level);
    const bool is_slope = level.is_step_safe & box_is_set(level.legal, x0, z0, x1, z1);
    slopes_.add_if(is_slope, n);
    walks_.add_if(!is_slope, n);
  }
  for (const uint16_t n : walks_.span()) {
    const crowd::Avatar& a = avatars_[n];
    const int32_t x = (a.x + a.vx) >> world::kUnitBits, z = (a.z + a.vz) >> world::kUnitBits;
    if (world::tile_along(x) == (a.x >> (world::kUnitBits + world::kTileBits)) &&
        world::tile_along(z) == (a.z >> (world::kUnitBits + world::kTileBits)))
      continue;
    ground.for_tile(world::tile_along(x), world::tile_along(z), a.y - in_.step_mm,
                    a.y + in_.step_mm, [&](uint32_t level) { ground.prefetch_cell(level, x, z); });
  }
}

void Group::climb(List& blocked) {
  for (const uint16_t n : slopes_.span()) {
    crowd::Avatar& a = avatars_[n];
    const world::GroundPoint to = target(a);
    blocked.add_if(!try_move(in_, a, to, a.level, in_.ground->feet(a.level, to)), n);
  }
}

void Group::walk_on(List& blocked) {
  const crowd::CrowdGround& ground = *in_.ground;
  for (const uint16_t n : walks_.span()) {
    crowd::Avatar& a = avatars_[n];
    const world::GroundPoint from = a.point(), to = target(a);
    uint32_t level = a.level;
    const crowd::CrowdGround::Walk here = ground.walk(level);
    const bool on_tile =
        ((from.x ^ to.x) | (from.z ^ to.z)) >> (world::kUnitBits + world::kTileBits) == 0;
    const bool is_open = here.is_isolated && on_tile
                             ? world::walk(LoneLevel{here.legal}, level, from, to, in_.step_mm)
                             : to.x >= 0 && to.z >= 0 && to.x < in_.units_x && to.z < in_.units_z &&
                                   walk(ground, level, from, to, in_.step_mm);
    const bool moved = is_open && try_move(in_, a, to, level, ground.feet(level, to));
    walls_ += !is_open;
    blocked.add_if(!moved, n);
  }
}

// To the left or to the right, at random.
void turn(const StepInput& in, crowd::Avatar& a) {
  const bool left = (random_u64(in.seed, a.id, in.step) & 1) != 0;
  const int32_t vx = left ? -a.vz : a.vz;
  a.vz = left ? a.vx : -a.vx;
  a.vx = vx;
}

// The last stage of a group, and all three for those that turn.
void finish(const StepInput& in, Group& straight, size_t size, StepCounts& counts) {
  List blocked, waits;
  straight.finish(blocked);
  crowd::Avatar* a = straight.avatars();
  for (const uint16_t n : blocked.span()) turn(in, a[n]);
  Group turned(in);
  turned.start(a, blocked);
  turned.prefetch_cells();
  turned.finish(waits);
  counts.moved += size - waits.size();
  counts.waited += waits.size();
  counts.blocked_by_wall += straight.walls();
  counts.blocked_by_avatar += blocked.size() - straight.walls();
}

}  // namespace

void move_runs(const StepInput& in, crowd::Avatar* avatars,
               std::span<const crowd::CrowdBlocks::Run> runs, StepCounts& counts) {
  if (runs.empty()) return;
  const crowd::Avatar* readable = avatars + runs.back().last;
  std::array<Group, 3> groups = {Group(in), Group(in), Group(in)};
  std::array<size_t, 3> sizes{};
  size_t begun = 0;
  // What is due when group g has started, or would have if there were one.
  const auto follow = [&](size_t g) {
    if (g >= 1 && g - 1 < begun) groups[(g - 1) % 3].prefetch_cells();
    if (g >= 2) finish(in, groups[(g - 2) % 3], sizes[(g - 2) % 3], counts);
  };
  for (const crowd::CrowdBlocks::Run& run : runs) {
    for (uint32_t first = run.first; first < run.last; first += kGroup) {
      const size_t size = std::min<size_t>(kGroup, run.last - first);
      sizes[begun % 3] = size;
      groups[begun % 3].start_all(avatars + first, size, readable);
      follow(begun++);
    }
  }
  follow(begun);
  follow(begun + 1);
}

}  // namespace throng::papers
