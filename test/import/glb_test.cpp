// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "import/formats/glb.h"

#include <gtest/gtest.h>

#include <cstring>

#include "core/files/read_file.h"
#include "core/random.h"
#include "import/formats/assimp_reader.h"
#include "scratch_folder.h"
#include "throng/scene.h"

namespace throng {
namespace {

std::string chunk(uint32_t kind, std::string bytes, char fill) {
  while (bytes.size() % 4 != 0) bytes += fill;
  const auto size = static_cast<uint32_t>(bytes.size());
  std::string out(8, '\0');
  std::memcpy(out.data(), &size, 4);
  std::memcpy(out.data() + 4, &kind, 4);
  return out + bytes;
}

std::string glb(const std::string& json, const std::string& binary) {
  const std::string chunks = chunk(0x4E4F534A, json, ' ') + chunk(0x004E4942, binary, '\0');
  const uint32_t head[3] = {0x46546C67, 2, static_cast<uint32_t>(chunks.size() + 12)};
  return std::string(reinterpret_cast<const char*>(head), sizeof head) + chunks;
}

Result<importer::RawScene> read(const std::string& bytes) {
  Context context;
  importer::ReadOptions options;
  options.name = "some.glb";
  return importer::read_glb(bytes, options, context);
}

std::vector<Vec3d> corners_of(const Scene& scene) {
  std::vector<Vec3d> all;
  for (const auto& t : scene.triangles) {
    for (const uint32_t corner : t) all.push_back(scene.positions[corner]);
  }
  return all;
}

TEST(Glb, BuiltInWorldsAreReadAsAssimpReadsThem) {
  const test::ScratchFolder folder;
  for (const char* name : {"garage", "stairs", "cube"}) {
    const auto scene = create_builtin_world({.name = name});
    ASSERT_TRUE(scene);
    const std::string path = folder.path() + "/" + name + ".glb";
    ASSERT_TRUE(write_glb(*scene, path));
    const auto bytes = read_file(path);
    ASSERT_TRUE(bytes);
    const auto ours = read(*bytes);
    ASSERT_TRUE(ours) << ours.error().message;
    Context context;
    importer::ReadOptions options;
    options.name = path;
    const auto theirs = importer::read_with_assimp(path, options, context);
    ASSERT_TRUE(theirs) << theirs.error().message;
    EXPECT_EQ(ours->scene.area, theirs->scene.area) << name;
    const auto a = corners_of(ours->scene), b = corners_of(theirs->scene);
    ASSERT_EQ(a.size(), b.size()) << name;
    for (size_t i = 0; i < a.size(); ++i) ASSERT_LT(length(a[i] - b[i]), 1e-4) << name << i;
    ASSERT_EQ(ours->scene.parts.size(), theirs->scene.parts.size()) << name;
    for (size_t i = 0; i < ours->scene.parts.size(); ++i) {
      EXPECT_EQ(ours->scene.parts[i].node, theirs->scene.parts[i].node);
      EXPECT_EQ(ours->scene.parts[i].material, theirs->scene.parts[i].material);
    }
  }
}

// A quarter turn about Y takes X to -Z; then twice as large; then moved, below another that moves.
TEST(Glb, NodesScaleThenTurnThenMoveWhatIsBelowThem) {
  const float square[12] = {0, 0, 0, 1, 0, 0, 1, 0, 1, 0, 0, 1};
  const uint8_t order[4] = {0, 1, 3, 2};
  std::string binary(reinterpret_cast<const char*>(square), sizeof square);
  binary.append(reinterpret_cast<const char*>(order), sizeof order);
  const auto made = read(glb(R"({"scene":0,"scenes":[{"nodes":[0]}],
    "nodes":[{"name":"house","translation":[10,0,0],"extras":{"area":3},"children":[1]},
             {"name":"floor","mesh":0,"scale":[2,2,2],
              "rotation":[0,0.7071067811865476,0,0.7071067811865476]}],
    "meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1,"mode":5}]}],
    "accessors":[{"bufferView":0,"componentType":5126,"count":4,"type":"VEC3"},
                 {"bufferView":1,"componentType":5121,"count":4,"type":"SCALAR"}],
    "bufferViews":[{"buffer":0,"byteLength":48},{"buffer":0,"byteOffset":48,"byteLength":4}],
    "buffers":[{"byteLength":52}]})",
                             binary));
  ASSERT_TRUE(made) << made.error().message;
  const auto corners = corners_of(made->scene);
  ASSERT_EQ(corners.size(), 6U);  // A strip of two, both wound alike.
  const std::vector<Vec3d> expected = {{10, 0, 0}, {10, 0, -2}, {12, 0, 0},
                                       {12, 0, 0}, {10, 0, -2}, {12, 0, -2}};
  for (size_t i = 0; i < 6; ++i) EXPECT_LT(length(corners[i] - expected[i]), 1e-6) << i;
  EXPECT_EQ(made->scene.area, (std::vector<AreaKind>{3, 3}));
  EXPECT_EQ(made->scene.parts.front().node, "house/floor");
}

TEST(Glb, WhatIsNotReadIsRefusedByName) {
  const auto fault = [](const std::string& json) {
    const auto made = read(glb(json, "binary"));
    return made ? std::string("no fault") : made.error().message;
  };
  EXPECT_NE(fault(R"({"extensionsRequired":["KHR_draco_mesh_compression"]})").find("KHR_draco"),
            std::string::npos);
  EXPECT_NE(fault("[]").find("no JSON object"), std::string::npos);
  EXPECT_NE(fault(R"({"scenes":[{"nodes":[7]}]})").find("node that does not exist"),
            std::string::npos);
  EXPECT_NE(fault(R"({"scenes":[{"nodes":[0]}],"nodes":[{"children":[0]}]})").find("or itself"),
            std::string::npos);
  // Each node twice below the one before it: the last would be read 2^n times.
  EXPECT_NE(fault(R"({"scenes":[{"nodes":[0]}],"nodes":[{"children":[1,1]},{}]})")
                .find("below two others"),
            std::string::npos);
  EXPECT_FALSE(read("glTF"));
}

// Wrong bytes give an error or a scene, and no other fault, under the sanitizers too.
TEST(Glb, DamagedFilesNeverReachBeyondTheirEnd) {
  const test::ScratchFolder folder;
  const auto cube = create_builtin_world({.name = "cube"});
  ASSERT_TRUE(cube);
  ASSERT_TRUE(write_glb(*cube, folder.path() + "/cube.glb"));
  const auto whole = read_file(folder.path() + "/cube.glb");
  ASSERT_TRUE(whole);
  size_t refused = 0, tried = 0;
  for (size_t end = 0; end < whole->size(); end += 7) {
    refused += read(whole->substr(0, end)) ? 0 : 1;
    ++tried;
  }
  EXPECT_EQ(refused, tried);
  for (uint64_t round = 0; round < 3000; ++round) {
    std::string bytes = *whole;
    for (uint64_t k = 0; k <= round % 4; ++k) {
      const auto at =
          static_cast<size_t>(random_unit(5, round, 2 * k) * static_cast<double>(bytes.size()));
      bytes[at] = static_cast<char>(random_unit(5, round, 2 * k + 1) * 256);
    }
    const auto made = read(bytes);
    if (!made) continue;
    for (const auto& t : made->scene.triangles) {
      for (const uint32_t corner : t) {
        ASSERT_TRUE(corner == importer::kNoVertex || corner < made->scene.positions.size());
      }
    }
  }
}

}  // namespace
}  // namespace throng
