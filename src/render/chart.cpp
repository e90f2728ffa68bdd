// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "render/canvas.h"
#include "render/marks.h"
#include "render/text.h"
#include "throng/picture.h"

// All lengths are for a chart 1200 pixels wide and grow with it.
namespace throng {
namespace {

// Distinct for colour-blind readers. Source: M. Okabe, K. Ito. Color Universal Design. 2008.
constexpr std::array<render::Rgb, 6> kColours{
    {{213, 94, 0}, {0, 114, 178}, {0, 158, 115}, {204, 121, 167}, {230, 159, 0}, {86, 180, 233}}};

struct Frame {
  double unit = 1;
  render::Rect plot;
  double x_low = 0, x_high = 1, y_high = 1;
  [[nodiscard]] render::Point at(double x, double y) const {
    return {plot.x + (x - x_low) / (x_high - x_low) * plot.width,
            plot.y + plot.height - y / y_high * plot.height};
  }
};

// The smallest round step that makes at most `max_ticks` ticks.
double tick_step(double range, double max_ticks) {
  double step = render::round_below(range / max_ticks);
  if (!(step > 0)) return range;  // hardly more than the smallest number
  while (range / step > max_ticks + 1e-9) step = render::round_below(step * 2.5 * (1 + 1e-9));
  return step;
}

std::string tick_text(double value) { return fmt::format("{:g}", value); }

void draw_axes(render::Canvas& canvas, const Frame& frame, const Chart& chart) {
  const double u = frame.unit, text = 12 * u;
  const render::Rect& p = frame.plot;
  const double y_step = tick_step(frame.y_high, 8);
  for (int32_t i = 0; i * y_step <= frame.y_high * (1 + 1e-9); ++i) {
    const render::Point at = frame.at(frame.x_low, i * y_step);
    canvas.line(at, {p.x + p.width, at.y}, std::max(1.0, u), render::kRule);
    render::draw_text(canvas, {p.x - 10 * u, at.y + text / 2}, tick_text(i * y_step),
                      {.size = text, .align = render::Align::kRight});
  }
  const double x_step = tick_step(frame.x_high - frame.x_low, 12);
  const double first = std::ceil(frame.x_low / x_step);
  const double range = frame.x_high - frame.x_low;
  for (int32_t i = 0; (first + i) * x_step <= frame.x_high + 1e-9 * range; ++i) {
    const double x = (first + i) * x_step + 0.0;  // never -0
    const render::Point at = frame.at(x, 0);
    canvas.line(at, {at.x, at.y + 6 * u}, std::max(1.0, u), render::kFaintInk);
    render::draw_text(canvas, {at.x, at.y + 12 * u + text}, tick_text(x),
                      {.size = text, .align = render::Align::kCentre});
  }
  canvas.line(frame.at(frame.x_low, 0), frame.at(frame.x_high, 0), std::max(1.0, 1.5 * u),
              render::kInk);
  render::draw_text(canvas, {p.x + p.width / 2, p.y + p.height + 54 * u}, chart.x_title,
                    {.size = text, .colour = render::kFaintInk, .align = render::Align::kCentre});
  render::draw_text(canvas, {p.x, p.y - 14 * u}, chart.y_title,
                    {.size = text, .colour = render::kFaintInk});
}

void draw_dashes(render::Canvas& canvas, const std::vector<render::Point>& points, double width,
                 double dash, render::Rgb colour) {
  double walked = 0;  // Along the whole line, so that dashes continue around corners.
  for (size_t i = 1; i < points.size(); ++i) {
    const render::Point a = points[i - 1], b = points[i];
    const double size = std::hypot(b.x - a.x, b.y - a.y);
    double from = 0;
    while (from < size) {
      const double in_period = std::fmod(walked + from, 2 * dash);
      const bool inked = in_period < dash;
      const double to = std::min(size, from + (inked ? dash : 2 * dash) - in_period + 1e-6);
      const auto point = [&](double s) {
        return render::Point{a.x + (b.x - a.x) * s / size, a.y + (b.y - a.y) * s / size};
      };
      if (inked) canvas.line(point(from), point(to), width, colour);
      from = to;
    }
    walked += size;
  }
}

// The pieces of a line that lie below the top of the plot.
std::vector<std::vector<render::Point>> pieces_of(const Frame& frame, const std::vector<double>& x,
                                                  const std::vector<double>& y) {
  std::vector<std::vector<render::Point>> pieces;
  bool inside = false;
  for (size_t i = 0; i < x.size(); ++i) {
    const bool now = y[i] <= frame.y_high;
    const auto crossing = [&] {
      const double t = (frame.y_high - y[i - 1]) / (y[i] - y[i - 1]);
      return frame.at(x[i - 1] + t * (x[i] - x[i - 1]), frame.y_high);
    };
    if (now && !inside) pieces.emplace_back();
    if (i > 0 && now != inside) pieces.back().push_back(crossing());
    if (now) pieces.back().push_back(frame.at(x[i], y[i]));
    inside = now;
  }
  return pieces;
}

void draw_band(render::Canvas& canvas, const Frame& frame, const Chart& chart,
               const ChartLine& line, render::Rgb colour) {
  for (size_t i = 1; i < chart.x.size(); ++i) {
    const auto edge = [&](size_t k, double side) {
      return frame.at(chart.x[k], std::max(0.0, line.values[k] + side * line.spread[k]));
    };
    const render::Point a = edge(i - 1, 1), b = edge(i, 1), c = edge(i, -1), d = edge(i - 1, -1);
    // Column by column, so that neighbouring pieces share no pixel.
    for (auto x = static_cast<int32_t>(std::ceil(a.x - 0.5)); x + 0.5 < b.x; ++x) {
      const double t = (x + 0.5 - a.x) / (b.x - a.x);
      const double top = std::max(frame.plot.y, a.y + (b.y - a.y) * t);
      const double bottom = d.y + (c.y - d.y) * t;
      for (auto y = static_cast<int32_t>(std::ceil(top - 0.5)); y + 0.5 < bottom; ++y) {
        canvas.blend(x, y, colour, 0.14);
      }
    }
  }
}

struct Drawn {
  const ChartLine* line = nullptr;
  render::Rgb colour;
  double width = 1;
};

// Colours in the order of the lines; faint lines and bounds take none.
std::vector<Drawn> styled(const Chart& chart, double unit) {
  std::vector<Drawn> drawn;
  size_t next = 0;
  for (const ChartLine& line : chart.lines) {
    const bool grey = line.kind == LineKind::kFaint || line.kind == LineKind::kDashed;
    const render::Rgb colour = line.kind == LineKind::kFaint ? render::kHatch
                               : grey                        ? render::kInk
                                                             : kColours[next++ % kColours.size()];
    const double width = line.kind == LineKind::kStrong  ? 5
                         : line.kind == LineKind::kPlain ? 2.5
                                                         : 1.2;
    drawn.push_back({&line, colour, std::max(1.0, width * unit)});
  }
  // Faint ones lie under the others.
  std::stable_sort(drawn.begin(), drawn.end(), [](const Drawn& a, const Drawn& b) {
    return (a.line->kind == LineKind::kFaint) > (b.line->kind == LineKind::kFaint);
  });
  return drawn;
}

void draw_legend(render::Canvas& canvas, const Frame& frame, const std::vector<Drawn>& drawn) {
  const double u = frame.unit, text = 12 * u;
  double y = frame.plot.y + 16 * u;
  for (const Drawn& d : drawn) {
    if (d.line->name.empty()) continue;
    const render::Point a{frame.plot.x + 20 * u, y}, b{frame.plot.x + 64 * u, y};
    // On a paper background, so that the grid does not cross the words.
    canvas.fill({a.x - 6 * u, y - 11 * u, 78 * u + render::text_width(d.line->name, {.size = text}),
                 22 * u},
                render::kPaper);
    if (d.line->kind == LineKind::kDashed) {
      draw_dashes(canvas, {a, b}, d.width, 7 * u, d.colour);
    } else {
      canvas.line(a, b, d.width, d.colour);
    }
    render::draw_text(canvas, {b.x + 10 * u, y + text / 2}, d.line->name, {.size = text});
    y += 24 * u;
  }
}

Result<void> check_chart(const Chart& chart) {
  const auto is_sound = [](double v) { return v >= 0 && v < 1e15; };
  const auto bad = [](const std::string& what) {
    return Error{Errc::kBadConfig, "chart: " + what};
  };
  if (chart.width < 400 || chart.width > 8000) return bad("width must be from 400 to 8000 px");
  if (chart.x.size() < 2) return bad("need at least two values of x");
  for (size_t i = 0; i < chart.x.size(); ++i) {
    if (!(std::fabs(chart.x[i]) < 1e15) || (i > 0 && !(chart.x[i] > chart.x[i - 1]))) {
      return bad("the values of x must be finite and ascend");
    }
  }
  if (!is_sound(chart.max)) return bad("the top of the y axis must be finite");
  for (const ChartLine& line : chart.lines) {
    const bool sizes = line.values.size() == chart.x.size() &&
                       (line.spread.empty() || line.spread.size() == chart.x.size());
    if (!sizes) return bad("the line '" + line.name + "' needs one value for each x");
    if (!std::ranges::all_of(line.values, is_sound) ||
        !std::ranges::all_of(line.spread, is_sound)) {
      return bad("the line '" + line.name + "' has a value below 0 or one that is not finite");
    }
  }
  return {};
}

}  // namespace

Result<Image> draw_chart(const Chart& chart) {
  if (auto ok = check_chart(chart); !ok) return ok.error();
  Frame frame;
  frame.unit = chart.width / 1200.0;
  const double u = frame.unit;
  const double head = (74 + 22 * static_cast<double>(chart.notes.size())) * u;
  frame.plot = {90 * u, head + 34 * u, chart.width - 130 * u, 520 * u};
  frame.x_low = std::min(0.0, chart.x.front());
  frame.x_high = chart.x.back();
  double top = chart.max;
  if (top == 0) {
    for (const ChartLine& line : chart.lines) {
      for (const double v : line.values) top = std::max(top, v);
    }
    top = top > 0 ? top * 1.05 : 1;
  }
  frame.y_high = top;

  render::Canvas canvas(
      chart.width, static_cast<int32_t>(frame.plot.y + frame.plot.height + 78 * u), render::kPaper);
  render::draw_text(canvas, {frame.plot.x, 50 * u}, chart.title, {.size = 19 * u, .bold = true});
  for (size_t i = 0; i < chart.notes.size(); ++i) {
    render::draw_text(canvas, {frame.plot.x, (80 + 22 * static_cast<double>(i)) * u},
                      chart.notes[i], {.size = 11 * u, .colour = render::kFaintInk});
  }
  draw_axes(canvas, frame, chart);
  const std::vector<Drawn> drawn = styled(chart, u);
  for (const Drawn& d : drawn) {
    if (!d.line->spread.empty()) draw_band(canvas, frame, chart, *d.line, d.colour);
  }
  for (const Drawn& d : drawn) {
    for (const std::vector<render::Point>& points : pieces_of(frame, chart.x, d.line->values)) {
      if (d.line->kind == LineKind::kDashed) {
        draw_dashes(canvas, points, d.width, 7 * u, d.colour);
      } else {
        canvas.path(points, d.width, d.colour);
      }
    }
  }
  draw_legend(canvas, frame, drawn);
  return std::move(canvas).take();
}

}  // namespace throng
