// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <span>

#include "throng/surface.h"

/// The bins in which promises are stored.
namespace throng::graph {

/// Every class's own limits, so that no class loses anything by rounding, and a few edges between
/// them so that costs and pictures can distinguish slopes. At most 15 of each.
[[nodiscard]] NodeBins make_bins(std::span<const AvatarClass> classes);

}  // namespace throng::graph
