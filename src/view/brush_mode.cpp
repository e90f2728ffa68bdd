// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <limits>

#include "view/density_brush.h"
#include "view/ground_pick.h"
#include "view/viewer_state.h"

// Brushes on the ground: painting densities of goals, and the outline of a brush under the pointer.
namespace throng {
namespace {

constexpr double kFarthestStroke = 3000;  // [m] From the eye.
constexpr double kDabSpacing = 6;         // [px] Between two dabs of a stroke.
constexpr double kMaxDabs = 24;           // Per move of the pointer.

}  // namespace

std::optional<Vec3d> Viewer::State::ground_under(double x, double y) const {
  if (!panel.has_world) return std::nullopt;
  const view::SightLine line = sight_line(x, y);
  const double cut = panel.is_cut ? panel.cut : std::numeric_limits<double>::infinity();
  return view::ground_on(world, {line.eye + origin, line.direction}, cut, kFarthestStroke);
}

// Paints from the pointer's last position on, without gaps in fast strokes.
void Viewer::State::paint_to(double x, double y) {
  const double moved = std::hypot(x - mouse_x, y - mouse_y);
  const double dabs = std::clamp(std::ceil(moved / kDabSpacing), 1.0, kMaxDabs);
  const auto weight =
      static_cast<uint8_t>(panel.tool == view::Tool::kUnpaint
                               ? 0
                               : std::clamp(std::lround(panel.brush_weight * 255), 1L, 255L));
  bool changed = false;
  for (double k = 1; k <= dabs; ++k) {
    const double share = k / dabs;
    const auto where =
        ground_under(mouse_x + share * (x - mouse_x), mouse_y + share * (y - mouse_y));
    if (!where) continue;
    if (panel.has_crowd) {
      if (weight > 0) (void)view::map_at(painted, panel.bounds, where->y);
      for (DensityMap& map : painted)
        changed |= view::paint(map, *where, panel.brush_radius, weight);
    } else if (panel.scenario && !painted.empty()) {
      DensityMap& map = painted[static_cast<size_t>(panel.scenario->painted)];
      changed |= view::paint(map, *where, panel.brush_radius, weight);
    }
  }
  if (changed) ordered[static_cast<size_t>(view::Overlay::kPainted)] = false;
}

void Viewer::State::send_painted() {
  ordered[static_cast<size_t>(view::Overlay::kPainted)] = false;
  if (panel.has_crowd) {
    change_crowd(
        [maps = painted](view::CrowdPlayer& player, Context&) { player.set_density(maps); });
  } else if (panel.scenario && !painted.empty()) {
    const DensityMap& map = painted[static_cast<size_t>(panel.scenario->painted)];
    change_scenario([name = map.name, weights = map.weights](view::ScenarioPlayer& player) {
      return player.set_density(name, weights);
    });
  }
}

void Viewer::State::show_brush(double x, double y) {
  std::optional<Vec3d> where;
  if (panel.tool != view::Tool::kPick && panel.mode != view::CameraMode::kWalk)
    where = ground_under(x, y);
  if (!where && !brush_shown) return;
  brush_shown = where.has_value();
  Marks marks;
  const bool adds = panel.tool == view::Tool::kPaint || panel.tool == view::Tool::kSpawn;
  const Rgba colour = adds ? rgba(255, 255, 255, 230) : rgba(255, 120, 90, 230);
  if (where) marks = view::brush_marks(*where - origin, panel.brush_radius, colour);
  if (auto ok = drawing.set_marks(kBrushSlot, marks); !ok) panel.status.error = ok.error().message;
}

}  // namespace throng
