// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <gtest/gtest.h>

#include <assimp/Importer.hpp>
#include <cmath>
#include <filesystem>
#include <fstream>

#include "scratch_folder.h"
#include "throng/bake.h"
#include "throng/scene.h"

namespace throng {
namespace {

class GlbWriter : public testing::Test {
 protected:
  [[nodiscard]] std::string path(const std::string& name) const {
    return folder_.path() + "/" + name;
  }
  [[nodiscard]] size_t files() const {
    return static_cast<size_t>(
        std::distance(std::filesystem::directory_iterator(folder_.path()), {}));
  }

 private:
  test::ScratchFolder folder_;
};

using Triangle = std::array<Vec3d, 3>;

std::vector<Triangle> triangles_of(const Scene& scene) {
  std::vector<Triangle> all;
  for (const auto& t : scene.triangles) {
    all.push_back({scene.positions[t[0]], scene.positions[t[1]], scene.positions[t[2]]});
  }
  return all;
}

// In the order of the nodes, which is the order of the parts.
std::vector<Triangle> read_with_assimp(const std::string& path) {
  std::vector<Triangle> all;
  Assimp::Importer importer;
  const aiScene* scene = importer.ReadFile(path, 0);
  if (scene == nullptr) {
    ADD_FAILURE() << importer.GetErrorString();
    return all;
  }
  const auto read_node = [&](const aiNode& node) {
    const aiMatrix4x4& m = node.mTransformation;
    const Vec3d origin{m.a4, m.b4, m.c4};
    for (unsigned i = 0; i < node.mNumMeshes; ++i) {
      const aiMesh& mesh = *scene->mMeshes[node.mMeshes[i]];
      for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
        Triangle t;
        for (unsigned c = 0; c < 3; ++c) {
          const aiVector3D& v = mesh.mVertices[mesh.mFaces[f].mIndices[c]];
          t[c] = Vec3d{v.x, v.y, v.z} + origin;
        }
        all.push_back(t);
      }
    }
  };
  read_node(*scene->mRootNode);
  for (unsigned i = 0; i < scene->mRootNode->mNumChildren; ++i) {
    read_node(*scene->mRootNode->mChildren[i]);
  }
  return all;
}

void expect_equal(const std::vector<Triangle>& a, const std::vector<Triangle>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (size_t t = 0; t < a.size(); ++t) {
    for (size_t c = 0; c < 3; ++c) {
      ASSERT_LT(length(a[t][c] - b[t][c]), 1e-4) << "triangle " << t << " corner " << c;
    }
  }
}

TEST_F(GlbWriter, BuiltinWorldsComeBackAsTheyWere) {
  for (const BuiltinWorldInfo& info : builtin_worlds()) {
    const std::string name(info.name);
    const auto scene = create_builtin_world({.name = name});
    ASSERT_TRUE(scene);
    ASSERT_TRUE(write_glb(*scene, path(name + ".glb")));
    SCOPED_TRACE(name);
    expect_equal(read_with_assimp(path(name + ".glb")), triangles_of(*scene));
  }
  EXPECT_EQ(files(), builtin_worlds().size());  // And no other file is left.
}

Scene load(const std::string& path) {
  Context context;
  SceneConfig config;
  config.sources.push_back({.path = path, .up = {}, .scale = {}, .transform = {}});
  auto scene = load_scene(config, context);
  EXPECT_TRUE(scene) << scene.error().message;
  return scene ? *std::move(scene) : Scene{};
}

TEST_F(GlbWriter, EveryTriangleKeepsItsAreaKind) {
  for (const BuiltinWorldInfo& info : builtin_worlds()) {
    const std::string name(info.name);
    const auto scene = create_builtin_world({.name = name});
    ASSERT_TRUE(scene);
    ASSERT_TRUE(write_glb(*scene, path(name + ".glb")));
    EXPECT_EQ(load(path(name + ".glb")).area, scene->area) << name;
  }
  // Every kind that there is; runs of one node that differ in nothing else.
  Scene kinds;
  for (int kind = 0; kind <= kAreaLast; ++kind) {
    const double x = 2 * kind;
    kinds.add_triangle({x, 0, 0}, {x, 0, 1}, {x + 1, 0, 0}, static_cast<AreaKind>(kind));
  }
  kinds.parts = {
      {.file = {}, .node = "row", .material = "tile", .first_triangle = 0, .triangle_count = 64}};
  ASSERT_TRUE(write_glb(kinds, path("kinds.glb")));
  const Scene back = load(path("kinds.glb"));
  EXPECT_EQ(back.area, kinds.area);
  EXPECT_EQ(back.report.warnings, std::vector<std::string>{});
}

// The generator's area kinds decide what is walkable: cars, pillars, railings.
TEST_F(GlbWriter, AWorldFromItsFileIsBakedLikeTheWorldItself) {
  const auto garage = create_builtin_world({.name = "garage"});
  ASSERT_TRUE(garage);
  ASSERT_TRUE(write_glb(*garage, path("garage.glb")));
  Context context;
  BakeReport direct;
  BakeReport file;
  ASSERT_TRUE(bake_world(*garage, {}, context, &direct));
  ASSERT_TRUE(bake_world(load(path("garage.glb")), {}, context, &file));
  ASSERT_EQ(direct.walkable_area.size(), file.walkable_area.size());
  for (size_t i = 0; i < direct.walkable_area.size(); ++i) {
    EXPECT_GT(direct.walkable_area[i], 1000);
    // Corners are floats in the file.
    EXPECT_NEAR(direct.walkable_area[i], file.walkable_area[i], 1e-4 * direct.walkable_area[i]);
  }
}

// Extras of other programs: kinds are inherited from the node above, and nonsense is harmless.
TEST_F(GlbWriter, AreaKindsOfOtherProgramsAreInheritedOrReported) {
  std::ifstream box(std::string(THRONG_TEST_DATA) + "/box.gltf");
  const std::string text{std::istreambuf_iterator<char>(box), {}};
  std::filesystem::copy_file(std::string(THRONG_TEST_DATA) + "/box.bin", path("box.bin"));
  const auto with = [&](const std::string& extras, const char* before = "\"mesh\"") {
    const size_t at = text.find(before);
    EXPECT_NE(at, std::string::npos);
    std::ofstream(path("box.gltf"))
        << text.substr(0, at) + "\"extras\":" + extras + "," + text.substr(at);
    return load(path("box.gltf"));
  };
  const auto all = [](const Scene& scene, AreaKind kind) {
    return !scene.area.empty() && scene.area == std::vector<AreaKind>(scene.area.size(), kind);
  };
  EXPECT_TRUE(all(with(R"({"area":0})"), kAreaBlocked));
  EXPECT_TRUE(all(with(R"({"area":9})", "\"children\""), 9));  // Of the node above.
  EXPECT_TRUE(all(with(R"({"area":5.0,"note":"x"})"), 5));
  EXPECT_TRUE(all(with(R"({"area":"large"})"), kAreaWalkable));
  EXPECT_TRUE(all(with(R"({"area":{"of":7}})"), kAreaWalkable));
  for (const char* bad : {"64", "255", "-1", "1e300"}) {
    const Scene scene = with(std::string(R"({"area":)") + bad + "}");
    EXPECT_TRUE(all(scene, kAreaWalkable)) << bad;
    ASSERT_FALSE(scene.report.warnings.empty()) << bad;
    EXPECT_NE(scene.report.warnings[0].find("area kind outside 0 to 63"), std::string::npos);
  }
}

TEST_F(GlbWriter, PlacesFarFromTheOriginKeepTheirTenthOfAMillimetre) {
  Scene scene;
  scene.add_box({100000.125, -3, 7000000.25}, {100001.377, 4.1234, 7000001.5});
  scene.add_triangle({-50000.001, 0.001, 0}, {-50001.002, 0, 0}, {-50000, 2000.003, 1});
  scene.parts = {
      {.file = {}, .node = "far", .material = "stone", .first_triangle = 0, .triangle_count = 12},
      {.file = {}, .node = "tower", .material = "wall", .first_triangle = 12, .triangle_count = 1}};
  ASSERT_TRUE(write_glb(scene, path("far.glb")));
  expect_equal(read_with_assimp(path("far.glb")), triangles_of(scene));
}

TEST_F(GlbWriter, PartsKeepTheirNodeAndMaterialNamesAndLooseTrianglesAreKept) {
  Scene scene;
  scene.add_box({0, 0, 0}, {1, 1, 1});
  scene.add_quad({0, 0, 0}, {0, 0, 1}, {1, 0, 1}, {1, 0, 0}, kAreaBlocked);
  scene.parts = {{.file = {},
                  .node = "a \"b\" \\ \n",
                  .material = "oak",
                  .first_triangle = 2,
                  .triangle_count = 12}};
  ASSERT_TRUE(write_glb(scene, path("names.glb")));
  Assimp::Importer importer;
  const aiScene* back = importer.ReadFile(path("names.glb"), 0);
  ASSERT_NE(back, nullptr) << importer.GetErrorString();
  // 2 loose triangles, 10 + 2 of the part: its last two are of another area kind.
  ASSERT_EQ(back->mNumMeshes, 3u);
  EXPECT_EQ(back->mMeshes[0]->mNumFaces, 2u);
  EXPECT_EQ(back->mMeshes[1]->mNumFaces, 10u);
  EXPECT_EQ(back->mMeshes[2]->mNumFaces, 2u);
  const auto material = [&](unsigned mesh) {
    return std::string(back->mMaterials[back->mMeshes[mesh]->mMaterialIndex]->GetName().C_Str());
  };
  EXPECT_EQ(material(0), "surface");
  EXPECT_EQ(material(1), "oak");
  EXPECT_EQ(std::string(back->mRootNode->mChildren[1]->mName.C_Str()).rfind("a \"b\" \\ \n", 0),
            0u);
}

TEST_F(GlbWriter, WhatCannotBeWrittenIsRefusedAndLeavesNothing) {
  const auto refusal = [&](const Scene& scene, const std::string& name) {
    const auto written = write_glb(scene, path(name));
    EXPECT_FALSE(written);
    return written ? Error{} : written.error();
  };
  Scene scene;
  EXPECT_EQ(refusal(scene, "empty.glb").code, Errc::kBadInput);
  scene.add_triangle({0, 0, 0}, {1, 0, 0}, {0, 0, 1});
  EXPECT_EQ(refusal(scene, "missing/folder.glb").code, Errc::kIo);
  scene.triangles[0][2] = 3;
  EXPECT_EQ(refusal(scene, "index.glb").code, Errc::kBadInput);
  scene.triangles[0][2] = 2;
  scene.positions[1].y = NAN;
  EXPECT_EQ(refusal(scene, "nan.glb").code, Errc::kBadInput);
  scene.positions[1].y = 0;
  std::filesystem::create_directory(path("taken.glb"));
  EXPECT_EQ(refusal(scene, "taken.glb").code, Errc::kIo);
  EXPECT_EQ(files(), 1u);  // Only the folder that blocks the name.
}

}  // namespace
}  // namespace throng
