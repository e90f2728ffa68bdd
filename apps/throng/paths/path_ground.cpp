// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "paths/path_ground.h"

#include <fmt/format.h>

#include <cmath>

#include "in_world.h"
#include "paths/boxes.h"

// The ends of `throng path` in a world, and its ground with what the options change.
namespace throng::app {

Error bad_end(const PathOptions& options, const Vec3d& position, const char* option,
              const std::string& what) {
  return bad_position(options.world, option, position, what);
}

Result<Vec3d> position_of(const World& world, const PathOptions& options,
                          const std::vector<double>& at, const char* option) {
  return position_in(world, options.world, option, at);
}

Result<Place> place_of(const World& world, const PathOptions& options, int32_t avatar_class,
                       const std::vector<double>& at, const char* option) {
  const Result<Vec3d> found = position_of(world, options, at, option);
  if (!found) return found.error();
  const Vec3d position = *found;
  const auto bad = [&](const std::string& what) {
    return bad_end(options, position, option, what);
  };
  const Place place = world.find_place(avatar_class, position, options.tolerance);
  if (!place) {
    if (auto ok = world.check_ground(); !ok) return ok.error();  // Its zone may be damaged.
    return bad(
        fmt::format("is no place where class {} can stand, within {} m up or down; see "
                    "`throng picture`, or give a larger --tolerance",
                    options.avatar_class, options.tolerance));
  }
  return place;
}

Result<void> put_up(const World& world, const PathOptions& options, int32_t avatar_class,
                    Edits& edits) {
  if (auto ok = add_boxes(options.blocks, edits); !ok) return ok.error();
  for (size_t i = 0; i < options.area_costs.size(); i += 2) {
    const double kind = options.area_costs[i];
    if (!(kind >= 0 && kind <= 255 && kind == std::floor(kind))) {
      return Error{
          Errc::kBadConfig,
          fmt::format("--area-cost: {} is no kind of ground; kinds are whole numbers from 0 to 255",
                      kind)};
    }
    if (auto ok = edits.set_area_cost(static_cast<uint8_t>(kind), options.area_costs[i + 1]); !ok) {
      return Error{ok.error().code, "--area-cost: " + ok.error().message};
    }
  }
  for (size_t i = 0; i < options.off_mesh_links.size(); i += 6) {
    OffMeshLink link;
    for (Place* end : {&link.from, &link.to}) {
      const auto at =
          options.off_mesh_links.begin() + static_cast<ptrdiff_t>(i + (end == &link.to ? 3 : 0));
      auto place = place_of(world, options, avatar_class, {at, at + 3}, "--off-mesh-link");
      if (!place) return place.error();
      *end = *place;
    }
    link.cost = length(link.to.position - link.from.position);
    if (auto added = edits.add_off_mesh_link(link); !added) {
      return Error{Errc::kBadInput, "--off-mesh-link: " + added.error().message};
    }
  }
  return {};
}

}  // namespace throng::app
