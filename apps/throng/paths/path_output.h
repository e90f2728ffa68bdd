// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>

#include "command.h"
#include "throng/path.h"

namespace throng::app {

/// What was asked for, beside the path that was found.
struct PathRun {
  std::string world, avatar_class;
  Vec3d goal;                                     ///< Feet. [m]
  double seconds = 0;                             ///< That the search took.
  uint64_t search_bytes = 0;                      ///< Limit of its memory.
  const char* memory_option = "--search-memory";  ///< Raises it.
};

/// A path of any finder as JSON, and as text: a line of sums and a line a point.
[[nodiscard]] Json path_json(const PathRun& run, const Path& path);
[[nodiscard]] std::string path_text(const PathRun& run, const Path& path);

}  // namespace throng::app
