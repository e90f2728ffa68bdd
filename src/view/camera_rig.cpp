// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "view/camera_rig.h"

#include <algorithm>
#include <cmath>
#include <numbers>

// Eye and target by yaw, pitch and distance; each move keeps one of them or a point in the picture.
namespace throng::view {
namespace {

constexpr double kMaxPitch = 1.55;     // [rad] Below pi / 2: straight down has no up.
constexpr double kNotchFactor = 0.85;  // Factor of the distance for a notch of the wheel.
constexpr double kMinDistance = 0.3;   // [m]
constexpr double kMaxDistance = 50000;

}  // namespace

Vec3d CameraRig::towards_eye() const {
  return {std::sin(yaw) * std::cos(pitch), std::sin(pitch), std::cos(yaw) * std::cos(pitch)};
}

Vec3d CameraRig::eye() const { return target + towards_eye() * distance; }

EyeCamera CameraRig::camera(double aspect) const {
  EyeCamera camera;
  camera.eye = eye();
  camera.target = target;
  camera.field_of_view = field_of_view;
  camera.aspect = aspect;
  // 24 bits of depth resolve, at 1000 times the near plane, steps of a thousandth of that depth.
  camera.nearest = std::clamp(distance * 0.004, 0.05, 2.0);
  camera.furthest = std::max(8000.0, distance * 12);
  return camera;
}

void CameraRig::look(Vec3d eye, Vec3d at) {
  const Vec3d away = eye - at;
  distance = std::max(length(away), kMinDistance);
  target = at;
  yaw = std::atan2(away.x, away.z);
  pitch = std::clamp(std::asin(std::clamp(away.y / distance, -1.0, 1.0)), -kMaxPitch, kMaxPitch);
}

void CameraRig::show(const Box3d& box, double aspect) {
  if (box.empty()) return;
  target = (box.min + box.max) * 0.5;
  const CameraAxes axes = camera_axes(camera(aspect));
  const double up = std::tan(0.5 * field_of_view), right = up * aspect;
  distance = 2;
  for (int32_t corner = 0; corner < 8; ++corner) {
    const Vec3d p =
        Vec3d{(corner & 1) != 0 ? box.max.x : box.min.x, (corner & 2) != 0 ? box.max.y : box.min.y,
              (corner & 4) != 0 ? box.max.z : box.min.z} -
        target;
    const double needed =
        std::max(std::abs(dot(p, axes.up)) / up, std::abs(dot(p, axes.right)) / right);
    distance = std::max(distance, 1.06 * needed - dot(p, axes.forward));
  }
}

void CameraRig::orbit(double dx, double dy, double height) {
  const double turn = std::numbers::pi / std::max(1.0, height);
  yaw = std::remainder(yaw - dx * turn, 2 * std::numbers::pi);
  pitch = std::clamp(pitch + dy * turn, -kMaxPitch, kMaxPitch);
}

void CameraRig::turn_head(double dx, double dy, double height) {
  const Vec3d stays = eye();
  orbit(dx * 0.6, dy * 0.6, height);
  target = stays - towards_eye() * distance;
}

void CameraRig::pan(double dx, double dy, double height) {
  const double a_pixel = 2 * distance * std::tan(0.5 * field_of_view) / std::max(1.0, height);
  const CameraAxes axes = camera_axes(camera(1));
  target = target - axes.right * (dx * a_pixel) + axes.up * (dy * a_pixel);
}

void CameraRig::zoom(double notches, double x, double y, double width, double height) {
  const double after =
      std::clamp(distance * std::pow(kNotchFactor, notches), kMinDistance, kMaxDistance);
  const EyeCamera now = camera(width / std::max(1.0, height));
  const Vec3d ray = pixel_ray(now, x, y, width, height);
  // The point on the ray at the target's depth keeps its place in the picture.
  const double ahead = dot(ray, camera_axes(now).forward);
  const Vec3d held = now.eye + ray * (distance / std::max(0.1, ahead));
  const double share = after / distance;
  target = held + (target - held) * share;
  distance = after;
}

void CameraRig::go(double right, double up, double ahead) {
  const Vec3d flat{-std::sin(yaw), 0, -std::cos(yaw)};
  target = target + flat * ahead + Vec3d{-flat.z, 0, flat.x} * right + Vec3d{0, up, 0};
}

Vec3d pixel_ray(const EyeCamera& camera, double x, double y, double width, double height) {
  const CameraAxes axes = camera_axes(camera);
  const double up = std::tan(0.5 * camera.field_of_view);
  const double u = (2 * x / width - 1) * up * width / height, v = (1 - 2 * y / height) * up;
  const Vec3d ray = axes.forward + axes.right * u + axes.up * v;
  return ray * (1 / length(ray));
}

}  // namespace throng::view
