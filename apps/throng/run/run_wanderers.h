// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "command.h"
#include "run/avatar_group.h"
#include "run/run_sinks.h"
#include "run/run_times.h"
#include "throng/papers.h"

/// `throng run --wander`: a crowd without goals.
namespace throng::app {

struct WanderRun {
  std::string world;  // or a file of slices
  std::string class_name;
  std::vector<AvatarGroup> also;
  WanderConfig config;
  std::vector<double> part = {};  // x0, z0, x1, z1 of a district; empty: the whole world [m]
  uint64_t steps = 100;
  uint64_t check_every = 10;  // steps [> 0]
  SinkOptions sinks;
};

/// Moves the crowd, and prints times, checks and hash. Returns the exit code.
int run_wanderers(Session& session, const World& world, WanderRun run, RunTimes& times);
/// The same on a file of slices. Classes are default classes.
int run_slice_wanderers(Session& session, WanderRun run);

}  // namespace throng::app
