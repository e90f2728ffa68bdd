// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "impostor/worn_parts.h"

#include <algorithm>
#include <array>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "core/random.h"

// Parts that avatars of one body exchange: which of them an avatar wears, and a part of one figure
// on the body of another. [TC00] 5 proposes both: "the different parts could be interchanged
// between avatars".
namespace throng {
namespace {

constexpr uint64_t kSeed = 0x776f726e;

// Out of a hundred avatars, how many wear one of this kind.
constexpr std::array<uint64_t, kWornKinds> kWearers = {50, 30, 35, 25, 30};

size_t body_vertices(const Character& character) {
  size_t first = character.positions.size();
  for (size_t t = character.body_triangles(); t < character.triangles.size(); ++t) {
    for (const uint32_t corner : character.triangles[t]) first = std::min<size_t>(first, corner);
  }
  return first;
}

// Copies one triangle after the other, with what they need.
class PartCopy {
 public:
  PartCopy(Character& onto, const Character& from) : onto_(onto), from_(from) {}

  // Fails with kNotFound: no joint of that name.
  Result<void> add(size_t triangle) {
    std::array<uint32_t, 3> corners{};
    for (size_t k = 0; k < 3; ++k) {
      const auto vertex = vertex_of(from_.triangles[triangle][k]);
      if (!vertex) return vertex.error();
      corners[k] = *vertex;
    }
    onto_.triangles.push_back(corners);
    onto_.material.push_back(material_of(from_.material[triangle]));
    return {};
  }

 private:
  Result<uint32_t> vertex_of(uint32_t vertex) {
    const auto found = vertices_.find(vertex);
    if (found != vertices_.end()) return found->second;
    Influence influence = from_.influences[vertex];
    for (size_t k = 0; k < influence.bone.size(); ++k) {
      if (influence.weight[k] == 0) continue;
      const auto bone = bone_of(influence.bone[k]);
      if (!bone) return bone.error();
      influence.bone[k] = *bone;
    }
    const auto number = static_cast<uint32_t>(onto_.positions.size());
    onto_.positions.push_back(from_.positions[vertex]);
    onto_.normals.push_back(from_.normals[vertex]);
    onto_.influences.push_back(influence);
    vertices_.emplace(vertex, number);
    return number;
  }
  // A bone of its own: the mesh hangs on the joint as it hung on that of its figure.
  Result<uint8_t> bone_of(uint8_t bone) {
    const auto found = bones_.find(bone);
    if (found != bones_.end()) return found->second;
    const Bone& source = from_.bones[bone];
    const std::string& name = from_.joints[static_cast<size_t>(source.joint)].name;
    const auto joint = std::find_if(onto_.joints.begin(), onto_.joints.end(),
                                    [&](const Joint& j) { return j.name == name; });
    if (joint == onto_.joints.end()) {
      return Error{Errc::kNotFound, "part: the body has no joint " + name +
                                        "; take a part of a figure with the same skeleton"};
    }
    if (onto_.bones.size() >= kMaxBones) {
      return Error{Errc::kLimit, "part: more than " + std::to_string(kMaxBones) + " bones"};
    }
    onto_.bones.push_back({.joint = static_cast<int32_t>(joint - onto_.joints.begin()),
                           .inverse_bind = source.inverse_bind});
    const auto number = static_cast<uint8_t>(onto_.bones.size() - 1);
    bones_.emplace(bone, number);
    return number;
  }
  uint8_t material_of(uint8_t material) {
    const auto found = materials_.find(material);
    if (found != materials_.end()) return found->second;
    onto_.materials.push_back(from_.materials[material]);
    const auto number = static_cast<uint8_t>(onto_.materials.size() - 1);
    materials_.emplace(material, number);
    return number;
  }

  Character& onto_;
  const Character& from_;
  std::map<uint32_t, uint32_t> vertices_;
  std::map<uint8_t, uint8_t> bones_, materials_;
};

}  // namespace

const char* word_for(WornKind kind) {
  static constexpr const char* kWords[] = {"hair", "hat", "coat", "bag", "skirt"};
  return kWords[static_cast<size_t>(kind)];
}

uint32_t worn_by(std::span<const AtlasPart> parts, uint32_t appearance) {
  uint32_t worn = 0;
  for (uint32_t kind = 0; kind < kWornKinds; ++kind) {
    if (random_below(kSeed, appearance, 2 * kind, 100) >= kWearers[kind]) continue;
    uint64_t count = 0;
    for (const AtlasPart& part : parts) count += part.kind == static_cast<WornKind>(kind) ? 1 : 0;
    if (count == 0) continue;
    uint64_t chosen = random_below(kSeed, appearance, 2 * kind + 1, count);
    for (size_t i = 0; i < parts.size(); ++i) {
      if (parts[i].kind == static_cast<WornKind>(kind) && chosen-- == 0) worn |= 1U << i;
    }
  }
  return worn;
}

Result<void> wear_part(Character& onto, const Character& from, BodyPart part, WornKind kind) {
  if (onto.worn.size() >= kMaxWorn) {
    return Error{Errc::kLimit, "part: more than " + std::to_string(kMaxWorn) + " to wear"};
  }
  if (onto.materials.size() + from.materials.size() > 256) {
    return Error{Errc::kLimit, "part: more than 256 materials"};
  }
  std::vector<size_t> chosen;
  for (const WornPart& worn : from.worn) {
    if (worn.kind != kind || !chosen.empty()) continue;
    for (uint32_t t = 0; t < worn.triangle_count; ++t) chosen.push_back(worn.first_triangle + t);
  }
  for (size_t t = 0; t < from.body_triangles() && from.worn.empty(); ++t) {
    if (from.materials[from.material[t]].part == part) chosen.push_back(t);
  }
  if (chosen.empty()) {
    return Error{Errc::kNotFound, std::string("part: the figure has no ") + word_for(part)};
  }
  Character grown = onto;  // So that a part that fails leaves nothing behind.
  PartCopy copy(grown, from);
  const auto first = static_cast<uint32_t>(grown.triangles.size());
  for (const size_t t : chosen) {
    if (auto ok = copy.add(t); !ok) return ok;
  }
  grown.worn.push_back(
      {word_for(kind), kind, first, static_cast<uint32_t>(grown.triangles.size()) - first});
  onto = std::move(grown);
  return {};
}

Character impostor::body_of(const Character& character) {
  Character body = character;
  const size_t vertices = body_vertices(character);
  body.triangles.resize(character.body_triangles());
  body.material.resize(body.triangles.size());
  body.positions.resize(vertices);
  body.normals.resize(vertices);
  body.influences.resize(vertices);
  body.worn.clear();
  return body;
}

bool impostor::is_rigid(WornKind kind) {
  return kind == WornKind::kHair || kind == WornKind::kHat || kind == WornKind::kBag;
}

Vec3d impostor::movement_of(const Character& character, const WornPart& part, const PosedMesh& from,
                            const PosedMesh& to) {
  Vec3d sum;
  for (uint32_t t = 0; t < part.triangle_count; ++t) {
    for (const uint32_t corner : character.triangles[part.first_triangle + t]) {
      sum = sum + to.positions[corner] - from.positions[corner];
    }
  }
  return sum * (1.0 / (3.0 * part.triangle_count));
}

Result<void> impostor::check_worn(const Character& character) {
  if (character.worn.empty()) return {};
  const auto bad = [](const char* what) {
    return Error{Errc::kBadInput, std::string("atlas: worn parts ") + what};
  };
  if (character.worn.size() > kMaxWorn) return bad("are more than 16");
  size_t at = character.worn[0].first_triangle;
  for (const WornPart& part : character.worn) {
    if (part.first_triangle != at || part.triangle_count == 0) {
      return bad("must follow one another, and have triangles");
    }
    at += part.triangle_count;
  }
  if (at != character.triangles.size()) return bad("must end with the last triangle");
  const size_t vertices = body_vertices(character);
  for (size_t t = 0; t < character.body_triangles(); ++t) {
    for (const uint32_t corner : character.triangles[t]) {
      if (corner >= vertices) return bad("must have vertices of their own, behind the body's");
    }
  }
  return {};
}

}  // namespace throng
