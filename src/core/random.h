// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

/// Counter-based random numbers: a pure function of (seed, stream, counter), so that threads,
/// order and machine never matter. Three rounds of a 64-bit mixer (SplitMix64's finaliser).
namespace throng {

constexpr uint64_t mix64(uint64_t x) {
  x ^= x >> 30;
  x *= 0xbf58476d1ce4e5b9ULL;
  x ^= x >> 27;
  x *= 0x94d049bb133111ebULL;
  return x ^ (x >> 31);
}

constexpr uint64_t random_u64(uint64_t seed, uint64_t stream, uint64_t counter) {
  return mix64(mix64(mix64(seed + 0x9e3779b97f4a7c15ULL) ^ stream) +
               counter * 0x9e3779b97f4a7c15ULL);
}

/// Uniform in [0, 1), 53 bits.
constexpr double random_unit(uint64_t seed, uint64_t stream, uint64_t counter) {
  return static_cast<double>(random_u64(seed, stream, counter) >> 11) * 0x1p-53;
}

/// Uniform in [0, n) for n >= 1, by the high half of a 128-bit product.
constexpr uint64_t random_below(uint64_t seed, uint64_t stream, uint64_t counter, uint64_t n) {
  return static_cast<uint64_t>(
      (static_cast<unsigned __int128>(random_u64(seed, stream, counter)) * n) >> 64);
}

}  // namespace throng
