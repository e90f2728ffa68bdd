// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "throng/base.h"
#include "throng/result.h"
#include "throng/scene.h"

/// Built-in worlds: generated scenes. The same name, size and seed give the same triangles on every
/// machine.
namespace throng {

/// Which world to generate. Zero means the world's own default.
struct BuiltinWorldConfig {
  std::string name = "garage";  ///< cube stairs garage bridge church powerplant city maze landscape
  double size = 0;              ///< Side of the footprint. [m, >= 0]
  uint64_t triangles = 0;       ///< Grows the world to about this many (powerplant, city).
  int32_t levels = 0;           ///< Storeys, where the world has storeys. [>= 0]
  uint64_t seed = 1;
};

/// Description of a built-in world.
struct BuiltinWorldInfo {
  std::string_view name;
  std::string_view summary;  ///< One line, for `throng generate --list`.
  double default_size = 0;   ///< [m]
};

/// All built-in worlds.
[[nodiscard]] THRONG_API std::span<const BuiltinWorldInfo> builtin_worlds();

/// Fails with kNotFound (unknown name) or kBadConfig (size out of limits). Linear in the triangles.
[[nodiscard]] THRONG_API Result<Scene> make_builtin_world(const BuiltinWorldConfig& config);

}  // namespace throng
