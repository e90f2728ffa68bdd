// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "path/air/air_view.h"

#include <algorithm>
#include <cmath>
#include <limits>

// Queries of the air as it is: the boxes of the space, or their parts where obstacles have cut
// them.
namespace throng::path {

namespace {

// Nearest to a goal of the wanted parts of a split box; of equally near boxes the first.
template <class Wanted>
std::optional<AirPoint> nearest_part(const SplitBoxes& splits, uint32_t box, AirPoint goal,
                                     Wanted is_wanted) {
  std::optional<AirPoint> nearest;
  double least = std::numeric_limits<double>::infinity();
  splits.for_parts(box, [&](uint32_t part) {
    const AirPoint p = nearest_of(splits.cube(part), goal);
    const double far = air_distance(p, goal);
    if (far >= least || !is_wanted(part)) return;
    least = far;
    nearest = p;
  });
  return nearest;
}

}  // namespace

std::optional<AirPoint> AirView::nearest_in(std::span<const uint32_t> components, AirPoint goal,
                                            ZoneOrder& order) const {
  if (components.empty()) return {};
  const FlightSpace& space = *space_;
  order.clear();
  for (uint32_t zone = 0; zone + 1 < space.first_box.size(); ++zone) {
    if (space.first_box[zone] == space.first_box[zone + 1]) continue;
    const auto beside = [&](double at, int32_t place) {
      const double low = static_cast<double>(place) * space.zone_side;
      return std::max({low - at, at - (low + space.zone_side), 0.0});
    };
    const double x = beside(goal.x, static_cast<int32_t>(zone) % space.zones_x);
    const double z = beside(goal.z, static_cast<int32_t>(zone) / space.zones_x);
    order.emplace_back(std::sqrt(x * x + z * z), zone);
  }
  std::sort(order.begin(), order.end());
  const auto is_wanted = [&](uint32_t box) {
    return std::binary_search(components.begin(), components.end(), component(box));
  };
  std::optional<AirPoint> nearest;
  double least = std::numeric_limits<double>::infinity();
  uint32_t best = kNoBox;
  for (const auto& [away, zone] : order) {
    if (away > least) break;
    for (uint32_t b = space.first_box[zone]; b < space.first_box[zone + 1]; ++b) {
      AirPoint p = nearest_of(space.boxes[b], goal);
      double far = air_distance(p, goal);
      if (far > least || (far == least && b > best)) continue;
      if (is_split(b)) {
        const auto part = nearest_part(changes_->splits(), b, goal, is_wanted);
        if (!part) continue;
        p = *part;
        far = air_distance(p, goal);
        if (far > least || (far == least && b > best)) continue;
      } else if (!is_wanted(b)) {
        continue;
      }
      least = far;
      nearest = p;
      best = b;
    }
  }
  return nearest;
}

}  // namespace throng::path
