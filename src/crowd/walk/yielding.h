// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

#include "crowd/walk/aside_search.h"
#include "crowd/walk/routes.h"

/// Bodies that stand aside for others which do not get on. docs/design/008-engine.md, "Standing
/// aside".
namespace throng::crowd {

/// A body that walks to a place, and waits there until another has passed.
struct StandsAside {
  uint32_t name = 0, generation = 0;
  uint32_t for_name = 0, for_generation = 0;
  PathPoint place;
  uint16_t seconds = 0;     ///< For so long.
  uint8_t has_arrived = 0;  ///< It had come to its goal before.
  uint8_t has_ended = 0;    ///< It lost its path to the place.
};
static_assert(sizeof(StandsAside) == 32);

/// All of them, by name, and what is found once in a second.
struct Yielding {
  std::vector<StandsAside> all;
  AsideSearch search;
  std::vector<uint32_t> index_of;                    // of a body, by name
  std::vector<uint32_t> blocked;                     // bodies
  std::vector<std::pair<uint64_t, uint32_t>> slow;   // square and body, sorted
  std::vector<uint64_t> squares;                     // around a line
  std::vector<PathLine> lines;                       // of the body that does not get on, first
  std::vector<std::pair<double, uint32_t>> on_line;  // where, and which body
  std::vector<uint32_t> column, asked;               // bodies
  std::vector<PathPoint> corners;

  /// So that later calls need no memory.
  void reserve(size_t line_count, size_t bodies) {
    constexpr size_t kFew = 1024;
    slow.reserve(bodies);
    blocked.reserve(bodies);
    if (!lines.empty()) return;
    lines.resize(line_count);
    for (PathLine& line : lines) line.reserve(Route::kCorners + 1);
    all.reserve(kFew);
    squares.reserve(kFew);
    on_line.reserve(kFew);
    column.reserve(kFew);
    asked.reserve(kFew);
    corners.reserve(kFew);
    search.reserve();
  }
  static uint64_t square_key(int64_t column, int64_t row) {
    return static_cast<uint64_t>(row) << 32 | static_cast<uint32_t>(column);
  }
  /// Calls f with each of the slow bodies of a square.
  template <class F>
  void for_slow_in(uint64_t square, F&& f) const {
    auto at = std::lower_bound(slow.begin(), slow.end(), std::pair(square, 0U));
    for (; at != slow.end() && at->first == square; ++at) f(at->second);
  }
  [[nodiscard]] StandsAside* find(uint32_t name) {
    const auto found =
        std::lower_bound(all.begin(), all.end(), name,
                         [](const StandsAside& one, uint32_t wanted) { return one.name < wanted; });
    return found != all.end() && found->name == name ? &*found : nullptr;
  }
  void put(const StandsAside& one) {
    if (StandsAside* old = find(one.name); old != nullptr) {
      *old = one;
      return;
    }
    all.insert(std::upper_bound(
                   all.begin(), all.end(), one,
                   [](const StandsAside& a, const StandsAside& b) { return a.name < b.name; }),
               one);
  }
  void erase(uint32_t name) {
    if (StandsAside* one = find(name); one != nullptr) all.erase(all.begin() + (one - all.data()));
  }
};

}  // namespace throng::crowd
