// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "impostor/figure_mesh.h"

#include "core/math/trig.h"

// Builds tubes from rings of vertices.
namespace throng::impostor {
namespace {

constexpr uint32_t kSides = 20;  // Even: left and right then mirror each other.

Influence influence_of(const BodyRing& ring) {
  Influence out;
  out.bone = {ring.bone, ring.other, 0, 0};
  out.weight = {static_cast<float>(1 - ring.share), static_cast<float>(ring.share), 0, 0};
  return out;
}

}  // namespace

void add_tube(Character& character, const std::vector<BodyRing>& rings, uint8_t material) {
  const auto base = static_cast<uint32_t>(character.positions.size());
  const auto add = [&](Vec3d p, const BodyRing& ring) {
    character.positions.push_back(p);
    character.normals.push_back({});
    character.influences.push_back(influence_of(ring));
  };
  for (const BodyRing& ring : rings) {
    for (uint32_t s = 0; s < kSides; ++s) {
      const double angle = (s + 0.5) / kSides;
      add(ring.centre + Vec3d{ring.wide * sin_turns(angle), 0, ring.deep * cos_turns(angle)}, ring);
    }
  }
  const auto count = static_cast<uint32_t>(rings.size());
  const uint32_t below = base + count * kSides, above = below + 1;
  add(rings.front().centre, rings.front());
  add(rings.back().centre, rings.back());
  const auto triangle = [&](uint32_t a, uint32_t b, uint32_t c) {
    const auto& p = character.positions;
    const Vec3d normal = cross(p[b] - p[a], p[c] - p[a]);  // Its length is twice the area.
    for (const uint32_t corner : {a, b, c}) {
      character.normals[corner] = character.normals[corner] + normal;
    }
    character.triangles.push_back({a, b, c});
    character.material.push_back(material);
  };
  for (uint32_t s = 0; s < kSides; ++s) {
    const uint32_t next = (s + 1) % kSides;
    for (uint32_t r = 0; r + 1 < count; ++r) {
      const uint32_t low = base + r * kSides, high = low + kSides;
      triangle(low + s, low + next, high + next);
      triangle(low + s, high + next, high + s);
    }
    const uint32_t top = base + (count - 1) * kSides;
    triangle(below, base + next, base + s);
    triangle(above, top + s, top + next);
  }
  for (size_t v = base; v < character.normals.size(); ++v) {
    const double size = length(character.normals[v]);
    if (size > 0) character.normals[v] = character.normals[v] * (1 / size);
  }
}

}  // namespace throng::impostor
