// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "crowd/crowd_step.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <span>

#include "core/prefetch.h"
#include "core/random.h"

// A run is moved in groups, and a group in passes, so that no pass waits for memory or guesses a
// branch: what is asked of most avatars is answered without one, and those that need more are put
// on a list for the next pass. The order in which claims commit (group, pass, place in the group)
// depends on nothing but the run.
namespace throng {
namespace {

constexpr size_t kGroup = 128;
constexpr int32_t kAheadLevel = 32;  // avatars between asking for a level's word and using it
constexpr int32_t kAheadRow = 16;
constexpr int32_t kShort = 2;  // longest plain step [cells]

// Numbers of avatars of a group.
class List {
 public:
  // Appends if `really`, without a branch. There is always room for one more.
  void add_if(bool really, uint16_t n) {
    at_[size_] = n;
    size_ += really;
  }
  [[nodiscard]] size_t size() const { return size_; }
  [[nodiscard]] std::span<const uint16_t> span() const { return {at_.data(), size_}; }

 private:
  std::array<uint16_t, kGroup> at_;  // not zeroed: this is made twice a group
  size_t size_ = 0;
};

// A plain step into another pixel.
struct Claim {
  uint32_t from;  // pixel
  uint16_t way;
  uint16_t n;
};

class Group {
 public:
  // Up to `readable`, avatars may be read ahead of their turn.
  Group(const StepInput& in, Avatar* avatars, const Avatar* readable)
      : in_(in), avatars_(avatars), last_readable_(readable - 1) {}

  // Each avatar of the list makes one step, or goes on the other list. What one pass asks for
  // arrives during the next, which deals with others.
  void move(const List& todo, List& blocked) {
    plan(todo);
    ask_for_levels();
    ask_for_pixels();
    ask_for_cells();
    claim(blocked);
    sort_uneven();
    climb(blocked);
    walk_on(blocked);
  }
  [[nodiscard]] uint64_t walls() const { return walls_; }

 private:
  void plan(const List& todo);
  void ask_for_levels() const;
  void ask_for_pixels();
  void ask_for_cells() const;
  void claim(List& blocked);
  void sort_uneven();
  void climb(List& blocked);
  void walk_on(List& blocked);

  const StepInput& in_;
  Avatar* avatars_;
  const Avatar* last_readable_;
  std::array<Claim, kGroup> claims_;
  std::array<CollisionMap::Slices, kGroup> slices_;  // of the claims
  size_t claims_size_ = 0;
  List uneven_;  // not plain: these go on one of the next two
  List slopes_;
  List walks_;
  uint64_t walls_ = 0;  // met
};

// All ones if true.
int32_t mask(bool condition) { return -static_cast<int32_t>(condition); }

// True if all cells of a box between two cells are set and lie on one tile of 64 rows. Boxes longer
// than kShort are not looked at.
[[gnu::always_inline]] inline bool box_is_set(const uint64_t* rows, int32_t x0, int32_t z0,
                                              int32_t x1, int32_t z1) {
  const bool near = (static_cast<uint32_t>((x0 ^ x1) | (z0 ^ z1)) < 64) &
                    (static_cast<uint32_t>(x1 - x0 + kShort) <= 2 * kShort) &
                    (static_cast<uint32_t>(z1 - z0 + kShort) <= 2 * kShort);
  // Of two cells that are at most two apart, the one between is all that lies between.
  const uint64_t common = rows[z0 & 63] & rows[((z0 + z1) >> 1) & 63] & rows[z1 & 63];
  const uint64_t all = (common >> (x0 & 63)) & (common >> (((x0 + x1) >> 1) & 63)) &
                       (common >> (x1 & 63)) & static_cast<uint64_t>(near);
  return all != 0;
}

// Whoever stays in his pixel on plain cells moves at once: nobody can object. Arithmetic instead of
// branches: which way an avatar goes is as good as random, and a wrong guess costs 20 cycles.
void Group::plan(const List& todo) {
  const PixelGrid grid = in_.map->grid();
  const CrowdGround::Plain plain = in_.ground->plain();
  size_t claimed = 0;
  for (const uint16_t n : todo.span()) {
    Avatar& a = avatars_[n];
    plain.prefetch(std::min<const Avatar*>(&a + kAheadLevel, last_readable_)->level);
    const Avatar& next = *std::min<const Avatar*>(&a + kAheadRow, last_readable_);
    throng::prefetch(&plain[next.level][(next.z >> kUnitBits) & 63]);

    const int32_t x0 = a.x >> kUnitBits, z0 = a.z >> kUnitBits;
    const int32_t x1 = (a.x + a.vx) >> kUnitBits, z1 = (a.z + a.vz) >> kUnitBits;
    const bool is_plain = box_is_set(plain[a.level], x0, z0, x1, z1);
    const int32_t px = grid.pixel(x0), pz = grid.pixel(z0);
    const int32_t dx = grid.pixel(x1) - px, dz = grid.pixel(z1) - pz;
    const bool stays = (dx | dz) == 0;
    claims_[claimed] = {in_.map->pixel(px, pz), static_cast<uint16_t>(CollisionMap::way(dx, dz)),
                        n};
    claimed += is_plain & !stays;
    uneven_.add_if(!is_plain, n);
    const int32_t go = mask(is_plain & stays);
    a.x += a.vx & go;
    a.z += a.vz & go;
  }
  claims_size_ = claimed;
}

void Group::ask_for_pixels() {
  const CollisionMap& map = *in_.map;
  for (size_t i = 0; i < claims_size_; ++i) {
    const Claim& c = claims_[i];
    slices_[i] = map.slices(avatars_[c.n].y);
    map.prefetch(slices_[i], c.from, c.way);
  }
}

void Group::claim(List& blocked) {
  CollisionMap& map = *in_.map;
  for (size_t i = 0; i < claims_size_; ++i) {
    const Claim& c = claims_[i];
    Avatar& a = avatars_[c.n];
    const bool moved = map.move_by_one(slices_[i], c.from, c.way);
    a.x += a.vx & mask(moved);
    a.z += a.vz & mask(moved);
    blocked.add_if(!moved, c.n);
  }
}

// A level of which nothing but its own cells can be reached inside the tile: as world/walk.h wants
// it, for the compiler to forget all that cannot happen.
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

// Puts the body at `to` if nobody is there.
bool commit(CollisionMap& map, Avatar& a, GroundPoint to, uint32_t level, int32_t y) {
  const CollisionMap::Mark old_mark = map.mark(a.point(), a.y);
  const CollisionMap::Mark mark = map.mark(to, y);
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

GroundPoint target(const Avatar& a) { return {int64_t{a.x} + a.vx, int64_t{a.z} + a.vz}; }

void Group::ask_for_levels() const {
  for (const uint16_t n : uneven_.span()) {
    const Avatar& a = avatars_[n];
    in_.ground->prefetch_walk(a.level);
    in_.ground->prefetch_tile((a.x + a.vx) >> (kUnitBits + 6), (a.z + a.vz) >> (kUnitBits + 6));
  }
}

void Group::ask_for_cells() const {
  for (const uint16_t n : uneven_.span()) {
    const Avatar& a = avatars_[n];
    const int32_t x = (a.x + a.vx) >> kUnitBits, z = (a.z + a.vz) >> kUnitBits;
    in_.ground->prefetch_cell(a.level, x, z);
    in_.ground->prefetch_levels(x >> 6, z >> 6);
    in_.map->prefetch(a.point(), a.y);
  }
}

// Slopes, where every cell in reach is legal, from walls, steps and edges of tiles.
void Group::sort_uneven() {
  const CrowdGround& ground = *in_.ground;
  for (const uint16_t n : uneven_.span()) {
    const Avatar& a = avatars_[n];
    const int32_t x0 = a.x >> kUnitBits, z0 = a.z >> kUnitBits;
    const int32_t x1 = (a.x + a.vx) >> kUnitBits, z1 = (a.z + a.vz) >> kUnitBits;
    const CrowdGround::Walk level = ground.walk(a.level);
    const bool is_slope = level.is_step_safe & box_is_set(level.legal, x0, z0, x1, z1);
    slopes_.add_if(is_slope, n);
    walks_.add_if(!is_slope, n);
  }
  for (const uint16_t n : walks_.span()) {
    const Avatar& a = avatars_[n];
    const int32_t x = (a.x + a.vx) >> kUnitBits, z = (a.z + a.vz) >> kUnitBits;
    if ((x >> 6) == (a.x >> (kUnitBits + 6)) && (z >> 6) == (a.z >> (kUnitBits + 6))) continue;
    ground.for_tile(x >> 6, z >> 6, a.y - in_.step_mm, a.y + in_.step_mm,
                    [&](uint32_t level) { ground.prefetch_cell(level, x, z); });
  }
}

void Group::climb(List& blocked) {
  for (const uint16_t n : slopes_.span()) {
    Avatar& a = avatars_[n];
    const GroundPoint to = target(a);
    blocked.add_if(!commit(*in_.map, a, to, a.level, in_.ground->feet(a.level, to)), n);
  }
}

void Group::walk_on(List& blocked) {
  const CrowdGround& ground = *in_.ground;
  for (const uint16_t n : walks_.span()) {
    Avatar& a = avatars_[n];
    const GroundPoint from = a.point(), to = target(a);
    uint32_t level = a.level;
    const CrowdGround::Walk here = ground.walk(level);
    const bool on_tile = ((from.x ^ to.x) | (from.z ^ to.z)) >> (kUnitBits + 6) == 0;
    const bool is_open = here.is_alone && on_tile
                             ? walk(LoneLevel{here.legal}, level, from, to, in_.step_mm)
                             : to.x >= 0 && to.z >= 0 && to.x < in_.units_x && to.z < in_.units_z &&
                                   walk(ground, level, from, to, in_.step_mm);
    const bool moved = is_open && commit(*in_.map, a, to, level, ground.feet(level, to));
    walls_ += !is_open;
    blocked.add_if(!moved, n);
  }
}

// To the left or to the right, by chance.
void turn(const StepInput& in, Avatar& a) {
  const bool left = (random_u64(in.seed, a.id, in.step) & 1) != 0;
  const int32_t vx = left ? -a.vz : a.vz;
  a.vz = left ? a.vx : -a.vx;
  a.vx = vx;
}

}  // namespace

void move_run(const StepInput& in, Avatar* first, Avatar* last, const Avatar* readable,
              StepCounts& counts) {
  for (Avatar* a = first; a < last; a += kGroup) {
    List all, blocked, waits;
    for (int64_t n = 0; n < std::min<int64_t>(kGroup, last - a); ++n) {
      all.add_if(true, static_cast<uint16_t>(n));
    }
    Group straight(in, a, readable);
    straight.move(all, blocked);
    for (const uint16_t n : blocked.span()) turn(in, a[n]);
    Group turned(in, a, a + all.size());
    turned.move(blocked, waits);
    counts.moved += all.size() - waits.size();
    counts.waited += waits.size();
    counts.blocked_by_wall += straight.walls();
    counts.blocked_by_avatar += blocked.size() - straight.walls();
  }
}

}  // namespace throng
