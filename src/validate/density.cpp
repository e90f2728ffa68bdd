// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "core/random.h"
#include "validate/plane_crowd.h"
#include "validate/statistics.h"
#include "validate/tests.h"

// Speed by density (fundamental diagram) of a crowd that walks in one direction around a ring: it
// has no ends that could slow the avatars down or let them leave. Density and speed as in [SS10].
namespace throng::validate {
namespace {

constexpr double kMiddle = 16, kWidth = 6;  // [m] of the ring
constexpr double kSide = 2 * (kMiddle + kWidth / 2) + 2;
constexpr double kMeasured = 4;  // [m] of its width: the parts near the walls are left out
constexpr int32_t kCorners = 180;

Ring circle(double radius) {
  Ring ring;
  for (int32_t k = 0; k < kCorners; ++k) {
    const double angle = 2 * std::numbers::pi * k / kCorners;
    ring.push_back({kSide / 2 + radius * std::cos(angle), kSide / 2 + radius * std::sin(angle)});
  }
  return ring;
}

PlaneConfig ring_plane() {
  PlaneConfig plane;
  plane.ground = box(0, 0, kSide, kSide);
  const double outer = kMiddle + kWidth / 2;
  plane.obstacles.push_back({.outer = circle(outer + 0.5), .holes = {circle(outer)}});
  plane.obstacles.push_back({.outer = circle(kMiddle - kWidth / 2), .holes = {}});
  return plane;
}

// Start points in rows around the ring, as far apart as the density allows, with random offsets
// within the free space.
std::vector<Point2> rows(double density, double radius, uint64_t seed) {
  const double width = kWidth - 2 * (radius + 2 * kCell);
  // Centres fill less than the width of the ring: the measured density is what counts.
  const double apart = std::max(1 / std::sqrt(density), 2 * radius + 0.004);
  const auto count = static_cast<int32_t>(width / apart) + 1;
  const double between = count > 1 ? width / (count - 1) : width;
  const double along = 1 / (density * between);
  std::vector<Point2> starts;
  for (int32_t row = 0; row < count; ++row) {
    const double r = kMiddle - width / 2 + between * row;
    const auto fit = static_cast<int32_t>(2 * std::numbers::pi * r / along);
    const double spare = std::max(0.0, std::min(along, between) - 2 * radius - 0.004);
    for (int32_t k = 0; k < fit; ++k) {
      const uint64_t n = starts.size();
      const double shift = 0.5 * spare * (random_unit(seed, 1, n) - 0.5);
      const double angle = (2 * std::numbers::pi * (k + 0.37 * row) / fit) + shift / r;
      const double off = 0.5 * spare * (random_unit(seed, 2, n) - 0.5);
      starts.push_back(
          {kSide / 2 + (r + off) * std::cos(angle), kSide / 2 + (r + off) * std::sin(angle)});
    }
  }
  return starts;
}

struct DiagramPoint {
  double density = 0;  // [1/m2]
  double speed = 0;    // [m/s]
  [[nodiscard]] double flow() const { return density * speed; }
};

struct Walk {
  double radius = 0, speed = 0;     // of the bodies [m, m/s]
  double warm = 30, measured = 30;  // [s]
};

// Each avatar prefers a velocity along the circle at its present distance from the middle.
Result<DiagramPoint> walk_around(const Walk& walk, double density, const ValidationConfig& config,
                                 ValidationResult& result, Context& context) {
  AvatarClass body;
  body.radius = walk.radius;
  body.speed = walk.speed;
  auto crowd = PlaneCrowd::create(ring_plane(), body, Routing::kStraight, config, context);
  if (!crowd) return crowd.error();
  const auto ids = crowd->add_fitting(rows(density, walk.radius, config.seed), 0, context);
  if (!ids) return ids.error();
  std::vector<AvatarId> walking;
  std::vector<Vec3d> velocities;
  double inside = 0, speeds = 0;
  uint64_t steps = 0;
  while (crowd->time() < walk.warm + walk.measured - 1e-9) {
    walking.clear();
    velocities.clear();
    for (const AvatarMotion& s : crowd->avatars()) {
      const double x = s.x - kSide / 2, z = s.z - kSide / 2;
      const double r = std::hypot(x, z);
      // The chord of one step along that circle.
      const double angle = walk.speed * PlaneCrowd::kStep / r;
      const double tx = x * std::cos(angle) - z * std::sin(angle) - x;
      const double tz = x * std::sin(angle) + z * std::cos(angle) - z;
      const double size = walk.speed / std::hypot(tx, tz);
      walking.push_back(s.id);
      velocities.push_back({tx * size, 0, tz * size});
    }
    crowd->set_velocities(walking, velocities);
    crowd->step();
    if (context.cancel) return Error{Errc::kCancelled, "cancelled"};
    if (crowd->time() <= walk.warm) continue;
    ++steps;
    for (const AvatarMotion& s : crowd->avatars()) {
      const double x = s.x - kSide / 2, z = s.z - kSide / 2;
      const double r = std::hypot(x, z);
      if (std::abs(r - kMiddle) > kMeasured / 2) continue;
      inside += 1;
      speeds += (s.vz * x - s.vx * z) / r;
    }
  }
  crowd->report(result);
  const double area = 2 * std::numbers::pi * kMiddle * kMeasured;
  return DiagramPoint{inside / (area * static_cast<double>(steps)), speeds / inside};
}

std::string at_density(const char* what, double density) {
  return fmt::format("{} at {:.2f} /m2", what, density);
}

ValidationChart diagram(const std::string& name, const std::string& title,
                        const std::vector<DiagramPoint>& points, bool flow) {
  ValidationChart chart;
  chart.name = name;
  chart.chart.title = title;
  chart.chart.x_title = "density, 1/m2";
  chart.chart.y_title = flow ? "flow, p/(m s)" : "speed, m/s";
  if (!flow) chart.chart.max = 1.6;  // room for the legend
  ChartLine ours{.name = "throng", .kind = LineKind::kStrong};
  ChartLine theirs{.name = "[Weidmann93]", .kind = LineKind::kDashed};
  for (const DiagramPoint& p : points) {
    chart.chart.x.push_back(p.density);
    ours.values.push_back(std::max(0.0, flow ? p.flow() : p.speed));
    const double speed = weidmann(p.density);
    theirs.values.push_back(flow ? speed * p.density : speed);
  }
  chart.chart.lines = {std::move(theirs), std::move(ours)};
  return chart;
}

Result<std::vector<DiagramPoint>> diagram_of(const Walk& walk, std::vector<double> densities,
                                             const ValidationConfig& config,
                                             ValidationResult& result, Context& context) {
  std::vector<DiagramPoint> points;
  for (const double density : densities) {
    const auto point = walk_around(walk, density, config, result, context);
    if (!point) return point.error();
    points.push_back(*point);
  }
  return points;
}

Walk walk_of(const AvatarClass& body, const ValidationConfig& config) {
  return {.radius = body.radius,
          .speed = body.speed,
          .warm = config.brief ? 10.0 : 30.0,
          .measured = config.brief ? 10.0 : 30.0};
}

Result<ValidationResult> fundamental(const ValidationConfig& config, Context& context) {
  ValidationResult result;
  std::vector<double> densities{0.25, 0.5, 0.75, 1, 1.5, 2, 2.5, 3, 3.5};
  if (config.brief) densities = {0.5, 1, 1.5, 2, 2.6, 3.2, 3.7};
  const auto points = diagram_of(walk_of({}, config), densities, config, result, context);
  if (!points) return points.error();
  double error = 0, largest = 0;
  for (const DiagramPoint& p : *points) {
    const double wanted = weidmann(p.density);
    error += std::abs(p.speed - wanted) / wanted / static_cast<double>(points->size());
    largest = std::max(largest, p.flow());
    result.measures.push_back(
        {.name = at_density("speed", p.density), .value = p.speed, .unit = "m/s"});
    result.measures.push_back(
        {.name = at_density("of [Weidmann93]", p.density), .value = p.speed / wanted});
  }
  result.measures.push_back({.name = "mean error against [Weidmann93]",
                             .value = 100 * error,
                             .unit = "%",
                             .low = 0,
                             .high = 10});
  result.measures.push_back({.name = "largest flow", .value = largest, .unit = "p/(m s)"});
  result.charts.push_back(
      diagram("fundamental_speed", "Speed by density, one way", *points, false));
  result.charts.push_back(diagram("fundamental_flow", "Flow by density, one way", *points, true));
  return result;
}

// RiMEA 4 requires densities up to 6 people a square metre.
Result<ValidationResult> fundamental_dense(const ValidationConfig& config, Context& context) {
  ValidationResult result;
  std::vector<double> densities{0.5, 1, 2, 3, 4, 5, 6};
  if (config.brief) densities = {1, 3, 6};
  const auto points = diagram_of(walk_of({}, config), densities, config, result, context);
  if (!points) return points.error();
  double rises = 0;
  for (size_t i = 0; i < points->size(); ++i) {
    const DiagramPoint& p = (*points)[i];
    result.measures.push_back(
        {.name = at_density("speed", p.density), .value = p.speed, .unit = "m/s"});
    if (i > 0) rises = std::max(rises, p.speed - (*points)[i - 1].speed);
  }
  result.measures.push_back({.name = "largest rise of speed with density",
                             .value = rises,
                             .unit = "m/s",
                             .low = 0,
                             .high = 0});
  result.measures.push_back(
      {.name = "densest", .value = points->back().density, .unit = "1/m2", .low = 5, .high = 7});
  result.charts.push_back(
      diagram("fundamental_dense", "Speed by density up to 6 /m2", *points, false));
  return result;
}

constexpr const char* kMethod =
    "A ring 6 m wide, middle 16 m from its centre, desired speed 1.34 m/s around it. "
    "After 30 s, over 30 s: classic density and mean speed along the ring in the 4 m around its "
    "middle line, each step [SS10].";

const std::array<Test, 2> kDensityTests{Test{{"fundamental", "Speed by density, 0.25 to 3.5 /m2",
                                              kMethod, "[Weidmann93], mean error at most 10 %"},
                                             fundamental},
                                        Test{{"fundamental-dense", "Speed by density up to 6 /m2",
                                              kMethod, "RiMEA 4: speed falls as density rises"},
                                             fundamental_dense}};

}  // namespace

std::span<const Test> density_tests() { return kDensityTests; }

}  // namespace throng::validate
