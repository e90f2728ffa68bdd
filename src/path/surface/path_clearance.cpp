// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <limits>
#include <vector>

#include "core/access.h"
#include "graph/node_clearance.h"
#include "throng/path.h"
#include "world/zone_data.h"

// The worst of what nodes promise along a path: segment by segment, each straight in the parameters
// of its patch. Between patches that do not touch only the body of the path's own class was proved.
// Time: linear in the segments times the nodes and cells of their patches.
namespace throng {
namespace {

void take_worse(NodeClearance& worst, const NodeClearance& other) {
  worst.classes &= other.classes;
  worst.inclination = std::max(worst.inclination, other.inclination);
  worst.height = std::min(worst.height, other.height);
  worst.headroom = std::min(worst.headroom, other.headroom);
  worst.width = std::min(worst.width, other.width);
}

// For each point: does the path come to it over a link between places that do not touch?
std::vector<bool> ends_of_links(const Path& path) {
  std::vector<bool> over(path.points.size(), false);
  for (const PathLink& link : path.links) {
    if (link.over_hole && link.point < over.size()) over[link.point] = true;
  }
  return over;
}

}  // namespace

NodeClearance clearance_along(const Nodes& nodes, int32_t avatar_class, const Path& path) {
  THRONG_ASSERT(nodes);
  const auto& classes = data_of(nodes.world())->summary.classes;
  const std::vector<NodePlace>& places = path.node_places;
  if (places.size() < 2 || path.segments.size() + 1 != places.size()) return {};
  if (avatar_class < 0 || static_cast<size_t>(avatar_class) >= classes.size()) return {};
  constexpr double kUnbounded = std::numeric_limits<double>::infinity();
  NodeClearance worst{.classes = UINT16_MAX,
                      .inclination = 0,
                      .height = kUnbounded,
                      .headroom = kUnbounded,
                      .width = kUnbounded};
  graph::NodeClearances clearances(*data_of(nodes));
  const std::vector<bool> is_link = ends_of_links(path);
  const auto at = [&](const NodePlace& place) {
    if (!place) return;  // In the air, on a drop link.
    take_worse(worst, clearances.along(avatar_class, place.node1 - 1,
                                       {place.s, place.t, place.s, place.t}));
  };
  const AvatarClass& avatar = classes[static_cast<size_t>(avatar_class)];
  for (size_t i = 0; i < path.segments.size(); ++i) {
    const NodePlace &from = places[i], &to = places[i + 1];
    if (path.segments[i] == SegmentKind::kWalk && from && to) {
      take_worse(worst, clearances.along(avatar_class, to.node1 - 1, {from.s, from.t, to.s, to.t}));
      continue;
    }
    at(from);
    at(to);
    const bool in_the_air = path.segments[i] == SegmentKind::kOffMesh || is_link[i + 1] || !to;
    if (!in_the_air) continue;  // Two patches touch there.
    const bool is_upright = avatar.climb_slope == 0;
    take_worse(worst, {.classes = static_cast<uint16_t>(1u << avatar_class),
                       .inclination = 0,
                       .height = avatar.height,
                       .headroom = is_upright ? avatar.height : 0,
                       .width = 0});
  }
  return worst;
}

}  // namespace throng
