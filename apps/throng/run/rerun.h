// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>

#include "command.h"
#include "run/run_crowd.h"
#include "run/run_wanderers.h"
#include "throng/recording.h"
#include "throng/world.h"

/// Repeats a recorded run: one entry per model in rerun.cpp.
namespace throng::app {

/// A run at step 0.
struct Rerun {
  std::function<void()> step;
  std::function<uint64_t()> state_hash;
};

inline constexpr const char* kWanderersModel = "wanderers";
/// What a recording of wanderers keeps. Threads never change a result.
[[nodiscard]] Json wanderers_settings(const WanderRun& run);

inline constexpr const char* kCrowdModel = "crowd";
[[nodiscard]] Json crowd_settings(const CrowdRun& run);

/// Fails with kBadFile: a model or settings that this program does not know.
[[nodiscard]] Result<Rerun> make_rerun(const RecordingInfo& info, const World& world,
                                       int32_t workers);

/// The world of a recording: the folder that it names, or `folder` if it is not empty. Fails with
/// kBadFile: not there, or not the one that was recorded.
[[nodiscard]] Result<World> world_of(const RecordingInfo& info, const std::string& folder);

}  // namespace throng::app
