// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "paths/clearance_output.h"

#include <fmt/format.h>

// What nodes promise at a place or along a path, for people and as JSON.
namespace throng::app {
namespace {

std::vector<std::string> names_of(uint16_t stand, const std::vector<AvatarClass>& classes) {
  std::vector<std::string> names;
  for (size_t c = 0; c < classes.size(); ++c) {
    if ((stand >> c & 1) != 0) names.push_back(classes[c].name);
  }
  return names;
}

}  // namespace

Json clearance_json(const NodeClearance& clearance, const std::vector<AvatarClass>& classes) {
  return {{"inclination", clearance.inclination},
          {"height", clearance.height},
          {"headroom", clearance.headroom},
          {"width", clearance.width},
          {"classes", names_of(clearance.classes, classes)}};
}

std::string clearance_text(const NodeClearance& clearance, const std::vector<AvatarClass>& classes,
                           const std::string& where) {
  std::string names;
  for (const std::string& name : names_of(clearance.classes, classes)) {
    names += (names.empty() ? "" : ", ") + name;
  }
  return fmt::format(
      "  {} the ground is at most {:g} deg steep, with {:.2f} m free along its normal and {:.2f} m "
      "straight up,\n  and there is nowhere closed within {:.3f} m; can stand there: {}\n",
      where, clearance.inclination, clearance.height, clearance.headroom, clearance.width, names);
}

}  // namespace throng::app
