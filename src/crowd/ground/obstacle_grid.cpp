// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "crowd/ground/obstacle_grid.h"

#include <algorithm>

// A hierarchical grid of boxes. Constant time, but for the obstacles that share a square.
namespace throng::crowd {

ObstacleGrid::Squares ObstacleGrid::squares(size_t level, const std::array<double, 4>& box) {
  const double side = std::ldexp(1.0, kBaseBits + static_cast<int>(level));
  const auto square = [&](double at) {
    return static_cast<int32_t>(std::floor(std::clamp(at, -kMaxPosition, kMaxPosition) / side));
  };
  return {square(box[0]), square(box[1]), square(box[2]), square(box[3])};
}

size_t ObstacleGrid::level_of(const std::array<double, 4>& box) {
  const auto near = [](double at) { return std::clamp(at, -kMaxPosition, kMaxPosition); };
  const double wide = std::max(near(box[2]) - near(box[0]), near(box[3]) - near(box[1]));
  size_t level = 0;
  while (level + 1 < kLevels && std::ldexp(1.0, kBaseBits + static_cast<int>(level)) < wide) {
    ++level;
  }
  return level;
}

void ObstacleGrid::set(uint32_t slot, AirObstacle shape, path::Solid solid) {
  erase(slot);
  if (item_of_.size() <= slot) item_of_.resize(slot + size_t{1}, kNoItem);
  item_of_[slot] = static_cast<uint32_t>(items_.size());
  const std::array<double, 4> box = shape.box();
  items_.push_back({std::move(shape), std::move(solid), slot});
  const size_t level = level_of(box);
  ++on_level_[level];
  const Squares s = squares(level, box);
  for (int32_t z = s.z0; z <= s.z1; ++z) {
    for (int32_t x = s.x0; x <= s.x1; ++x) slots_[key(level, x, z)].push_back(slot);
  }
}

void ObstacleGrid::erase(uint32_t slot) {
  if (slot >= item_of_.size() || item_of_[slot] == kNoItem) return;
  const uint32_t i = item_of_[slot];
  const std::array<double, 4> box = items_[i].shape.box();
  const size_t level = level_of(box);
  --on_level_[level];
  const Squares s = squares(level, box);
  for (int32_t z = s.z0; z <= s.z1; ++z) {
    for (int32_t x = s.x0; x <= s.x1; ++x) {
      const auto found = slots_.find(key(level, x, z));
      std::erase(found->second, slot);
      if (found->second.empty()) slots_.erase(found);
    }
  }
  item_of_[slot] = kNoItem;
  if (i + 1 < items_.size()) {
    items_[i] = std::move(items_.back());
    item_of_[items_[i].slot] = i;
  }
  items_.pop_back();
}

void ObstacleGrid::list_near(const AirPosition& at, double radius,
                             std::vector<const Item*>& found) const {
  found.clear();
  const auto add = [&](const Item& item) {
    found.push_back(&item);
    return false;
  };
  (void)any_near(at, radius, add);
  std::sort(found.begin(), found.end(),
            [](const Item* a, const Item* b) { return a->slot < b->slot; });
  found.erase(std::unique(found.begin(), found.end()), found.end());
}

}  // namespace throng::crowd
