// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "throng/papers.h"

/// The parts of load_slices, for files in memory.
namespace throng::papers {

/// What a file says, right or wrong, and the checksum that it should have.
struct StoredSlices {
  DepthSlices slices;
  uint64_t sum = 0;
};

/// Reads the bytes of a file. Fails with kBadFile: no slices, of another version, truncated, or
/// with bytes after their end. `name` is for messages.
[[nodiscard]] Result<StoredSlices> decode_slices(std::span<const uint8_t> bytes,
                                                 const std::string& name);
/// The checksum of slices.
[[nodiscard]] uint64_t sum_of(const DepthSlices& slices);
/// Are the numbers such that all functions of slices can use them?
[[nodiscard]] bool is_sound(const DepthSlices& slices);

}  // namespace throng::papers
