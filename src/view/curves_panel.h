// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "throng/crowd.h"

/// [CAACD]'s application layer: a person sets Mass, MaxSpeed and MaxForce of an avatar, or of all.
namespace throng::view {

struct PanelState;

/// The values that keys and sliders change.
enum class CurveValue : uint8_t { kMass, kMaxSpeed, kMaxForce };

/// The state of the panel's part for avatars that [CAACD] steers.
struct CurvesPanel {
  int64_t of = -1;          ///< The avatar that `shown` is of; -1: all.
  CurvilinearTuning shown;  ///< As sliders show it.
  CurvilinearTuning all;    ///< What all were given last.
  bool edited = false;      ///< `shown` was changed since the avatar was picked.
  // Requests of this frame; the owner clears them.
  bool changed = false;  ///< Send `shown` to the avatar, or to all.
  bool to_all = false;   ///< Send `shown` to all.
};

/// Steps a value of the avatar picked, or of all, up (1) or down (-1): by 0.25, 0.1 and 0.02 within
/// the sliders' limits.
void step_curve(CurvesPanel& curves, CurveValue value, int32_t by);

/// Shows the values of the avatar that is picked now, or of all.
void follow_picked(PanelState& state);

/// Draws the part: values, states, and the counts of an experiment.
void draw_curves(PanelState& state);

}  // namespace throng::view
