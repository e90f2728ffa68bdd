// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include "core/files/read_file.h"
#include "scratch_folder.h"
#include "throng/scene.h"

namespace throng {
namespace {

std::string refusal(const std::string& name, const std::string& text) {
  const test::ScratchFolder folder;
  const std::string path = folder.write(name, text);
  const auto config = load_scene_config(path);
  if (config) return "accepted";
  EXPECT_EQ(config.error().code, Errc::kBadFile);
  EXPECT_EQ(config.error().message.substr(0, path.size()), path);
  return config.error().message.substr(path.size());
}

const char* const kToml = R"(plan_height = 2.5
curve_tolerance = 0.05

[[source]]
path = "hall.ifc"

[[source]]
path = "/data/site.obj"
up = "z"
scale = 0.001
transform = { translate = [10, 0, -5], rotate_y = 90, scale = 2 }

[[source]]
path = "x.glb"
transform = { rows = [[1, 0, 0, 7], [0, 1, 0, 8], [0, 0, 1, 9]] }

[[rule]]
material = "Water*"
kind = "blocked"

[[rule]]
node = "IfcDoor*"
kind = "ignored"

[[rule]]
material = "Carpet"
kind = 7

[[volume]]
kind = 5
corners = [[0, 0], [4, 0], [4, 3]]
low = -1
high = 2.5
)";

const char* const kJson = R"({"plan_height": 2.5, "curve_tolerance": 0.05, "source": [
  {"path": "hall.ifc"},
  {"path": "/data/site.obj", "up": "z", "scale": 0.001,
   "transform": {"translate": [10, 0, -5], "rotate_y": 90, "scale": 2}},
  {"path": "x.glb", "transform": {"rows": [[1, 0, 0, 7], [0, 1, 0, 8], [0, 0, 1, 9]]}}],
 "rule": [{"material": "Water*", "kind": "blocked"}, {"node": "IfcDoor*", "kind": "ignored"},
          {"material": "Carpet", "kind": 7}],
 "volume": [{"kind": 5, "corners": [[0, 0], [4, 0], [4, 3]], "low": -1, "high": 2.5}]})";

TEST(SceneConfig, TomlAndJsonSayTheSame) {
  const test::ScratchFolder folder;
  for (const auto& [name, text] : {std::pair{"s.toml", kToml}, std::pair{"s.json", kJson}}) {
    const auto config = load_scene_config(folder.write(name, text));
    ASSERT_TRUE(config) << config.error().message;
    EXPECT_EQ(config->plan_height, 2.5);
    EXPECT_EQ(config->curve_tolerance, 0.05);
    ASSERT_EQ(config->sources.size(), 3u);
    EXPECT_EQ(config->sources[0].path, folder.path() + "/hall.ifc");  // Relative to the scene file.
    EXPECT_FALSE(config->sources[0].up);
    EXPECT_EQ(config->sources[1].path, "/data/site.obj");
    EXPECT_EQ(config->sources[1].up, 'z');
    EXPECT_EQ(config->sources[1].scale, 0.001);
    // Scaled by 2, turned a quarter about the vertical (x goes to -z), then moved.
    EXPECT_EQ(config->sources[1].transform({1, 1, 0}), (Vec3d{10, 2, -7}));
    EXPECT_EQ(config->sources[2].transform({1, 1, 1}), (Vec3d{8, 9, 10}));
    ASSERT_EQ(config->rules.size(), 3u);
    EXPECT_EQ(config->rules[0].kind, kAreaBlocked);
    EXPECT_EQ(config->rules[1].kind, kAreaIgnored);
    EXPECT_EQ(config->rules[1].node, "IfcDoor*");
    EXPECT_EQ(config->rules[2].kind, 7);
    ASSERT_EQ(config->volumes.size(), 1u);
    EXPECT_EQ(config->volumes[0].kind, 5);
    ASSERT_EQ(config->volumes[0].prism.corners.size(), 3u);
    EXPECT_EQ(config->volumes[0].prism.corners[2], (std::array<double, 2>{4, 3}));
    EXPECT_EQ(config->volumes[0].prism.low, -1);
    EXPECT_EQ(config->volumes[0].prism.high, 2.5);
  }
}

TEST(SceneConfig, TheExampleInTheDocumentationWorks) {
  const auto page = read_file(std::string(THRONG_TEST_DATA) + "/../../docs/inputs.md");
  ASSERT_TRUE(page) << page.error().message;
  const size_t begin = page->find("```toml\n") + 8;
  ASSERT_LT(begin, page->size());
  const test::ScratchFolder folder;
  const auto config = load_scene_config(
      folder.write("doc.toml", page->substr(begin, page->find("```", begin) - begin)));
  ASSERT_TRUE(config) << config.error().message;
  EXPECT_EQ(config->sources.size(), 3u);
  EXPECT_EQ(config->rules.size(), 3u);
  EXPECT_EQ(config->volumes.size(), 1u);
}

TEST(SceneConfig, VolumesAreConvexPrismsOfAKind) {
  EXPECT_EQ(refusal("a.toml", "[[volume]]\nkind = 3\nlow = 0\nhigh = 1\n"),
            ":1: volume 1: corners is missing");
  EXPECT_NE(
      refusal("a.toml", "[[volume]]\nkind = 3\nlow = 0\nhigh = 1\ncorners = [[0, 0], [1, 0], 7]\n")
          .find("corners must be a list of [x, z]"),
      std::string::npos);
  EXPECT_NE(refusal("a.toml",
                    "[[volume]]\nkind = 3\nlow = 2\nhigh = 1\n"
                    "corners = [[0, 0], [1, 0], [1, 1]]\n")
                .find("its bottom must lie below its top"),
            std::string::npos);
  EXPECT_NE(refusal("a.toml",
                    "[[volume]]\nkind = 99\nlow = 0\nhigh = 1\n"
                    "corners = [[0, 0], [1, 0], [1, 1]]\n")
                .find("kind must be"),
            std::string::npos);
}

TEST(SceneConfig, FaultsAreNamedByLineAndKey) {
  EXPECT_EQ(refusal("a.toml", "[[source]]\npath = 'a.obj'\n\nup = 'x'\n"),
            ":4: source 1: up must be \"y\" or \"z\"");
  EXPECT_EQ(refusal("a.toml", "[[source]]\nup = 'y'\n"), ":1: source 1: path is missing");
  EXPECT_EQ(refusal("a.toml", "[[source]]\npath = 'a'\nscale = 0\n"),
            ":3: source 1: scale = 0 is outside 1e-06 to 1000000");
  EXPECT_EQ(
      refusal("a.toml", "[[source]]\npath = 'a'\nscale = 1\ntransform = { translate = [1, 2] }\n"),
      ":4: source 1: transform: translate must be a list of 3 numbers");
  EXPECT_EQ(refusal("a.toml", "[[source]]\npath = 'a'\ntransform = { rows = [[1, 2, 3, 4]] }\n"),
            ":3: source 1: transform: rows must be 3 lists of 4 numbers");
  EXPECT_EQ(refusal("a.toml", "[[source]]\npath = 'a'\ntransform = 3\n"),
            ":3: source 1: transform: need a table of settings here");
  EXPECT_EQ(refusal("a.toml", "[[rule]]\nmaterial = '*'\nkind = 64\n").substr(0, 24),
            ":3: rule 1: kind must be");
  EXPECT_EQ(refusal("a.toml", "[[rule]]\nkind = 'blocked'\n"),
            ":1: rule 1: needs a pattern: material or node (\"*\" for all)");
  EXPECT_EQ(refusal("a.toml", "plan_hight = 2\n").substr(0, 36),
            ":1: scene: unknown key 'plan_hight';");
  EXPECT_EQ(refusal("a.json", "{\n\"curve_tolerance\": -1}"),
            ":2: scene: curve_tolerance = -1 is outside 0.0001 to 10");
  EXPECT_EQ(refusal("a.json", "{\n\"rule\": 3}"),
            ":2: scene: rule must be a list of tables: write [[rule]]");
  EXPECT_NE(refusal("a.toml", "source = [1]\n"), "accepted");
}

}  // namespace
}  // namespace throng
