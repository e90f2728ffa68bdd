// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "crowd/sense_kernel.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "crowd/sense_kernel.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace throng {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using DI = hn::CappedTag<int32_t, 16>;
using DF = hn::RebindToFloat<DI>;
using DU = hn::RebindToUnsigned<DI>;

void FindSeen(const Places& places, uint32_t first, uint32_t last, const Eye& eye,
              SeenLists& lists) {
  const DI d;
  const DF df;
  const DU du;
  const auto x = hn::Set(d, eye.x), z = hn::Set(d, eye.z), y = hn::Set(d, eye.y);
  const auto most = hn::Set(df, eye.most), touch = hn::Set(df, eye.touch);
  const auto tall = hn::Set(d, eye.tall), touch_tall = hn::Set(d, eye.touch_tall);
  const auto self = hn::Set(du, eye.self);
  for (uint32_t i = first; i < last; i += static_cast<uint32_t>(hn::Lanes(d))) {
    const auto dx = hn::ConvertTo(df, hn::Sub(hn::LoadU(d, places.x + i), x));
    const auto dz = hn::ConvertTo(df, hn::Sub(hn::LoadU(d, places.z + i), z));
    const auto dy = hn::Abs(hn::Sub(hn::LoadU(d, places.y + i), y));
    const auto square = hn::Add(hn::Mul(dx, dx), hn::Mul(dz, dz));
    const auto entry = hn::Iota(du, i);
    const auto others = hn::AndNot(hn::Eq(entry, self), hn::FirstN(du, last - i));
    const auto near = hn::And(hn::RebindMask(du, hn::Lt(square, most)), others);
    const auto seen = hn::And(near, hn::RebindMask(du, hn::Lt(dy, tall)));
    hn::CompressStore(entry, seen, du, lists.entries + lists.seen);
    lists.seen +=
        hn::CompressStore(square, hn::RebindMask(df, seen), df, lists.squares + lists.seen);
    const auto close = hn::And(hn::RebindMask(du, hn::Lt(square, touch)), others);
    const auto touched = hn::And(close, hn::RebindMask(du, hn::Lt(dy, touch_tall)));
    if (hn::AllFalse(du, touched)) continue;
    lists.touches += hn::CompressStore(entry, touched, du, lists.touched + lists.touches);
  }
}

// Of each, how many are nearer.
size_t KeepNearest(SeenLists& lists, size_t most) {
  const DF d;
  const size_t lanes = hn::Lanes(d);
  size_t kept = 0;
  for (size_t n = 0; n < lists.seen; ++n) {
    const float square = lists.squares[n];
    const auto here = hn::Set(d, square);
    size_t nearer = 0;
    for (size_t m = 0; m < lists.seen; m += lanes) {
      const auto valid = hn::FirstN(d, lists.seen - m);
      nearer += hn::CountTrue(d, hn::And(valid, hn::Lt(hn::LoadU(d, lists.squares + m), here)));
    }
    lists.entries[kept] = lists.entries[n];
    kept += nearer < most;
  }
  return kept;
}

}  // namespace HWY_NAMESPACE
}  // namespace throng
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace throng {

HWY_EXPORT(FindSeen);
HWY_EXPORT(KeepNearest);

void find_seen(const Places& places, uint32_t first, uint32_t last, const Eye& eye,
               SeenLists& lists) {
  HWY_DYNAMIC_DISPATCH(FindSeen)(places, first, last, eye, lists);
}
size_t keep_nearest(SeenLists& lists, size_t most) {
  return lists.seen <= most ? lists.seen : HWY_DYNAMIC_DISPATCH(KeepNearest)(lists, most);
}

}  // namespace throng
#endif
