// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cstdlib>
#include <functional>

#include "core/files/classes_file.h"
#include "core/files/config_file.h"
#include "core/files/read_file.h"
#include "core/random.h"
#include "import/formats/bsp.h"
#include "import/formats/city.h"
#include "import/formats/obj.h"
#include "import/formats/plan.h"
#include "import/formats/ply.h"
#include "import/raw/clean.h"
#include "import/scene_config.h"
#include "scratch_folder.h"
#include "throng/avatar.h"
#include "tiny_bsp.h"

// Every parser on damaged files: cut at every byte, bytes changed at random. The tests assert
// that the process survives, that results are consistent, and that refusals have a message.
namespace throng {
namespace {

std::string data(const std::string& name) {
  const auto bytes = read_file(std::string(THRONG_TEST_DATA) + "/" + name);
  EXPECT_TRUE(bytes) << bytes.error().message;
  return bytes ? *bytes : std::string();
}

// Calls `use` on each damaged copy of `whole`.
void for_damaged(const std::string& whole, size_t stride, uint64_t flips,
                 const std::function<void(const std::string&)>& use) {
  for (size_t size = 0; size < whole.size(); size += stride) use(whole.substr(0, size));
  for (uint64_t i = 0; i < flips; ++i) {
    std::string text = whole;
    const uint64_t changes = 1 + random_below(7, i, 0, 8);
    for (uint64_t k = 0; k < changes; ++k) {
      const size_t at = random_below(7, i, 3 * k + 1, text.size());
      const auto byte = static_cast<char>(random_below(7, i, 3 * k + 2, 256));
      // Half of the changes stay printable, to pass the first checks of a text parser.
      const auto digit = static_cast<char>('0' + random_below(7, i, 3 * k + 2, 10));
      text[at] = random_below(7, i, 3 * k + 3, 2) == 0 ? byte : digit;
    }
    use(text);
  }
}

using Reader = Result<importer::RawScene> (*)(std::string_view, const importer::ReadOptions&,
                                              Context&);

void expect_survives(Reader read, const std::string& whole) {
  uint64_t kept = 0;
  for_damaged(whole, 1, 20000, [&](const std::string& bytes) {
    Context context;
    importer::ReadOptions options;
    options.name = "damaged";
    auto raw = read(bytes, options, context);
    if (!raw) {
      EXPECT_EQ(raw.error().message.rfind("damaged", 0), 0u) << raw.error().message;
      return;
    }
    Scene& scene = raw->scene;
    ASSERT_EQ(scene.area.size(), scene.triangles.size());
    if (!importer::clean_scene(scene, "damaged", context)) return;
    ++kept;
    for (const auto& corners : scene.triangles) {
      for (const uint32_t corner : corners) ASSERT_LT(corner, scene.positions.size());
    }
    uint64_t in_parts = 0;
    for (const ScenePart& part : scene.parts) in_parts += part.triangle_count;
    ASSERT_EQ(in_parts, scene.triangles.size());
  });
  EXPECT_GT(kept,
            100u);  // Else damage is too heavy to test more than the first checks.
}

TEST(Damaged, ObjFiles) { expect_survives(&importer::read_obj, data("box.obj")); }
TEST(Damaged, PlyFiles) {
  expect_survives(&importer::read_ply, data("box.ply"));
  expect_survives(&importer::read_ply, data("box_binary.ply"));
}
TEST(Damaged, CityJsonFiles) { expect_survives(&importer::read_cityjson, data("house.city.json")); }
TEST(Damaged, CityGmlFiles) { expect_survives(&importer::read_citygml, data("house.gml")); }
TEST(Damaged, Levels) { expect_survives(&importer::read_bsp, test::tiny_level()); }
TEST(Damaged, WktPlans) { expect_survives(&importer::read_wkt, data("plan.wkt")); }
TEST(Damaged, GeoJsonPlans) { expect_survives(&importer::read_geojson, data("plan.geojson")); }

TEST(Damaged, SettingsFiles) {
  for (const char* name : {"scene.toml", "scene.json", "classes.toml", "classes.json"}) {
    for_damaged(data(name), 1, 2000, [&](const std::string& text) {
      const auto root = parse_config(text, name);
      if (!root) {
        EXPECT_EQ(root.error().message.rfind(name, 0), 0u) << root.error().message;
        return;
      }
      const auto config = importer::read_scene_config(*root, name, "");
      const auto classes = read_classes(*root, name);
      if (!config) {
        EXPECT_EQ(config.error().message.rfind(name, 0), 0u) << config.error().message;
      }
      if (classes) {
        EXPECT_TRUE(check_classes(*classes));
      }
    });
  }
}

// assimp runs in a child process for each of these: slower, so every 16th byte is enough here.
// THRONG_EVERY_BYTE=1 takes all (minutes).
TEST(Damaged, ModelsThroughAssimpSlow) {
  const bool all = std::getenv("THRONG_EVERY_BYTE") != nullptr;
  const test::ScratchFolder folder;
  folder.write("box.bin", data("box.bin"));  // box.gltf's numbers stand there.
  for (const char* name : {"box.stl", "box_binary.stl", "box.dae", "box.glb", "box.gltf",
                           "box_ascii.fbx", "box.3ds", "wall.ifc"}) {
    uint64_t kept = 0;
    uint64_t crashed = 0;
    for_damaged(data(name), all ? 1 : 16, all ? 1000 : 50, [&](const std::string& bytes) {
      Context context;
      SceneConfig config;
      config.sources.push_back(
          {.path = folder.write(name, bytes), .up = {}, .scale = {}, .transform = {}});
      const auto scene = load_scene(config, context);
      if (scene) {
        ++kept;
        return;
      }
      const std::string& message = scene.error().message;
      EXPECT_EQ(message.rfind(config.sources[0].path, 0), 0u) << message;
      crashed += message.find("crashed") != std::string::npos ? 1 : 0;
    });
    EXPECT_GT(kept, 0u) << name;
    std::printf("%-16s %6llu read, %llu crashes of assimp contained\n", name,
                static_cast<unsigned long long>(kept), static_cast<unsigned long long>(crashed));
  }
}

}  // namespace
}  // namespace throng
