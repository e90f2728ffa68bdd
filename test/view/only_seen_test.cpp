// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <set>
#include <utility>
#include <vector>

#include "baked.h"
#include "core/random.h"
#include "rays.h"
#include "throng_view/viewer.h"
#include "view/crowd_player.h"
#include "view/view_settings.h"

// CrowdStart::only_seen, by the frames of the timeline and by the viewer's pictures.
namespace throng {
namespace {

// Blocks of houses, 20 m by 20 m and 12 m high, between streets of 10 m.
struct Town {
  Scene scene;
  World world;
  Town() {
    scene.add_box({0, -1, 0}, {160, 0, 160});
    for (int32_t z = 0; z < 5; ++z) {
      for (int32_t x = 0; x < 5; ++x) {
        const Vec3d low{10.0 + 30 * x, 0, 10.0 + 30 * z};
        scene.add_box(low, low + Vec3d{20, 12, 20});
      }
    }
    world = test::bake(scene, 0.25, {default_classes()[0]});
  }
};

const Town& town() {
  static const Town one;
  return one;
}

bool is_free(Vec3d eye, Vec3d point) {
  const Scene& scene = town().scene;
  const Vec3d ray = point - eye;
  return std::none_of(scene.triangles.begin(), scene.triangles.end(),
                      [&](const std::array<uint32_t, 3>& t) {
                        const auto at = meet(scene, t, eye, ray);
                        return at && at->u >= 0 && at->v >= 0 && at->u + at->v <= 1 &&
                               at->along > 0 && at->along < 1;
                      });
}

// Is any of 40 random points of a body in sight?
bool is_body_in_sight(Vec3d eye, Vec3d feet, uint64_t salt) {
  for (uint64_t k = 0; k < 40; ++k) {
    const double turn = 6.283185307 * random_unit(91, salt, 3 * k);
    const double out = 0.3 * random_unit(91, salt, 3 * k + 1);
    const Vec3d point =
        feet + Vec3d{out * std::cos(turn), 0.05 + 1.7 * random_unit(91, salt, 3 * k + 2),
                     out * std::sin(turn)};
    if (is_free(eye, point)) return true;
  }
  return false;
}

CrowdStart start_with(uint32_t avatars) {
  CrowdStart start;
  start.avatars = avatars;
  start.only_seen = true;
  start.sight = 90;
  start.dt = 0.2;
  return start;
}

// Frame by frame, with an eye at at(step).
template <class At>
void watch(At at, int32_t steps) {
  Context context;
  const Vec3d origin{80, 0, 80};
  constexpr uint32_t kAll = 600;
  auto made = view::CrowdPlayer::create(town().world, {}, start_with(kAll), 1, origin,
                                        view::occluders_of(town().scene, origin), context);
  ASSERT_TRUE(made) << made.error().message;
  view::CrowdPlayer& player = **made;
  EXPECT_EQ(player.next(), nullptr);  // It waits for look_from().
  using Id = std::pair<uint64_t, uint32_t>;
  std::shared_ptr<const view::TimelineFrame> last;
  uint64_t came = 0, went = 0, in_sight = 0, seen = 0, counted = 0;
  size_t min_seen = kAll, max_seen = 0, largest = 0;
  for (int32_t step = 0; step <= steps; ++step) {
    const Vec3d eye = at(step);
    player.look_from({.eye = eye});
    const auto now = player.next();
    ASSERT_NE(now, nullptr);
    ASSERT_EQ(now->fault, "");
    ASSERT_EQ(now->generations.size(), now->size());
    const auto ids_of = [](const view::TimelineFrame& m) {
      std::set<Id> out;
      for (size_t i = 0; i < m.size(); ++i) out.insert({m.ids[i], m.generations[i]});
      return out;
    };
    const auto count_seen = [&](const view::TimelineFrame& m, const std::set<Id>& others,
                                uint64_t& all) {
      for (size_t i = 0; i < m.size(); ++i) {
        if (others.count({m.ids[i], m.generations[i]}) > 0) continue;
        const Vec3d feet = origin + Vec3d{m.x[i], m.y[i], m.z[i]};
        in_sight += is_body_in_sight(eye, feet, all++) ? 1 : 0;
      }
    };
    if (last) {
      const std::set<Id> before = ids_of(*last), after = ids_of(*now);
      count_seen(*now, before, came);
      count_seen(*last, after, went);
    }
    if (step >= 50 && step % 10 == 0) {
      size_t here = 0;
      for (size_t i = 0; i < now->size(); ++i) {
        const Vec3d feet = origin + Vec3d{now->x[i], now->y[i], now->z[i]};
        here += is_free(eye, feet + Vec3d{0, 1, 0}) ? 1 : 0;
      }
      min_seen = std::min(min_seen, here);
      max_seen = std::max(max_seen, here);
      seen += here;
      ++counted;
    }
    largest = std::max(largest, now->size());
    last = now;
  }
  std::printf(
      "%.1f in sight in the mean, %zu to %zu; %llu came, %llu went, %llu in sight; at most "
      "%zu of %u simulated\n",
      static_cast<double>(seen) / static_cast<double>(counted), min_seen, max_seen,
      static_cast<unsigned long long>(came), static_cast<unsigned long long>(went),
      static_cast<unsigned long long>(in_sight), largest, kAll);
  EXPECT_GT(came, 30U);
  EXPECT_GT(went, 30U);
  EXPECT_EQ(in_sight, 0U);
  EXPECT_GT(min_seen * counted * 2, seen);  // The density stays about the same.
  EXPECT_LT(max_seen * counted, 2 * seen);
  EXPECT_LT(largest, kAll * 19 / 20);  // The town is hardly larger than the sight.
}

TEST(OnlySeen, AStreetStaysPopulatedAndNoAvatarComesOrGoesInSight) {
  watch([](int32_t) { return Vec3d{35, 1.7, 65}; }, 600);
}

TEST(OnlySeen, AStreetStaysPopulatedForAnEyeThatMoves) {
  watch(
      [](int32_t step) {
        const double along = std::fmod(step * 0.28, 60.0);
        return Vec3d{35, 1.7, 65 + (along < 30 ? along : 60 - along)};
      },
      600);
}

TEST(OnlySeen, TheWholeMixIsKept) {
  const World world = test::bake(town().scene, 0.25, {default_classes()[0], default_classes()[1]});
  CrowdStart start = start_with(600);
  start.mix = {2, 1};
  Context context;
  auto made = view::CrowdPlayer::create(world, {}, start, 1, {},
                                        view::occluders_of(town().scene, {}), context);
  ASSERT_TRUE(made) << made.error().message;
  double children = 0, all = 0;
  for (int step = 0; step < 100; ++step) {
    (*made)->look_from({.eye = {35, 1.7, 65}});
    const auto now = (*made)->next();
    ASSERT_NE(now, nullptr);
    ASSERT_EQ(now->fault, "");
    for (const uint8_t of : now->classes) children += of == 1 ? 1 : 0;
    all += static_cast<double>(now->size());
  }
  EXPECT_GT(all, 5000);
  EXPECT_NEAR(children / all, 1.0 / 3, 0.08);
}

// Streets are black west of x = 50, grey to x = 110 and white beyond. Seen from a crossing, with
// and without the region around the eye.
TEST(OnlySeen, AvatarsAreWhereTheMapIsBright) {
  CrowdStart start = start_with(600);
  start.sight = 200;
  start.map.width = 16, start.map.height = 1;
  for (int32_t column = 0; column < 16; ++column) {
    start.map.weights.push_back(column < 5 ? 0 : column < 11 ? 60 : 240);
  }
  for (const double region : {0.0, 2.0}) {
    start.region = region;
    Context context;
    auto made = view::CrowdPlayer::create(town().world, {}, start, 1, {},
                                          view::occluders_of(town().scene, {}), context);
    ASSERT_TRUE(made) << made.error().message;
    double grey = 0, white = 0;
    for (int step = 0; step < 100; ++step) {
      (*made)->look_from({.eye = {95 + 0.02 * step, 1.7, 65}});
      const auto now = (*made)->next();
      ASSERT_NE(now, nullptr);
      ASSERT_EQ(now->fault, "");
      for (const float x : now->x) {
        ASSERT_GE(x, 50);
        ASSERT_LE(x, 160);
        grey += x < 110 ? 1 : 0;
        white += x >= 110 ? 1 : 0;
      }
    }
    EXPECT_GT(grey, 500);
    EXPECT_GT(white, 2 * grey);  // A quarter of the weight.
  }
}

// A picture of its own corners: beyond it there are none.
TEST(OnlySeen, TheMapHasCorners) {
  CrowdStart start = start_with(600);
  start.map = {.x0 = 60, .z0 = 60, .x1 = 100, .z1 = 100, .width = 1, .height = 1, .weights = {9}};
  Context context;
  auto made = view::CrowdPlayer::create(town().world, {}, start, 1, {},
                                        view::occluders_of(town().scene, {}), context);
  ASSERT_TRUE(made) << made.error().message;
  size_t all = 0;
  for (int step = 0; step < 30; ++step) {
    (*made)->look_from({.eye = {65, 1.7, 65}});
    const auto now = (*made)->next();
    ASSERT_NE(now, nullptr);
    ASSERT_EQ(now->fault, "");
    for (size_t i = 0; i < now->size(); ++i) {
      ASSERT_TRUE(now->x[i] >= 60 && now->x[i] <= 100 && now->z[i] >= 60 && now->z[i] <= 100);
    }
    all += now->size();
  }
  EXPECT_GT(all, 300U);
}

LoadStage stage_of(const CrowdStart& start) {
  return [start](StageParts& parts, Context&) -> Result<void> {
    if (auto ok = parts.set_scene(town().scene); !ok) return ok;
    parts.set_world(town().world);
    AtlasConfig config;
    config.frames = 4;
    config.pixels = 16;
    Context context;
    auto atlas = create_atlas(built_in_character(), config, context);
    if (!atlas) return atlas.error();
    parts.set_atlases({{*atlas}});
    parts.set_crowd(start);
    return {};
  };
}

Viewer made_viewer(const std::string& settings) {
  Result<Drawing> drawing = Drawing::create();
  EXPECT_TRUE(drawing) << drawing.error().message;
  Result<Viewer> viewer =
      Viewer::create(*std::move(drawing), {.settings = settings, .font = {}, .panel = false});
  EXPECT_TRUE(viewer) << viewer.error().message;
  return *std::move(viewer);
}

TEST(OnlySeenViewer, SendsTheEyeToTheCrowd) {
  const auto film = [](double from, double turn) {
    Viewer viewer = made_viewer("");
    viewer.look_at({35, 1.7, from}, {35, 1.7, 95});
    viewer.load("town", stage_of(start_with(600)));
    viewer.wait_until_loaded();
    std::vector<uint8_t> all;
    for (int32_t frame = 0; frame < 8; ++frame) {
      viewer.look_at({35, 1.7, from + turn * frame}, {35, 1.7, 95});
      viewer.play_for(0.25);
      auto image = viewer.picture(0, 240, 160);
      EXPECT_TRUE(image);
      all.insert(all.end(), image->rgb.begin(), image->rgb.end());
    }
    EXPECT_EQ(viewer.status().error, "");
    EXPECT_GT(viewer.status().avatars, 60U);
    EXPECT_LT(viewer.status().avatars, 500U);
    EXPECT_GT(viewer.status().drawn, 5U);
    return all;
  };
  const auto once = film(65, 0.3);
  EXPECT_EQ(film(65, 0.3), once);  // Whatever the speed of the crowd's thread.
  EXPECT_NE(film(65, 0), once);
}

TEST(OnlySeenViewer, KeepsItAsASetting) {
  view::ViewSettings settings;
  settings.only_seen = settings.coarse_far = true;
  Viewer viewer = made_viewer(view::settings_text(settings));
  CrowdStart start = start_with(600);
  start.only_seen = false;
  viewer.look_at({35, 1.7, 65}, {35, 1.7, 95});
  viewer.load("town", stage_of(start));
  viewer.wait_until_loaded();
  viewer.play_for(0.5);
  ASSERT_TRUE(viewer.picture(0, 160, 120));
  EXPECT_LT(viewer.status().avatars, 500U);
  const auto kept = view::read_settings(viewer.settings());
  ASSERT_TRUE(kept);
  EXPECT_TRUE(kept->only_seen);
  EXPECT_TRUE(kept->coarse_far);
}

TEST(OnlySeen, FarAvatarsAreInLowDetailIfSet) {
  Context context;
  for (const bool coarse : {false, true}) {
    CrowdStart start;
    start.avatars = 100;
    start.coarse_far = coarse;
    auto made = view::CrowdPlayer::create(town().world, {}, start, 1, {}, nullptr, context);
    ASSERT_TRUE(made);
    (*made)->look_from({.eye = {80, 900, 80}});
    (void)(*made)->next();
    const auto far = (*made)->next();
    EXPECT_EQ(far->report.low_detail > 0, coarse);
    (*made)->look_from({.eye = {80, 20, 80}});
    EXPECT_EQ((*made)->next()->report.low_detail, 0U);
  }
}

}  // namespace
}  // namespace throng
