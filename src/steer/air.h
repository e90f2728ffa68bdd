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

/// As in steer::SampledSettings, but for the gap: flyers keep larger distances.
struct AirSettings {
  float horizon = 2;          ///< Later touches do not count. [s, > 0]
  float straightness = 0.8f;  ///< Share of "less progress", beside "another velocity", in a cost.
  float keep = 0.2f;          ///< Cost of a change of the present velocity.
  float right = 0.1f;         ///< Cost of passing on the left.
  float threat = 0.5f;        ///< Cost of the most urgent touch.
  float gap = 0.05f;          ///< Preferred between two bodies. [m]
  float wall = 0.5f;          ///< Cost of flying up to a wall,
  float wall_horizon = 0.7f;  ///< if it is reached within this. [s, > 0]
};

inline constexpr size_t kMaxNearInAir = 8;
inline constexpr size_t kAirDirections = 42;  ///< Ahead, five rings of eight, back.
inline constexpr size_t kAirSpeeds = 3;
inline constexpr size_t kAirTrials = kAirDirections * kAirSpeeds;
inline constexpr size_t kAirChoices = 8;
inline constexpr float kAirStop = 0.5f;  ///< Within which a body that stops at its target is there
                                         ///< at its present speed. [s]

struct AirNeighbour {
  Space at, velocity;  ///< `at`: offset of its feet.
  float radii = 0;     ///< Sum of both.
  float height = 0;    ///< Of the other.
  uint32_t slot = 0;   ///< Of the other.
};

/// The input of steering for one body.
struct AirSituation {
  Space velocity;
  Space preferred;    ///< The velocity without others. [at most `fastest`]
  float fastest = 1;  ///< [m/s, > 0]
  float height = 1;   ///< Of the body. [m]
  size_t size = 0;    ///< Of `near`.
  std::array<AirNeighbour, kMaxNearInAir> near;
  /// Distance to a wall in each direction of air_fan(preferred), if `has_walls`. [m]
  std::array<float, kAirDirections> free_distance{};
  bool has_walls = false;
};

/// Unit vectors around the preferred velocity (around X if it is 0), the first along it.
using AirFan = std::array<Space, kAirDirections>;
AirFan air_fan(Space preferred);

/// How soon two upright cylinders touch if one moves with `velocity` and the other keeps its own: 1
/// / the time until then, 0 if not within the horizon. [1/s]
float soonness(const AirSettings& settings, const AirSituation& situation,
               const AirNeighbour& other, Space velocity);

/// True if the preferred velocity leads to no touch with a body or a wall within their horizons.
bool preferred_is_open(const AirSettings& settings, const AirSituation& situation);

/// The velocities of the smallest costs, the best first.
using AirChoices = std::array<Space, kAirChoices>;
AirChoices best_of(const AirSettings& settings, const AirSituation& situation);

/// The preferred velocity of a body with the offset `to_target` to its target: at `speed`, turned
/// by 2 atan(detour_angle) to the side `roll` (0 right, 1 right and up, 2 right and down), and not
/// past the target within `dt`. If it `stops`, the speed is at most the remaining distance in
/// kAirStop.
Space preferred_towards(Space to_target, float speed, float dt, float detour_angle, int32_t roll,
                        bool stops);

}  // namespace throng::steer
