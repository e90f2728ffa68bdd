// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "render/canvas.h"
#include "render/colour.h"
#include "render/marks.h"
#include "render/text.h"
#include "throng/picture.h"

// All lengths are for a picture 1200 pixels wide and grow with it.
namespace throng {
namespace {

// Light for low values, dark for high ones: zero is white paper.
render::Rgb heat_colour(double t) {
  return render::height_colour(0.98 - 0.93 * std::clamp(t, 0.0, 1.0));
}

Result<void> check_map(const HeatMap& map) {
  constexpr int32_t kMax = 1'000'000;
  const auto bad = [](const char* what) {
    return Error{Errc::kBadConfig, std::string("heat map: ") + what};
  };
  if (map.picture_width < 400 || map.picture_width > 8000) {
    return bad("the picture must be from 400 to 8000 px wide");
  }
  if (map.width < 1 || map.depth < 1 || map.width > kMax || map.depth > kMax ||
      map.values.size() != static_cast<size_t>(map.width) * static_cast<size_t>(map.depth)) {
    return bad("needs width * depth values");
  }
  if (!(map.cell > 0 && map.cell < 1e9) || !(std::fabs(map.x0) < 1e9 && std::fabs(map.z0) < 1e9)) {
    return bad("needs cells of more than 0 m at a finite place");
  }
  const auto sound = [](double v) { return v >= 0 && v < 1e15; };
  if (!std::ranges::all_of(map.values, sound) || !sound(map.max)) {
    return bad("has a value below 0 or one that is not finite");
  }
  return {};
}

// Mean over the cells that a pixel covers, or the cell under its middle if they are larger.
double value_at(const HeatMap& map, double pixel, int32_t px, int32_t py) {
  const auto range = [&](int32_t p, int32_t cells) {
    const auto last = static_cast<double>(cells - 1);
    const double first = pixel <= 1 ? (p + 0.5) * pixel : p * pixel;
    const double end = pixel <= 1 ? first : (p + 1) * pixel - 1;
    return std::pair{static_cast<int64_t>(std::min(first, last)),
                     static_cast<int64_t>(std::clamp(end, std::min(first, last), last))};
  };
  const auto [i0, i1] = range(px, map.width);
  const auto [k0, k1] = range(py, map.depth);
  double sum = 0;
  for (int64_t k = k0; k <= k1; ++k) {
    for (int64_t i = i0; i <= i1; ++i) sum += map.values[static_cast<size_t>(k * map.width + i)];
  }
  return sum / static_cast<double>((i1 - i0 + 1) * (k1 - k0 + 1));
}

void draw_bar(render::Canvas& canvas, const render::Rect& bar, double top, const std::string& unit,
              double text) {
  const auto rows = static_cast<int32_t>(bar.height);
  for (int32_t row = 0; row < rows; ++row) {
    canvas.fill({bar.x, bar.y + row, bar.width, 1}, heat_colour(1 - (row + 0.5) / rows));
  }
  canvas.frame(bar, 1, render::kFaintInk);
  double tick = render::round_below(top / 5);
  while (top / tick > 6.001) tick = render::round_below(tick * 2.5);
  for (int32_t i = 0; i * tick <= top * (1 + 1e-9); ++i) {
    const double y = bar.y + bar.height * (1 - i * tick / top);
    canvas.line({bar.x + bar.width, y}, {bar.x + bar.width + text * 0.35, y}, 1, render::kFaintInk);
    render::draw_text(canvas, {bar.x + bar.width + text * 0.7, y + text / 2},
                      fmt::format("{:g}", i * tick), {.size = text});
  }
  render::draw_text(canvas, {bar.x, bar.y - text}, unit,
                    {.size = text, .colour = render::kFaintInk});
}

// Between ticks. [m]
double tick_step(const HeatMap& map) {
  const double longer = std::max(map.width, map.depth) * map.cell;
  double step = render::round_below(longer / 6);
  while (longer / step > 10) step = render::round_below(step * 2.5);
  return step;
}

// All digits: in a national grid coordinates are large and close to each other.
std::string metres_text(double metres) { return fmt::format("{:.12g}", metres + 0.0); }

// How far the ticks' texts along z reach to the left of the plot. [px]
double left_of_plot(const HeatMap& map, double text) {
  const double step = tick_step(map), last = map.z0 + map.depth * map.cell;
  double widest = 0;
  for (double n = std::ceil(map.z0 / step - 1e-9); n * step <= last + 1e-9; ++n) {
    widest = std::max(widest, render::text_width(metres_text(n * step), {.size = text}));
  }
  return text * 0.8 + widest;
}

void draw_ticks(render::Canvas& canvas, const render::Rect& plot, const HeatMap& map, double scale,
                double text) {
  const double width = map.width * map.cell, depth = map.depth * map.cell;
  const double step = tick_step(map);
  for (double n = std::ceil(map.x0 / step - 1e-9); n * step <= map.x0 + width + 1e-9; ++n) {
    const double x = plot.x + (n * step - map.x0) * scale;
    canvas.line({x, plot.y + plot.height}, {x, plot.y + plot.height + text * 0.4}, 1,
                render::kFaintInk);
    render::draw_text(canvas, {x, plot.y + plot.height + text * 1.8}, metres_text(n * step),
                      {.size = text, .align = render::Align::kCentre});
  }
  for (double n = std::ceil(map.z0 / step - 1e-9); n * step <= map.z0 + depth + 1e-9; ++n) {
    const double y = plot.y + (n * step - map.z0) * scale;
    canvas.line({plot.x - text * 0.4, y}, {plot.x, y}, 1, render::kFaintInk);
    render::draw_text(canvas, {plot.x - text * 0.8, y + text / 2}, metres_text(n * step),
                      {.size = text, .align = render::Align::kRight});
  }
  render::draw_text(canvas, {plot.x + plot.width, plot.y + plot.height + text * 3.6}, "x, z [m]",
                    {.size = text, .colour = render::kFaintInk, .align = render::Align::kRight});
}

}  // namespace

Result<Image> draw_heat_map(const HeatMap& map) {
  if (auto ok = check_map(map); !ok) return ok.error();
  const double u = map.picture_width / 1200.0, text = 12 * u;
  const double head = (74 + 22 * static_cast<double>(map.notes.size())) * u;
  const double width = map.width * map.cell, depth = map.depth * map.cell;
  // As large as fits the width, and no taller than it is wide.
  const double left = std::max(80 * u, std::ceil(left_of_plot(map, text) + 8 * u));
  const double room = map.picture_width - 140 * u - left;
  const double scale = std::min(room / width, room / depth);
  const render::Rect plot{left, head + 20 * u, std::max(1.0, std::floor(width * scale)),
                          std::max(1.0, std::floor(depth * scale))};
  const double tall = std::max(plot.height, 160 * u);
  render::Canvas canvas(map.picture_width, static_cast<int32_t>(plot.y + tall + 70 * u),
                        render::kPaper);
  render::draw_text(canvas, {plot.x, 50 * u}, map.title, {.size = 19 * u, .bold = true});
  for (size_t i = 0; i < map.notes.size(); ++i) {
    render::draw_text(canvas, {plot.x, (80 + 22 * static_cast<double>(i)) * u}, map.notes[i],
                      {.size = 11 * u, .colour = render::kFaintInk});
  }
  double top = map.max > 0 ? map.max : *std::ranges::max_element(map.values);
  if (!(top > 0)) top = 1;
  const double pixel = 1 / (scale * map.cell);  // in cells
  const auto x0 = static_cast<int32_t>(plot.x), y0 = static_cast<int32_t>(plot.y);
  for (int32_t y = 0; y < static_cast<int32_t>(plot.height); ++y) {
    for (int32_t x = 0; x < static_cast<int32_t>(plot.width); ++x) {
      const double value = value_at(map, pixel, x, y);
      canvas.set(x0 + x, y0 + y, value > 0 ? heat_colour(value / top) : render::kPaper);
    }
  }
  canvas.frame({plot.x - 1, plot.y - 1, plot.width + 2, plot.height + 2}, 1, render::kRule);
  draw_ticks(canvas, plot, map, scale, text);
  draw_bar(canvas, {map.picture_width - 110 * u, plot.y + 30 * u, 22 * u, tall - 40 * u}, top,
           map.unit, text);
  return std::move(canvas).take();
}

}  // namespace throng
