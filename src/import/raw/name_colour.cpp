// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "import/raw/name_colour.h"

#include <cstdint>
#include <map>
#include <string>

// Looks for known words in names of materials and nodes. Linear in the length of a name.
namespace throng::importer {
namespace {

struct Named {
  std::string_view word;
  float r, g, b, a;
};

// The materials of built-in worlds.
constexpr std::array<Named, 27> kWhole = {{
    {"floor", 0.50F, 0.49F, 0.46F, 1},     {"slab", 0.38F, 0.38F, 0.38F, 1},
    {"wall", 0.72F, 0.66F, 0.56F, 1},      {"roof", 0.42F, 0.14F, 0.09F, 1},
    {"ramp", 0.62F, 0.47F, 0.22F, 1},      {"stairs", 0.68F, 0.52F, 0.32F, 1},
    {"pillar", 0.60F, 0.60F, 0.62F, 1},    {"kerb", 0.66F, 0.64F, 0.58F, 1},
    {"pavement", 0.44F, 0.42F, 0.39F, 1},  {"road", 0.10F, 0.10F, 0.11F, 1},
    {"grass", 0.16F, 0.32F, 0.09F, 1},     {"stone", 0.60F, 0.54F, 0.43F, 1},
    {"wood", 0.30F, 0.16F, 0.07F, 1},      {"grating", 0.40F, 0.43F, 0.46F, 1},
    {"steel", 0.14F, 0.24F, 0.36F, 1},     {"railing", 0.80F, 0.58F, 0.06F, 1},
    {"pipe", 0.55F, 0.58F, 0.60F, 1},      {"tank", 0.72F, 0.74F, 0.76F, 1},
    {"car", 0.55F, 0.03F, 0.03F, 1},       {"car dark", 0.03F, 0.06F, 0.16F, 1},
    {"car light", 0.70F, 0.71F, 0.73F, 1}, {"tyre", 0.02F, 0.02F, 0.02F, 1},
    {"glass", 0.06F, 0.12F, 0.16F, 1},     {"trunk", 0.16F, 0.09F, 0.04F, 1},
    {"crown", 0.10F, 0.26F, 0.06F, 1},     {"water", 0.05F, 0.18F, 0.26F, 1},
    {"tiles", 0.36F, 0.13F, 0.09F, 1},
}};

// Words that may stand anywhere in a name; the first that is found counts:
// "textures/gothic_floor/metalbridge06", "RoofSurface", "IfcWallStandardCase".
constexpr std::array<Named, 57> kWords = {{
    {"water", 0.05F, 0.18F, 0.26F, 1},      {"lava", 0.70F, 0.15F, 0.02F, 1},
    {"grass", 0.16F, 0.28F, 0.09F, 1},      {"vegetation", 0.11F, 0.24F, 0.07F, 1},
    {"plantcover", 0.13F, 0.25F, 0.08F, 1}, {"foliage", 0.11F, 0.24F, 0.07F, 1},
    {"leaves", 0.11F, 0.24F, 0.07F, 1},     {"tree", 0.11F, 0.22F, 0.07F, 1},
    {"glass", 0.10F, 0.17F, 0.21F, 1},      {"window", 0.10F, 0.17F, 0.21F, 1},
    {"brick", 0.38F, 0.15F, 0.09F, 1},      {"railing", 0.30F, 0.31F, 0.33F, 1},
    {"rust", 0.25F, 0.11F, 0.05F, 1},       {"metal", 0.26F, 0.28F, 0.30F, 1},
    {"steel", 0.26F, 0.28F, 0.30F, 1},      {"iron", 0.20F, 0.20F, 0.21F, 1},
    {"alumin", 0.52F, 0.54F, 0.56F, 1},     {"copper", 0.42F, 0.19F, 0.09F, 1},
    {"wood", 0.30F, 0.17F, 0.08F, 1},       {"timber", 0.30F, 0.17F, 0.08F, 1},
    {"plank", 0.30F, 0.17F, 0.08F, 1},      {"door", 0.27F, 0.15F, 0.08F, 1},
    {"furni", 0.32F, 0.20F, 0.11F, 1},      {"marble", 0.68F, 0.66F, 0.62F, 1},
    {"granite", 0.30F, 0.29F, 0.29F, 1},    {"gravel", 0.38F, 0.35F, 0.31F, 1},
    {"cobble", 0.30F, 0.28F, 0.26F, 1},     {"stone", 0.46F, 0.41F, 0.33F, 1},
    {"rock", 0.36F, 0.33F, 0.28F, 1},       {"cliff", 0.36F, 0.32F, 0.26F, 1},
    {"sand", 0.60F, 0.49F, 0.30F, 1},       {"dirt", 0.24F, 0.16F, 0.09F, 1},
    {"snow", 0.80F, 0.82F, 0.84F, 1},       {"concrete", 0.42F, 0.42F, 0.40F, 1},
    {"cement", 0.42F, 0.42F, 0.40F, 1},     {"asphalt", 0.10F, 0.10F, 0.11F, 1},
    {"plaster", 0.68F, 0.64F, 0.56F, 1},    {"gypsum", 0.72F, 0.70F, 0.66F, 1},
    {"carpet", 0.20F, 0.14F, 0.15F, 1},     {"curtain", 0.38F, 0.20F, 0.17F, 1},
    {"fabric", 0.36F, 0.25F, 0.20F, 1},     {"tile", 0.48F, 0.42F, 0.36F, 1},
    {"roof", 0.36F, 0.13F, 0.09F, 1},       {"ceiling", 0.66F, 0.65F, 0.62F, 1},
    {"bridge", 0.46F, 0.45F, 0.43F, 1},     {"tunnel", 0.34F, 0.33F, 0.32F, 1},
    {"stair", 0.55F, 0.44F, 0.30F, 1},      {"column", 0.56F, 0.55F, 0.52F, 1},
    {"pillar", 0.56F, 0.55F, 0.52F, 1},     {"wall", 0.66F, 0.60F, 0.50F, 1},
    {"road", 0.12F, 0.12F, 0.13F, 1},       {"traffic", 0.14F, 0.14F, 0.15F, 1},
    {"railway", 0.24F, 0.20F, 0.17F, 1},    {"floor", 0.48F, 0.45F, 0.40F, 1},
    {"ground", 0.30F, 0.27F, 0.21F, 1},     {"terrain", 0.23F, 0.27F, 0.14F, 1},
    {"relief", 0.23F, 0.27F, 0.14F, 1},
}};

std::array<float, 4> colour_of(const Named& named) { return {named.r, named.g, named.b, named.a}; }

}  // namespace

std::optional<std::array<float, 4>> name_colour(std::string_view name) {
  for (const Named& named : kWhole) {
    if (named.word == name) return colour_of(named);
  }
  std::string lower(name);
  for (char& c : lower) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  for (const Named& named : kWords) {
    if (lower.find(named.word) != std::string::npos) return colour_of(named);
  }
  return std::nullopt;
}

std::array<float, 4> any_colour(std::string_view name) {
  if (const auto known = name_colour(name)) return *known;
  uint32_t hash = 2166136261U;  // FNV-1a
  for (const char c : name) hash = (hash ^ static_cast<uint8_t>(c)) * 16777619U;
  const auto part = [&](uint32_t shift) {
    return 0.15F + 0.6F * static_cast<float>((hash >> shift) & 255) / 255.0F;
  };
  return {part(0), part(8), part(16), 1};
}

void add_named_materials(Scene& scene) {
  std::map<std::string, uint32_t> made;
  for (ScenePart& part : scene.parts) {
    if (part.material1 != 0) continue;
    std::string name = part.material;
    auto colour = name_colour(name);
    if (!colour) {
      // Of "Type/id" or "storey/wall/wall 12" the last part that has a known colour.
      for (size_t end = part.node.size(); !colour && end != std::string::npos;) {
        const size_t slash = end == 0 ? std::string::npos : part.node.rfind('/', end - 1);
        const size_t begin = slash == std::string::npos ? 0 : slash + 1;
        name = part.node.substr(begin, end - begin);
        colour = name_colour(name);
        end = slash;
      }
    }
    if (!colour) continue;
    const auto [found, is_new] =
        made.try_emplace(name, static_cast<uint32_t>(scene.materials.size()) + 1);
    if (is_new) {
      scene.materials.push_back({.name = name, .colour = *colour, .opacity = Opacity::kOpaque});
    }
    part.material1 = found->second;
  }
}

}  // namespace throng::importer
