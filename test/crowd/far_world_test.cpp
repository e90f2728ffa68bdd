// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <vector>

#include "baked.h"
#include "crowds.h"
#include "patch_nets.h"
#include "path/overlay/mesh_finder.h"
#include "scratch_folder.h"
#include "throng/papers.h"
#include "throng/path.h"
#include "throng/recording.h"
#include "throng/verify.h"

// National grids count metres from far away: a world is the same wherever it lies, to less than a
// millimetre at 10 000 km. Translations are by whole metres, which are whole cells of an eighth.
namespace throng {
namespace {

constexpr double kCell = 0.125;       // [m]
constexpr double kMillimetre = 1e-3;  // [m]

const std::vector<Vec3d>& translations() {
  static const std::vector<Vec3d> all = {
      {678000, 0, -5403500}, {1e7, 0, 1e7}, {-1e7, 0, -1e7}, {-9999999, 0, 1e7}};
  return all;
}

Scene moved(Scene scene, Vec3d by) {
  for (Vec3d& p : scene.positions) p = p + by;
  for (BezierPatch& patch : scene.patches.patches) {
    for (Vec3d& p : patch.points) p = p + by;
  }
  return scene;
}

const Scene& garage() {
  static const Scene scene = test::builtin({.name = "garage", .size = 45, .levels = 2});
  return scene;
}

void expect_same_positions(const std::vector<AvatarState>& near,
                           const std::vector<AvatarState>& far, Vec3d by) {
  ASSERT_EQ(near.size(), far.size());
  for (size_t i = 0; i < near.size(); ++i) {
    EXPECT_EQ(near[i].id, far[i].id);
    EXPECT_LT(length(far[i].position - by - near[i].position), 0.01 * kMillimetre) << i;
  }
}

TEST(FarWorld, IsBakedAsNearTheCoordinateOrigin) {
  const World near = test::bake(garage(), kCell);
  for (const Vec3d& by : translations()) {
    const World far = test::bake(moved(garage(), by), kCell);
    EXPECT_EQ(far.summary().origin - by, near.summary().origin);
    ASSERT_EQ(far.level_tile_count(), near.level_tile_count());
    for (uint32_t l = 0; l < near.level_tile_count(); ++l) {
      const LevelTileContent a = near.level_tile(l), b = far.level_tile(l);
      EXPECT_EQ(a.tile_x, b.tile_x);
      EXPECT_EQ(a.tile_z, b.tile_z);
      EXPECT_EQ(a.floor, b.floor);
      EXPECT_EQ(a.clearance, b.clearance);
    }
  }
}

TEST(FarWorld, WanderersWalkAndAreRecordedAsNearTheCoordinateOrigin) {
  const World near = test::bake(garage(), kCell);
  const test::ScratchFolder folder;
  const std::string path = folder.path() + "/run.replay";
  for (const Vec3d& by : translations()) {
    const World far = test::bake(moved(garage(), by), kCell);
    auto a = Wanderers::create(near, {.avatars = 80, .seed = 4});
    auto b = Wanderers::create(far, {.avatars = 80, .seed = 4});
    ASSERT_TRUE(a && b);
    RecordingInfo info{.classes = {{.name = "adult"}}, .model = {}, .settings = {}};
    info.origin = recording_origin(far.summary().bounds);
    auto recorder = Recorder::create(path, info);
    ASSERT_TRUE(recorder) << recorder.error().message;
    std::vector<AvatarState> near_states, far_states;
    std::vector<std::vector<Vec3d>> walked;
    for (uint64_t step = 1; step <= 150; ++step) {
      a->step();
      b->step();
      ASSERT_EQ(a->state_hash(), b->state_hash()) << step;
      EXPECT_EQ(b->check().overlaps, 0u);
      EXPECT_EQ(b->check().wall_entries, 0u);
      a->read(near_states);
      b->read(far_states);
      expect_same_positions(near_states, far_states, by);
      RecordedFrame frame;
      frame.step = step;
      frame.time = 0.1 * static_cast<double>(step);
      frame.resize(far_states.size());
      for (size_t i = 0; i < far_states.size(); ++i) {
        frame.ids[i] = far_states[i].id;
        frame.positions[i] = far_states[i].position;
      }
      walked.push_back(frame.positions);
      const auto ok = recorder->append(frame.view());
      ASSERT_TRUE(ok) << ok.error().message;
    }
    ASSERT_TRUE(recorder->finish());
    auto replay = Replay::open(path);
    ASSERT_TRUE(replay) << replay.error().message;
    ASSERT_EQ(replay->frame_count(), walked.size());
    RecordedFrame frame;
    for (uint64_t f = 0; f < walked.size(); ++f) {
      ASSERT_TRUE(replay->read(f, frame));
      for (size_t i = 0; i < walked[f].size(); ++i) {
        const Vec3d off = frame.positions[i] - walked[f][i];
        EXPECT_LT(std::max({std::fabs(off.x), std::fabs(off.y), std::fabs(off.z)}),
                  0.501 * kMillimetre);
      }
    }
  }
}

TEST(FarWorld, ACrowdWithGoalsWalksAsNearTheCoordinateOrigin) {
  const World near = test::bake(garage(), kCell);
  for (const Vec3d& by : translations()) {
    const World far = test::bake(moved(garage(), by), kCell);
    Crowd a = made(near), b = made(far);
    const auto a_ids = scattered(a, 60), b_ids = scattered(b, 60);
    ASSERT_EQ(a_ids.size(), b_ids.size());
    std::vector<Place> a_goals, b_goals;
    for (size_t i = 0; i < a_ids.size(); ++i) {
      a_goals.push_back(near.random_place(0, 7, i));
      b_goals.push_back(far.find_place(0, a_goals.back().position + by, 0.01));
      ASSERT_TRUE(b_goals.back());
      EXPECT_EQ(a_goals.back().level1, b_goals.back().level1);
    }
    a.set_goals(a_ids, a_goals);
    b.set_goals(b_ids, b_goals);
    std::vector<AvatarState> near_states, far_states;
    for (int step = 0; step < 200; ++step) {
      a.step();
      b.step();
      a.read(near_states);
      b.read(far_states);
      expect_same_positions(near_states, far_states, by);
    }
    EXPECT_EQ(a.state_hash(), b.state_hash());
    EXPECT_EQ(b.check().overlaps, 0u);
    EXPECT_EQ(b.check().wall_entries, 0u);
  }
}

TEST(FarWorld, PathsAreThoseNearTheCoordinateOrigin) {
  Context context;
  const World near = test::bake(garage(), kCell);
  auto a = path::MeshFinder::create(near, {}, context);
  ASSERT_TRUE(a);
  for (const Vec3d& by : translations()) {
    const Scene scene = moved(garage(), by);
    const World far = test::bake(scene, kCell);
    auto b = path::MeshFinder::create(far, {}, context);
    ASSERT_TRUE(b);
    Path near_path, far_path;
    for (uint64_t n = 0; n < 40; ++n) {
      const Place from = near.random_place(0, 3, 2 * n), to = near.random_place(0, 3, 2 * n + 1);
      a->find(from, to, near_path);
      b->find({from.position + by, from.level1}, {to.position + by, to.level1}, far_path);
      EXPECT_EQ(near_path.end, far_path.end);
      EXPECT_NEAR(near_path.length, far_path.length, kMillimetre);
      ASSERT_EQ(near_path.points.size(), far_path.points.size());
      for (size_t i = 0; i < near_path.points.size(); ++i) {
        EXPECT_LT(length(far_path.points[i].position - by - near_path.points[i].position),
                  kMillimetre);
      }
    }
    const auto report = verify_world(far, scene, {.samples = 2000}, context);
    ASSERT_TRUE(report);
    EXPECT_EQ(report->entered, 0u);
    EXPECT_EQ(report->unsupported, 0u);
    EXPECT_EQ(report->broken, 0u);
  }
}

// A cell of a tenth of a metre is not a binary fraction: the grid is rounded, and all holds
// nevertheless.
TEST(FarWorld, CellsThatAreNoBinaryFractionWalkToTheMillimetre) {
  const World near = test::bake(garage(), 0.1);
  for (const Vec3d& by : translations()) {
    const World far = test::bake(moved(garage(), by), 0.1);
    ASSERT_EQ(far.level_tile_count(), near.level_tile_count());
    auto a = Wanderers::create(near, {.avatars = 80, .seed = 4});
    auto b = Wanderers::create(far, {.avatars = 80, .seed = 4});
    ASSERT_TRUE(a && b);
    std::vector<AvatarState> near_states, far_states;
    for (int step = 0; step < 100; ++step) {
      a->step();
      b->step();
    }
    EXPECT_EQ(a->state_hash(), b->state_hash());
    a->read(near_states);
    b->read(far_states);
    expect_same_positions(near_states, far_states, by);
  }
}

std::vector<AvatarClass> climbers() {
  std::vector<AvatarClass> all = default_classes();
  all.push_back({.name = "climber"});
  all.back().climb_slope = 180;
  return all;
}

// A net of patches with a vault over it that pierces it: links over the hole as well.
Scene pierced_net() {
  PatchSet set = test::make_net({.side = 3, .cell = 8, .relief = 3});
  PatchSet pierces = test::make_net({.side = 1, .cell = 8, .relief = 2, .split_some = false});
  for (BezierPatch& patch : pierces.patches) {
    for (Vec3d& p : patch.points) p = {8 + p.y, p.x - 4, 8 + p.z};  // Upright.
  }
  set.append(pierces);
  return test::patch_scene(set);
}

TEST(FarWorld, NodesAndTheirPathsAreThoseNearTheCoordinateOrigin) {
  Context context;
  const Scene scene = pierced_net();
  const auto near = Nodes::create(test::bake(scene, 0.25, climbers()), scene, {.size = 1}, context);
  ASSERT_TRUE(near) << near.error().message;
  const NodeSummary expected = near->summary();
  for (const Vec3d& by : translations()) {
    const Scene far_scene = moved(scene, by);
    const auto far =
        Nodes::create(test::bake(far_scene, 0.25, climbers()), far_scene, {.size = 1}, context);
    ASSERT_TRUE(far) << far.error().message;
    const NodeSummary found = far->summary();
    EXPECT_EQ(found.nodes, expected.nodes);
    EXPECT_EQ(found.arcs, expected.arcs);
    for (const int32_t c : {0, 4}) {
      const auto report = verify_node_paths(*far, far_scene,
                                            {.samples = 30, .seed = 5, .avatar_class = c}, context);
      ASSERT_TRUE(report) << report.error().message;
      EXPECT_EQ(report->entered, 0u);
      EXPECT_EQ(report->unsupported, 0u);
      EXPECT_EQ(report->broken, 0u);
      EXPECT_EQ(report->disagree, 0u);
    }
  }
}

}  // namespace
}  // namespace throng
