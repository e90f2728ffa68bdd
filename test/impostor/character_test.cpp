// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "impostor/gait.h"
#include "throng/impostor.h"

namespace throng {
namespace {

TEST(Character, MaterialNamesGiveBodyParts) {
  EXPECT_EQ(body_part_of("Shirt"), BodyPart::kShirt);
  EXPECT_EQ(body_part_of("T-SHIRT.001"), BodyPart::kShirt);
  EXPECT_EQ(body_part_of("HairBase"), BodyPart::kHair);
  EXPECT_EQ(body_part_of("Jeans"), BodyPart::kPants);
  EXPECT_EQ(body_part_of("Socks"), BodyPart::kShoes);
  EXPECT_EQ(body_part_of("skin_face"), BodyPart::kSkin);
  EXPECT_EQ(body_part_of("Eyes"), BodyPart::kOther);
  EXPECT_EQ(body_part_of(""), BodyPart::kOther);
}

TEST(Character, AClipIsFoundByItsNameOrItsLastWord) {
  Character c;
  for (const char* name : {"Rig|Man_RunningJump", "Rig|Man_Run", "Rig|Man_Walk", "walk"}) {
    c.clips.push_back({.name = name, .seconds = 1, .tracks = {}});
  }
  EXPECT_EQ(*find_clip(c, "run"), 1U);
  EXPECT_EQ(*find_clip(c, "Walk"), 3U);  // A whole name before a last word.
  EXPECT_EQ(*find_clip(c, "Rig|Man_Walk"), 2U);
  const auto none = find_clip(c, "Swim");
  ASSERT_FALSE(none);
  EXPECT_EQ(none.error().code, Errc::kNotFound);
  EXPECT_NE(none.error().message.find("Man_Run"), std::string::npos);
}

// An arm of two bones along x, bent by a quarter turn about z at its middle.
TEST(Character, VerticesFollowTheirBonesByWeight) {
  Character c;
  Transform elbow;
  elbow.m[0][3] = 1;
  Transform back;
  back.m[0][3] = -1;
  c.joints = {{"upper", -1, {}}, {"lower", 0, elbow}};
  c.bones = {{0, {}}, {1, back}};
  c.positions = {{0.5, 0, 0}, {2, 0, 0}, {1, 0.2, 0}, {2, 0, 0}};
  c.normals.assign(4, {0, 1, 0});
  c.influences = {{{0, 0, 0, 0}, {1, 0, 0, 0}},
                  {{1, 0, 0, 0}, {1, 0, 0, 0}},
                  {{0, 1, 0, 0}, {0.5F, 0.5F, 0, 0}},
                  {{0, 1, 0, 0}, {0.5F, 0.5F, 0, 0}}};
  const double half = std::sqrt(0.5);
  JointTrack bend;
  bend.joint = 1;
  bend.rotation_times = {0, 1, 2};
  bend.rotations = {{0, 0, 0, 1}, {0, 0, half, half}, {0, 0, -half, -half}};
  c.clips.push_back({.name = "bend", .seconds = 2, .tracks = {bend}});
  PosedMesh mesh;
  const auto expect_at = [&](size_t v, Vec3d p) {
    EXPECT_NEAR(length(mesh.positions[v] - p), 0, 1e-12) << v;
  };
  pose_character(c, 0, 0, mesh);
  for (size_t v = 0; v < 4; ++v) expect_at(v, c.positions[v]);
  pose_character(c, 0, 1, mesh);
  expect_at(0, {0.5, 0, 0});
  expect_at(1, {1, 1, 0});
  expect_at(2, {0.9, 0.1, 0});
  expect_at(3, {1.5, 0.5, 0});
  EXPECT_NEAR(length(mesh.normals[1] - Vec3d{-1, 0, 0}), 0, 1e-12);
  EXPECT_NEAR(length(mesh.normals[2] - Vec3d{-half, half, 0}), 0, 1e-12);
  pose_character(c, 0, 1.5, mesh);  // q and -q are one rotation: no rotation between them.
  expect_at(1, {1, 1, 0});
  pose_character(c, 0, 0.5, mesh);
  expect_at(1, {1 + half, half, 0});
  pose_character(c, 0, 3, mesh);  // The clip repeats.
  expect_at(1, {1, 1, 0});
}

TEST(BuiltInCharacter, StandsOnTheGroundAndHasItsHeight) {
  const Character c = built_in_character();
  PosedMesh mesh;
  for (const char* word : {"Walk", "Idle"}) {
    const size_t clip = *find_clip(c, word);
    Box3d bounds;
    for (int32_t i = 0; i < 40; ++i) {
      pose_character(c, clip, c.clips[clip].seconds * i / 40, mesh);
      double lowest = 1;
      for (const Vec3d& p : mesh.positions) {
        bounds.add(p);
        lowest = std::min(lowest, p.y);
      }
      EXPECT_NEAR(lowest, 0, 1e-9) << word << " " << i;
    }
    EXPECT_NEAR(bounds.max.y, 1.75, 0.03) << word;
    EXPECT_NEAR(bounds.min.x, -bounds.max.x, 1e-9);
  }
}

// A moment of the walk, mirrored, is the moment half a cycle on: what mirrored views rely on.
TEST(BuiltInCharacter, HalfACycleOnIsTheMirrorImage) {
  const Character c = built_in_character();
  const size_t walk = *find_clip(c, "Walk");
  const double seconds = c.clips[walk].seconds;
  PosedMesh now, later;
  for (int32_t i = 0; i < 20; ++i) {
    pose_character(c, walk, seconds * i / 20, now);
    pose_character(c, walk, seconds * (i + 10) / 20, later);
    const auto sorted = [](const std::vector<Vec3d>& points, auto coordinate) {
      std::vector<double> values;
      for (const Vec3d& p : points) values.push_back(coordinate(p));
      std::sort(values.begin(), values.end());
      return values;
    };
    const auto expect_alike = [&](auto mine, auto theirs, const char* axis) {
      const auto a = sorted(now.positions, mine), b = sorted(later.positions, theirs);
      double off = 0;
      for (size_t v = 0; v < a.size(); ++v) off = std::max(off, std::fabs(a[v] - b[v]));
      EXPECT_LE(off, 1e-6) << axis << " at " << i;
    };
    const auto x = [](Vec3d p) { return p.x; };
    const auto y = [](Vec3d p) { return p.y; };
    const auto z = [](Vec3d p) { return p.z; };
    expect_alike(
        x, [](Vec3d p) { return -p.x; }, "x");
    expect_alike(y, y, "y");
    expect_alike(z, z, "z");
  }
}

TEST(BuiltInCharacter, FeetThatCarryWeightDoNotSkate) {
  const Character c = built_in_character();
  const size_t walk = *find_clip(c, "Walk");
  const impostor::ClipPlace place = impostor::place_of_clip(c, walk);
  const double stride = impostor::stride_of_clip(c, walk, place);
  EXPECT_GT(stride, 1.2);
  EXPECT_LT(stride, 1.8);
  // In the middle of a stance the sole moves back as fast as the body moves on.
  PosedMesh now, next;
  impostor::pose_in_place(c, walk, place, 0.24, now);
  impostor::pose_in_place(c, walk, place, 0.26, next);
  size_t lowest = 0;
  for (size_t v = 0; v < now.positions.size(); ++v) {
    if (now.positions[v].y < now.positions[lowest].y) lowest = v;
  }
  EXPECT_NEAR((now.positions[lowest].z - next.positions[lowest].z) / 0.02, stride, 0.2 * stride);
  const size_t idle = *find_clip(c, "Idle");
  EXPECT_EQ(impostor::stride_of_clip(c, idle, impostor::place_of_clip(c, idle)), 0);
}

TEST(LoadCharacter, WhatIsNoCharacterIsRefusedInOneSentence) {
  Context context;
  const auto refused = [&](const std::string& path, Errc code, const char* word) {
    const auto loaded = load_character(path, context);
    ASSERT_FALSE(loaded) << path;
    EXPECT_EQ(loaded.error().code, code) << loaded.error().message;
    EXPECT_NE(loaded.error().message.find(word), std::string::npos) << loaded.error().message;
  };
  refused("nosuch.glb", Errc::kBadFile, "no such file");
  refused(THRONG_TEST_DATA "/box.glb", Errc::kBadInput, "skeleton");
  refused(THRONG_TEST_DATA "/plan.wkt", Errc::kBadFile, "plan.wkt");
}

// The real people, where they are present.
TEST(SharedCharacters, AllHaveAWalkThatCarriesThem) {
  const std::filesystem::path folder = THRONG_SHARED_CHARACTERS;
  if (!std::filesystem::is_directory(folder)) GTEST_SKIP() << folder << " is not here";
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    Context context;
    const auto c = load_character(entry.path().string(), context);
    ASSERT_TRUE(c) << c.error().message;
    EXPECT_EQ(c->bones.size(), 31U) << entry.path();
    EXPECT_EQ(c->clips.size(), 11U) << entry.path();
    const size_t walk = *find_clip(*c, "Walk");
    const impostor::ClipPlace place = impostor::place_of_clip(*c, walk);
    PosedMesh mesh;
    impostor::pose_in_place(*c, walk, place, 0, mesh);
    Box3d bounds;
    for (const Vec3d& p : mesh.positions) bounds.add(p);
    const double height = bounds.max.y - bounds.min.y;
    const double strides = impostor::stride_of_clip(*c, walk, place) / height;
    EXPECT_GT(strides, 0.7) << entry.path();
    EXPECT_LT(strides, 1.2) << entry.path();
    // Upright: higher than wide, wider than deep or nearly so.
    EXPECT_GT(height, 1.5 * (bounds.max.x - bounds.min.x)) << entry.path();
  }
}

}  // namespace
}  // namespace throng
