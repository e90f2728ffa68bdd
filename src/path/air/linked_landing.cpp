// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "path/air/linked_landing.h"

#include <cmath>

#include "core/access.h"
#include "graph/leaf_links.h"

// A look-up in the stored links, and the same test as of any landing: from where a body lands it
// can take off again. Logarithmic in the links of a zone.
namespace throng::path {
namespace {

// Between a surface and the level of the ground that was made of it. [m]
constexpr double kLevelTolerance = 0.1;

}  // namespace

Place linked_landing(const AirLinks& links, const FlightEndpoints& ends, const AirView& air,
                     int32_t avatar_class, AirPoint at) {
  if (!links) return {};
  const uint32_t box = ends.lowest_box(at);
  if (box == kNoBox) return {};
  const graph::LeafLinkData& data = *data_of(links);
  const graph::LinksOfLeaf found =
      graph::links_of_leaf(data, {static_cast<int32_t>(std::floor(at.x)), air.cube(box).y,
                                  static_cast<int32_t>(std::floor(at.z))});
  for (const format::LeafLink& link : found.links) {
    if ((link.classes() >> avatar_class & 1) == 0) continue;
    const auto end = graph::end_of(*data.nodes, *found.zone, link);
    if (!end) return {};
    const Place place = data.nodes->world.find_place(avatar_class, end->feet, kLevelTolerance);
    const auto up = ends.take_off(place);
    if (!up || air.component(air.box_at(*up)) != air.component(box)) return {};
    return place;
  }
  return {};
}

}  // namespace throng::path
