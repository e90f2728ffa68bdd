// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <string>

#include "render/canvas.h"

/// What makes a picture readable: scale bars, height bars, round numbers with units.
namespace throng::render {

/// The largest 1, 2 or 5 times a power of ten that is at most `value`.
[[nodiscard]] double round_below(double value);

/// "250 m", "2.5 km", "20 cm".
[[nodiscard]] std::string length_text(double metres);

/// A bar of a round length, at most `width` pixels long, with its length written over it. `at` is
/// its left end.
void draw_scale_bar(Canvas& canvas, Point at, double width, double pixels_per_metre, double text);

/// Colours from `low` (at the foot) to `high`, with round heights in metres to the right.
void draw_height_bar(Canvas& canvas, const Rect& bar, double low, double high, double text,
                     const std::function<Rgb(double)>& colour);

}  // namespace throng::render
