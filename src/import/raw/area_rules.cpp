// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "import/raw/area_rules.h"

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

#include "import/raw/scene_triangles.h"

// Gives triangles their area kinds by the names of their parts. Linear in parts and triangles;
// patterns are matched with one place to return to, so a match needs pattern x text steps at most.
namespace throng::importer {
namespace {

char lower(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

}  // namespace

// One place to return to suffices: a later star makes all earlier ones irrelevant.
bool glob_matches(std::string_view pattern, std::string_view text) {
  if (pattern.empty()) return true;
  size_t p = 0;
  size_t t = 0;
  size_t star = std::string_view::npos;
  size_t retry = 0;
  while (t < text.size()) {
    if (p < pattern.size() && pattern[p] == '*') {
      star = p++;
      retry = t;
    } else if (p < pattern.size() && (pattern[p] == '?' || lower(pattern[p]) == lower(text[t]))) {
      ++p;
      ++t;
    } else if (star != std::string_view::npos) {
      p = star + 1;
      t = ++retry;
    } else {
      return false;
    }
  }
  while (p < pattern.size() && pattern[p] == '*') ++p;
  return p == pattern.size();
}

bool glob_matches_path(std::string_view pattern, std::string_view path) {
  if (glob_matches(pattern, path)) return true;
  while (!path.empty()) {
    const size_t slash = path.find('/');
    if (glob_matches(pattern, path.substr(0, slash))) return true;
    if (slash == std::string_view::npos) break;
    path.remove_prefix(slash + 1);
  }
  return false;
}

std::span<const AreaRule> default_rules() {
  static const std::array<AreaRule, 6> rules{{
      {.material = {}, .node = "IfcSpace*", .kind = kAreaIgnored},
      {.material = {}, .node = "IfcOpeningElement*", .kind = kAreaIgnored},
      {.material = {}, .node = "TrafficSpace", .kind = kAreaIgnored},
      {.material = {}, .node = "AuxiliaryTrafficSpace", .kind = kAreaIgnored},
      {.material = {}, .node = "ClearanceSpace", .kind = kAreaIgnored},
      {.material = "ClosureSurface", .node = {}, .kind = kAreaIgnored},
  }};
  return rules;
}

void apply_rules(Scene& scene, std::span<const AreaRule> rules) {
  const auto kind_of = [&](const ScenePart& part) {
    std::optional<AreaKind> kind;
    // A default rule tests the part's own name alone: furniture hangs below its IfcSpace.
    const std::string_view node = part.node;
    const std::string_view own = node.substr(node.rfind('/') + 1);
    const std::string_view type = node.substr(0, node.find('/'));  // "Type/id" of city models.
    for (const AreaRule& rule : default_rules()) {
      if (!glob_matches(rule.material, part.material)) continue;
      if (glob_matches(rule.node, own) || glob_matches(rule.node, type)) kind = rule.kind;
    }
    for (const AreaRule& rule : rules) {
      if (!glob_matches(rule.material, part.material)) continue;
      if (glob_matches_path(rule.node, part.node)) kind = rule.kind;
    }
    return kind;
  };
  size_t kept = 0;
  std::vector<ScenePart> kept_parts;
  for (ScenePart& part : scene.parts) {
    const std::optional<AreaKind> kind = kind_of(part);
    if (kind == kAreaIgnored) {
      scene.report.ignored += part.triangle_count;
      continue;
    }
    const auto first = static_cast<uint32_t>(kept);
    if (!kind && kept == part.first_triangle) {  // Nothing to move, nothing to mark.
      kept += part.triangle_count;
      kept_parts.push_back(std::move(part));
      continue;
    }
    for (uint32_t i = 0; i < part.triangle_count; ++i, ++kept) {
      const size_t from = size_t{part.first_triangle} + i;
      move_triangle(scene, from, kept);
      if (kind) scene.area[kept] = *kind;  // A plan's walls are blocked already.
    }
    part.first_triangle = first;
    kept_parts.push_back(std::move(part));
  }
  scene.parts = std::move(kept_parts);
  keep_triangles(scene, kept);
}

}  // namespace throng::importer
