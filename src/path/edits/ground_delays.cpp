// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "path/edits/ground_delays.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

// Lengths times delays, square by square along a segment. Time: linear in the squares.
namespace throng::path {
namespace {

// Delay counts more than once, because each that joins a queue also delays all behind it: by the
// volume-delay function of [BPR64], t = t0 (1 + a v^4), by four times what it waits itself. Weights
// were measured: docs/design/017-congestion.md.
double slowed(uint16_t share) {
  constexpr double kFree = GroundDelays::kFree;
  const double longer =
      share * GroundDelays::kMaxDelayed <= kFree ? GroundDelays::kMaxDelayed : kFree / share;
  return 1 + GroundDelays::kWeight * (longer - 1);
}

}  // namespace

GroundDelays::GroundDelays(size_t levels) : shares_(levels), is_slow_(levels, 0) {
  for (Shares& shares : shares_) shares.fill(kFree);
}

size_t GroundDelays::direction(int64_t dx, int64_t dz) {
  if (std::llabs(dx) >= std::llabs(dz)) return dx >= 0 ? 0 : 2;
  return dz >= 0 ? 1 : 3;
}

GroundDelays::Heading GroundDelays::heading(world::GroundPoint from, world::GroundPoint to) {
  constexpr double kCosine = 0.5, kLeast = 0.02;
  const auto dx = static_cast<double>(to.x - from.x), dz = static_cast<double>(to.z - from.z);
  const double size = std::sqrt(dx * dx + dz * dz);
  Heading heading;
  if (!(size > 0)) return heading;
  const std::array<double, kDirections> cosines{dx / size, dz / size, -dx / size, -dz / size};
  for (size_t d = 0; d < kDirections; ++d) {
    const double part = std::clamp(cosines[d] + kCosine, 0.0, 1.0);
    heading.weights[d] = std::max(part * part, kLeast);
  }
  return heading;
}

double GroundDelays::factor(uint32_t level, int32_t x, int32_t z, const Heading& heading) const {
  if (!is_slow(level)) return 1;
  const uint16_t* share = &shares_[level][first_bin(x, z)];
  double more = 0;
  for (size_t d = 0; d < kDirections; ++d) {
    if (share[d] != kFree) more = std::max(more, (slowed(share[d]) - 1) * heading.weights[d]);
  }
  return 1 + more;
}

double GroundDelays::length(uint32_t level, world::GroundPoint from, world::GroundPoint to) const {
  constexpr int32_t kBits = 4 + world::kUnitBits;  // of a square
  static_assert(1 << 4 == kSide);
  const auto dx = static_cast<double>(to.x - from.x), dz = static_cast<double>(to.z - from.z);
  const double size = std::sqrt(dx * dx + dz * dz) * (1.0 / world::kUnitsPerCell);
  if (!is_slow(level)) return size;
  const Heading towards = heading(from, to);
  int64_t x = from.x >> kBits, z = from.z >> kBits;
  const int64_t end_x = to.x >> kBits, end_z = to.z >> kBits;
  const int64_t step_x = end_x > x ? 1 : -1, step_z = end_z > z ? 1 : -1;
  const auto factor_here = [&] {
    return factor(level, world::in_tile(static_cast<int32_t>(x * kSide)),
                  world::in_tile(static_cast<int32_t>(z * kSide)), towards);
  };
  double t = 0, sum = 0;
  while (x != end_x || z != end_z) {
    // Where the segment crosses the next line of the squares along each axis.
    constexpr double kNot = 2;
    const double at_x =
        x == end_x
            ? kNot
            : static_cast<double>(((step_x > 0 ? x + 1 : x) * (int64_t{1} << kBits)) - from.x) / dx;
    const double at_z =
        z == end_z
            ? kNot
            : static_cast<double>(((step_z > 0 ? z + 1 : z) * (int64_t{1} << kBits)) - from.z) / dz;
    const double next = std::clamp(std::min(at_x, at_z), t, 1.0);
    sum += (next - t) * factor_here();
    t = next;
    if (at_x <= at_z) {
      x += step_x;
    } else {
      z += step_z;
    }
  }
  return (sum + (1 - t) * factor_here()) * size;
}

}  // namespace throng::path
