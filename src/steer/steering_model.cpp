// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <array>
#include <cstddef>

#include "throng/avatar.h"

// Names of the steering models.
namespace throng {
namespace {

constexpr std::array<const char*, 3> kNames = {"sampled", "caacd", "social-force"};

}  // namespace

const char* name_of(SteeringModel model) { return kNames[static_cast<size_t>(model)]; }

std::optional<SteeringModel> find_steering_model(std::string_view name) {
  for (size_t n = 0; n < kNames.size(); ++n) {
    if (name == kNames[n]) return static_cast<SteeringModel>(n);
  }
  return std::nullopt;
}

const char* steering_model_names() { return "sampled, caacd or social-force"; }

}  // namespace throng
