// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "render/poster.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "render/marks.h"
#include "render/text.h"
#include "render/views.h"

// All lengths are for a sheet 1600 pixels wide and grow with it.
namespace throng {
namespace {

constexpr size_t kMaxStoreys = 12;

// Where everything goes. [px]
struct Sheet {
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

TextStyle style(const Sheet& sheet, double size, Rgb colour = kInk) {
  return {.size = std::max(4.5, size * sheet.unit), .colour = colour};
}

Sheet make_sheet(int32_t width, size_t lines) {
  Sheet sheet;
  sheet.width = width;
  sheet.unit = width / 1600.0;
  sheet.margin = 44 * sheet.unit;
  sheet.inner = width - 2 * sheet.margin;
  sheet.head = (104 + 24 * static_cast<double>(lines)) * sheet.unit;
  sheet.caption = 34 * sheet.unit;
  sheet.foot = 58 * sheet.unit;
  return sheet;
}

// Fewest columns, so the largest plans, that keep the plans' part of the sheet below its width.
void lay_out_plans(Sheet& sheet, const PictureWorld& world, size_t plans) {
  const double gap = 36 * sheet.unit;
  const double most = sheet.width * (plans == 1 ? 0.75 : 0.5);
  for (size_t columns = 1; columns <= std::min<size_t>(plans, 6); ++columns) {
    sheet.columns = columns;
    sheet.rows = (plans + columns - 1) / columns;
    sheet.panel_width =
        (sheet.inner - gap * static_cast<double>(columns - 1)) / static_cast<double>(columns);
    sheet.grid = make_raster_grid(world, std::max(1, static_cast<int32_t>(sheet.panel_width)),
                                  std::max(1, static_cast<int32_t>(most)));
    const double fit = std::min(sheet.panel_width / sheet.grid.width, most / sheet.grid.height);
    sheet.pixels_per_texel = std::max(1.0, fit);
    sheet.map_width = std::floor(sheet.grid.width * sheet.pixels_per_texel + 1e-6);
    sheet.map_height = std::floor(sheet.grid.height * sheet.pixels_per_texel + 1e-6);
    if (sheet.plans_end() - sheet.head <= sheet.width * (plans == 1 ? 0.9 : 0.8)) break;
  }
}

void draw_head(Canvas& canvas, const Sheet& sheet, const PosterText& text) {
  TextStyle title = style(sheet, 24);
  title.bold = true;
  double y = sheet.margin + title.size;
  draw_text(canvas, {sheet.margin, y}, fit_text(text.title, sheet.inner, title), title);
  const TextStyle plain = style(sheet, 10.5, kFaintInk);
  y += 16 * sheet.unit;
  for (const std::string& line : text.lines) {
    y += 22 * sheet.unit;
    draw_text(canvas, {sheet.margin, y}, fit_text(line, sheet.inner, plain), plain);
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

// What stands over a plan: as much of it as fits.
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

void draw_plans(Canvas& canvas, const Sheet& sheet, const PictureWorld& world,
                std::span<const StoreyRaster> storeys, std::span<const size_t> plans,
                const HeightScale& scale, const PlacedMarks& marks) {
  const double step = (sheet.inner + 36 * sheet.unit) / static_cast<double>(sheet.columns);
  for (size_t p = 0; p < plans.size(); ++p) {
    const StoreyRaster& storey = storeys[plans[p]];
    const double x = std::floor(sheet.margin + static_cast<double>(p % sheet.columns) * step);
    const double y =
        std::floor(sheet.head + static_cast<double>(p / sheet.columns) * sheet.row_height());
    TextStyle name = style(sheet, 12);
    name.bold = true;
    const std::string title = fmt::format("Storey {}", storey.storey);
    draw_text(canvas, {x, y + 18 * sheet.unit}, title, name);
    const TextStyle plain = style(sheet, 9.5, kFaintInk);
    const double used = text_width(title, name) + 14 * sheet.unit;
    draw_text(canvas, {x + used, y + 18 * sheet.unit},
              storey_text(storey, world.class_name, sheet.panel_width - used, plain), plain);

    const double top = std::floor(y + sheet.caption);
    draw_plan(canvas, static_cast<int32_t>(x), static_cast<int32_t>(top), sheet.pixels_per_texel,
              storeys, plans[p], sheet.grid, scale, marks);
    canvas.frame({x - 1, top - 1, sheet.map_width + 2, sheet.map_height + 2}, 1, kRule);
    const double foot = top + sheet.map_height + 16 * sheet.unit;
    const TextStyle small = style(sheet, 9.5);
    draw_scale_bar(canvas, {x + small.size * 0.2, foot},
                   std::min(sheet.map_width * 0.4, 360 * sheet.unit),
                   sheet.pixels_per_texel / sheet.grid.texel_metres(), small.size);
    if (p == 0) {
      draw_axes(canvas,
                {x + std::max(sheet.map_width - 34 * sheet.unit, 0.0), foot - 4 * sheet.unit},
                16 * sheet.unit, style(sheet, 8.5, kFaintInk));
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

SectionPlace place_section(const Sheet& sheet, std::span<const StoreyRaster> storeys, Point corner,
                           double width) {
  double low = 0, high = 0;
  for (size_t s = 0; s < storeys.size(); ++s) {
    low = s == 0 ? storeys[s].low : std::min(low, storeys[s].low);
    high = s == 0 ? storeys[s].high : std::max(high, storeys[s].high);
  }
  const double air = std::max(2.2, (high - low) * 0.06);
  const double range = high - low + 1.5 * air;
  SectionPlace place;
  place.low = low - 0.5 * air;
  const double true_scale = width / sheet.grid.width_metres();
  const double least = 110 * sheet.unit, most = 420 * sheet.unit;
  place.exaggeration = std::max(1, static_cast<int32_t>(std::ceil(least / (range * true_scale))));
  place.pixels_per_metre = true_scale * place.exaggeration;
  if (place.exaggeration == 1 && range * true_scale > most) {
    width *= most / (range * true_scale);  // A tower: narrower, so that it is not distorted.
    place.pixels_per_metre = most / range;
  }
  place.rect = {std::floor(corner.x), std::floor(corner.y), std::floor(width),
                std::floor(range * place.pixels_per_metre)};
  return place;
}

void draw_titled_section(Canvas& canvas, const Sheet& sheet, const PictureWorld& world,
                         const SectionPlace& place, int32_t row, const HeightScale& scale) {
  const Section section =
      cut_section(world, sheet.grid, row, std::max(1, static_cast<int32_t>(place.rect.width)));
  TextStyle name = style(sheet, 12);
  name.bold = true;
  std::string title = fmt::format("Section along x at z = {:.1f} m", section.z);
  if (place.exaggeration > 1) title += fmt::format(", heights x {}", place.exaggeration);
  draw_text(canvas, {place.rect.x, place.rect.y - 16 * sheet.unit}, title, name);
  const TextStyle small = style(sheet, 9.5);
  draw_section(canvas, place.rect, section, place.low, place.pixels_per_metre, small.size, scale);
  draw_scale_bar(canvas, {place.rect.x, place.rect.y + place.rect.height + 16 * sheet.unit},
                 place.rect.width * 0.4, place.rect.width / sheet.grid.width_metres(), small.size);
}

void draw_legend(Canvas& canvas, const Sheet& sheet, Point corner, const HeightScale& scale,
                 const std::string& class_name, const PlacedMarks& marks) {
  const double unit = sheet.unit;
  TextStyle name = style(sheet, 12);
  name.bold = true;
  draw_text(canvas, {corner.x, corner.y}, "Legend", name);
  const TextStyle small = style(sheet, 9.5);
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
  if (!marks.way.empty()) {
    swatch(
        [&](const Rect& r) {
          canvas.line({r.x, r.y + r.height / 2}, {r.x + r.width, r.y + r.height / 2}, 3.2 * unit,
                      kWay);
        },
        "way");
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
  if (choice.left_out > 0) head.lines.emplace_back();  // Written below.
  Sheet sheet = make_sheet(config.width, head.lines.size());
  lay_out_plans(sheet, world, one ? 1 : choice.shown.size());
  const StoreyRasters rasters = rasterise_storeys(world, index, choice.shown, sheet.grid);
  const std::span<const StoreyRaster> storeys = rasters.storeys;
  if (choice.left_out > 0) {
    head.lines.back() = fmt::format(
        "{} of {} storeys are shown, with the small ones near them; {:.0f} m2 of floor are not",
        choice.shown.size(), last + 1, rasters.left_out_area);
  }
  std::vector<size_t> plans;
  for (size_t s = 0; s < storeys.size(); ++s) {
    if (!one || storeys[s].storey == config.storey) plans.push_back(s);
  }
  const HeightScale scale = make_height_scale(storeys);
  const PlacedMarks marks{place_avatars(avatars, storeys, sheet.grid),
                          place_way(config.path, storeys, sheet.grid)};

  // The lower part: the fan and, beside it, section and legend; without the fan they share the row.
  const double unit = sheet.unit, top = sheet.plans_end() + 44 * unit;
  const double axis = 64 * unit, names = 30 * unit;
  FanLayout fan;
  double right = sheet.margin;
  if (!one) {
    fan = lay_out_fan(storeys, sheet.grid, sheet.inner * 0.56 - names, sheet.width * 0.66);
    right += sheet.inner * 0.6;
  }
  const double section_width = one ? sheet.inner * 0.62 : sheet.inner * 0.4;
  const SectionPlace section =
      place_section(sheet, storeys, {right + axis, top + 16 * unit}, section_width - axis);
  const double section_end = section.rect.y + section.rect.height + 40 * unit;
  const Point legend =
      one ? Point{sheet.margin + sheet.inner * 0.68, top} : Point{right, section_end + 44 * unit};
  const double bottom = std::max({section_end, legend.y + 226 * unit, one ? 0 : top + fan.height});

  Canvas canvas(config.width, static_cast<int32_t>(std::ceil(bottom + sheet.margin)), kPaper);
  draw_head(canvas, sheet, head);
  draw_plans(canvas, sheet, world, storeys, plans, scale, marks);
  if (!one) {
    TextStyle name = style(sheet, 12);
    name.bold = true;
    draw_fan(canvas, static_cast<int32_t>(sheet.margin + names),
             static_cast<int32_t>(top + 14 * unit), fan, storeys, sheet.grid, style(sheet, 11).size,
             scale, marks);
    draw_text(canvas, {sheet.margin, top},
              storeys.size() > 1 ? "The storeys pulled apart" : "Seen at a slant", name);
  }
  draw_titled_section(canvas, sheet, world, section,
                      index.section_row(sheet.grid.cell_z, sheet.grid.cells_z), scale);
  draw_legend(canvas, sheet, legend, scale, world.class_name, marks);
  return std::move(canvas).take();
}

}  // namespace throng
