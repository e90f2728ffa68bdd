// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <unordered_map>
#include <utility>
#include <vector>

#include "crowd/ground/air_obstacle.h"
#include "path/edits/solid.h"

/// The obstacles that flyers and climbers test, by where they are.
namespace throng::crowd {

/// Squares of the plan in levels, each twice as wide as the one below. An obstacle is on the lowest
/// level whose squares are at least as wide as its box, in up to four of them: so to add one, to
/// erase it and to find it cost the same for any number and size of the others.
class ObstacleGrid {
 public:
  /// `unit`: of the world. [m]
  explicit ObstacleGrid(double unit) : unit_(unit) {}

  struct Item {
    AirObstacle shape;
    path::Solid solid;  // the same
    uint32_t slot = 0;
  };
  /// Replaces what is known of the slot.
  void set(uint32_t slot, AirObstacle shape, path::Solid solid);
  void erase(uint32_t slot);
  [[nodiscard]] bool is_empty() const { return items_.empty(); }

  /// Does a test hold for one of the obstacles that may hold a body at this position? It is called
  /// for few others, in no order, and may be called twice for one. [m]
  template <class Test>
  [[nodiscard]] bool any_near(const AirPosition& at, double radius, Test test) const;
  /// All that may hold such a body, in order of slot. Replaces `found`.
  void list_near(const AirPosition& at, double radius, std::vector<const Item*>& found) const;

 private:
  static constexpr int32_t kBaseBits = 15;  // of the width of a square of level 0 [units]
  static constexpr size_t kLevels = 20;     // the last holds any box
  // [units] beyond what a body's position can be
  static constexpr double kMaxPosition = 4294967296.0;
  static constexpr size_t kMaxUnindexed = 32;  // obstacles that take less time than a look-up
  static constexpr uint32_t kNoItem = UINT32_MAX;

  struct Squares {  // last included
    int32_t x0, z0, x1, z1;
  };
  static Squares squares(size_t level, const std::array<double, 4>& box);
  static uint64_t key(size_t level, int32_t x, int32_t z) {
    const auto number = [](int32_t i) { return static_cast<uint64_t>(i + (1 << 28)); };
    return uint64_t{level} << 58 | number(x) << 29 | number(z);
  }
  static size_t level_of(const std::array<double, 4>& box);

  double unit_;
  std::vector<Item> items_;        // in no order
  std::vector<uint32_t> item_of_;  // by slot: in items_, or kNoItem
  std::array<uint32_t, kLevels> on_level_{};
  std::unordered_map<uint64_t, std::vector<uint32_t>> slots_;  // by square; looked up only
};

template <class Test>
bool ObstacleGrid::any_near(const AirPosition& at, double radius, Test test) const {
  const auto test_all = [&] {
    for (const Item& item : items_) {
      if (test(item)) return true;
    }
    return false;
  };
  if (items_.size() <= kMaxUnindexed) return test_all();
  const double range = AirObstacle::range(radius, unit_) + 1;  // and what rounding adds
  const std::array<double, 4> box{at.x - range, at.z - range, at.x + range, at.z + range};
  uint64_t count = 0;
  for (size_t level = 0; level < kLevels; ++level) {
    if (on_level_[level] == 0) continue;
    const Squares s = squares(level, box);
    count += static_cast<uint64_t>(s.x1 - s.x0 + 1) * static_cast<uint64_t>(s.z1 - s.z0 + 1);
  }
  if (count >= items_.size()) return test_all();
  for (size_t level = 0; level < kLevels; ++level) {
    if (on_level_[level] == 0) continue;
    const Squares s = squares(level, box);
    for (int32_t z = s.z0; z <= s.z1; ++z) {
      for (int32_t x = s.x0; x <= s.x1; ++x) {
        const auto found = slots_.find(key(level, x, z));
        if (found == slots_.end()) continue;
        for (const uint32_t slot : found->second) {
          if (test(items_[item_of_[slot]])) return true;
        }
      }
    }
  }
  return false;
}

}  // namespace throng::crowd
