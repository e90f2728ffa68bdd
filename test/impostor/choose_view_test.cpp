// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <set>
#include <tuple>

#include "core/math/trig.h"
#include "core/random.h"
#include "impostor/figure_raster.h"
#include "throng/impostor.h"

namespace throng {
namespace {

const AtlasShape kSeedShape{.pixels = 64, .directions = 16, .elevations = 8, .frames = 10};
const AtlasClip kWalk{.name = "Walk", .first_frame = 0, .frames = 10, .seconds = 1, .stride = 1.5};

// Where the viewer of a view stands, as the figure sees it; in a mirrored one, of its mirror image.
Vec3d viewer_of(const AtlasShape& shape, const ViewChoice& choice) {
  Vec3d towards =
      impostor::figure_camera(choice.column, shape.directions, choice.row, shape.elevations)
          .towards;
  if (choice.mirrored) towards.x = -towards.x;
  return towards;
}

Vec3d direction(double azimuth, double elevation) {
  const double a = azimuth * 2 * std::numbers::pi, e = elevation * 2 * std::numbers::pi;
  return {std::sin(a) * std::cos(e), std::sin(e), std::cos(a) * std::cos(e)};
}

TEST(ChooseView, EachOfAllDirectionsElevationsAndFramesIsChosenWhereItWasDrawn) {
  std::set<std::tuple<int, int, int, bool>> seen;
  for (int32_t sector = 0; sector < 32; ++sector) {
    for (int32_t row = 0; row < 8; ++row) {
      for (int32_t frame = 0; frame < 10; ++frame) {
        const double azimuth = (sector + 0.5) / 32, elevation = (row + 0.5) / 32;
        const ViewChoice choice =
            choose_view(kSeedShape, kWalk, direction(azimuth, elevation) * 7.0, 0, frame / 10.0);
        EXPECT_NEAR(dot(viewer_of(kSeedShape, choice), direction(azimuth, elevation)), 1, 1e-9);
        // The mirror image of a left step is a right step.
        EXPECT_EQ(choice.frame, choice.mirrored ? (frame + 5) % 10 : frame);
        seen.insert({choice.frame, choice.row, choice.column, choice.mirrored});
      }
    }
  }
  EXPECT_EQ(seen.size(), 32U * 8 * 10);
}

// The nearest of all views by angle about the axis first and by elevation then, found by trying
// all.
TEST(ChooseView, IsTheNearestOfAllViewsFromAnywhere) {
  for (const int32_t directions : {2, 3, 16, 64}) {
    for (const int32_t elevations : {1, 5, 8, 32}) {
      AtlasShape shape = kSeedShape;
      shape.directions = directions;
      shape.elevations = elevations;
      for (uint64_t i = 0; i < 400; ++i) {
        const double azimuth = random_unit(3, i, 0), elevation = random_unit(3, i, 1) * 0.5 - 0.25;
        const double heading = random_unit(3, i, 2) * 20 - 10;
        const double scale = std::pow(10.0, random_unit(3, i, 3) * 6 - 2);
        const ViewChoice choice =
            choose_view(shape, kWalk, direction(azimuth, elevation) * scale, heading, 0.3);
        const double seen_from = azimuth - heading;
        double best = 1;
        for (int32_t k = 0; k < 2 * directions; ++k) {
          const double off = (k + 0.5) / (2 * directions) - seen_from;
          best = std::min(best, std::fabs(off - std::floor(off + 0.5)));
        }
        const int32_t sector = choice.mirrored ? 2 * directions - 1 - choice.column : choice.column;
        const double off = (sector + 0.5) / (2 * directions) - seen_from;
        EXPECT_LE(std::fabs(off - std::floor(off + 0.5)), best + 5e-5);
        double nearest = 1;
        for (int32_t k = 0; k < elevations; ++k) {
          nearest = std::min(nearest, std::fabs((k + 0.5) / (4 * elevations) - elevation));
        }
        EXPECT_LE(std::fabs((choice.row + 0.5) / (4 * elevations) - elevation), nearest + 5e-5);
      }
    }
  }
}

TEST(ChooseView, OddPlacesOfTheEyeGiveAViewLikeAnyOther) {
  for (const Vec3d eye : {Vec3d{0, 0, 0}, Vec3d{0, 1, 0}, Vec3d{0, -1, 0}, Vec3d{-1e-30, 0, 1},
                          Vec3d{-0.0, 0, -1}, Vec3d{1e9, 1e9, -1e9}}) {
    for (const double heading : {0.0, 1.0, -1.0, 0.999999999, 1e6}) {
      for (const double phase : {0.0, 1.0, -0.25, 0.9999999999999999}) {
        const ViewChoice choice = choose_view(kSeedShape, kWalk, eye, heading, phase);
        EXPECT_TRUE(choice.column >= 0 && choice.column < 16 && choice.row >= 0 && choice.row < 8 &&
                    choice.frame >= 0 && choice.frame < 10);
      }
    }
  }
  EXPECT_EQ(choose_view(kSeedShape, kWalk, {0, 1, 0}, 0, 0).row, 7);
  EXPECT_EQ(choose_view(kSeedShape, kWalk, {0, -1, 0.1}, 0, 0).row, 0);
}

TEST(ChooseView, FramesOfALaterClipFollowThoseOfTheFirst) {
  AtlasShape shape = kSeedShape;
  shape.frames = 16;
  const AtlasClip second{.name = "Idle", .first_frame = 10, .frames = 6, .seconds = 2, .stride = 0};
  EXPECT_EQ(choose_view(shape, second, {0.1, 0, 1}, 0, 0.5).frame, 13);
  EXPECT_EQ(choose_view(shape, second, {-0.1, 0, 1}, 0, 0.5).frame, 10);
}

TEST(ChooseView, PhaseFollowsTheDistanceWalked) {
  EXPECT_DOUBLE_EQ(walk_phase(kWalk, 0.75, 0), 0.5);
  EXPECT_DOUBLE_EQ(walk_phase(kWalk, 0.75, 0.75), 0.25);
  EXPECT_DOUBLE_EQ(walk_phase(kWalk, -0.375, 0), 0.75);
  const AtlasClip stands{.name = "Idle", .first_frame = 0, .frames = 10, .seconds = 4, .stride = 0};
  EXPECT_DOUBLE_EQ(walk_phase(stands, 100, 0.25), 0.25);
  // One that stands breathes: by the time alone, forwards and backwards.
  const AtlasClip breathes{
      .name = "stand", .first_frame = 0, .frames = 8, .seconds = 4, .stride = 0};
  EXPECT_DOUBLE_EQ(walk_phase(breathes, 100, 0.25, 0), 0.25);
  EXPECT_DOUBLE_EQ(walk_phase(breathes, 100, 0.25, 5), 0.5);
  EXPECT_DOUBLE_EQ(walk_phase(breathes, 100, 0.25, -2), 0.75);
  EXPECT_DOUBLE_EQ(walk_phase(kWalk, 0.75, 0, 5), 0.5);  // not by its walk's time
}

TEST(Trig, AgreesWithTheCLibrary) {
  for (int32_t i = -4000; i <= 4000; ++i) {
    const double turns = i / 997.0;
    EXPECT_NEAR(sin_turns(turns), std::sin(turns * 2 * std::numbers::pi), 1e-12);
    EXPECT_NEAR(cos_turns(turns), std::cos(turns * 2 * std::numbers::pi), 1e-12);
    const auto x = static_cast<float>(std::sin(turns)), z = static_cast<float>(std::cos(turns));
    double expected = std::atan2(x, z) / (2 * std::numbers::pi);
    expected -= std::floor(expected);
    double off = turns_of(x, z) - expected;
    off -= std::floor(off + 0.5);
    EXPECT_NEAR(off, 0, 2.5e-6);
  }
}

}  // namespace
}  // namespace throng
