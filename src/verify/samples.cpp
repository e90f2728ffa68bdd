// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "verify/samples.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/random.h"

// Draws places, moves and points of the surface, and tests each with the exact body.
namespace throng::verify {
namespace {

constexpr double kShortestMove = 0.02;   ///< [m]
constexpr double kLongestMove = 3;       ///< [m]
constexpr size_t kLargestIsland = 1600;  ///< Lattice points of half a cell: 4 m^2 at 0.1 m cells.

// Streams of our own: a world that draws its places from `seed` must not share them.
constexpr uint64_t kDirectionSalt = 0x646972656374;
constexpr uint64_t kLengthSalt = 0x6c656e677468;

// A direction without a sine, uniform by rejection.
std::array<double, 2> random_direction(uint64_t seed, uint64_t n) {
  for (uint64_t k = 0;; k += 2) {
    const double x = 2 * random_unit(seed ^ kDirectionSalt, n, k) - 1;
    const double z = 2 * random_unit(seed ^ kDirectionSalt, n, k + 1) - 1;
    const double squared = x * x + z * z;
    if (squared > 1 || squared < 0.01) continue;
    const double size = std::sqrt(squared);
    return {x / size, z / size};
  }
}

// A legal move from `start`: as drawn, or, where it is blocked, nearly as far as the world allows,
// which is where bodies come closest to walls.
std::optional<Place> random_move(const Claims& claims, const Place& start, uint64_t seed,
                                 uint64_t n) {
  const auto direction = random_direction(seed, n);
  const double u = random_unit(seed ^ kLengthSalt, n, 0);
  const double length = kShortestMove + (kLongestMove - kShortestMove) * u * u * u;
  const auto try_length = [&](double l) -> std::optional<Place> {
    const MoveResult result = claims.move(start, direction[0] * l, direction[1] * l);
    if (result.end == MoveEnd::kArrived) return result.place;
    return std::nullopt;
  };
  if (auto whole = try_length(length)) return whole;
  std::optional<Place> best;
  double legal = 0;
  double blocked = length;
  for (int i = 0; i < 8; ++i) {
    const double middle = (legal + blocked) / 2;
    if (auto place = try_length(middle)) {
      best = place;
      legal = middle;
    } else {
      blocked = middle;
    }
  }
  return best;
}

BodyShape shape_of(const Claims& claims, double growth, double headroom) {
  return {.radius = claims.avatar.radius + growth,
          .bottom = body_bottom(claims.avatar),
          .height = claims.avatar.height + headroom,
          .step = claims.avatar.step_height,
          .levelness = levelness_limit(claims.avatar),
          .spacing = claims.cell};
}

}  // namespace

StateRecord check_state(const Claims& claims, const BodyCheck& body, uint64_t seed, uint64_t n) {
  StateRecord record;
  const Place place = claims.random_place(seed, n);
  if (!place) return record;
  record.exists = true;
  record.feet = {place.position.x, claims.feet(place), place.position.z};
  if (const auto intruder = body.intruder(record.feet)) {
    record.entered = true;
    record.intruder = *intruder;
  }
  record.unsupported = !body.is_supported(record.feet);
  record.feet_error = body.feet_error(record.feet);
  return record;
}

MoveRecord check_move(const Claims& claims, const BodyCheck& body, uint64_t seed, uint64_t n) {
  MoveRecord record;
  const Place start = claims.random_place(seed, n);
  if (!start) return record;
  const auto end = random_move(claims, start, seed, n);
  if (!end) return record;
  record.legal = true;

  check_segment(claims, body, start, *end, claims.cell / 4, record.segment);
  return record;
}

PointCheck::PointCheck(const Claims& claims, const TriangleTree& tree)
    : claims_(&claims),
      exact_(tree, shape_of(claims, 0, 0)),
      grown_(tree, shape_of(claims, claims.cell, claims.resolution)) {}

PointRecord PointCheck::check(Vec3d feet) {
  PointRecord record;
  if (!exact_.stands(feet)) return record;  // Then the grown body does not either.
  const bool grown_stands = grown_.stands(feet);
  const bool kept = is_kept(feet);
  record.exact = kept ? Stand::kKept : denied(exact_, feet);
  if (grown_stands) record.grown = kept ? Stand::kKept : denied(grown_, feet);
  return record;
}

// The world's floor in a column may be any surface that the body's step swallows.
bool PointCheck::is_kept(Vec3d feet) const {
  return static_cast<bool>(claims_->find_place(feet, std::max(claims_->avatar.step_height, 0.1)));
}

// An area too large to be searched counts as lost, whether it is connected or not: a bake that
// denied a whole storey must not be excused.
Stand PointCheck::denied(Stance& stance, Vec3d feet) const {
  const WalkEnd end = stance.walk(feet, claims_->cell / 2, kLargestIsland,
                                  [this](Vec3d at) { return is_kept(at); });
  return end == WalkEnd::kIsland ? Stand::kIsolated : Stand::kLost;
}

}  // namespace throng::verify
