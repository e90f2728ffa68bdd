// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "throng/base.h"
#include "throng/world.h"

/// The links of a world's air as lines to draw, like the last figures of [PACS00].
namespace throng::render {

/// From the middle of a free air box to the middle of one that shares a face with it, or to the
/// ground elected for it.
struct AirLine {
  Vec3d a, b;
  bool to_ground = false;
};

/// Lines from air boxes whose middle lies in the area's x and z; from all for an empty area. Ground
/// is linked for the first class that flies. Fails with kNotFound: the world has no air.
[[nodiscard]] Result<std::vector<AirLine>> air_lines(const World& world, const Box3d& area);

}  // namespace throng::render
