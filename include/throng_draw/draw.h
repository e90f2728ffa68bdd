// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "throng/impostor.h"
#include "throng/impostor_pack.h"
#include "throng/picture.h"
#include "throng/result.h"
#include "throng/scene.h"

/// Pictures of a world and its crowd by a graphics library, without a window. A library of its own,
/// throng_draw: the run-time library needs no graphics. OpenGL ES 3.0, so that a browser can run
/// the same.
namespace throng {

/// Avatars that share an atlas and a clip. Positions are relative to the drawing's origin.
struct DrawnCrowd {
  size_t atlas = 0;  ///< As Drawing::add_atlas numbers them.
  size_t clip = 0;
  ImpostorArrays avatars;
};

struct DrawingConfig {
  EyeCamera camera;  ///< Relative to the drawing's origin; `aspect` follows from the picture.
  int32_t width = 1280, height = 720;  ///< [px, 16 to 8192]
  int32_t samples = 2;                 ///< Along each side of a pixel. [1 to 4]
  Vec3d to_sun{-0.5, 0.75, 0.45};      ///< Towards the sun, any length. [y > 0]
  bool avatar_shadows = true;          ///< Those of the scene are always there.
  int32_t workers = 0;                 ///< For packing, 0 for all cores. [>= 0]
};

/// What a picture took.
struct DrawingReport {
  size_t avatars = 0;       ///< In all crowds.
  size_t drawn = 0;         ///< Not culled.
  double seconds_pack = 0;  ///< Culling and packing, shadows included.
  double seconds_draw = 0;  ///< Upload, draw calls and reading back.
};

/// A drawing without a window. Movable, not copyable; one thread at a time.
class THRONG_API Drawing {
 public:
  /// Fails with kNotFound where there is no EGL, or no driver that draws without a window.
  [[nodiscard]] static Result<Drawing> create();
  Drawing(Drawing&&) noexcept;
  Drawing& operator=(Drawing&&) noexcept;
  ~Drawing();

  /// What draws: "llvmpipe (LLVM 15.0.6, 256 bits)".
  [[nodiscard]] std::string renderer() const;
  /// The triangles to draw, and the point that everything is relative to. Replaces what was there.
  /// Fails with kLimit: more triangles than the card's memory holds.
  [[nodiscard]] Result<void> set_scene(const Scene& scene, Vec3d origin);
  /// Keeps a copy of an atlas. Fails with kLimit: pages larger than the card's textures.
  [[nodiscard]] Result<size_t> add_atlas(const Atlas& atlas);
  /// Fails with kBadConfig if draw() would.
  [[nodiscard]] static Result<void> check(const DrawingConfig& config);
  /// Fails with kBadConfig, or kLimit: a picture larger than the card draws.
  [[nodiscard]] Result<Image> draw(std::span<const DrawnCrowd> crowds, const DrawingConfig& config,
                                   DrawingReport* report = nullptr);

 private:
  struct State;
  explicit Drawing(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace throng
