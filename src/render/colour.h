// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

/// Colours of all pictures, chosen to be distinct for colour-blind readers and in grey print.
namespace throng::render {

struct Rgb {
  uint8_t r = 0, g = 0, b = 0;
  friend bool operator==(Rgb, Rgb) = default;
};

inline constexpr Rgb kPaper{255, 255, 255};
inline constexpr Rgb kInk{31, 36, 46};
inline constexpr Rgb kFaintInk{118, 124, 134};
inline constexpr Rgb kRule{206, 210, 216};
inline constexpr Rgb kContext{239, 240, 242};  ///< Under or over other storeys.
inline constexpr Rgb kSolid{38, 42, 50};
inline constexpr Rgb kNoStanding{214, 216, 220};
inline constexpr Rgb kHatch{160, 164, 171};
inline constexpr Rgb kShaft{226, 233, 243};
inline constexpr Rgb kAvatar{232, 74, 28};
inline constexpr Rgb kPath{20, 60, 220};

/// The height ramp at t in [0, 1]: dark violet, blue, green, light yellow. Lightness rises evenly
/// (it is a path through Oklab), so equal steps in height look equal.
Rgb height_colour(double t);

/// a at t = 0, b at t = 1.
Rgb mix(Rgb a, Rgb b, double t);

/// Darker (< 1) or lighter (> 1).
Rgb shade(Rgb colour, double factor);

}  // namespace throng::render
