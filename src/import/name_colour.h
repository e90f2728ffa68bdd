// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <optional>
#include <string_view>

#include "throng/scene.h"

/// Colours by what things are called: for worlds that say what they are made of, but not what it
/// looks like.
namespace throng {

/// In linear light. Nothing if the name is of nothing known.
[[nodiscard]] std::optional<std::array<float, 4>> name_colour(std::string_view name);

/// The same, or a colour of the name's own.
[[nodiscard]] std::array<float, 4> any_colour(std::string_view name);

/// Gives each part that has no material one by the name of its material, or else of its node, where
/// these say what it is.
void add_named_materials(Scene& scene);

}  // namespace throng
