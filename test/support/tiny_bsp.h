// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

/// Quake 3 levels made by hand, for the reader's tests.
namespace throng::test {

struct TinyTexture {
  std::string name;
  int32_t surface = 0;
  int32_t content = 1;  // solid
};

struct TinyFace {
  int32_t texture = 0;
  int32_t type = 1;
  std::vector<std::array<float, 3>> points;
  std::vector<int32_t> corners;  // Of polygons and meshes: triples of indices into points.
  int32_t columns = 0;           // Of patches.
  int32_t rows = 0;
};

/// The bytes of a level: model 0 owns the first `world_faces` faces, model 1 the rest.
inline std::string make_bsp(const std::vector<TinyTexture>& textures,
                            const std::vector<TinyFace>& faces, size_t world_faces,
                            const std::string& entities) {
  std::string lumps[17];
  const auto put = [](std::string& out, const auto& value) {
    out.append(reinterpret_cast<const char*>(&value), sizeof value);
  };
  lumps[0] = entities;
  for (const TinyTexture& texture : textures) {
    std::string name = texture.name;
    name.resize(64, '\0');
    lumps[1] += name;
    put(lumps[1], texture.surface);
    put(lumps[1], texture.content);
  }
  for (int model = 0; model < 2; ++model) {
    for (int i = 0; i < 6; ++i) put(lumps[7], 0.0f);
    put(lumps[7], static_cast<int32_t>(model == 0 ? 0 : world_faces));
    put(lumps[7], static_cast<int32_t>(model == 0 ? world_faces : faces.size() - world_faces));
    put(lumps[7], int32_t{0});
    put(lumps[7], int32_t{0});
  }
  int32_t vertex = 0;
  int32_t corner = 0;
  for (const TinyFace& face : faces) {
    for (const auto& p : face.points) {
      for (const float value : p) put(lumps[10], value);
      for (int i = 0; i < 8; ++i) put(lumps[10], 0.0f);  // Texture, light map, normal, colour.
    }
    for (const int32_t index : face.corners) put(lumps[11], index);
    const auto points = static_cast<int32_t>(face.points.size());
    const auto corners = static_cast<int32_t>(face.corners.size());
    for (const int32_t value : {face.texture, -1, face.type, vertex, points, corner, corners}) {
      put(lumps[13], value);
    }
    for (int i = 0; i < 17; ++i) put(lumps[13], int32_t{0});
    put(lumps[13], face.columns);
    put(lumps[13], face.rows);
    vertex += points;
    corner += corners;
  }
  std::string out = "IBSP";
  put(out, int32_t{46});
  auto offset = static_cast<int32_t>(8 + 17 * 8);
  for (const std::string& lump : lumps) {
    put(out, offset);
    put(out, static_cast<int32_t>(lump.size()));
    offset += static_cast<int32_t>(lump.size());
  }
  for (const std::string& lump : lumps) out += lump;
  return out;
}

/// A floor, an arch as a 3 x 3 patch, water, and a door as model 1.
inline std::string tiny_level() {
  const std::vector<TinyTexture> textures{{"textures/base/floor", 0, 1},
                                          {"textures/base/arch", 0, 1},
                                          {"textures/liquids/water", 0, 32}};
  TinyFace floor{0, 1, {{0, 0, 0}, {400, 0, 0}, {400, 400, 0}, {0, 400, 0}}, {0, 1, 2, 0, 2, 3},
                 0, 0};
  TinyFace arch{1, 2, {}, {}, 3, 3};
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) {
      arch.points.push_back({100.0f * static_cast<float>(column), 100.0f * static_cast<float>(row),
                             column == 1 ? 200.0f : 0.0f});
    }
  }
  TinyFace water = floor;
  water.texture = 2;
  TinyFace door = floor;
  door.type = 3;
  for (auto& p : door.points) p[2] = 80;
  return make_bsp(
      textures, {floor, arch, water, door}, 3,
      "{ \"classname\" \"worldspawn\" } { \"model\" \"*1\" \"classname\" \"func_door\" }");
}

}  // namespace throng::test
