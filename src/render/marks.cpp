// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "render/marks.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "render/text.h"

namespace throng::render {
namespace {

// The number of decimals that a tick needs.
std::string number(double value, double tick) {
  const int decimals = tick >= 1 ? 0 : static_cast<int>(std::ceil(-std::log10(tick) - 1e-9));
  return fmt::format("{:.{}f}", std::fabs(value) < tick / 2 ? 0.0 : value, decimals);
}

}  // namespace

double round_below(double value) {
  if (!(value > 0)) return 0;
  const double power = std::pow(10.0, std::floor(std::log10(value) + 1e-9));
  for (const double step : {5.0, 2.0}) {
    if (step * power <= value * (1 + 1e-9)) return step * power;
  }
  return power;
}

std::string length_text(double metres) {
  if (metres >= 1000) return fmt::format("{:g} km", metres / 1000);
  if (metres >= 1 || metres == 0) return fmt::format("{:g} m", metres);
  if (metres >= 0.01) return fmt::format("{:g} cm", metres * 100);
  return fmt::format("{:g} mm", metres * 1000);
}

void draw_scale_bar(Canvas& canvas, Point at, double width, double pixels_per_metre, double text) {
  const double length = round_below(width / pixels_per_metre);
  const double end = at.x + length * pixels_per_metre;
  const double tick = std::max(2.0, text * 0.4), line = std::max(1.0, text / 7);
  canvas.line({at.x, at.y}, {end, at.y}, line, kInk);
  canvas.line({at.x, at.y - tick}, {at.x, at.y + tick}, line, kInk);
  canvas.line({end, at.y - tick}, {end, at.y + tick}, line, kInk);
  draw_text(canvas, {end + text * 0.8, at.y + text / 2}, length_text(length), {.size = text});
}

void draw_height_bar(Canvas& canvas, const Rect& bar, double low, double high, double text,
                     const std::function<Rgb(double)>& colour) {
  const auto rows = static_cast<int32_t>(bar.height);
  for (int32_t row = 0; row < rows; ++row) {
    canvas.fill({bar.x, bar.y + row, bar.width, 1}, colour(1 - (row + 0.5) / rows));
  }
  canvas.frame(bar, 1, kFaintInk);
  const double range = high - low;
  const TextStyle style{.size = text};
  const double label_x = bar.x + bar.width + text * 0.7;
  if (!(range > 0.0005)) {
    draw_text(canvas, {label_x, bar.y + bar.height / 2 + text / 2}, fmt::format("{:.2f} m", low),
              style);
    return;
  }
  const double max_ticks = std::clamp(bar.height / (text * 2.6), 2.0, 6.0);
  double tick = round_below(range / max_ticks);
  while (range / tick > max_ticks + 1) tick *= 2;
  for (double value = std::ceil(low / tick - 1e-6) * tick; value <= high + tick * 1e-6;
       value += tick) {
    const double y = bar.y + bar.height * (1 - std::clamp((value - low) / range, 0.0, 1.0));
    canvas.line({bar.x + bar.width, y}, {bar.x + bar.width + text * 0.35, y}, 1, kFaintInk);
    draw_text(canvas, {label_x, y + text / 2}, number(value, tick) + " m", style);
  }
}

}  // namespace throng::render
