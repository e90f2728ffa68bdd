// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "throng/base.h"
#include "throng/world.h"

namespace throng::view {

/// Heights of the storeys of a world, lowest first: heights of large level areas, at least two
/// metres apart. A landscape may have one or none. Reads every zone. [m]
[[nodiscard]] std::vector<double> storey_heights(const World& world, Context& context);

}  // namespace throng::view
