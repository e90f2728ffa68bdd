// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <limits>
#include <string>
#include <vector>

#include "throng/bake.h"
#include "throng/scene.h"
#include "throng/surface.h"
#include "throng/verify.h"

// The oracle of nodes and of paths over them, on worlds that hold and on sources that they do not
// fit.
namespace throng {
namespace {

// A floor with a crate that only one of two classes steps on.
Scene yard() {
  Scene scene;
  scene.add_quad({0, 0, 0}, {0, 0, 8}, {10, 0, 8}, {10, 0, 0});
  scene.add_box({6, 0, 2}, {8, 0.5, 6});
  return scene;
}

const Nodes& yard_nodes() {
  static const Nodes nodes = [] {
    Context context;
    const auto world = bake_world(
        yard(), {.cell = 0.2, .classes = {{.name = "adult"}, {.name = "ogre", .step_height = 0.6}}},
        context);
    EXPECT_TRUE(world) << world.error().message;
    const auto made = Nodes::create(*world, yard(), {}, context);
    EXPECT_TRUE(made) << made.error().message;
    return *made;
  }();
  return nodes;
}

// Both functions with the same arguments; their errors.
std::vector<Error> errors_of(const Scene& source, const VerifyConfig& config, bool cancel = false) {
  Context context;
  context.cancel = cancel;
  const auto places = verify_nodes(yard_nodes(), source, config, context);
  const auto paths = verify_node_paths(yard_nodes(), source, config, context);
  EXPECT_FALSE(places);
  EXPECT_FALSE(paths);
  std::vector<Error> errors;
  if (!places) errors.push_back(places.error());
  if (!paths) errors.push_back(paths.error());
  return errors;
}

void expect_refused(Errc code, const Scene& source, const VerifyConfig& config,
                    bool cancel = false) {
  for (const Error& error : errors_of(source, config, cancel)) {
    EXPECT_EQ(error.code, code) << error.message;
    EXPECT_EQ(error.message.rfind("verify: ", 0) == 0 || error.message.rfind("path: ", 0) == 0,
              true)
        << error.message;
  }
}

TEST(VerifyNodes, PlacesAndArcsOfAWorldHoldForEachClass) {
  Context context;
  for (const int32_t c : {0, 1}) {
    const auto report =
        verify_nodes(yard_nodes(), yard(), {.samples = 2000, .avatar_class = c}, context);
    ASSERT_TRUE(report) << report.error().message;
    EXPECT_EQ(report->places, 2000u);
    EXPECT_GE(report->arcs, 2000u);
    EXPECT_EQ(
        report->entered + report->unsupported + report->steeper + report->lower + report->one_way,
        0u);
    EXPECT_TRUE(report->faults.empty());
  }
}

TEST(VerifyNodes, PlacesInAnotherSourceAreFaults) {
  Context context;
  Scene wall = yard();
  wall.add_box({2, 0, 0}, {4, 3, 8});
  const auto entered = verify_nodes(yard_nodes(), wall, {.samples = 1000}, context);
  ASSERT_TRUE(entered) << entered.error().message;
  EXPECT_GT(entered->entered, 60u);
  ASSERT_FALSE(entered->faults.empty());
  EXPECT_EQ(entered->faults[0].what, "entered");
  EXPECT_GE(entered->faults[0].triangle, yard().triangles.size());

  Scene lower = yard();
  for (Vec3d& p : lower.positions) p.y -= 2;
  const auto unsupported = verify_nodes(yard_nodes(), lower, {.samples = 1000}, context);
  ASSERT_TRUE(unsupported) << unsupported.error().message;
  EXPECT_EQ(unsupported->unsupported, 1000u);
}

TEST(VerifyNodePaths, PathsOfAWorldHoldAndThoseOfAnotherSourceDoNot) {
  Context context;
  for (const int32_t c : {0, 1}) {
    const auto report =
        verify_node_paths(yard_nodes(), yard(), {.samples = 100, .avatar_class = c}, context);
    ASSERT_TRUE(report) << report.error().message;
    EXPECT_EQ(report->pairs, 100u);
    EXPECT_EQ(report->reached + report->disconnected, 100u);
    EXPECT_GT(report->reached, 30u);
    EXPECT_GE(report->length, report->straight);
    EXPECT_EQ(report->entered + report->unsupported + report->broken + report->disagree, 0u);
  }
  Scene wall = yard();
  wall.add_box({4.9, 0, 0}, {5.1, 3, 8});
  const auto entered = verify_node_paths(yard_nodes(), wall, {.samples = 100}, context);
  ASSERT_TRUE(entered) << entered.error().message;
  EXPECT_GT(entered->entered, 20u);

  VerifyConfig config{.samples = 100};
  config.obstacles = {Prism::box({4.9, 0, -1}, {5.1, 3, 9})};
  const auto divided = verify_node_paths(yard_nodes(), yard(), config, context);
  ASSERT_TRUE(divided) << divided.error().message;
  EXPECT_GT(divided->blocked, 20u) << "from one side to the other";
  EXPECT_EQ(divided->entered + divided->unsupported + divided->broken + divided->disagree, 0u);
}

TEST(VerifyNodes, BadSettingsAndSourcesAreRefusedAndACancelEndsIt) {
  for (const int32_t bad : {-1, 2}) {
    expect_refused(Errc::kBadConfig, yard(), {.samples = 10, .avatar_class = bad});
  }
  expect_refused(Errc::kBadConfig, yard(), {.samples = 0});
  expect_refused(Errc::kBadConfig, yard(), {.samples = UINT64_MAX});
  expect_refused(Errc::kBadConfig, yard(), {.samples = 10, .workers = -1});
  expect_refused(Errc::kBadInput, Scene{}, {.samples = 10});
  Scene bad = yard();
  bad.triangles[3][1] = 100000;
  expect_refused(Errc::kBadInput, bad, {.samples = 10});
  bad = yard();
  bad.positions[2].x = std::numeric_limits<double>::quiet_NaN();
  expect_refused(Errc::kBadInput, bad, {.samples = 10});
  bad = yard();
  bad.area.pop_back();
  expect_refused(Errc::kBadInput, bad, {.samples = 10});
  expect_refused(Errc::kCancelled, yard(), {.samples = 10}, true);
}

TEST(VerifyNodePaths, BadObstaclesAreRefused) {
  Context context;
  VerifyConfig config{.samples = 10};
  config.obstacles = {Prism::box({4, 0, 4}, {5, 1, 5}), Prism{}};
  const auto refused = verify_node_paths(yard_nodes(), yard(), config, context);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, Errc::kBadInput);
}

}  // namespace
}  // namespace throng
