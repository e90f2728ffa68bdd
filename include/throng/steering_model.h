// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "throng/base.h"

/// Steering models: how avatars on foot avoid each other.
namespace throng {

/// The function that decides at which velocity an avatar would walk. Whatever the model, the moves
/// pass the same tests: avatars never overlap and never enter a wall. docs/algorithms.md, "Models".
enum class SteeringModel : uint8_t {
  kSampled,      ///< "sampled": our own; velocities are sampled and their costs compared.
  kCurvilinear,  ///< "caacd": [CAACD] as printed, scaled to bodies and speeds.
  kSocialForce,  ///< "social-force": [HM95] as printed, walls included.
};

/// The name of a model in scenario files and on the command line.
[[nodiscard]] THRONG_API const char* name_of(SteeringModel model);
/// The model with a name, or none.
[[nodiscard]] THRONG_API std::optional<SteeringModel> find_steering_model(std::string_view name);
/// All names, "a, b or c", for messages.
[[nodiscard]] THRONG_API const char* steering_model_names();

}  // namespace throng
