// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "throng/base.h"

namespace throng {

/// The box of the corners that triangles use; empty without triangles. Linear, on `workers` threads
/// (0: all).
[[nodiscard]] Box3d corner_box(std::span<const Vec3d> positions,
                               std::span<const std::array<uint32_t, 3>> triangles, int32_t workers);

}  // namespace throng
