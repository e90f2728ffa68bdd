// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "view/camera_rig.h"

#include <gtest/gtest.h>

#include <cmath>

// Points of the world in the picture before and after each move of the eye.
namespace throng {
namespace {

constexpr double kWidth = 1280, kHeight = 720;

view::CameraRig some_rig() {
  view::CameraRig rig;
  rig.look({10, 8, 20}, {1, 2, 3});
  return rig;
}

// The pixel of a point. [px]
std::pair<double, double> pixel_of(const view::CameraRig& rig, Vec3d p) {
  const EyeCamera camera = rig.camera(kWidth / kHeight);
  const CameraAxes axes = camera_axes(camera);
  const double deep = dot(p - camera.eye, axes.forward);
  const double scale = 0.5 * kHeight / std::tan(0.5 * camera.field_of_view);
  return {0.5 * kWidth + dot(p - camera.eye, axes.right) / deep * scale,
          0.5 * kHeight - dot(p - camera.eye, axes.up) / deep * scale};
}

TEST(CameraRig, LooksAtTheGivenTarget) {
  const view::CameraRig rig = some_rig();
  EXPECT_NEAR(length(rig.eye() - Vec3d{10, 8, 20}), 0, 1e-9);
  const auto [x, y] = pixel_of(rig, {1, 2, 3});
  EXPECT_NEAR(x, 640, 1e-6);
  EXPECT_NEAR(y, 360, 1e-6);
}

TEST(CameraRig, ARayThroughAPixelMeetsWhatIsSeenThere) {
  const view::CameraRig rig = some_rig();
  const EyeCamera camera = rig.camera(kWidth / kHeight);
  for (const Vec3d p : {Vec3d{0, 0, 0}, {3, 1, 2}, {-4, 5, 6}}) {
    const auto [x, y] = pixel_of(rig, p);
    const Vec3d ray = view::pixel_ray(camera, x, y, kWidth, kHeight);
    EXPECT_NEAR(length(cross(ray, p - camera.eye)), 0, 1e-6);
    EXPECT_GT(dot(ray, p - camera.eye), 0);
  }
}

TEST(CameraRig, ZoomKeepsWhatIsUnderThePointer) {
  view::CameraRig rig = some_rig();
  const EyeCamera before = rig.camera(kWidth / kHeight);
  const Vec3d ray = view::pixel_ray(before, 300, 500, kWidth, kHeight);
  const double deep = rig.distance / dot(ray, camera_axes(before).forward);
  const Vec3d held = before.eye + ray * deep;
  const double distance = rig.distance;
  rig.zoom(3, 300, 500, kWidth, kHeight);
  EXPECT_LT(rig.distance, 0.7 * distance);
  const auto [x, y] = pixel_of(rig, held);
  EXPECT_NEAR(x, 300, 1e-6);
  EXPECT_NEAR(y, 500, 1e-6);
  rig.zoom(-3, 300, 500, kWidth, kHeight);
  EXPECT_NEAR(rig.distance, distance, 1e-9);
}

TEST(CameraRig, PanMovesTheTargetWithThePointer) {
  view::CameraRig rig = some_rig();
  const Vec3d held = rig.target;
  rig.pan(40, -25, kHeight);
  const auto [x, y] = pixel_of(rig, held);
  EXPECT_NEAR(x, 680, 1e-6);
  EXPECT_NEAR(y, 335, 1e-6);
}

TEST(CameraRig, OrbitKeepsTheTargetAndTurningTheHeadTheEye) {
  view::CameraRig rig = some_rig();
  const Vec3d target = rig.target;
  const double distance = rig.distance;
  rig.orbit(100, 30, kHeight);
  EXPECT_EQ(rig.target, target);
  EXPECT_NEAR(length(rig.eye() - target), distance, 1e-9);
  const Vec3d eye = rig.eye();
  rig.turn_head(-60, 20, kHeight);
  EXPECT_NEAR(length(rig.eye() - eye), 0, 1e-9);
  rig.orbit(0, 1e6, kHeight);  // Stops at the top.
  EXPECT_LT(rig.pitch, 1.56);
}

TEST(CameraRig, GoesOverTheGroundWhereItLooks) {
  view::CameraRig rig;
  rig.look({0, 5, 10}, {0, 0, 0});
  rig.go(0, 0, 2);
  EXPECT_NEAR(rig.target.z, -2, 1e-9);
  EXPECT_NEAR(rig.target.x, 0, 1e-9);
  rig.go(3, 0, 0);
  EXPECT_NEAR(rig.target.x, 3, 1e-9);  // Right of the direction -Z.
}

TEST(CameraRig, ShowsAllOfABoxFromAnySide) {
  Box3d box;
  box.add({-10, 0, 5});
  box.add({60, 12, 45});
  for (const double aspect : {16.0 / 9, 0.5}) {
    view::CameraRig rig;
    for (double yaw = 0; yaw < 6.3; yaw += 0.7) {
      rig.yaw = yaw;
      rig.show(box, aspect);
      const EyeCamera camera = rig.camera(aspect);
      const CameraAxes axes = camera_axes(camera);
      const double up = std::tan(0.5 * camera.field_of_view);
      for (int32_t k = 0; k < 8; ++k) {
        const Vec3d p =
            Vec3d{(k & 1) != 0 ? 60.0 : -10, (k & 2) != 0 ? 12.0 : 0, (k & 4) != 0 ? 45.0 : 5} -
            camera.eye;
        const double deep = dot(p, axes.forward);
        EXPECT_LE(std::abs(dot(p, axes.up)), up * deep);
        EXPECT_LE(std::abs(dot(p, axes.right)), up * aspect * deep);
      }
    }
  }
}

}  // namespace
}  // namespace throng
