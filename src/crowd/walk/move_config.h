// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "crowd/mode/own_curves.h"
#include "crowd/walk/queue.h"
#include "crowd/walk/step_units.h"
#include "steer/air.h"
#include "steer/lanes.h"
#include "steer/models.h"
#include "steer/sampled.h"
#include "throng/crowd.h"

namespace throng::crowd {

/// How the avatars of a crowd move, whichever engine moves them.
struct MoveConfig {
  StepUnits units = {};
  float sight = 5;                 ///< [m]
  int32_t rounds = 3;              ///< Of conflict resolution.
  bool deadlock_avoidance = true;  ///< Of walkers with kSampled, flyers and climbers.
  /// A walker that continues decides again after that; only with kSampled. [s]
  float reaction = 0.2f;
  uint64_t seed = 1;
  int32_t workers = 0;
  SteeringModel model = SteeringModel::kSampled;  ///< Of walkers.
  caacd::Model curves = {};                       ///< Of kCurvilinear.
  const OwnCurves* own_curves = nullptr;          ///< Of single avatars; outlives the engines.
  FlyerAxes flyer_axes = FlyerAxes::kOurs;        ///< Of kCurvilinear.
  steer::SampledSettings steering = {};
  steer::DeadlockAvoidance deadlock_settings = {};
  steer::LaneSettings lanes = {};
  steer::SpacingSettings spacing = {};
  bool queues = false;  ///< Walkers with kSampled queue; else they push.
  QueueSettings queue = {};
  float acceleration = 0;                ///< At most; 0: no limit. [m/s2]
  steer::AirSettings air_steering = {};  ///< Of flyers and climbers.
  /// Of walkers, by class. None: stairs and slopes slow no body.
  std::vector<SlopeFactors> slope_factors = {};

  /// The settings of [CAACD] of an avatar.
  [[nodiscard]] caacd::Model curves_of(uint32_t slot) const {
    return own_curves != nullptr ? own_curves->model_of(slot, curves) : curves;
  }
};

}  // namespace throng::crowd
