// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <string>
#include <vector>

#include "core/files/read_file.h"
#include "import/formats/glb.h"
#include "import/formats/mtl.h"
#include "import/formats/texture_reader.h"
#include "import/raw/name_colour.h"
#include "scratch_folder.h"
#include "throng/scene.h"

namespace throng {
namespace {

// Two rows of two texels: red, green; blue, see-through white.
Texture four_texels() {
  return {.name = "four.png",
          .width = 2,
          .height = 2,
          .rgba = {255, 0, 0, 255, 0, 255, 0, 255, 0, 0, 255, 255, 255, 255, 255, 0}};
}

// An uncompressed TGA, rows from the top, which any program can write.
std::string tga(int32_t width, int32_t height, const std::vector<uint8_t>& rgba) {
  const std::array<uint8_t, 18> head{0,
                                     0,
                                     2,
                                     0,
                                     0,
                                     0,
                                     0,
                                     0,
                                     0,
                                     0,
                                     0,
                                     0,
                                     static_cast<uint8_t>(width),
                                     static_cast<uint8_t>(width >> 8),
                                     static_cast<uint8_t>(height),
                                     static_cast<uint8_t>(height >> 8),
                                     32,
                                     0x28};
  std::string out(reinterpret_cast<const char*>(head.data()), head.size());
  for (size_t i = 0; i < rgba.size(); i += 4) {
    for (const size_t c : {2, 1, 0, 3}) out += static_cast<char>(rgba[i + c]);
  }
  return out;
}

std::string tga(const Texture& t) { return tga(t.width, t.height, t.rgba); }

// A square with the whole texture on it, a triangle of one colour, and one without material.
Scene textured_scene() {
  Scene scene;
  scene.add_quad({0, 0, 0}, {1, 0, 0}, {1, 0, 1}, {0, 0, 1});
  scene.add_triangle({2, 0, 0}, {3, 0, 0}, {3, 0, 1});
  scene.add_triangle({4, 0, 0}, {5, 0, 0}, {5, 0, 1});
  scene.textures = {four_texels()};
  scene.materials = {
      {.name = "sign",
       .colour = {0.5F, 1, 1, 1},
       .texture1 = 1,
       .opacity = Opacity::kHoles,
       .threshold = 0.25F},
      {.name = "pane", .colour = {0.1F, 0.2F, 0.3F, 0.5F}, .opacity = Opacity::kBlended}};
  scene.parts = {
      {.file = {},
       .node = "a",
       .material = "sign",
       .first_triangle = 0,
       .triangle_count = 2,
       .material1 = 1},
      {.file = {},
       .node = "b",
       .material = "pane",
       .first_triangle = 2,
       .triangle_count = 1,
       .material1 = 2},
      {.file = {}, .node = "c", .material = "thing", .first_triangle = 3, .triangle_count = 1}};
  const auto& t = scene.triangles;
  scene.texture_corners.resize(t.size());
  for (size_t i = 0; i < 2; ++i) {
    for (size_t k = 0; k < 3; ++k) {
      const Vec3d p = scene.positions[t[i][k]];
      scene.texture_corners[i][k] = {static_cast<float>(p.x), static_cast<float>(p.z)};
    }
  }
  return scene;
}

Result<Scene> load(const std::string& path, std::vector<AreaVolume> volumes = {}) {
  SceneConfig config;
  config.sources.push_back({.path = path, .up = {}, .scale = {}, .transform = {}});
  config.materials = SceneMaterials::kRead;
  config.volumes = std::move(volumes);
  Context context;
  return load_scene(config, context);
}

const Material& material_of(const Scene& scene, std::string_view node) {
  for (const ScenePart& part : scene.parts) {
    if (part.node == node && part.material1 != 0) return scene.materials[part.material1 - 1];
  }
  static const Material none{.name = "none"};
  ADD_FAILURE() << node << " has no material";
  return none;
}

void expect_looks_of_textured_scene(const Scene& scene) {
  const Material& sign = material_of(scene, "a");
  EXPECT_EQ(sign.name, "sign");
  EXPECT_NEAR(sign.colour[0], 0.5, 1e-6);
  EXPECT_EQ(sign.colour[1], 1);
  EXPECT_EQ(sign.opacity, Opacity::kHoles);
  EXPECT_EQ(sign.threshold, 0.25F);
  ASSERT_EQ(scene.textures.size(), 1U);
  ASSERT_EQ(sign.texture1, 1U);
  EXPECT_EQ(scene.textures[0].width, 2);
  EXPECT_EQ(scene.textures[0].rgba, four_texels().rgba);
  const Material& pane = material_of(scene, "b");
  EXPECT_EQ(pane.opacity, Opacity::kBlended);
  EXPECT_NEAR(pane.colour[2], 0.3, 1e-6);
  EXPECT_NEAR(pane.colour[3], 0.5, 1e-6);
  EXPECT_EQ(pane.texture1, 0U);
  ASSERT_EQ(scene.texture_corners.size(), scene.triangles.size());
  for (size_t t = 0; t < 2; ++t) {
    for (size_t k = 0; k < 3; ++k) {
      const Vec3d p = scene.positions[scene.triangles[t][k]];
      EXPECT_NEAR(scene.texture_corners[t][k][0], p.x, 1e-6);
      EXPECT_NEAR(scene.texture_corners[t][k][1], p.z, 1e-6);
    }
  }
}

TEST(Materials, GoThroughGlbAndBackWithTheirTextures) {
  const test::ScratchFolder folder;
  const std::string path = folder.path() + "/looks.glb";
  ASSERT_TRUE(write_glb(textured_scene(), path));
  const auto by_assimp = load(path);
  ASSERT_TRUE(by_assimp) << by_assimp.error().message;
  EXPECT_TRUE(by_assimp->report.warnings.empty());
  expect_looks_of_textured_scene(*by_assimp);
  const auto bytes = read_file(path);
  ASSERT_TRUE(bytes);
  Context context;
  importer::ReadOptions options;
  options.name = path;
  options.materials = SceneMaterials::kRead;
  auto by_us = importer::read_glb(*bytes, options, context);
  ASSERT_TRUE(by_us) << by_us.error().message;
  ASSERT_TRUE(importer::read_textures(*by_us, path, context));
  expect_looks_of_textured_scene(by_us->scene);
}

TEST(Materials, AreLeftOutUnlessRequested) {
  const test::ScratchFolder folder;
  const std::string path = folder.path() + "/looks.glb";
  ASSERT_TRUE(write_glb(textured_scene(), path));
  SceneConfig config;
  config.sources.push_back({.path = path, .up = {}, .scale = {}, .transform = {}});
  Context context;
  const auto scene = load_scene(config, context);
  ASSERT_TRUE(scene);
  EXPECT_TRUE(scene->materials.empty());
  EXPECT_TRUE(scene->textures.empty());
  EXPECT_TRUE(scene->texture_corners.empty());
  config.materials = SceneMaterials::kRead;
  const auto looks = load_scene(config, context);
  ASSERT_TRUE(looks);
  EXPECT_EQ(scene->positions, looks->positions);
  EXPECT_EQ(scene->triangles, looks->triangles);
  EXPECT_EQ(scene->area, looks->area);
}

constexpr const char* kObj =
    "mtllib looks.mtl\n"
    "v 0 0 0\nv 1 0 0\nv 1 0 1\nv 0 0 1\nv 2 0 0\n"
    "vt 0 1\nvt 1 1\nvt 1 0\nvt 0 0\n"
    "o a\nusemtl sign\nf 1/1 2/2 3/3 4/-1\n"
    "o b\nusemtl pane\nf 1 2 5\n";
constexpr const char* kMtl =
    "newmtl sign\nKd 0 0 0\nmap_d four.tga\nmap_Kd -s 1 1 1 -clamp on four.tga\n"
    "newmtl pane\nKd 0.5 1 0\nd 0.25\n";

TEST(Materials, OfAnObjComeFromTheFileBesideIt) {
  const test::ScratchFolder folder;
  folder.write("looks.mtl", kMtl);
  folder.write("four.tga", tga(four_texels()));
  const auto scene = load(folder.write("looks.obj", kObj));
  ASSERT_TRUE(scene) << scene.error().message;
  EXPECT_TRUE(scene->report.warnings.empty());
  const Material& sign = material_of(*scene, "a");
  EXPECT_EQ(sign.opacity, Opacity::kHoles);
  EXPECT_EQ(sign.colour[0], 1);  // Black would leave nothing of the texture.
  ASSERT_EQ(sign.texture1, 1U);
  EXPECT_EQ(scene->textures[0].rgba, four_texels().rgba);
  const Material& pane = material_of(*scene, "b");
  EXPECT_EQ(pane.colour, (std::array<float, 4>{0.25F, 1, 0, 0.25F}));
  EXPECT_EQ(pane.opacity, Opacity::kBlended);
  ASSERT_EQ(scene->texture_corners.size(), 3U);
  for (size_t t = 0; t < 2; ++t) {
    for (size_t k = 0; k < 3; ++k) {
      const Vec3d p = scene->positions[scene->triangles[t][k]];
      EXPECT_NEAR(scene->texture_corners[t][k][0], p.x, 1e-6);
      EXPECT_NEAR(scene->texture_corners[t][k][1], p.z, 1e-6);
    }
  }
}

TEST(Materials, ThatAreMissingAreReportedOnceAndReplacedByPlainColours) {
  const test::ScratchFolder folder;
  const std::string path = folder.write("looks.obj", kObj);
  const auto without = load(path);
  ASSERT_TRUE(without);
  ASSERT_EQ(without->report.warnings.size(), 1U);
  EXPECT_EQ(without->report.warnings[0],
            path + ": the materials of looks.mtl are not beside it; plain colours stand in");
  folder.write("looks.mtl", std::string(kMtl) + "newmtl other\nmap_Kd nowhere/wall.png\n");
  folder.write("four.tga", tga(four_texels()).substr(0, 5));
  const auto damaged = load(path);
  ASSERT_TRUE(damaged);
  ASSERT_EQ(damaged->report.warnings.size(), 1U);
  EXPECT_EQ(damaged->report.warnings[0],
            path +
                ": 2 of 2 textures cannot be used, for one four.tga is no PNG, JPEG, TGA or "
                "BMP that can be read; plain colours stand in");
  for (const ScenePart& part : damaged->parts) {
    EXPECT_EQ(part.material1 != 0, part.node == "b") << part.node;
  }
  EXPECT_TRUE(damaged->texture_corners.empty());
}

// The sizes in a PNG's header precede everything that can be checked.
std::string png_of_size(uint32_t width, uint32_t height) {
  std::string out("\x89PNG\r\n\x1a\n\0\0\0\rIHDR", 16);
  for (const uint32_t value : {width, height}) {
    for (const int shift : {24, 16, 8, 0}) out += static_cast<char>(value >> shift);
  }
  return out + std::string("\x08\x06\0\0\0\0\0\0\0", 9);
}

TEST(Materials, TexturesThatAreDamagedOrTooLargeAreRefusedInAClause) {
  EXPECT_EQ(importer::decode_texture(png_of_size(20000, 20000), 2048).error().message,
            "is no PNG, JPEG, TGA or BMP that can be read");
  EXPECT_EQ(importer::decode_texture(png_of_size(12000, 8000), 2048).error().message,
            "has 12000 x 8000 texels, more than 67 million");
  EXPECT_EQ(importer::decode_texture("", 2048).error().message,
            "is no PNG, JPEG, TGA or BMP that can be read");
  EXPECT_EQ(importer::decode_texture(std::string(100, 'x'), 2048).error().message,
            "is no PNG, JPEG, TGA or BMP that can be read");
  EXPECT_EQ(importer::decode_texture(png_of_size(64, 64), 2048).error().message, "is damaged");
  const std::string whole = tga(four_texels());
  for (size_t size = 0; size < whole.size(); ++size) {
    (void)importer::decode_texture(whole.substr(0, size), 2048);  // Any result, but no crash.
  }
  const auto one = importer::decode_texture(tga(1, 1, {9, 8, 7, 255}), 2048);
  ASSERT_TRUE(one) << one.error().message;
  EXPECT_EQ(one->rgba, (std::vector<uint8_t>{9, 8, 7, 255}));
}

// Faulty decoders, for which the child process exists; the texture's name selects the fault.
Result<Texture> fragile_decoder(const importer::TextureSource& source, const std::string& model,
                                int32_t max_side) {
  if (source.name == "crash") std::raise(SIGSEGV);
  if (source.name == "abort") std::abort();
  if (source.name == "leave") _exit(0);
  if (source.name == "hang") {
    for (volatile bool for_ever = true; for_ever;) continue;
  }
  if (source.name == "greedy") {
    for (std::vector<std::vector<char>> all;;) all.emplace_back(size_t{16} << 20, 'x');
  }
  return importer::read_texture(source, model, max_side);
}

importer::RawScene scene_with_textures(const std::vector<std::string>& names) {
  importer::RawScene raw;
  for (size_t i = 0; i < names.size(); ++i) {
    raw.textures.push_back({.name = names[i], .bytes = tga(four_texels())});
    raw.scene.add_triangle({0, 0, 0}, {1, 0, 0}, {0, 0, 1});
    raw.scene.materials.push_back({.name = names[i],
                                   .colour = {1, 1, 1, 0.5F},
                                   .texture1 = static_cast<uint32_t>(i + 1),
                                   .opacity = Opacity::kBlended});
    raw.scene.parts.push_back({.file = {},
                               .node = names[i],
                               .material = names[i],
                               .first_triangle = static_cast<uint32_t>(i),
                               .triangle_count = 1,
                               .material1 = static_cast<uint32_t>(i + 1)});
  }
  raw.scene.texture_corners.resize(names.size());
  return raw;
}

constexpr importer::TextureDecoding kFragile{
    .read = &fragile_decoder, .bytes = uint64_t{256} << 20, .seconds = 1};

TEST(Materials, ADecoderThatCrashesHangsOrEatsMemoryCostsOnlyThatTexture) {
  for (const char* bad : {"crash", "abort", "leave", "hang", "greedy"}) {
    SCOPED_TRACE(bad);
    importer::RawScene raw = scene_with_textures({"first", bad, "third"});
    raw.scene.materials[1].colour = {0.2F, 0.6F, 0.1F, 1};  // One that can stand alone.
    Context context;
    ASSERT_TRUE(importer::read_textures(raw, "sign.dae", context, kFragile));
    const Scene& scene = raw.scene;
    ASSERT_EQ(scene.textures.size(), 2U);
    EXPECT_EQ(scene.textures[0].name, "first");
    EXPECT_EQ(scene.textures[1].name, "third");
    for (const Texture& texture : scene.textures) EXPECT_EQ(texture.rgba, four_texels().rgba);
    EXPECT_EQ(scene.materials[0].texture1, 1U);
    EXPECT_EQ(scene.materials[1].texture1, 0U);
    EXPECT_EQ(scene.materials[1].opacity, Opacity::kOpaque);
    EXPECT_EQ(scene.materials[2].texture1, 2U);
    EXPECT_EQ(scene.parts[1].material1, 2U);
    EXPECT_EQ(scene.texture_corners.size(), 3U);
    ASSERT_EQ(scene.report.warnings.size(), 1U);
    EXPECT_EQ(scene.report.warnings[0],
              "sign.dae: 1 of 3 textures cannot be used, for one " + std::string(bad) +
                  " crashes its decoder, or takes it too long or too much memory; plain colours "
                  "stand in");
  }
}

TEST(Materials, TexturesThatAllCrashTheirDecoderAreGivenUpAfterSome) {
  std::vector<std::string> names(40, "crash");
  names[2] = "good";
  names[39] = "behind";
  importer::RawScene raw = scene_with_textures(names);
  Context context;
  ASSERT_TRUE(importer::read_textures(raw, "sign.dae", context, kFragile));
  ASSERT_EQ(raw.scene.textures.size(), 1U);
  EXPECT_EQ(raw.scene.textures[0].name, "good");
  EXPECT_EQ(raw.scene.parts[2].material1, 3U);
  EXPECT_EQ(raw.scene.parts[39].material1, 0U);  // White without its texture is no colour.
  ASSERT_EQ(raw.scene.report.warnings.size(), 1U);
  EXPECT_TRUE(raw.scene.report.warnings[0].starts_with("sign.dae: 39 of 40 textures"));
}

TEST(Materials, LargeTexturesAreHalvedUntilTheyFit) {
  std::vector<uint8_t> rgba;
  for (int32_t i = 0; i < 100 * 40; ++i) {
    const bool left = i % 100 < 50;
    // Transparent texels are black, which must not darken opaque ones.
    const std::array<uint8_t, 4> texel = left         ? std::array<uint8_t, 4>{200, 100, 50, 255}
                                         : i % 2 == 0 ? std::array<uint8_t, 4>{80, 60, 40, 255}
                                                      : std::array<uint8_t, 4>{0, 0, 0, 0};
    rgba.insert(rgba.end(), texel.begin(), texel.end());
  }
  const auto small = importer::decode_texture(tga(100, 40, rgba), 25);
  ASSERT_TRUE(small);
  EXPECT_EQ(small->width, 25);
  EXPECT_EQ(small->height, 10);
  EXPECT_EQ(std::vector<uint8_t>(small->rgba.begin(), small->rgba.begin() + 4),
            (std::vector<uint8_t>{200, 100, 50, 255}));
  EXPECT_EQ(std::vector<uint8_t>(small->rgba.begin() + 80, small->rgba.begin() + 84),
            (std::vector<uint8_t>{80, 60, 40, 128}));
}

TEST(Materials, PiecesThatAVolumeCutsKeepTheirPlaceInTheTexture) {
  const test::ScratchFolder folder;
  const std::string path = folder.path() + "/looks.glb";
  ASSERT_TRUE(write_glb(textured_scene(), path));
  AreaVolume volume;
  volume.prism.corners = {{0.2, 0.3}, {0.7, 0.3}, {0.7, 0.9}, {0.2, 0.9}};
  volume.prism.low = -1;
  volume.prism.high = 1;
  volume.kind = 5;
  const auto scene = load(path, {volume});
  ASSERT_TRUE(scene) << scene.error().message;
  ASSERT_GT(scene->triangles.size(), 6U);
  ASSERT_EQ(scene->texture_corners.size(), scene->triangles.size());
  for (const ScenePart& part : scene->parts) {
    if (part.node != "a") continue;
    for (size_t i = 0; i < part.triangle_count; ++i) {
      const size_t t = part.first_triangle + i;
      for (size_t k = 0; k < 3; ++k) {
        const Vec3d p = scene->positions[scene->triangles[t][k]];
        EXPECT_NEAR(scene->texture_corners[t][k][0], p.x, 1e-6);
        EXPECT_NEAR(scene->texture_corners[t][k][1], p.z, 1e-6);
      }
    }
  }
}

TEST(Materials, TwoModelsKeepTheirOwn) {
  const test::ScratchFolder folder;
  const std::string path = folder.path() + "/looks.glb";
  ASSERT_TRUE(write_glb(textured_scene(), path));
  folder.write("looks.mtl", kMtl);
  folder.write("four.tga", tga(four_texels()));
  SceneConfig config;
  for (const std::string& one : {folder.write("looks.obj", kObj), path}) {
    config.sources.push_back({.path = one, .up = {}, .scale = {}, .transform = {}});
  }
  config.materials = SceneMaterials::kRead;
  Context context;
  const auto scene = load_scene(config, context);
  ASSERT_TRUE(scene);
  ASSERT_EQ(scene->textures.size(), 2U);
  EXPECT_EQ(scene->texture_corners.size(), scene->triangles.size());
  std::vector<uint32_t> of_signs;
  for (const ScenePart& part : scene->parts) {
    if (part.material == "sign") of_signs.push_back(scene->materials[part.material1 - 1].texture1);
  }
  EXPECT_EQ(of_signs, (std::vector<uint32_t>{1, 2}));
}

TEST(Materials, NamesSayWhatBuiltInWorldsAndCitiesAreMadeOf) {
  const auto garage = create_builtin_world({.name = "garage"});
  ASSERT_TRUE(garage);
  for (const ScenePart& part : garage->parts) EXPECT_NE(part.material1, 0U) << part.material;
  const auto roof = importer::name_colour("RoofSurface");
  ASSERT_TRUE(roof);
  EXPECT_GT((*roof)[0], 2 * (*roof)[2]);  // Red.
  EXPECT_TRUE(importer::name_colour("textures/gothic_floor/metalbridge06"));
  EXPECT_FALSE(importer::name_colour("ShapeGroup 7"));
  EXPECT_FALSE(importer::name_colour(""));
}

}  // namespace
}  // namespace throng
