// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "crowd/ground/plan_steps.h"

#include <algorithm>
#include <cstring>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "crowd/ground/plan_steps.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep
#include <hwy/highway.h>

// The step of a vector of avatars over flat blocks, without branches. Constant time an avatar.
HWY_BEFORE_NAMESPACE();
namespace throng::crowd {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using DI = hn::CappedTag<int32_t, 8>;
using DU = hn::RebindToUnsigned<DI>;
using I = hn::Vec<DI>;
using U = hn::Vec<DU>;
constexpr size_t kMaxLanes = 8;

HWY_INLINE uint64_t bits_of(hn::Mask<DI> mask) {
#if HWY_TARGET == HWY_SCALAR
  return static_cast<uint64_t>(hn::CountTrue(DI(), mask));
#else
  alignas(8) uint8_t bytes[8] = {};
  hn::StoreMaskBits(DI(), mask, bytes);
  return bytes[0];
#endif
}

struct Fields {
  I x, z, vx, vz, level;
};

HWY_INLINE Fields load(const Avatar* a) {
  const DI d;
#if HWY_TARGET == HWY_SCALAR
  return {hn::Set(d, a->x), hn::Set(d, a->z), hn::Set(d, a->vx), hn::Set(d, a->vz),
          hn::Set(d, static_cast<int32_t>(a->level))};
#else
  // Fields in fours: x z vx vz of an avatar, then y level id reserved of the same.
  const int32_t* p = &a->x;
  I x0, z0, vx0, vz0, x1, z1, vx1, vz1;
  hn::LoadInterleaved4(d, p, x0, z0, vx0, vz0);
  hn::LoadInterleaved4(d, p + 4 * hn::Lanes(d), x1, z1, vx1, vz1);
  return {hn::ConcatEven(d, x1, x0), hn::ConcatEven(d, z1, z0), hn::ConcatEven(d, vx1, vx0),
          hn::ConcatEven(d, vz1, vz0), hn::ConcatOdd(d, z1, z0)};
#endif
}

// High halves of the products, as PixelGrid::pixel computes them.
HWY_INLINE U pixel(U cell, U magic) {
#if HWY_TARGET == HWY_SCALAR
  const uint64_t product = uint64_t{hn::GetLane(cell)} * hn::GetLane(magic);
  return hn::Set(DU(), static_cast<uint32_t>(product >> 32));
#else
  const DU d;
  const auto even = hn::BitCast(d, hn::MulEven(cell, magic));
  const auto odd = hn::BitCast(d, hn::MulEven(hn::Shuffle2301(cell), magic));
  return hn::OddEven(odd, hn::Shuffle2301(even));
#endif
}

// The row of blocks that contains a point, of the 32 bits that hold it and the next row.
HWY_INLINE U blocks_at(const LevelLine* lines, I level, I z) {
  const DI d;
  const DU du;
  const I row = hn::ShiftRight<world::kUnitBits + 2>(z);
  const I pair = hn::ShiftLeft<1>(hn::And(row, hn::Set(d, 14)));
  const auto* base = reinterpret_cast<const int32_t*>(lines);
  const I words = hn::GatherOffset(d, base, hn::Add(hn::ShiftLeft<6>(level), pair));
  const I half = hn::ShiftLeft<4>(hn::And(row, hn::Set(d, 1)));
  return hn::Shr(hn::BitCast(du, words), hn::BitCast(du, half));
}

PlannedSteps PlanSteps(const LevelLine* lines, PixelGrid grid, Avatar* avatars, size_t size) {
  const DI d;
  const DU du;
  const size_t lanes = hn::Lanes(d);
  const U magic = hn::Set(du, static_cast<uint32_t>(grid.magic()));
  const I fifteen = hn::Set(d, 15);
  PlannedSteps planned;
  for (size_t i = 0; i < size; i += lanes) {
    const size_t count = std::min(lanes, size - i);
    Avatar* a = avatars + i;
    Avatar rest[kMaxLanes];
    if (count < lanes) {
      std::copy_n(a, count, rest);
      a = rest;
    }
    const Fields f = load(a);
    const I x1 = hn::Add(f.x, f.vx), z1 = hn::Add(f.z, f.vz);
    // LevelLine::box_is_flat, word by word
    const U common = hn::And(blocks_at(lines, f.level, f.z), blocks_at(lines, f.level, z1));
    const I bx0 = hn::And(hn::ShiftRight<world::kUnitBits + 2>(f.x), fifteen);
    const I bx1 = hn::And(hn::ShiftRight<world::kUnitBits + 2>(x1), fifteen);
    const U both =
        hn::And(hn::Shr(common, hn::BitCast(du, bx0)), hn::Shr(common, hn::BitCast(du, bx1)));
    const I moved = hn::Or(hn::Xor(f.x, x1), hn::Xor(f.z, z1));
    const auto on_tile = hn::Eq(hn::ShiftRight<world::kUnitBits + 6>(moved), hn::Zero(d));
    const auto is_flat = hn::And(on_tile, hn::TestBit(hn::BitCast(d, both), hn::Set(d, 1)));

    const auto pixel_of = [&](I v) {
      return pixel(hn::BitCast(du, hn::ShiftRight<world::kUnitBits>(v)), magic);
    };
    const U across =
        hn::Or(hn::Xor(pixel_of(f.x), pixel_of(x1)), hn::Xor(pixel_of(f.z), pixel_of(z1)));
    const auto same_pixel = hn::Eq(hn::BitCast(d, across), hn::Zero(d));
    const auto goes = hn::And(is_flat, same_pixel);
    alignas(64) int32_t places[2 * kMaxLanes];
    hn::StoreInterleaved2(hn::IfThenElse(goes, x1, f.x), hn::IfThenElse(goes, z1, f.z), d, places);
    for (size_t n = 0; n < count; ++n) std::memcpy(&avatars[i + n].x, places + 2 * n, 8);

    const uint64_t here = (uint64_t{1} << count) - 1;
    const uint64_t flat = bits_of(is_flat) & here, stays = bits_of(goes) & here;
    planned.stays |= stays << i;
    planned.leaves |= (flat & ~stays) << i;
  }
  return planned;
}

}  // namespace HWY_NAMESPACE
}  // namespace throng::crowd
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace throng::crowd {

HWY_EXPORT(PlanSteps);

PlannedSteps plan_steps(const LevelLine* lines, PixelGrid grid, Avatar* avatars, size_t size) {
  return HWY_DYNAMIC_DISPATCH(PlanSteps)(lines, grid, avatars, size);
}

}  // namespace throng::crowd
#endif
