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

size_t FindSeen(const Places& places, uint32_t first, uint32_t last, const Eye& eye, float* squares,
                uint32_t* entries) {
  const DI d;
  const DF df;
  const DU du;
  const auto x = hn::Set(d, eye.x), z = hn::Set(d, eye.z), y = hn::Set(d, eye.y);
  const auto most = hn::Set(df, eye.most);
  const auto tall = hn::Set(d, eye.tall);
  size_t found = 0;
  for (uint32_t i = first; i < last; i += static_cast<uint32_t>(hn::Lanes(d))) {
    const auto dx = hn::ConvertTo(df, hn::Sub(hn::LoadU(d, places.x + i), x));
    const auto dz = hn::ConvertTo(df, hn::Sub(hn::LoadU(d, places.z + i), z));
    const auto dy = hn::Abs(hn::Sub(hn::LoadU(d, places.y + i), y));
    const auto square = hn::Add(hn::Mul(dx, dx), hn::Mul(dz, dz));
    const auto here = hn::RebindMask(d, hn::FirstN(d, last - i));
    const auto same_floor = hn::And(hn::Lt(dy, tall), here);
    const auto seen = hn::And(hn::Lt(square, most), hn::RebindMask(df, same_floor));
    const auto entry = hn::Iota(du, i);
    hn::CompressStore(entry, hn::RebindMask(du, seen), du, entries + found);
    found += hn::CompressStore(square, seen, df, squares + found);
  }
  return found;
}

}  // namespace HWY_NAMESPACE
}  // namespace throng
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace throng {

HWY_EXPORT(FindSeen);

size_t find_seen(const Places& places, uint32_t first, uint32_t last, const Eye& eye,
                 float* squares, uint32_t* entries) {
  return HWY_DYNAMIC_DISPATCH(FindSeen)(places, first, last, eye, squares, entries);
}

}  // namespace throng
#endif
