// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "throng_view/viewer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <string>

#include "throng/bake.h"
#include "throng/crowd.h"
#include "throng/scenario.h"
#include "throng/scene.h"
#include "view/crowd_player.h"
#include "view/density_brush.h"

// The viewer without a window: events in, pictures out.
namespace throng {
namespace {

constexpr int32_t kWidth = 480, kHeight = 320;

struct Baked {
  Scene scene;
  World world;
};

const Baked& two_floors() {
  static const Baked baked = [] {
    Baked b;
    b.scene.add_box({0, -0.3, 0}, {20, 0, 20});
    b.scene.add_box({0, 3, 0}, {20, 3.3, 8});
    b.scene.add_box({9, 0, 9}, {11, 1.5, 11});
    Context context;
    auto world = bake_world(b.scene, {}, context);
    b.world = *std::move(world);
    return b;
  }();
  return baked;
}

const Atlas& people() {
  static const Atlas atlas = [] {
    AtlasConfig config;
    config.clips = {"Walk", "Idle"};
    config.frames = 4;
    config.pixels = 32;
    Context context;
    auto built = create_atlas(built_in_character(), config, context);
    return *std::move(built);
  }();
  return atlas;
}

LoadStage stage_with(uint32_t avatars) {
  return [avatars](StageParts& parts, Context&) -> Result<void> {
    const Baked& baked = two_floors();
    if (auto ok = parts.set_scene(baked.scene); !ok) return ok;
    parts.set_world(baked.world);
    parts.set_atlases({{people()}});
    CrowdStart start;
    start.avatars = avatars;
    start.near = 8;
    parts.set_crowd(start);
    return {};
  };
}

Viewer made_viewer(const ViewerConfig& config = {}) {
  Result<Drawing> drawing = Drawing::create();
  EXPECT_TRUE(drawing) << drawing.error().message;
  Result<Viewer> viewer = Viewer::create(*std::move(drawing), config);
  EXPECT_TRUE(viewer) << viewer.error().message;
  return *std::move(viewer);
}

void press(Viewer& viewer, Key key) {
  ViewEvent event{.kind = ViewEventKind::kKeyDown};
  event.key = key;
  viewer.handle(event);
  event.kind = ViewEventKind::kKeyUp;
  viewer.handle(event);
}

void hold(Viewer& viewer, Key key, bool down) {
  ViewEvent event{.kind = down ? ViewEventKind::kKeyDown : ViewEventKind::kKeyUp};
  event.key = key;
  viewer.handle(event);
}

void mouse(Viewer& viewer, ViewEventKind kind, double x, double y,
           MouseButton button = MouseButton::kLeft) {
  ViewEvent event{.kind = kind};
  event.x = x;
  event.y = y;
  event.button = button;
  viewer.handle(event);
}

size_t pixels_that_differ(const Image& a, const Image& b) {
  size_t count = 0;
  for (size_t i = 0; i < a.rgb.size(); i += 3) {
    count += std::abs(a.rgb[i] - b.rgb[i]) + std::abs(a.rgb[i + 1] - b.rgb[i + 1]) > 24 ? 1 : 0;
  }
  return count;
}

Image picture(Viewer& viewer, double now) {
  auto image = viewer.picture(now, kWidth, kHeight);
  EXPECT_TRUE(image) << image.error().message;
  return *std::move(image);
}

TEST(Viewer, ShowsAWorldAndACrowdThatWalks) {
  Viewer viewer = made_viewer({.settings = {}, .font = {}, .panel = false});
  const Image empty = picture(viewer, 0);
  viewer.load("two floors", stage_with(60));
  EXPECT_TRUE(viewer.status().loading);
  viewer.wait_until_loaded();
  EXPECT_EQ(viewer.status().error, "");
  viewer.play_for(1);
  const Image first = picture(viewer, 0);
  EXPECT_GT(pixels_that_differ(empty, first), first.rgb.size() / 3 / 10);
  EXPECT_EQ(viewer.status().avatars, 60U);
  EXPECT_GT(viewer.status().drawn, 30U);
  EXPECT_NEAR(viewer.status().time, 1, 1e-9);
  viewer.play_for(2);
  const Image later = picture(viewer, 0);
  EXPECT_GT(pixels_that_differ(first, later), 50U);
}

TEST(Viewer, TheSameTimeGivesTheSamePicture) {
  const auto taken = [] {
    Viewer viewer = made_viewer({.settings = {}, .font = {}, .panel = false});
    viewer.load("two floors", stage_with(40));
    viewer.wait_until_loaded();
    viewer.play_for(1.5);
    return picture(viewer, 0).rgb;
  };
  EXPECT_EQ(taken(), taken());
}

TEST(Viewer, KeysAndMouseMoveTheEyeAsInOtherPrograms) {
  Viewer viewer = made_viewer({.settings = {}, .font = {}, .panel = false});
  viewer.load("two floors", stage_with(5));
  viewer.wait_until_loaded();
  (void)picture(viewer, 0);
  const EyeCamera start = viewer.status().camera;
  mouse(viewer, ViewEventKind::kMouseDown, 100, 100);
  mouse(viewer, ViewEventKind::kMouseMove, 180, 130);
  mouse(viewer, ViewEventKind::kMouseUp, 180, 130);
  (void)picture(viewer, 0.1);
  const EyeCamera turned = viewer.status().camera;
  EXPECT_NEAR(length(turned.target - start.target), 0, 1e-9);
  EXPECT_GT(length(turned.eye - start.eye), 1);
  mouse(viewer, ViewEventKind::kMouseDown, 100, 100, MouseButton::kRight);
  mouse(viewer, ViewEventKind::kMouseMove, 150, 100);
  mouse(viewer, ViewEventKind::kMouseUp, 150, 100, MouseButton::kRight);
  (void)picture(viewer, 0.2);
  EXPECT_GT(length(viewer.status().camera.target - turned.target), 0.5);
  ViewEvent wheel{.kind = ViewEventKind::kWheel};
  wheel.y = 4;
  viewer.handle(wheel);
  (void)picture(viewer, 0.3);
  EXPECT_LT(length(viewer.status().camera.eye - viewer.status().camera.target),
            0.6 * length(turned.eye - turned.target));
  press(viewer, Key::kHome);
  hold(viewer, key_of('W'), true);
  (void)picture(viewer, 0.4);
  const Vec3d before = viewer.status().camera.target;
  (void)picture(viewer, 0.6);
  hold(viewer, key_of('W'), false);
  const Vec3d after = viewer.status().camera.target;
  EXPECT_GT(length(after - before), 0.5);
  EXPECT_NEAR(after.y, before.y, 1e-9);  // At the same height.
  viewer.handle({.kind = ViewEventKind::kLeave});
  (void)picture(viewer, 0.8);
  EXPECT_NEAR(length(viewer.status().camera.target - after), 0, 1e-9);
}

TEST(Viewer, AGamepadMovesTheEyeAndNonsenseDoesNot) {
  Viewer viewer = made_viewer({.settings = {}, .font = {}, .panel = false});
  viewer.load("two floors", stage_with(5));
  viewer.wait_until_loaded();
  double now = 0;
  const auto moved_by = [&](const GamepadState& state) {
    (void)picture(viewer, now += 0.1);
    const Vec3d before = viewer.status().camera.target;
    viewer.set_gamepad(state);
    (void)picture(viewer, now += 0.2);
    viewer.set_gamepad({});
    return viewer.status().camera.target - before;
  };
  const Vec3d ahead = moved_by({.walk_y = -1}), back = moved_by({.walk_y = 1});
  EXPECT_GT(length(ahead), 0.1);
  EXPECT_LT(length(ahead + back), 0.2 * length(ahead));
  EXPECT_GT(length(moved_by({.walk_y = -1, .hurry = true})), 2 * length(ahead));
  EXPECT_LT(length(moved_by({.walk_x = 1e300})), 2 * length(ahead)) << "a stick has an end";
  EXPECT_EQ(length(moved_by({.walk_x = std::nan(""), .walk_y = std::nan("")})), 0);
  EXPECT_GT(length(moved_by({.look_x = 1})), 0.01);
}

// All events of a drag between two frames, without a move, as from a fast hand on a slow machine.
TEST(Viewer, ADragWithinOneFrameCounts) {
  Viewer viewer = made_viewer();
  viewer.load("two floors", stage_with(5));
  viewer.wait_until_loaded();
  (void)picture(viewer, 0);
  mouse(viewer, ViewEventKind::kMouseMove, 60, 60);  // On the panel.
  (void)picture(viewer, 0.1);
  const EyeCamera start = viewer.status().camera;
  mouse(viewer, ViewEventKind::kMouseMove, 430, 150);  // Off it.
  mouse(viewer, ViewEventKind::kMouseDown, 430, 150);
  mouse(viewer, ViewEventKind::kMouseUp, 350, 160);
  (void)picture(viewer, 0.2);
  EXPECT_GT(length(viewer.status().camera.eye - start.eye), 1);
  EXPECT_EQ(viewer.status().picked, -1);
}

TEST(Viewer, AClickWithinOneFrameReachesThePanel) {
  Viewer viewer = made_viewer();
  viewer.load("two floors", stage_with(5));
  viewer.wait_until_loaded();
  (void)picture(viewer, 0);
  mouse(viewer, ViewEventKind::kMouseMove, 40, 93);  // "Pause".
  (void)picture(viewer, 0.1);
  EXPECT_TRUE(viewer.status().playing);
  mouse(viewer, ViewEventKind::kMouseDown, 40, 93);
  mouse(viewer, ViewEventKind::kMouseUp, 40, 93);
  (void)picture(viewer, 0.2);
  (void)picture(viewer, 0.3);
  EXPECT_FALSE(viewer.status().playing);
}

Scenario a_scenario() {
  const auto scenario = parse_scenario(R"(
seconds = 20
[plane]
floor = [[0, 0], [20, 0], [20, 20], [0, 20]]
[[area]]
name = "door"
box = [0.5, 0.5, 4, 19]
[[area]]
name = "far"
box = [15, 15, 19, 19]
[[area]]
name = "near"
box = [6, 1, 9, 4]
[[density]]
name = "goals"
box = [0, 0, 20, 20]
pixel = 1
paint = [{ area = "far", weight = 100 }]
[[journey]]
name = "visit"
stages = [{ density = "goals" }]
[[source]]
name = "all"
area = "door"
count = 30
journey = "visit"
[[obstacle]]
name = "crate"
box = [10, 2, 12, 4]
y = [0, 1]
begin = 2
)",
                                       "test.toml");
  EXPECT_TRUE(scenario) << scenario.error().message;
  return *scenario;
}

LoadStage stage_of(const Scenario& scenario) {
  return [scenario](StageParts& parts, Context& context) -> Result<void> {
    const auto scene = load_scene(scenario, context);
    if (!scene) return scene.error();
    if (auto ok = parts.set_scene(*scene); !ok) return ok;
    const auto world = bake_world(scenario, *scene, context);
    if (!world) return world.error();
    parts.set_world(*world);
    parts.set_atlases({{people()}});
    parts.set_scenario(scenario);
    return {};
  };
}

TEST(Viewer, RunsAScenarioByItsOwnClockWithItsObstacles) {
  Viewer viewer = made_viewer({.settings = R"({"shadows": false})", .font = {}, .panel = false});
  viewer.load("scenario", stage_of(a_scenario()));
  viewer.wait_until_loaded();
  EXPECT_EQ(viewer.status().error, "");
  viewer.look_at({11, 6, 3.1}, {11, 0, 3});
  viewer.play_for(1);
  const Image before = picture(viewer, 0);
  EXPECT_EQ(viewer.status().avatars, 30U);
  viewer.play_for(1.5);
  const Image crate = picture(viewer, 0);
  // The crate's colour is the only warm one: much more red than blue.
  const auto warm = [](const Image& image) {
    size_t count = 0;
    for (size_t i = 0; i < image.rgb.size(); i += 3) {
      count += image.rgb[i] > image.rgb[i + 2] + 60 ? 1 : 0;
    }
    return count;
  };
  EXPECT_LT(warm(before), 200U);
  EXPECT_GT(warm(crate), 10000U);
  viewer.play_for(100);  // It ends after 20 s.
  (void)picture(viewer, 0);
  EXPECT_NEAR(viewer.status().time, 20, 0.11);
  viewer.load("two floors", stage_with(3));
  viewer.wait_until_loaded();
  viewer.look_at({11, 6, 3.1}, {11, 0, 3});
  EXPECT_LT(warm(picture(viewer, 0)), 200U);  // The crate left with its scenario.
}

size_t pink(const Image& image) {
  size_t count = 0;
  for (size_t i = 0; i < image.rgb.size(); i += 3) {
    count += image.rgb[i] > image.rgb[i + 1] + 50 && image.rgb[i + 2] > image.rgb[i + 1] + 20;
  }
  return count;
}

TEST(Viewer, TheBrushPaintsWhereADragGoesAndWipesItAway) {
  for (const bool of_scenario : {false, true}) {
    Viewer viewer = made_viewer({.settings = R"({"shadows": false})", .font = {}, .panel = false});
    viewer.load("stage", of_scenario ? stage_of(a_scenario()) : stage_with(20));
    viewer.wait_until_loaded();
    viewer.look_at({10, 25, 10.1}, {10, 0, 10});
    viewer.play_for(0.1);
    (void)picture(viewer, 0);
    const EyeCamera before = viewer.status().camera;
    const auto seen = [&] {
      viewer.wait_for_overlays();
      return pink(picture(viewer, 0));
    };
    press(viewer, key_of('T'));
    const size_t first = seen();
    EXPECT_EQ(first > 0, of_scenario);  // Its own map.
    mouse(viewer, ViewEventKind::kMouseDown, 180, 230);
    mouse(viewer, ViewEventKind::kMouseMove, 280, 230);
    mouse(viewer, ViewEventKind::kMouseUp, 280, 230);
    const size_t painted = seen();
    EXPECT_GT(painted, first + 3000);
    EXPECT_EQ(viewer.status().camera.eye, before.eye);  // Nothing turned.
    press(viewer, key_of('T'));
    mouse(viewer, ViewEventKind::kMouseDown, 180, 230);
    mouse(viewer, ViewEventKind::kMouseUp, 220, 230);
    const size_t left = seen();
    EXPECT_LT(left, painted - 1000);
    EXPECT_GT(left, first);
    press(viewer, key_of('T'));
    mouse(viewer, ViewEventKind::kMouseDown, 300, 230);
    mouse(viewer, ViewEventKind::kMouseUp, 350, 230);
    (void)picture(viewer, 0);
    EXPECT_NE(viewer.status().camera.eye, before.eye);  // Drags turn again.
    EXPECT_EQ(viewer.status().error, "");
  }
}

TEST(CrowdPlayer, PeopleGoWhereItIsPainted) {
  Context context;
  CrowdStart start;
  start.avatars = 24;
  auto player = view::CrowdPlayer::create(two_floors().world, {}, start, 1, {}, nullptr, context);
  ASSERT_TRUE(player) << player.error().message;
  std::vector<DensityMap> maps;
  const auto near = [](const view::TimelineFrame& moment, double x, double z, double within) {
    size_t count = 0;
    for (size_t i = 0; i < moment.size(); ++i) {
      count += std::hypot(moment.x[i] - x, moment.z[i] - z) < within ? 1 : 0;
    }
    return count;
  };
  const auto after = [&](int32_t steps) {
    for (int32_t k = 1; k < steps; ++k) (void)(*player)->next();
    return (*player)->next();
  };
  const auto at_first = after(2);
  const size_t before = near(*at_first, 3, 15, 4);
  view::paint(view::map_at(maps, two_floors().scene.bounds(), 0), {3, 0, 15}, 3, 255);
  (*player)->set_density(maps);
  const size_t there = near(*after(300), 3, 15, 4);
  EXPECT_LT(before, 10U);
  EXPECT_GT(there, 14U);  // The others are up where no path leads down, or on their paths.
  (*player)->set_density({});
  EXPECT_LT(near(*after(300), 3, 15, 4), 10U);
}

TEST(Viewer, AScenarioThatCannotRunSaysWhy) {
  Scenario scenario = a_scenario();
  scenario.areas[0].prisms = {Prism::box({100, -1, 100}, {101, 3, 101})};
  Viewer viewer = made_viewer({.settings = {}, .font = {}, .panel = false});
  viewer.load("scenario", stage_of(scenario));
  viewer.wait_until_loaded();
  EXPECT_NE(viewer.status().error.find("source 'all': no"), std::string::npos)
      << viewer.status().error;
}

TEST(Viewer, SpacePausesAndPeriodMakesOneStep) {
  Viewer viewer = made_viewer({.settings = {}, .font = {}, .panel = false});
  viewer.load("two floors", stage_with(20));
  viewer.wait_until_loaded();
  viewer.play_for(0.5);
  EXPECT_TRUE(viewer.status().playing);
  press(viewer, Key::kSpace);
  (void)picture(viewer, 0);
  const double paused = viewer.status().time;
  (void)picture(viewer, 1);
  EXPECT_FALSE(viewer.status().playing);
  EXPECT_EQ(viewer.status().time, paused);
  press(viewer, Key::kPeriod);
  viewer.play_for(0);
  (void)picture(viewer, 2);
  EXPECT_NEAR(viewer.status().time - paused, 0.1, 0.11);
  EXPECT_GT(viewer.status().time, paused);
}

TEST(Viewer, StoreysArePeeledOffFromAbove) {
  Viewer viewer = made_viewer({.settings = {}, .font = {}, .panel = false});
  viewer.load("two floors", stage_with(150));
  viewer.wait_until_loaded();
  viewer.look_at({10, 40, 10.1}, {10, 0, 10});
  viewer.play_for(0.2);
  press(viewer, Key::kSpace);
  const Image whole = picture(viewer, 0);
  const size_t all = viewer.status().drawn;
  press(viewer, Key::kPageDown);
  const Image peeled = picture(viewer, 0.1);
  EXPECT_LT(viewer.status().drawn, all);
  EXPECT_GT(viewer.status().drawn, 0U);
  EXPECT_EQ(viewer.status().avatars, 150U);
  EXPECT_GT(pixels_that_differ(whole, peeled), 500U);
  press(viewer, Key::kPageUp);
  const Image again = picture(viewer, 0.2);
  EXPECT_EQ(viewer.status().drawn, all);
  EXPECT_LT(pixels_that_differ(whole, again), 20U);
}

TEST(Viewer, AClickPicksTheAvatarThereAndEscapeReleasesIt) {
  Viewer viewer = made_viewer({.settings = R"({"shadows": false})", .font = {}, .panel = false});
  (void)picture(viewer, 0);  // Sets the picture's shape, which the first view depends on.
  viewer.load("two floors", stage_with(1));
  viewer.wait_until_loaded();
  viewer.play_for(0.1);
  press(viewer, Key::kSpace);
  // One avatar: the pixels that differ from the empty world.
  const Image with = picture(viewer, 0);
  viewer.load("empty", stage_with(0));
  viewer.wait_until_loaded();
  viewer.play_for(0.1);
  const Image without = picture(viewer, 0.1);
  double x = 0, y = 0, n = 0;
  for (int32_t v = 0; v < kHeight; ++v) {
    for (int32_t u = 0; u < kWidth; ++u) {
      const size_t i = (static_cast<size_t>(v) * kWidth + static_cast<size_t>(u)) * 3;
      if (std::abs(with.rgb[i] - without.rgb[i]) < 40) continue;
      x += u;
      y += v;
      ++n;
    }
  }
  ASSERT_GT(n, 5);
  viewer.load("one", stage_with(1));
  viewer.wait_until_loaded();
  viewer.play_for(0.1);
  (void)picture(viewer, 0.2);
  mouse(viewer, ViewEventKind::kMouseDown, x / n, y / n);
  mouse(viewer, ViewEventKind::kMouseUp, x / n, y / n);
  EXPECT_EQ(viewer.status().picked, 0);
  press(viewer, Key::kEscape);
  EXPECT_EQ(viewer.status().picked, -1);
  mouse(viewer, ViewEventKind::kMouseDown, 3, 3);
  mouse(viewer, ViewEventKind::kMouseUp, 3, 3);
  EXPECT_EQ(viewer.status().picked, -1);
}

TEST(Viewer, AControlledAvatarFollowsTheSameRules) {
  Viewer viewer = made_viewer({.settings = {}, .font = {}, .panel = false});
  viewer.load("two floors", stage_with(30));
  viewer.wait_until_loaded();
  viewer.look_at({10, 12, 26}, {10, 0, 15});
  viewer.play_for(0.2);
  (void)picture(viewer, 0);
  press(viewer, key_of('3'));
  viewer.play_for(0.3);
  (void)picture(viewer, 0.1);
  ASSERT_GE(viewer.status().controlled, 0);
  EXPECT_EQ(viewer.status().avatars, 31U);
  viewer.play_for(0.2);
  (void)picture(viewer, 0.2);
  const Vec3d start = viewer.status().camera.target;
  hold(viewer, key_of('W'), true);
  (void)picture(viewer, 0.3);
  viewer.play_for(12);
  (void)picture(viewer, 0.4);
  const Vec3d end = viewer.status().camera.target;
  EXPECT_LT(end.z, start.z - 2);  // Ahead is away from the eye.
  EXPECT_GT(end.z, 0);            // The ground's edge stops it.
  press(viewer, key_of('V'));
  (void)picture(viewer, 0.5);
  EXPECT_TRUE(viewer.take_requests().grab_mouse);
  press(viewer, Key::kEscape);
  viewer.play_for(0.5);
  (void)picture(viewer, 0.6);
  EXPECT_EQ(viewer.status().controlled, -1);
  EXPECT_EQ(viewer.status().avatars, 30U);
  EXPECT_FALSE(viewer.take_requests().grab_mouse);
}

TEST(Viewer, KeysMakeRequests) {
  Viewer viewer = made_viewer();
  press(viewer, Key::kF11);
  press(viewer, Key::kF12);
  EXPECT_TRUE(viewer.take_requests().fullscreen);
  EXPECT_TRUE(viewer.take_requests().fullscreen);
  EXPECT_FALSE(viewer.take_requests().save_picture);
  ViewEvent drop{.kind = ViewEventKind::kDrop};
  drop.path = "walks/a.replay";
  viewer.handle(drop);
  EXPECT_EQ(viewer.take_requests().open, "walks/a.replay");
  hold(viewer, Key::kControl, true);
  press(viewer, key_of('Q'));
  EXPECT_TRUE(viewer.take_requests().close);
}

TEST(Viewer, ThePanelIsDrawnAndTakesTheMouse) {
  Viewer viewer = made_viewer();
  viewer.load("two floors", stage_with(10));
  viewer.wait_until_loaded();
  press(viewer, Key::kSpace);
  (void)picture(viewer, 0);
  const Image with = picture(viewer, 0.1);
  const EyeCamera before = viewer.status().camera;
  mouse(viewer, ViewEventKind::kMouseMove, 60, 60);  // On the panel.
  (void)picture(viewer, 0.2);
  mouse(viewer, ViewEventKind::kMouseDown, 60, 60);
  mouse(viewer, ViewEventKind::kMouseMove, 90, 90);
  mouse(viewer, ViewEventKind::kMouseUp, 90, 90);
  (void)picture(viewer, 0.3);
  EXPECT_EQ(viewer.status().camera.eye, before.eye);
  press(viewer, Key::kTab);
  (void)picture(viewer, 0.4);
  const Image without = picture(viewer, 0.5);
  EXPECT_GT(pixels_that_differ(with, without), 10000U);
  press(viewer, Key::kF1);
  (void)picture(viewer, 0.6);
  const Image help = picture(viewer, 0.7);
  EXPECT_GT(pixels_that_differ(help, without), 10000U);
}

TEST(Viewer, SettingsAreKeptAndBadOnesRefused) {
  std::string kept;
  {
    Viewer viewer = made_viewer();
    press(viewer, Key::kTab);
    press(viewer, Key::kComma);
    kept = viewer.settings();
  }
  Viewer viewer = made_viewer({.settings = kept, .font = {}});
  EXPECT_EQ(viewer.settings(), kept);
  EXPECT_NE(kept.find("\"panel\": false"), std::string::npos);
  EXPECT_NE(kept.find("\"speed\": 0.70710"), std::string::npos);
  Result<Drawing> drawing = Drawing::create();
  ASSERT_TRUE(drawing);
  const auto refused = Viewer::create(*std::move(drawing), {.settings = "panel", .font = {}});
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, Errc::kBadFile);
  Viewer odd = made_viewer({.settings = R"({"speed": 1e9, "edges": "much"})", .font = {}});
  EXPECT_NE(odd.settings().find("\"speed\": 1.0"), std::string::npos);
}

TEST(Viewer, ALoadThatFailsSaysWhyAndOneThatIsReplacedIsCancelled) {
  Viewer viewer = made_viewer({.settings = {}, .font = {}, .panel = false});
  viewer.load("bad", [](StageParts&, Context&) -> Result<void> {
    return Error{Errc::kBadFile, "bad: has no triangles"};
  });
  viewer.wait_until_loaded();
  EXPECT_EQ(viewer.status().error, "bad: has no triangles");
  std::atomic<bool> seen = false;
  viewer.load("endless", [&seen](StageParts&, Context& context) -> Result<void> {
    while (!context.cancel) {
    }
    seen = true;
    return Error{Errc::kCancelled, ""};
  });
  viewer.load("two floors", stage_with(3));
  viewer.wait_until_loaded();
  (void)picture(viewer, 0);
  EXPECT_EQ(viewer.status().error, "");
  EXPECT_EQ(viewer.status().name, "two floors");
  while (!seen) {
  }
}

}  // namespace
}  // namespace throng
