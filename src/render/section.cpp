// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "render/marks.h"
#include "render/text.h"
#include "render/views.h"

// Draws a section: the world cut along x. Solid is dark, free space light, and floors are coloured
// lines.
namespace throng::render {
namespace {

constexpr Rgb kMatter{176, 180, 187};
constexpr Rgb kAir{250, 251, 253};

}  // namespace

Section cut_section(const PictureWorld& world, const RasterGrid& grid, int32_t row,
                    int32_t columns) {
  Section section;
  section.free_spans.resize(static_cast<size_t>(columns));
  section.z = world.origin.z + (row + 0.5) * world.cell;
  std::vector<int32_t> cells;  // Sampled, not averaged: half a wall would be no wall.
  for (int32_t c = 0; c < columns; ++c) {
    cells.push_back(grid.cell_x + static_cast<int32_t>((c + 0.5) / columns * grid.cells_x));
  }
  for (uint32_t i = 0; i < world.storeys.size(); ++i) {
    const LevelTileContent tile = world.level_tile(i);
    if (tile.tile_z != row / kTileCells) continue;
    for (size_t c = 0; c < cells.size(); ++c) {
      if (cells[c] / kTileCells != tile.tile_x) continue;
      const auto cell = static_cast<size_t>(row % kTileCells * kTileCells + cells[c] % kTileCells);
      if (tile.floor[cell] == kNoFloor) continue;
      const double ceiling = tile.ceiling[cell] == kOpenSky
                                 ? std::numeric_limits<double>::infinity()
                                 : world.origin.y + tile.ceiling[cell] / 1000.0;
      const auto avatar_class = static_cast<size_t>(world.avatar_class);
      section.free_spans[c].push_back({.floor = world.origin.y + tile.floor[cell] / 1000.0,
                                       .ceiling = ceiling,
                                       .stands = tile.clearance[avatar_class][cell] > 0});
    }
  }
  for (auto& free_spans : section.free_spans) {
    std::sort(free_spans.begin(), free_spans.end(),
              [](const SectionSpan& a, const SectionSpan& b) { return a.floor < b.floor; });
  }
  return section;
}

void draw_section(Canvas& canvas, const Rect& rect, const Section& section, double low,
                  double pixels_per_metre, double text, const HeightScale& scale) {
  const double bottom = rect.y + rect.height;
  const auto y_of = [&](double height) {
    return std::clamp(bottom - (height - low) * pixels_per_metre, rect.y, bottom);
  };
  const double column = rect.width / static_cast<double>(section.free_spans.size());
  const double line = std::max(1.5, text * 0.22);
  for (size_t c = 0; c < section.free_spans.size(); ++c) {
    const double x = rect.x + static_cast<double>(c) * column;
    if (section.free_spans[c].empty()) continue;
    canvas.fill({x, rect.y, column, rect.height}, kAir);
    const double top = y_of(section.free_spans[c].back().floor);
    canvas.fill({x, top, column, bottom - top}, kMatter);
    for (const SectionSpan& span : section.free_spans[c]) {
      const double ceiling = y_of(span.ceiling), floor = y_of(span.floor);
      canvas.fill({x, ceiling, column, floor - ceiling}, kAir);
    }
    for (const SectionSpan& span : section.free_spans[c]) {
      const double floor = y_of(span.floor);
      canvas.fill({x, floor, column, line}, span.stands ? scale.colour(span.floor) : kHatch);
    }
  }
  canvas.frame({rect.x - 1, rect.y - 1, rect.width + 2, rect.height + 2}, 1, kRule);

  const double high = low + rect.height / pixels_per_metre;
  double tick = round_below(high - low);
  for (double finer = tick; (high - low) / finer <= rect.height / (text * 2.4);) {
    tick = finer;
    finer = round_below(tick * 0.55);  // 5, 2, 1, 0.5 ...
  }
  for (double height = std::ceil(low / tick - 1e-6) * tick; height <= high + 1e-6; height += tick) {
    const double y = y_of(height);
    canvas.line({rect.x - text * 0.5, y}, {rect.x - 1, y}, 1, kFaintInk);
    draw_text(
        canvas, {rect.x - text * 0.8, y + text / 2},
        fmt::format("{:.{}f} m", std::fabs(height) < tick / 2 ? 0.0 : height, tick < 1 ? 1 : 0),
        {.size = text, .colour = kFaintInk, .align = Align::kRight});
  }
}

}  // namespace throng::render
