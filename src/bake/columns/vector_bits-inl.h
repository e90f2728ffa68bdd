// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#if defined(THRONG_BAKE_VECTOR_BITS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef THRONG_BAKE_VECTOR_BITS_INL_H_
#undef THRONG_BAKE_VECTOR_BITS_INL_H_
#else
#define THRONG_BAKE_VECTOR_BITS_INL_H_
#endif

#include <hwy/highway.h>

#include <cstdint>

/// Small vector helpers that all kernels of the bake share; compiled once for each target, so it is
/// included after <hwy/highway.h> by files that use foreach_target.
HWY_BEFORE_NAMESPACE();
namespace throng::bake {
namespace HWY_NAMESPACE {

/// Bit i is lane i of the mask; bits past the lanes are 0. [at most 64 lanes]
template <class D>
HWY_INLINE uint64_t bits_of(D d, hwy::HWY_NAMESPACE::Mask<D> mask) {
  namespace hn = hwy::HWY_NAMESPACE;
  if constexpr (HWY_TARGET == HWY_SCALAR) {
    return hn::AllTrue(d, mask) ? 1 : 0;
  } else {
    alignas(8) uint8_t bytes[8] = {};
    hn::StoreMaskBits(d, mask, bytes);
    uint64_t bits;
    __builtin_memcpy(&bits, bytes, 8);
    return hn::Lanes(d) < 64 ? bits & ((uint64_t{1} << hn::Lanes(d)) - 1) : bits;
  }
}

/// Lane i of the mask is bit i; bits past the lanes do not matter. [at most 64 lanes]
template <class D>
HWY_INLINE hwy::HWY_NAMESPACE::Mask<D> mask_of(D d, uint64_t bits) {
  namespace hn = hwy::HWY_NAMESPACE;
  if constexpr (HWY_TARGET == HWY_SCALAR) {
    return hn::MaskFromVec(hn::Set(d, static_cast<hn::TFromD<D>>((bits & 1) != 0 ? -1 : 0)));
  } else {
    alignas(8) uint8_t bytes[8];
    __builtin_memcpy(bytes, &bits, 8);
    return hn::LoadMaskBits(d, bytes);
  }
}

/// 0, 1, 2 ... as a table: Highway 1.0 makes an Iota out of sixteen single stores and one load that
/// has to wait for them all, which took a quarter of the time of all columns.
template <class T>
alignas(64) inline constexpr T kCounting[16] = {0, 1, 2,  3,  4,  5,  6,  7,
                                                8, 9, 10, 11, 12, 13, 14, 15};

/// Lane i holds first + i. [at most 16 lanes]
template <class D>
HWY_INLINE hwy::HWY_NAMESPACE::Vec<D> counting_from(D d, hwy::HWY_NAMESPACE::TFromD<D> first) {
  namespace hn = hwy::HWY_NAMESPACE;
  return hn::Add(hn::Set(d, first), hn::Load(d, kCounting<hn::TFromD<D>>));
}

}  // namespace HWY_NAMESPACE
}  // namespace throng::bake
HWY_AFTER_NAMESPACE();

#endif  // the toggle
