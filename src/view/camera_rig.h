// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "throng/base.h"
#include "throng/impostor.h"

/// The eye, and how it is moved. Y is up.
namespace throng::view {

enum class CameraMode : uint8_t {
  kOrbit,  ///< Around a point.
  kFly,    ///< Anywhere.
  kWalk,   ///< With an avatar.
};

/// An eye at `distance` from a target. `yaw` (from +Z towards +X) and `pitch` (up) are the
/// direction from the target to the eye.
struct CameraRig {
  Vec3d target;
  double yaw = 0.8;      ///< [rad]
  double pitch = 0.5;    ///< [rad, within 1.55]
  double distance = 20;  ///< [m, > 0]
  double field_of_view = 0.8;

  [[nodiscard]] Vec3d eye() const;
  [[nodiscard]] Vec3d towards_eye() const;  ///< Unit vector.
  [[nodiscard]] EyeCamera camera(double aspect) const;
  void look(Vec3d eye, Vec3d at);
  /// Moves the eye so that all of a box is in the picture.
  void show(const Box3d& box, double aspect);

  /// By pixels in a picture of that height: a drag over the whole height is half a turn.
  void orbit(double dx, double dy, double height);
  void turn_head(double dx, double dy, double height);  ///< The eye stays.
  /// The point under the pointer, at the target's distance, stays under it.
  void pan(double dx, double dy, double height);
  /// By notches, towards the point under the pointer: (x, y) of a picture of width x height.
  void zoom(double notches, double x, double y, double width, double height);
  /// By metres: right, up, and ahead over the ground.
  void go(double right, double up, double ahead);
};

/// The direction of the ray through a pixel: unit vector.
[[nodiscard]] Vec3d pixel_ray(const EyeCamera& camera, double x, double y, double width,
                              double height);

}  // namespace throng::view
