// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <assimp/Importer.hpp>
#include <cmath>
#include <filesystem>
#include <fstream>

#include "throng/builtin_worlds.h"
#include "throng/scene.h"

namespace throng {
namespace {

// A folder of its own for each test, gone afterwards.
class GlbWriter : public testing::Test {
 protected:
  GlbWriter()
      : folder_(std::filesystem::temp_directory_path() /
                ("throng_glb_" + std::to_string(getpid()) + "_" +
                 testing::UnitTest::GetInstance()->current_test_info()->name())) {
    std::filesystem::create_directories(folder_);
  }
  ~GlbWriter() override { std::filesystem::remove_all(folder_); }
  [[nodiscard]] std::string path(const std::string& name) const {
    return (folder_ / name).string();
  }
  [[nodiscard]] size_t files() const {
    return static_cast<size_t>(std::distance(std::filesystem::directory_iterator(folder_), {}));
  }

 private:
  std::filesystem::path folder_;
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
    const auto scene = make_builtin_world({.name = name});
    ASSERT_TRUE(scene);
    ASSERT_TRUE(write_glb(*scene, path(name + ".glb")));
    SCOPED_TRACE(name);
    expect_equal(read_with_assimp(path(name + ".glb")), triangles_of(*scene));
  }
  EXPECT_EQ(files(), builtin_worlds().size());  // And nothing else lies about.
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
  EXPECT_EQ(files(), 1u);  // Only the folder that stood in the way.
}

}  // namespace
}  // namespace throng
