// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <numeric>
#include <string>
#include <vector>

#include "throng/bake.h"
#include "throng/papers.h"
#include "throng_view/viewer.h"
#include "view/crowd_player.h"
#include "view/curved_frame.h"
#include "view/plane_player.h"

// [CAACD] in the viewer: values that a person sets, states and fields, the experiment of section V.
namespace throng {
namespace {

constexpr int32_t kWidth = 480, kHeight = 320;

struct Baked {
  Scene scene;
  World world;
};

const Baked& floor_of_20_metres() {
  static const Baked baked = [] {
    Baked b;
    b.scene.add_box({0, -0.3, 0}, {20, 0, 20});
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

CrowdStart curved_start(uint32_t avatars) {
  CrowdStart start;
  start.avatars = avatars;
  start.near = 8;
  start.model = SteeringModel::kCurvilinear;
  return start;
}

LoadStage crowd_stage(const CrowdStart& start) {
  return [start](StageParts& parts, Context&) -> Result<void> {
    if (auto ok = parts.set_scene(floor_of_20_metres().scene); !ok) return ok;
    parts.set_world(floor_of_20_metres().world);
    parts.set_atlases({{people()}});
    parts.set_crowd(start);
    return {};
  };
}

LoadStage plane_stage(const ExperimentStart& start) {
  return [start](StageParts& parts, Context&) -> Result<void> {
    Scene scene;
    scene.add_box({-2, -0.1, -2}, {22, 0, 22});
    if (auto ok = parts.set_scene(scene); !ok) return ok;
    parts.set_atlases({{people()}});
    parts.set_experiment(start);
    return {};
  };
}

Viewer viewer_of(const LoadStage& stage) {
  Result<Drawing> drawing = Drawing::create();
  EXPECT_TRUE(drawing) << drawing.error().message;
  Result<Viewer> viewer =
      Viewer::create(*std::move(drawing), {.settings = {}, .font = {}, .panel = false});
  EXPECT_TRUE(viewer) << viewer.error().message;
  viewer->load("curves", stage);
  viewer->wait_until_loaded();
  EXPECT_EQ(viewer->status().error, "");
  return *std::move(viewer);
}

void press(Viewer& viewer, char key, int times = 1) {
  for (int k = 0; k < times; ++k) {
    ViewEvent event{.kind = ViewEventKind::kKeyDown};
    event.key = key_of(key);
    viewer.handle(event);
    event.kind = ViewEventKind::kKeyUp;
    viewer.handle(event);
  }
}

Image picture(Viewer& viewer) {
  auto image = viewer.picture(0, kWidth, kHeight);
  EXPECT_TRUE(image) << image.error().message;
  return *std::move(image);
}

size_t pixels_that_differ(const Image& a, const Image& b) {
  size_t count = 0;
  for (size_t i = 0; i < a.rgb.size(); i += 3) {
    count += std::abs(a.rgb[i] - b.rgb[i]) + std::abs(a.rgb[i + 1] - b.rgb[i + 1]) > 24 ? 1 : 0;
  }
  return count;
}

size_t sum(const std::vector<size_t>& counts) {
  return std::accumulate(counts.begin(), counts.end(), size_t{0});
}

TEST(Curves, KeysSetTheValuesOfAllAvatarsOrOfTheOnePicked) {
  Viewer viewer = viewer_of(crowd_stage(curved_start(30)));
  viewer.play_for(1);
  (void)picture(viewer);
  ASSERT_TRUE(viewer.status().curves);
  EXPECT_EQ(viewer.status().curves->mass, 2.0);
  EXPECT_EQ(sum(viewer.status().states), 30U);
  press(viewer, '5', 2);
  press(viewer, '6');
  press(viewer, '9');
  EXPECT_EQ(viewer.status().curves->mass, 2.5);
  EXPECT_NEAR(viewer.status().curves->max_speed, 0.3, 1e-12);
  EXPECT_NEAR(viewer.status().curves->max_force, 0.08, 1e-12);
  press(viewer, '4', 100);
  EXPECT_EQ(viewer.status().curves->mass, 0.25) << "the slider's limit";
  press(viewer, '5', 7);
  // The one that is picked gets a value of its own; the others keep theirs.
  viewer.pick(4);
  viewer.play_for(1);
  (void)picture(viewer);
  EXPECT_EQ(viewer.status().curves->mass, 2.0);
  press(viewer, '5', 4);
  viewer.play_for(1);
  viewer.pick(5);
  (void)picture(viewer);
  EXPECT_EQ(viewer.status().curves->mass, 2.0);
  viewer.pick(4);
  (void)picture(viewer);
  EXPECT_EQ(viewer.status().curves->mass, 3.0);
  viewer.pick(-1);
  (void)picture(viewer);
  EXPECT_EQ(viewer.status().curves->mass, 2.0);
}

TEST(Curves, ACrowdOfAnotherModelHasNoneOfIt) {
  CrowdStart start = curved_start(10);
  start.model = SteeringModel::kSampled;
  Viewer viewer = viewer_of(crowd_stage(start));
  viewer.play_for(1);
  press(viewer, '5', 3);
  (void)picture(viewer);
  EXPECT_FALSE(viewer.status().curves);
  EXPECT_TRUE(viewer.status().states.empty());
  EXPECT_FALSE(viewer.status().experiment);
}

TEST(Curves, FieldsAreDrawnAndChangeWithTheStates) {
  Viewer viewer = viewer_of(crowd_stage(curved_start(40)));
  viewer.play_for(1);
  const Image without = picture(viewer);
  press(viewer, 'G');
  const Image with = picture(viewer);
  EXPECT_GT(pixels_that_differ(without, with), 500U);
  viewer.play_for(2);
  EXPECT_GT(pixels_that_differ(with, picture(viewer)), 500U);
}

// Mean distance walked by avatars of a crowd after MaxSpeed of all was set.
double walked_with(double max_speed, bool one) {
  CrowdStart start = curved_start(12);
  Context context;
  auto player =
      view::CrowdPlayer::create(floor_of_20_metres().world, {}, start, 1, {}, nullptr, context);
  EXPECT_TRUE(player);
  const CurvilinearTuning tuning{.mass = 2, .max_speed = max_speed, .max_force = 0.06};
  std::optional<uint64_t> id;
  if (one) id = 3;
  (*player)->set_curves(id, tuning);
  EXPECT_EQ((*player)->spawn({10, 0, 10}, 3, 2, context), 2U);
  std::shared_ptr<const view::TimelineFrame> first, last;
  for (int step = 0; step < 60; ++step) {
    last = (*player)->next();
    if (!first) first = last;
  }
  EXPECT_EQ(last->curved->avatars.size(), 14U);
  for (size_t i = 0; i < last->size(); ++i) {
    const bool has = !one || last->ids[i] == 3;
    EXPECT_EQ(last->curved->avatars[i].tuning.max_speed, has ? max_speed : 0.4) << i;
  }
  double walked = 0;
  for (size_t i = 0; i < 12; ++i) {
    if (!one || last->ids[i] == 3) walked += last->walked[i] - first->walked[i];
  }
  return walked;
}

TEST(Curves, AnAvatarsSpeedChangesWithItsMaxSpeed) {
  for (const bool one : {false, true}) {
    EXPECT_GT(walked_with(0.4, one), 1.5 * walked_with(0.2, one)) << one;
    EXPECT_GT(walked_with(0.6, one), 1.15 * walked_with(0.4, one)) << one;
  }
}

view::CurvedWalker walker(double x, double speed_x) {
  return {.position = {x, 0, 0}, .velocity = {speed_x, 0, 0}, .radius = 0.25, .speed = 1.3};
}

// As [CAACD] II has it: r = A_r + B_r, and a bound belongs to the inner state.
TEST(Curves, StatesFollowFromTheDistanceAndTheNearestApproach) {
  const auto state = [](double apart, double speed) {
    const std::vector<view::CurvedWalker> two{walker(0, speed), walker(apart, -speed)};
    const auto frame = view::curved_frame(two);
    EXPECT_EQ(frame->avatars[0].state, frame->avatars[1].state);
    EXPECT_EQ(frame->count_states()[static_cast<size_t>(frame->avatars[0].state)], 2U);
    return frame->avatars[0].state;
  };
  EXPECT_EQ(state(1.21, 0), caacd::State::kTolerable);
  EXPECT_EQ(state(1.19, 0), caacd::State::kAlert);
  EXPECT_EQ(state(0.74, 0), caacd::State::kCritical);
  EXPECT_EQ(state(0.49, 0), caacd::State::kCollision);
  EXPECT_EQ(state(1.19, 1.3), caacd::State::kCritical) << "it will be";
  EXPECT_EQ(state(1.19, -1.3), caacd::State::kAlert) << "they move apart";
  std::vector<view::CurvedWalker> above{walker(0, 0), walker(0.3, 0)};
  above[1].position.y = 3;
  EXPECT_EQ(view::curved_frame(above)->avatars[0].state, caacd::State::kTolerable);
}

ExperimentStart experiment(int32_t avatars, const caacd::ParameterSet& set) {
  ExperimentStart start;
  start.space.avatars = avatars;
  start.model = caacd::with_set({}, set);
  return start;
}

TEST(Curves, TheExperimentIsThatOfThePlaneAndItsCountsAreShown) {
  const ExperimentStart start = experiment(60, caacd::named_sets()[0]);
  auto space = caacd::random_space(start.space, start.model);
  ASSERT_TRUE(space) << space.error().message;
  auto plain = caacd::Simulation::create(*std::move(space), start.model);
  ASSERT_TRUE(plain) << plain.error().message;
  for (int frame = 0; frame < 300; ++frame) plain->step();
  Viewer viewer = viewer_of(plane_stage(start));
  viewer.look_at({10, 20, 26}, {10, 0, 10});
  viewer.play_for(300 / ExperimentStart::kFramesPerSecond + 1e-9);
  const Image image = picture(viewer);
  const ViewerStatus status = viewer.status();
  ASSERT_TRUE(status.experiment);
  EXPECT_NEAR(static_cast<double>(status.experiment->frames), 300, 1);
  EXPECT_GT(plain->counts().collisions, 0);
  EXPECT_NEAR(static_cast<double>(status.experiment->collisions),
              static_cast<double>(plain->counts().collisions), 1);
  EXPECT_NEAR(status.experiment->walked, plain->counts().walked, 60);
  EXPECT_EQ(sum(status.states), 60U);
  EXPECT_EQ(status.avatars, 60U);
  EXPECT_GT(status.drawn, 30U);
  // Its fields are on at first.
  press(viewer, 'G');
  EXPECT_GT(pixels_that_differ(image, picture(viewer)), 2000U);
  // World tools do nothing on the plane.
  press(viewer, '3');
  press(viewer, 'T');
  press(viewer, 'C');
  (void)picture(viewer);
  EXPECT_EQ(viewer.status().error, "");
}

TEST(Curves, ValuesOfTheExperimentChangeWhileItRuns) {
  auto player = view::PlanePlayer::create(experiment(20, {2, 0.4, 0.06}), {});
  ASSERT_TRUE(player) << player.error().message;
  view::PlanePlayer& plane = **player;
  auto frame = plane.next();
  plane.set_curves(7, {.mass = 1, .max_speed = 0.8, .max_force = 0.1});
  plane.set_curves(99, {.mass = 1, .max_speed = 0.8, .max_force = 0.1});
  plane.set_curves(8, {.mass = 0, .max_speed = 0.8, .max_force = 0.1});
  for (int k = 0; k < 100; ++k) frame = plane.next();
  for (size_t i = 0; i < 20; ++i) {
    EXPECT_EQ(frame->curved->avatars[i].tuning.max_speed, i == 7 ? 0.8 : 0.4) << i;
  }
  plane.set_curves({}, {.mass = 1, .max_speed = 1.2, .max_force = 0.06});
  frame = plane.again();
  for (size_t i = 0; i < 20; ++i) EXPECT_EQ(frame->curved->avatars[i].tuning.max_speed, 1.2) << i;
}

TEST(Curves, ARunEndsWhenAllStandAndABadOneIsRefused) {
  auto player = view::PlanePlayer::create(experiment(5, {2, 1.2, 0.2}), {});
  ASSERT_TRUE(player) << player.error().message;
  int frames = 0;
  std::shared_ptr<const view::TimelineFrame> last;
  while (auto frame = (*player)->next()) {
    last = frame;
    ASSERT_LT(++frames, 5000);
  }
  EXPECT_EQ(last->curved->counts->arrived + last->curved->counts->waiting, 5);
  EXPECT_FALSE(view::PlanePlayer::create(experiment(0, {2, 1.2, 0.2}), {}));
}

}  // namespace
}  // namespace throng
