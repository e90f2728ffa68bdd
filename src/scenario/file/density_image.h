// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <string>

#include "throng/scenario.h"

/// Density maps from images and painted areas.
namespace throng::scenario {

/// Reads a PNG's brightness into width, height and weights. Fails with kBadFile.
[[nodiscard]] Result<void> read_density_image(const std::string& path, DensityMap& map);

/// Sets the weight of the pixels whose middles are in one of the prisms.
void paint_density(DensityMap& map, std::span<const Prism> prisms, uint8_t weight);

}  // namespace throng::scenario
