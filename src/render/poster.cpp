// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "render/poster.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "render/marks.h"
#include "render/text.h"
#include "render/views.h"

// Lays out and draws a poster. All lengths are for one 1600 pixels wide and grow with it.
namespace throng::render {
namespace {

constexpr size_t kMaxStoreys = 12;

// Positions and sizes. [px]
struct Layout {
  double unit = 1;
  double width = 0, margin = 0, inner = 0;
  double head = 0;  // Height of the title block.
  size_t columns = 1, rows = 1;
  double panel_width = 0, caption = 0, foot = 0;
  double pixels_per_texel = 1;
  double map_width = 0, map_height = 0;
  RasterGrid grid;
  [[nodiscard]] double row_height() const { return caption + map_height + foot; }
  [[nodiscard]] double plans_end() const { return head + static_cast<double>(rows) * row_height(); }
};

TextStyle style(const Layout& layout, double size, Rgb colour = kInk) {
  return {.size = std::max(4.5, size * layout.unit), .colour = colour};
}

Layout make_layout(int32_t width, size_t lines) {
  Layout layout;
  layout.width = width;
  layout.unit = width / 1600.0;
  layout.margin = 44 * layout.unit;
  layout.inner = width - 2 * layout.margin;
  layout.head = (104 + 24 * static_cast<double>(lines)) * layout.unit;
  layout.caption = 34 * layout.unit;
  layout.foot = 58 * layout.unit;
  return layout;
}

// The smallest number of columns, hence the largest plans, for which the height of all plans stays
// below a share of the poster's width.
void lay_out_plans(Layout& layout, const PictureWorld& world, size_t plans) {
  const double spacing = 36 * layout.unit;
  const double max_height = layout.width * (plans == 1 ? 0.75 : 0.5);
  for (size_t columns = 1; columns <= std::min<size_t>(plans, 6); ++columns) {
    layout.columns = columns;
    layout.rows = (plans + columns - 1) / columns;
    layout.panel_width =
        (layout.inner - spacing * static_cast<double>(columns - 1)) / static_cast<double>(columns);
    layout.grid = make_raster_grid(world, std::max(1, static_cast<int32_t>(layout.panel_width)),
                                   std::max(1, static_cast<int32_t>(max_height)));
    const double fit =
        std::min(layout.panel_width / layout.grid.width, max_height / layout.grid.height);
    layout.pixels_per_texel = std::max(1.0, fit);
    layout.map_width = std::floor(layout.grid.width * layout.pixels_per_texel + 1e-6);
    layout.map_height = std::floor(layout.grid.height * layout.pixels_per_texel + 1e-6);
    if (layout.plans_end() - layout.head <= layout.width * (plans == 1 ? 0.9 : 0.8)) break;
  }
}

void draw_head(Canvas& canvas, const Layout& layout, const PosterText& text) {
  TextStyle title = style(layout, 24);
  title.bold = true;
  double y = layout.margin + title.size;
  draw_text(canvas, {layout.margin, y}, fit_text(text.title, layout.inner, title), title);
  const TextStyle plain = style(layout, 10.5, kFaintInk);
  y += 16 * layout.unit;
  for (const std::string& line : text.lines) {
    y += 22 * layout.unit;
    draw_text(canvas, {layout.margin, y}, fit_text(line, layout.inner, plain), plain);
  }
}

// Two short arrows from one corner: x to the right, z down.
void draw_axes(Canvas& canvas, Point corner, double length, const TextStyle& text) {
  const double line = std::max(1.0, text.size / 8), tip = text.size * 0.4;
  const Point x{corner.x + length, corner.y}, z{corner.x, corner.y + length};
  canvas.line(corner, x, line, text.colour);
  canvas.line(corner, z, line, text.colour);
  for (const double s : {-1.0, 1.0}) {
    canvas.line(x, {x.x - tip, x.y + s * tip}, line, text.colour);
    canvas.line(z, {z.x + s * tip, z.y - tip}, line, text.colour);
  }
  draw_text(canvas, {x.x + text.size * 0.5, x.y + text.size / 2}, "x", text);
  draw_text(canvas, {z.x + text.size * 0.6, z.y + text.size * 0.2}, "z", text);
}

// The text over a plan, as much of it as fits.
std::string storey_text(const StoreyRaster& storey, const std::string& class_name, double width,
                        const TextStyle& text) {
  const std::string height = storey.high - storey.low < 0.05
                                 ? fmt::format("{:.2f} m", storey.low)
                                 : fmt::format("{:.2f} to {:.2f} m", storey.low, storey.high);
  const std::string area =
      fmt::format("{:.{}f} m2", storey.stand_area, storey.stand_area < 100 ? 1 : 0);
  for (const std::string& line :
       {fmt::format("floor at {}, {} stands on {}", height, class_name, area),
        fmt::format("{}, {} {}", height, class_name, area), fmt::format("{}, {}", height, area)}) {
    if (text_width(line, text) <= width) return line;
  }
  return fit_text(height, width, text);
}

void draw_plans(Canvas& canvas, const Layout& layout, const PictureWorld& world,
                std::span<const StoreyRaster> storeys, std::span<const size_t> plans,
                const HeightScale& scale, const PlacedMarks& marks) {
  const double step = (layout.inner + 36 * layout.unit) / static_cast<double>(layout.columns);
  for (size_t p = 0; p < plans.size(); ++p) {
    const StoreyRaster& storey = storeys[plans[p]];
    const double x = std::floor(layout.margin + static_cast<double>(p % layout.columns) * step);
    const double y =
        std::floor(layout.head + static_cast<double>(p / layout.columns) * layout.row_height());
    TextStyle name = style(layout, 12);
    name.bold = true;
    const std::string title = fmt::format("Storey {}", storey.storey);
    draw_text(canvas, {x, y + 18 * layout.unit}, title, name);
    const TextStyle plain = style(layout, 9.5, kFaintInk);
    const double used = text_width(title, name) + 14 * layout.unit;
    draw_text(canvas, {x + used, y + 18 * layout.unit},
              storey_text(storey, world.class_name, layout.panel_width - used, plain), plain);

    const double top = std::floor(y + layout.caption);
    draw_plan(canvas, static_cast<int32_t>(x), static_cast<int32_t>(top), layout.pixels_per_texel,
              storeys, plans[p], layout.grid, scale, marks);
    canvas.frame({x - 1, top - 1, layout.map_width + 2, layout.map_height + 2}, 1, kRule);
    const double foot = top + layout.map_height + 16 * layout.unit;
    const TextStyle small = style(layout, 9.5);
    draw_scale_bar(canvas, {x + small.size * 0.2, foot},
                   std::min(layout.map_width * 0.4, 360 * layout.unit),
                   layout.pixels_per_texel / layout.grid.texel_metres(), small.size);
    if (p == 0) {
      draw_axes(canvas,
                {x + std::max(layout.map_width - 34 * layout.unit, 0.0), foot - 4 * layout.unit},
                16 * layout.unit, style(layout, 8.5, kFaintInk));
    }
  }
}

// The section at true scale where it is legible, else with heights exaggerated by a whole number.
struct SectionPlace {
  Rect rect;
  double low = 0;
  double pixels_per_metre = 1;
  int32_t exaggeration = 1;
};

SectionPlace place_section(const Layout& layout, std::span<const StoreyRaster> storeys,
                           Point corner, double width) {
  double low = 0, high = 0;
  for (size_t s = 0; s < storeys.size(); ++s) {
    low = s == 0 ? storeys[s].low : std::min(low, storeys[s].low);
    high = s == 0 ? storeys[s].high : std::max(high, storeys[s].high);
  }
  const double air = std::max(2.2, (high - low) * 0.06);
  const double range = high - low + 1.5 * air;
  SectionPlace place;
  place.low = low - 0.5 * air;
  const double true_scale = width / layout.grid.width_metres();
  const double min_height = 110 * layout.unit, max_height = 420 * layout.unit;
  place.exaggeration =
      std::max(1, static_cast<int32_t>(std::ceil(min_height / (range * true_scale))));
  place.pixels_per_metre = true_scale * place.exaggeration;
  if (place.exaggeration == 1 && range * true_scale > max_height) {
    width *= max_height / (range * true_scale);  // A tower: narrower, so that it is not distorted.
    place.pixels_per_metre = max_height / range;
  }
  place.rect = {std::floor(corner.x), std::floor(corner.y), std::floor(width),
                std::floor(range * place.pixels_per_metre)};
  return place;
}

void draw_titled_section(Canvas& canvas, const Layout& layout, const PictureWorld& world,
                         const SectionPlace& place, int32_t row, const HeightScale& scale) {
  const Section section =
      cut_section(world, layout.grid, row, std::max(1, static_cast<int32_t>(place.rect.width)));
  TextStyle name = style(layout, 12);
  name.bold = true;
  std::string title = fmt::format("Section along x at z = {:.1f} m", section.z);
  if (place.exaggeration > 1) title += fmt::format(", heights x {}", place.exaggeration);
  draw_text(canvas, {place.rect.x, place.rect.y - 16 * layout.unit}, title, name);
  const TextStyle small = style(layout, 9.5);
  draw_section(canvas, place.rect, section, place.low, place.pixels_per_metre, small.size, scale);
  draw_scale_bar(canvas, {place.rect.x, place.rect.y + place.rect.height + 16 * layout.unit},
                 place.rect.width * 0.4, place.rect.width / layout.grid.width_metres(), small.size);
}

void draw_legend(Canvas& canvas, const Layout& layout, Point corner, const HeightScale& scale,
                 const std::string& class_name, const PlacedMarks& marks) {
  const double unit = layout.unit;
  TextStyle name = style(layout, 12);
  name.bold = true;
  draw_text(canvas, {corner.x, corner.y}, "Legend", name);
  const TextStyle small = style(layout, 9.5);
  const double top = corner.y + 24 * unit;
  draw_height_bar(canvas, {corner.x, top, 20 * unit, 168 * unit}, scale.low, scale.high, small.size,
                  [](double t) { return height_colour(t); });
  draw_text(canvas, {corner.x, top + 190 * unit}, "height of the floor", small);

  const double x = corner.x + 190 * unit;
  double y = top;
  const auto swatch = [&](auto&& fill, const std::string& text) {
    const Rect box{x, y, 26 * unit, 17 * unit};
    fill(box);
    canvas.frame(box, 1, kRule);
    draw_text(canvas, {x + 38 * unit, y + 13 * unit}, text, small);
    y += 29 * unit;
  };
  swatch([&](const Rect& r) { canvas.hatch(r, kNoStanding, kHatch, 5); },
         fmt::format("floor, but too tight or steep for {}", class_name));
  swatch([&](const Rect& r) { canvas.fill(r, kSolid); }, "wall, pillar, closed");
  swatch([&](const Rect& r) { canvas.fill(r, kShaft); }, "open to a storey below");
  swatch([&](const Rect& r) { canvas.fill(r, kContext); }, "other storeys only");
  if (!marks.avatars.empty()) {
    swatch(
        [&](const Rect& r) {
          canvas.disc({r.x + r.width / 2, r.y + r.height / 2}, 6 * unit, kAvatar);
        },
        "avatar");
  }
  if (!marks.path.empty()) {
    swatch(
        [&](const Rect& r) {
          canvas.line({r.x, r.y + r.height / 2}, {r.x + r.width, r.y + r.height / 2}, 3.2 * unit,
                      kPath);
        },
        "path");
  }
}

}  // namespace

Result<Image> draw_poster(const PictureWorld& world, const PosterText& text,
                          std::span<const PictureAvatar> avatars, const PictureConfig& config) {
  if (config.width < 200 || config.width > 16000) {
    return Error{Errc::kBadConfig,
                 fmt::format("picture: width is {}; it must be 200 to 16000 pixels", config.width)};
  }
  const int32_t last =
      world.storeys.empty() ? -1 : *std::max_element(world.storeys.begin(), world.storeys.end());
  if (last < 0) {
    return Error{Errc::kNotFound, "picture: this world has no floor; bake a model with surfaces"};
  }
  if (config.storey > last) {
    return Error{Errc::kNotFound,
                 fmt::format("picture: no storey {}; this world has 0 to {}", config.storey, last)};
  }

  const bool one = config.storey >= 0;
  const StoreyIndex index(world);
  const StoreyChoice choice = index.choose(config.storey, kMaxStoreys);
  PosterText head = text;
  const bool names_left_out = !one && choice.left_out > 0;
  if (names_left_out) head.lines.emplace_back();  // Written below.
  Layout layout = make_layout(config.width, head.lines.size());
  lay_out_plans(layout, world, one ? 1 : choice.shown.size());
  const StoreyRasters rasters = rasterise_storeys(world, index, choice.shown, layout.grid);
  const std::span<const StoreyRaster> storeys = rasters.storeys;
  if (names_left_out) {
    head.lines.back() = fmt::format(
        "{} of {} storeys are shown, with the small ones near them; {:.0f} m2 of floor are not",
        choice.shown.size(), last + 1, rasters.left_out_area);
  }
  std::vector<size_t> plans;
  for (size_t s = 0; s < storeys.size(); ++s) {
    if (!one || storeys[s].storey == config.storey) plans.push_back(s);
  }
  const HeightScale scale = make_height_scale(storeys);
  const PlacedMarks marks{place_avatars(avatars, storeys, layout.grid),
                          place_path(config.path, storeys, layout.grid)};

  // The lower part: the fan and, beside it, section and legend; without the fan they share the row.
  const double unit = layout.unit, top = layout.plans_end() + 44 * unit;
  const double axis = 64 * unit, names = 30 * unit;
  FanLayout fan;
  double right = layout.margin;
  if (!one) {
    fan = lay_out_fan(storeys, layout.grid, layout.inner * 0.56 - names, layout.width * 0.66);
    right += layout.inner * 0.6;
  }
  const double section_width = one ? layout.inner * 0.62 : layout.inner * 0.4;
  const SectionPlace section =
      place_section(layout, storeys, {right + axis, top + 16 * unit}, section_width - axis);
  const double section_end = section.rect.y + section.rect.height + 40 * unit;
  const Point legend =
      one ? Point{layout.margin + layout.inner * 0.68, top} : Point{right, section_end + 44 * unit};
  const double bottom = std::max({section_end, legend.y + 226 * unit, one ? 0 : top + fan.height});

  Canvas canvas(config.width, static_cast<int32_t>(std::ceil(bottom + layout.margin)), kPaper);
  draw_head(canvas, layout, head);
  draw_plans(canvas, layout, world, storeys, plans, scale, marks);
  if (!one) {
    TextStyle name = style(layout, 12);
    name.bold = true;
    draw_fan(canvas, static_cast<int32_t>(layout.margin + names),
             static_cast<int32_t>(top + 14 * unit), fan, storeys, layout.grid,
             style(layout, 11).size, scale, marks);
    draw_text(canvas, {layout.margin, top},
              storeys.size() > 1 ? "The storeys pulled apart" : "Seen at a slant", name);
  }
  draw_titled_section(canvas, layout, world, section,
                      index.section_row(layout.grid.cell_z, layout.grid.cells_z), scale);
  draw_legend(canvas, layout, legend, scale, world.class_name, marks);
  return std::move(canvas).take();
}

}  // namespace throng::render
