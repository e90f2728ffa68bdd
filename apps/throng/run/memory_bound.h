// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdint>
#include <string>

#include "throng/base.h"

namespace throng::app {

/// The memory that a command may take, and the parts of it.
struct MemoryBound {
  uint64_t bytes = 0;  // 0: not bounded

  explicit operator bool() const { return bytes > 0; }
  /// For zones of the world. [bytes]
  [[nodiscard]] uint64_t zones() const { return left() / 3; }
  /// For one search, with the ground that it makes. [bytes]
  [[nodiscard]] uint64_t search() const { return left() / 2; }
  /// For the triangles of the block of zones that is baked: a zone in the making takes the rest.
  /// [bytes]
  [[nodiscard]] uint64_t blocks() const {
    constexpr uint64_t kZones = uint64_t{120} << 20;
    return std::max(bytes / 4, bytes - std::min(bytes, kZones));
  }
  /// For a batch of zones whose nodes are made. [bytes]
  [[nodiscard]] uint64_t nodes() const {
    constexpr uint64_t kRest = uint64_t{80} << 20;
    return std::max(bytes / 2, bytes - std::min(bytes, kRest));
  }
  /// Fails with kBadConfig if the process has taken more. `when`: as in "its crowd is made".
  [[nodiscard]] Result<void> check(const std::string& when, const std::string& remedy) const;

 private:
  static constexpr uint64_t kProgram = uint64_t{24} << 20;
  [[nodiscard]] uint64_t left() const { return bytes < kProgram ? 0 : bytes - kProgram; }
};

/// --memory, in MiB.
void add_memory(CLI::App& command, MemoryBound& bound, const std::string& text);

}  // namespace throng::app
