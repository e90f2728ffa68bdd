// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "render/colour.h"

#include <algorithm>
#include <array>
#include <cmath>

// Colour ramps through Oklab: B. Ottosson, A perceptual color space for image processing, 2020.
namespace throng::render {
namespace {

uint8_t to_byte(double v) { return static_cast<uint8_t>(std::lround(std::clamp(v, 0.0, 255.0))); }

double to_srgb(double linear) {
  const double v = std::clamp(linear, 0.0, 1.0);
  return 255 * (v <= 0.0031308 ? 12.92 * v : 1.055 * std::pow(v, 1 / 2.4) - 0.055);
}

Rgb from_oklab(double lightness, double a, double b) {
  const auto cube = [](double v) { return v * v * v; };
  const double l = cube(lightness + 0.3963377774 * a + 0.2158037573 * b);
  const double m = cube(lightness - 0.1055613458 * a - 0.0638541728 * b);
  const double s = cube(lightness - 0.0894841775 * a - 1.2914855480 * b);
  return {to_byte(to_srgb(4.0767416621 * l - 3.3077115913 * m + 0.2309699292 * s)),
          to_byte(to_srgb(-1.2684380046 * l + 2.6097574011 * m - 0.3413193965 * s)),
          to_byte(to_srgb(-0.0041960863 * l - 0.7034186147 * m + 1.7076147010 * s))};
}

Rgb ramp_at(double t) {
  constexpr double kRadians = 3.14159265358979323846 / 180;
  const double lightness = 0.43 + 0.50 * t;
  const double hue = (300 - 195 * t) * kRadians;  // From violet through blue and green to yellow.
  const double chroma = 0.105 + 0.035 * t;
  return from_oklab(lightness, chroma * std::cos(hue), chroma * std::sin(hue));
}

}  // namespace

Rgb height_colour(double t) {
  constexpr size_t kSteps = 256;
  static const std::array<Rgb, kSteps> table = [] {
    std::array<Rgb, kSteps> made{};
    for (size_t i = 0; i < kSteps; ++i) made[i] = ramp_at(static_cast<double>(i) / (kSteps - 1));
    return made;
  }();
  return table[static_cast<size_t>(std::clamp(t, 0.0, 1.0) * (kSteps - 1) + 0.5)];
}

Rgb mix(Rgb a, Rgb b, double t) {
  const auto one = [t](uint8_t from, uint8_t to) { return to_byte(from + (to - from) * t); };
  return {one(a.r, b.r), one(a.g, b.g), one(a.b, b.b)};
}

Rgb shade(Rgb colour, double factor) {
  return {to_byte(colour.r * factor), to_byte(colour.g * factor), to_byte(colour.b * factor)};
}

}  // namespace throng::render
