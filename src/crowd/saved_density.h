// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "crowd/mode/shared_state.h"

/// Density classes as the bytes of a saved crowd.
namespace throng::crowd {

[[nodiscard]] std::vector<uint8_t> save_densities(std::span<const DensityClass> classes);
/// Of classes of the world below `bodies`. None: the bytes are not what save_densities writes.
[[nodiscard]] std::optional<std::vector<DensityClass>> restore_densities(
    std::span<const uint8_t> saved, size_t bodies);

}  // namespace throng::crowd
