// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <optional>
#include <string_view>

#include "throng/scene.h"

/// Colours by name, for worlds that name their materials but give them no colours.
namespace throng::importer {

/// In linear light. Nothing if no part of the name is known.
[[nodiscard]] std::optional<std::array<float, 4>> name_colour(std::string_view name);

/// The same, or a colour made from a hash of the name.
[[nodiscard]] std::array<float, 4> any_colour(std::string_view name);

/// Gives each part without a material one by its material's name, or by its node's name, if that
/// name is known.
void add_named_materials(Scene& scene);

}  // namespace throng::importer
