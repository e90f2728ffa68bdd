// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "render/canvas.h"
#include "render/marks.h"
#include "render/text.h"
#include "throng/papers.h"

// [CAACD] figure 9, in colours: the fill of an avatar shows its state.
namespace throng::caacd {
namespace {

constexpr std::array<std::pair<Activity, const char*>, 5> kActivities{
    {{Activity::kTravelling, "travelling"},
     {Activity::kAvoiding, "avoiding"},
     {Activity::kArriving, "arriving"},
     {Activity::kWaiting, "waiting"},
     {Activity::kArrived, "arrived"}}};

render::Rgb colour_of(Activity activity) {
  switch (activity) {
    case Activity::kTravelling:
      return {0, 114, 178};
    case Activity::kAvoiding:
      return {213, 94, 0};
    case Activity::kArriving:
      return {0, 158, 115};
    case Activity::kWaiting:
      return {204, 121, 167};
    case Activity::kArrived:
      return {118, 124, 134};
  }
  return render::kInk;
}

struct View {
  double unit = 1;  // Of the picture, as in other pictures.
  double scale = 1, left = 0, top = 0;
  [[nodiscard]] render::Point operator()(Vec3d p) const {
    return {left + p.x * scale, top + p.z * scale};
  }
};

void draw_ring(render::Canvas& canvas, render::Point centre, double radius, double line,
               render::Rgb colour) {
  constexpr int kCorners = 40;
  std::vector<render::Point> points;
  for (int i = 0; i <= kCorners; ++i) {
    const double angle = 2 * std::numbers::pi * i / kCorners;
    points.push_back({centre.x + radius * std::cos(angle), centre.y + radius * std::sin(angle)});
  }
  canvas.path(points, line, colour);
}

void draw_target(render::Canvas& canvas, render::Point at, double unit) {
  draw_ring(canvas, at, 5 * unit, std::max(1.0, 1.2 * unit), render::kInk);
  canvas.disc(at, 1.8 * unit, render::kInk);
}

void draw_avatar(render::Canvas& canvas, const View& view, const Body& body, Activity activity,
                 const Model& model) {
  const render::Point at = view(body.position);
  const double thin = std::max(0.8, 0.9 * view.unit);
  if (activity != Activity::kArrived) {
    draw_ring(canvas, at, body.fields.alert * view.scale, thin, render::kRule);
    draw_ring(canvas, at, body.fields.precaution * view.scale, thin, render::kHatch);
    // The probe: two lines ahead, as wide as the repulsive field.
    const Vec3d right = right_of(body.forward) * body.fields.repulsive;
    const Vec3d ahead = body.forward * probe_length(body, model);
    for (const Vec3d& side : {right, right * -1}) {
      canvas.line(view(body.position + side), view(body.position + side + ahead), thin,
                  render::kFaintInk);
    }
  }
  canvas.disc(at, body.fields.repulsive * view.scale, colour_of(activity));
  canvas.line(at, view(body.position + body.forward * (1.5 * body.fields.repulsive)),
              1.8 * view.unit, render::kInk);
}

}  // namespace

Result<Image> draw_simulation(const Simulation& simulation,
                              std::span<const std::vector<Vec3d>> trails,
                              const PictureConfig& config) {
  if (!(config.side > 0 && config.side < 1e9 && config.width >= 400 && config.width <= 8000)) {
    return Error{Errc::kBadConfig, "picture: need a side above 0 and a width from 400 to 8000 px"};
  }
  View view;
  view.unit = config.width / 1200.0;
  const double u = view.unit;
  view.left = 50 * u;
  view.top = 130 * u;
  view.scale = (config.width - 2 * view.left) / config.side;
  render::Canvas canvas(config.width,
                        static_cast<int32_t>(config.width - 2 * view.left + view.top + 60 * u),
                        render::kPaper);
  render::draw_text(canvas, {view.left, 54 * u}, config.title, {.size = 19 * u, .bold = true});
  const Counts& counts = simulation.counts();
  render::draw_text(canvas, {view.left, 84 * u},
                    fmt::format("frame {}: {} collisions, {} with obstacles; {} of {} have arrived",
                                counts.frames, counts.collisions, counts.obstacle_collisions,
                                counts.arrived, simulation.bodies().size()),
                    {.size = 11 * u, .colour = render::kFaintInk});
  double x = view.left;
  for (const auto& [activity, name] : kActivities) {
    canvas.disc({x + 6 * u, 106 * u}, 6 * u, colour_of(activity));
    render::draw_text(canvas, {x + 18 * u, 111 * u}, name, {.size = 11 * u});
    x += 42 * u + render::text_width(name, {.size = 11 * u});
  }
  draw_target(canvas, {x + 6 * u, 106 * u}, u);
  render::draw_text(canvas, {x + 18 * u, 111 * u}, "target", {.size = 11 * u});

  const double shown = config.side * view.scale;
  canvas.frame({view.left - 1, view.top - 1, shown + 2, shown + 2}, 1, render::kRule);
  for (const Obstacle& o : simulation.obstacles()) {
    draw_ring(canvas, view(o.position), o.fields.precaution * view.scale, std::max(1.0, u),
              render::kHatch);
    canvas.disc(view(o.position), o.fields.repulsive * view.scale, render::kNoStanding);
  }
  for (size_t i = 0; i < std::min(trails.size(), simulation.bodies().size()); ++i) {
    std::vector<render::Point> points;
    for (const Vec3d& p : trails[i]) points.push_back(view(p));
    const render::Rgb colour =
        render::mix(colour_of(simulation.activities()[i]), render::kPaper, 0.55);
    // Piece by piece: a long line drawn as one would be tested as a whole for each pixel around it.
    for (size_t k = 1; k < points.size(); ++k) {
      canvas.line(points[k - 1], points[k], std::max(1.0, 1.2 * u), colour);
    }
  }
  for (const Vec3d& target : simulation.targets()) draw_target(canvas, view(target), u);
  for (size_t i = 0; i < simulation.bodies().size(); ++i) {
    draw_avatar(canvas, view, simulation.bodies()[i], simulation.activities()[i],
                simulation.model());
  }
  return std::move(canvas).take();
}

}  // namespace throng::caacd
