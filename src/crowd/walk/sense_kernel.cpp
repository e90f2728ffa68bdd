// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "crowd/walk/sense_kernel.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "crowd/walk/sense_kernel.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep
#include <hwy/highway.h>

#include "core/arrays/compress-inl.h"

// Finds the bodies within sight, and the nearest of them, a vector at a time. The first is linear
// in the bodies around, the second quadratic in those within sight.
HWY_BEFORE_NAMESPACE();
namespace throng::crowd {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;
namespace simd = throng::HWY_NAMESPACE;

using DI = hn::CappedTag<int32_t, 16>;
using DF = hn::RebindToFloat<DI>;
using DU = hn::RebindToUnsigned<DI>;

// A body without sight (`max_square` 0) only finds those that it could touch.
template <bool kSees>
HWY_INLINE void FindAround(const Places& places, std::span<const Entries> around, const Eye& eye,
                           SeenLists& result) {
  const DI d;
  const DF df;
  const DU du;
  const auto x = hn::Set(d, eye.x), z = hn::Set(d, eye.z), y = hn::Set(d, eye.y);
  const auto max_square = hn::Set(df, eye.max_square), touch = hn::Set(df, eye.touch);
  const auto tall = hn::Set(d, eye.tall), touch_tall = hn::Set(d, eye.touch_tall);
  const auto self = hn::Set(du, eye.self);
  const auto first = hn::Iota(du, 0);  // Iota(du, i) may use memory.
  SeenLists lists = result;
  const auto query = [&](uint32_t i, uint32_t last) HWY_ATTR {
    const auto dx = hn::ConvertTo(df, hn::Sub(hn::LoadU(d, places.x + i), x));
    const auto dz = hn::ConvertTo(df, hn::Sub(hn::LoadU(d, places.z + i), z));
    const auto square = hn::Add(hn::Mul(dx, dx), hn::Mul(dz, dz));
    const auto entry = hn::Add(first, hn::Set(du, i));
    const auto others = hn::AndNot(hn::Eq(entry, self), hn::FirstN(du, last - i));
    const auto close = hn::And(hn::RebindMask(du, hn::Lt(square, touch)), others);
    const bool touches = !hn::AllFalse(du, close);
    if (!kSees && !touches) return;
    const auto dy = hn::Abs(hn::Sub(hn::LoadU(d, places.y + i), y));
    if (kSees) {
      const auto near = hn::And(hn::RebindMask(du, hn::Lt(square, max_square)), others);
      const auto seen = hn::And(near, hn::RebindMask(du, hn::Lt(dy, tall)));
      // Compressing into memory is slow on some machines; the lists have space for a whole vector.
      hn::StoreU(simd::compress(entry, seen), du, lists.entries + lists.seen);
      hn::StoreU(simd::compress(square, hn::RebindMask(df, seen)), df, lists.squares + lists.seen);
      lists.seen += hn::CountTrue(du, seen);
    }
    if (!touches) return;
    const auto touched = hn::And(close, hn::RebindMask(du, hn::Lt(dy, touch_tall)));
    hn::StoreU(simd::compress(entry, touched), du, lists.touched + lists.touches);
    lists.touches += hn::CountTrue(du, touched);
  };
  const auto lanes = static_cast<uint32_t>(hn::Lanes(d));
  for (const Entries& piece : around) {
    for (uint32_t i = piece.first; i < piece.last; i += lanes) query(i, piece.last);
  }
  result = lists;
}

void FindSeen(const Places& places, std::span<const Entries> around, const Eye& eye,
              SeenLists& lists) {
  if (eye.max_square > 0) {
    FindAround<true>(places, around, eye, lists);
  } else {
    FindAround<false>(places, around, eye, lists);
  }
}

// For each entry, how many are nearer; a vector of them at a time against all, one by one.
size_t KeepNearest(SeenLists& lists, size_t max_count) {
  const DF d;
  const DI di;
  const DU du;
  const size_t lanes = hn::Lanes(d);
  const auto too_many = hn::Set(di, static_cast<int32_t>(max_count));
  size_t kept = 0;
  for (size_t n = 0; n < lists.seen; n += lanes) {
    const auto here = hn::LoadU(d, lists.squares + n);
    auto left = too_many;  // ranks, downwards
    for (size_t m = 0; m < lists.seen; ++m) {
      const auto nearer = hn::Lt(hn::Set(d, lists.squares[m]), here);
      left = hn::Add(left, hn::VecFromMask(di, hn::RebindMask(di, nearer)));
    }
    const auto valid = hn::FirstN(du, lists.seen - n);
    const auto keeps = hn::And(valid, hn::RebindMask(du, hn::Gt(left, hn::Zero(di))));
    const auto entries = hn::LoadU(du, lists.entries + n);
    hn::StoreU(simd::compress(entries, keeps), du, lists.entries + kept);
    kept += hn::CountTrue(du, keeps);
  }
  return kept;
}

}  // namespace HWY_NAMESPACE
}  // namespace throng::crowd
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace throng::crowd {

HWY_EXPORT(FindSeen);
HWY_EXPORT(KeepNearest);

void find_seen(const Places& places, std::span<const Entries> around, const Eye& eye,
               SeenLists& lists) {
  HWY_DYNAMIC_DISPATCH(FindSeen)(places, around, eye, lists);
}
size_t keep_nearest(SeenLists& lists, size_t max_count) {
  return lists.seen <= max_count ? lists.seen : HWY_DYNAMIC_DISPATCH(KeepNearest)(lists, max_count);
}

}  // namespace throng::crowd
#endif
