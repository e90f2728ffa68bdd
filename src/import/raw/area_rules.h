// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <string_view>

#include "throng/scene.h"

/// Area kinds by name: which triangles are walkable, blocked or not solid.
namespace throng::importer {

/// Shell pattern (`*`, `?`), ASCII case ignored. An empty pattern matches everything. Linear in
/// practice: never more than pattern x text steps.
[[nodiscard]] bool glob_matches(std::string_view pattern, std::string_view text);

/// The same for a node path "a/b/c": the pattern may match the whole path or any one name in it.
[[nodiscard]] bool glob_matches_path(std::string_view pattern, std::string_view path);

/// What is not solid unless a rule of the user says so: volumes of rooms, cut-outs of doors and
/// windows, surfaces that only close a model for its maker's arithmetic.
[[nodiscard]] std::span<const AreaRule> default_rules();

/// Sets `area` by the default rules, then by `rules`; the last match wins. Triangles of ignored
/// parts are removed and counted in the report.
void apply_rules(Scene& scene, std::span<const AreaRule> rules);

}  // namespace throng::importer
