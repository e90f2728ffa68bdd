// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "throng/base.h"

/// Steering in the air by trying velocities: steer/sampled.h with a third axis. Bodies are upright
/// cylinders, so two of them pass beside each other, or one over the other.
/// docs/design/012-flyers.md.
namespace throng::steer {

/// Y is up. [m, m/s]
struct Space {
  float x = 0, y = 0, z = 0;
  friend Space operator+(Space a, Space b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
  friend Space operator-(Space a, Space b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
  friend Space operator*(float s, Space a) { return {s * a.x, s * a.y, s * a.z}; }
};
inline float dot(Space a, Space b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
float size_of(Space p);

/// Unit vectors of the plane, 45 degrees apart.
inline constexpr double kDiagonal = 0.70710678;
inline constexpr std::array<std::array<double, 2>, 8> kEighths = {{{1, 0},
                                                                   {kDiagonal, kDiagonal},
                                                                   {0, 1},
                                                                   {-kDiagonal, kDiagonal},
                                                                   {-1, 0},
                                                                   {-kDiagonal, -kDiagonal},
                                                                   {0, -1},
                                                                   {kDiagonal, -kDiagonal}}};

/// As steer::SampledSettings has them, but for the gap: who flies keeps farther away.
struct AirSettings {
  float horizon = 2;          ///< Touching later than that is of no concern. [s, > 0]
  float straightness = 0.8f;  ///< Share of "less progress", beside "another velocity", in a cost.
  float keep = 0.2f;          ///< Cost of leaving one's present velocity.
  float right = 0.1f;         ///< Cost of passing on the left.
  float threat = 0.5f;        ///< Cost of the most urgent touch.
  float gap = 0.05f;          ///< Wished between two bodies. [m]
  float wall = 0.5f;          ///< Cost of flying up to a wall,
  float wall_horizon = 0.7f;  ///< if it is reached within this. [s, > 0]
};

inline constexpr size_t kMaxNearInAir = 8;
inline constexpr size_t kAirDirections = 42;  ///< Ahead, five rings of eight, back.
inline constexpr size_t kAirSpeeds = 3;
inline constexpr size_t kAirTrials = kAirDirections * kAirSpeeds;
inline constexpr size_t kAirChoices = 8;

struct AirNeighbour {
  Space at, velocity;  ///< `at`: its feet from one's own.
  float radii = 0;     ///< Sum of both.
  float height = 0;    ///< The other's.
};

/// What a body steers by.
struct AirSituation {
  Space velocity;
  Space preferred;    ///< The velocity if nobody were there. [at most `fastest`]
  float fastest = 1;  ///< [m/s, > 0]
  float height = 1;   ///< Of the body. [m]
  size_t size = 0;    ///< Of `near`.
  std::array<AirNeighbour, kMaxNearInAir> near;
  /// How far it is to a wall in each direction of the fan around the wish, if `has_walls`. [m]
  std::array<float, kAirDirections> free_distance{};
  bool has_walls = false;
};

/// Unit vectors around the wish (around X, if there is none), the first along it.
using AirFan = std::array<Space, kAirDirections>;
AirFan air_fan(Space preferred);

/// How soon two upright cylinders touch if one goes at `velocity` and the other goes on: 1 / the
/// time until then, 0 if not within the horizon. [1/s]
float soonness(const AirSettings& settings, const AirSituation& situation,
               const AirNeighbour& other, Space velocity);

/// True if whoever does as he wishes touches nobody and no wall within their horizons.
bool preferred_is_open(const AirSettings& settings, const AirSituation& situation);

/// The velocities that cost least, the best first.
using AirChoices = std::array<Space, kAirChoices>;
AirChoices best_of(const AirSettings& settings, const AirSituation& situation);

/// The wish of a body whose aim is `way` off: at `speed`, turned aside by 2 atan(turn), to the side
/// `roll` (0 right, 1 over it, 2 under it), and not past the aim within `dt`; where `stops`, slower
/// the nearer it is: it would be there in half a second.
Space preferred_towards(Space way, float speed, float dt, float turn, int32_t roll, bool stops);

}  // namespace throng::steer
