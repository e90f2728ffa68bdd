// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <string>

#include "scratch_folder.h"
#include "throng/bake.h"
#include "throng/scenario.h"

// The world of a scenario, by each of the keys that may name one.
namespace throng {
namespace {

Scenario on_a_plane() {
  Scenario scenario;
  scenario.planes = {{.ground = {{{0, 0}, {8, 0}, {8, 6}, {0, 6}}, {}}, .obstacles = {}}};
  return scenario;
}

// An OBJ of one square floor, its normal up.
std::string floor_file(const test::ScratchFolder& folder, double side) {
  const std::string s = std::to_string(side);
  return folder.write("floor.obj", "v 0 0 0\nv " + s + " 0 0\nv " + s + " 0 " + s + "\nv 0 0 " + s +
                                       "\nf 1 4 3 2\n");
}

Errc code_of(const Result<World>& world) {
  EXPECT_FALSE(world);
  return world ? Errc::kOk : world.error().code;
}

TEST(ScenarioWorld, IsOpenedOrBakedWithItsCellAndClasses) {
  const test::ScratchFolder folder;
  Context context;
  Scenario scenario = on_a_plane();
  scenario.cell = 0.2;
  scenario.classes = {{.name = "porter", .radius = 0.4}};
  const auto plane = open_world(scenario, context);
  ASSERT_TRUE(plane) << plane.error().message;
  EXPECT_EQ(plane->summary().cell, 0.2);
  ASSERT_EQ(plane->summary().classes.size(), 1u);
  EXPECT_EQ(plane->summary().classes[0].name, "porter");
  EXPECT_TRUE(plane->find_place(0, {4, 0, 3}, 0.1));
  EXPECT_FALSE(plane->find_place(0, {9, 0, 3}, 0.1));

  Scenario builtin;
  builtin.builtins = {{.name = "cube"}};
  const auto cube = open_world(builtin, context);
  ASSERT_TRUE(cube) << cube.error().message;
  EXPECT_EQ(cube->summary().classes.size(), default_classes().size());

  Scenario models;
  models.models = {floor_file(folder, 5)};
  const auto floor = open_world(models, context);
  ASSERT_TRUE(floor) << floor.error().message;
  EXPECT_EQ(floor->summary().source_triangles, 2u);

  const std::string path = folder.path() + "/w.throng";
  const auto scene = load_scene(scenario, context);
  ASSERT_TRUE(scene);
  ASSERT_TRUE(bake_world_to(path, *scene, {.cell = 0.25}, context));
  scenario.world = path;  // The first that is given.
  const auto baked = open_world(scenario, context);
  ASSERT_TRUE(baked) << baked.error().message;
  EXPECT_EQ(baked->summary().cell, 0.25);
  EXPECT_EQ(baked->summary().hash, World::open(path)->summary().hash);
}

TEST(ScenarioWorld, ThatCannotBeUsedIsRefused) {
  const test::ScratchFolder folder;
  Context context;
  EXPECT_EQ(code_of(open_world(Scenario{}, context)), Errc::kBadConfig) << "none is named";
  Scenario scenario;
  scenario.world = folder.path() + "/nowhere.throng";
  const auto missing = open_world(scenario, context);
  EXPECT_EQ(code_of(missing), Errc::kBadFile);
  EXPECT_NE(missing.error().message.find(scenario.world), std::string::npos)
      << missing.error().message;
  scenario = {};
  scenario.models = {folder.path() + "/nowhere.obj"};
  EXPECT_EQ(code_of(open_world(scenario, context)), Errc::kBadFile);
  scenario = {};
  scenario.builtins = {{.name = "atlantis"}};
  EXPECT_EQ(code_of(open_world(scenario, context)), Errc::kNotFound);
  scenario = on_a_plane();
  scenario.planes[0].ground.outer.resize(2);
  EXPECT_EQ(code_of(open_world(scenario, context)), Errc::kBadInput);
  scenario = on_a_plane();
  scenario.cell = 0;
  EXPECT_EQ(code_of(open_world(scenario, context)), Errc::kBadConfig);
  scenario = on_a_plane();
  scenario.classes = {{.name = ""}};
  EXPECT_EQ(code_of(open_world(scenario, context)), Errc::kBadConfig);
  context.cancel = true;
  EXPECT_EQ(code_of(open_world(on_a_plane(), context)), Errc::kCancelled);
}

TEST(ScenarioWorld, ABakedOneHasNoTriangles) {
  const test::ScratchFolder folder;
  Context context;
  const std::string path = folder.path() + "/w.throng";
  const auto scene = load_scene(on_a_plane(), context);
  ASSERT_TRUE(scene);
  EXPECT_FALSE(scene->triangles.empty());
  ASSERT_TRUE(bake_world_to(path, *scene, {.cell = 0.25}, context));
  for (Scenario scenario : {Scenario{}, on_a_plane()}) {  // Not those of a plane beside it either.
    scenario.world = path;
    const auto refused = load_scene(scenario, context);
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, Errc::kBadConfig);
    EXPECT_NE(refused.error().message.find(path), std::string::npos) << refused.error().message;
  }
}

}  // namespace
}  // namespace throng
