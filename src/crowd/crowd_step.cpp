// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "crowd/crowd_step.h"

#include <algorithm>
#include <numeric>

#include "core/random.h"

namespace throng {
namespace {

constexpr int kAhead = 16;

enum class Try { kMoved, kWall, kAvatar };

// Moves one avatar by (vx, vz) if ground and map allow.
inline Try try_move(const StepInput& in, Avatar& a, int32_t vx, int32_t vz) {
  const GroundPoint from = a.point();
  const GroundPoint to{int64_t{a.x} + vx, int64_t{a.z} + vz};
  if (to.x < 0 || to.z < 0 || to.x >= in.units_x || to.z >= in.units_z) return Try::kWall;
  uint32_t level = a.level;
  const int32_t x0 = from.cell_x(), z0 = from.cell_z(), x1 = to.cell_x(), z1 = to.cell_z();
  if (x0 != x1 || z0 != z1) {
    const bool same_tile = (x0 >> 6) == (x1 >> 6) && (z0 >> 6) == (z1 >> 6);
    const auto [low_x, high_x] = std::minmax(x0, x1);
    const auto [low_z, high_z] = std::minmax(z0, z1);
    if (!same_tile ||
        !in.ground->box_is_free(level, low_x & 63, high_x & 63, low_z & 63, high_z & 63)) {
      if (!walk(*in.ground, level, from, to, in.step_mm)) return Try::kWall;
    }
  }
  const int32_t y = in.ground->feet(level, to);
  const CollisionMap::Mark old_mark = in.map->mark(from, a.y);
  const CollisionMap::Mark mark = in.map->mark(to, y);
  if (!(mark == old_mark)) {
    in.map->clear(old_mark);
    if (!in.map->is_free(mark)) {
      in.map->set(old_mark);
      return Try::kAvatar;
    }
    in.map->set(mark);
  }
  a.x = static_cast<int32_t>(to.x);
  a.z = static_cast<int32_t>(to.z);
  a.y = y;
  a.level = level;
  return Try::kMoved;
}

}  // namespace

CrowdBlocks::CrowdBlocks(int32_t width, int32_t depth, int32_t pixel_cells, int32_t block_pixels) {
  const int32_t block_cells = pixel_cells * block_pixels;
  block_units_ = block_cells << kUnitBits;
  blocks_x_ = static_cast<uint32_t>(width / block_cells) + 1;
  blocks_z_ = static_cast<uint32_t>(depth / block_cells) + 1;
  first_.resize(static_cast<size_t>(blocks_x_) * blocks_z_ + 1);
}

void CrowdBlocks::sort(std::vector<Avatar>& avatars, std::vector<Avatar>& scratch) {
  std::fill(first_.begin(), first_.end(), 0);
  for (const Avatar& avatar : avatars) ++first_[block(avatar) + 1];
  for (auto& runs : runs_) runs.clear();
  std::inclusive_scan(first_.begin(), first_.end(), first_.begin());
  for (uint32_t z = 0, b = 0; z < blocks_z_; ++z) {
    for (uint32_t x = 0; x < blocks_x_; ++x, ++b) {
      if (first_[b] != first_[b + 1])
        runs_[(z & 1) * 2 + (x & 1)].push_back({first_[b], first_[b + 1]});
    }
  }
  scratch.resize(avatars.size());
  for (const Avatar& avatar : avatars) scratch[first_[block(avatar)]++] = avatar;
  avatars.swap(scratch);
  // Within a block, avatars of one level lie together: they read the same rows of it.
  for (const auto& runs : runs_) {
    for (const Run& run : runs) {
      std::stable_sort(avatars.begin() + run.first, avatars.begin() + run.last,
                       [](const Avatar& a, const Avatar& b) { return a.level < b.level; });
    }
  }
}

void move_run(const StepInput& in, Avatar* first, Avatar* last, StepCounts& counts) {
  for (Avatar* a = first; a != last; ++a) {
    // What the next avatars will read is on its way while this one moves.
    if (last - a > kAhead) in.ground->prefetch_record(a[kAhead].level);
    if (last - a > kAhead / 2) {
      const Avatar& next = a[kAhead / 2];
      in.ground->prefetch_row(next.level, next.z);
      in.map->prefetch(next.point());
    }
    const Try straight = try_move(in, *a, a->vx, a->vz);
    if (straight == Try::kMoved) {
      ++counts.moved;
      continue;
    }
    ++(straight == Try::kWall ? counts.blocked_by_wall : counts.blocked_by_avatar);
    const bool left = (random_u64(in.seed, a->id, in.step) & 1) != 0;
    const int32_t vx = left ? -a->vz : a->vz;
    const int32_t vz = left ? a->vx : -a->vx;
    a->vx = vx;
    a->vz = vz;
    if (try_move(in, *a, vx, vz) == Try::kMoved) {
      ++counts.moved;
    } else {
      ++counts.waited;
    }
  }
}

}  // namespace throng
