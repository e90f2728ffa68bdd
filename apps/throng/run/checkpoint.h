// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "command.h"
#include "throng/base.h"

/// Files from which a run goes on that was ended.
namespace throng::app {

/// A run of avatars with goals between two steps.
struct Checkpoint {
  uint64_t step = 0;            // made so far
  Json settings;                // crowd_settings
  uint64_t world = 0;           // WorldSummary::hash
  std::vector<uint64_t> given;  // goals, by slot
  std::vector<uint8_t> crowd;   // Crowd::save
};

struct CheckpointOptions {
  std::string write;     // this file, again and again; empty: none
  uint64_t every = 100;  // steps
  std::string resume;    // from this file; empty: from the start
};

/// Replaces the file once all is written. Fails with kIo; then the file is as it was.
Result<void> write_checkpoint(const std::string& path, const Checkpoint& checkpoint);
/// Fails with kNotFound and kBadFile: no checkpoint, of another version, or not whole.
Result<Checkpoint> read_checkpoint(const std::string& path);
/// Fails with kBadConfig and the setting if a run has another world or other settings.
Result<void> check_settings(const Checkpoint& checkpoint, const std::string& path, uint64_t world,
                            const Json& settings);

}  // namespace throng::app
