// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>

#include "render/canvas.h"

/// Text in a built-in stroke font, sharp at any size. ASCII; other bytes draw as a box.
namespace throng::render {

enum class Align { kLeft, kCentre, kRight };

struct TextStyle {
  double size = 9;  ///< Height of a capital letter. [px]
  Rgb colour = kInk;
  Align align = Align::kLeft;
  bool bold = false;
};

/// Width of a line of text. [px]
[[nodiscard]] double text_width(std::string_view text, const TextStyle& style);

/// Draws one line of text whose baseline begins (or centres, or ends) at `at`.
void draw_text(Canvas& canvas, Point at, std::string_view text, const TextStyle& style);

/// The longest beginning of `text` that fits, followed by ".." if it was cut.
[[nodiscard]] std::string fit_text(std::string_view text, double width, const TextStyle& style);

}  // namespace throng::render
