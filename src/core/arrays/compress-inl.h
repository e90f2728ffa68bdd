// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <hwy/highway.h>

#include <array>
#include <cstdint>

#ifndef THRONG_CORE_COMPRESS_TABLE
#define THRONG_CORE_COMPRESS_TABLE
namespace throng {

/// By mask of 8 lanes: those that are set, then the others, 4 bits each, the first lowest.
inline constexpr std::array<uint32_t, 256> kCompressOrders = [] {
  std::array<uint32_t, 256> orders{};
  for (uint32_t mask = 0; mask < 256; ++mask) {
    uint32_t place = 0;
    for (const uint32_t wanted : {1u, 0u}) {
      for (uint32_t lane = 0; lane < 8; ++lane) {
        if ((mask >> lane & 1) == wanted) orders[mask] |= lane << (4 * place++);
      }
    }
  }
  return orders;
}();
alignas(32) inline constexpr std::array<uint32_t, 8> kCompressShifts{0, 4, 8, 12, 16, 20, 24, 28};

}  // namespace throng
#endif

#if defined(THRONG_CORE_COMPRESS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef THRONG_CORE_COMPRESS_INL_H_
#undef THRONG_CORE_COMPRESS_INL_H_
#else
#define THRONG_CORE_COMPRESS_INL_H_
#endif

/// Compiled once for each target, so it is included after <hwy/highway.h> by files that use
/// foreach_target.
HWY_BEFORE_NAMESPACE();
namespace throng {
namespace HWY_NAMESPACE {

/// The lanes of a vector that a mask has, first; the others do not matter. [lanes of 32 bits]
/// As Highway's Compress, but that of version 1.0 for AVX2 has its table as a local constant, of
/// which g++ 12 makes a copy of 1 KiB in each call: that took a quarter of a crowd's step.
template <class V, class M>
HWY_INLINE V compress(V v, M mask) {
  namespace hn = hwy::HWY_NAMESPACE;
  using D = hn::DFromV<V>;
  static_assert(sizeof(hn::TFromD<D>) == 4);
  if constexpr (HWY_TARGET == HWY_AVX2 && D::kPrivateN == 8) {
    const D d;
    const hn::RebindToUnsigned<D> du;
    const hn::RebindToSigned<D> di;
    uint8_t bits[8] = {};
    hn::StoreMaskBits(d, mask, bits);
    const auto orders =
        hn::Shr(hn::Set(du, kCompressOrders[bits[0]]), hn::Load(du, kCompressShifts.data()));
    const auto lanes = hn::BitCast(di, hn::And(orders, hn::Set(du, 7)));
    return hn::TableLookupLanes(v, hn::IndicesFromVec(d, lanes));
  } else {
    return hn::Compress(v, mask);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace throng
HWY_AFTER_NAMESPACE();

#endif
