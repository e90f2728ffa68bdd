// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "import/formats/plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

// Builds ground, walls, roofs and plates from the polygons of a plan, which a sweep over the edges
// checks for crossings.
namespace throng {
namespace {

using Point = std::array<double, 2>;

struct Segment {
  importer::Vec2d a, b;
  size_t ring = 0;
};

double ring_area(const Ring& ring) {
  double area = 0;
  for (size_t i = 0; i < ring.size(); ++i) {
    const Point& a = ring[i];
    const Point& b = ring[(i + 1) % ring.size()];
    area += (a[0] - ring[0][0]) * (b[1] - ring[0][1]) - (a[1] - ring[0][1]) * (b[0] - ring[0][0]);
  }
  return area / 2;
}

bool cross_each_other(const Segment& s, const Segment& t) {
  return importer::orient(s.a, s.b, t.a) * importer::orient(s.a, s.b, t.b) < 0 &&
         importer::orient(t.a, t.b, s.a) * importer::orient(t.a, t.b, s.b) < 0;
}

importer::Vec2d crossing_point(const Segment& s, const Segment& t) {
  const importer::Vec2d d{s.b.x - s.a.x, s.b.y - s.a.y};
  const importer::Vec2d e{t.b.x - t.a.x, t.b.y - t.a.y};
  const double k = ((t.a.x - s.a.x) * e.y - (t.a.y - s.a.y) * e.x) / (d.x * e.y - d.y * e.x);
  return {s.a.x + k * d.x, s.a.y + k * d.y};
}

// The place where two edges of the polygon cross, in words, or nothing. Two edges are compared only
// while a line that sweeps from left to right touches both.
std::string find_crossing(const Polygon& polygon) {
  std::vector<Segment> segments;
  const auto add = [&](const Ring& ring, size_t index) {
    for (size_t i = 0; i < ring.size(); ++i) {
      const Point& p = ring[i];
      const Point& q = ring[(i + 1) % ring.size()];
      Segment segment{{p[0], p[1]}, {q[0], q[1]}, index};
      if (segment.b.x < segment.a.x) std::swap(segment.a, segment.b);
      segments.push_back(segment);
    }
  };
  add(polygon.outer, 0);
  for (size_t i = 0; i < polygon.holes.size(); ++i) add(polygon.holes[i], i + 1);
  std::stable_sort(segments.begin(), segments.end(),
                   [](const Segment& s, const Segment& t) { return s.a.x < t.a.x; });
  std::vector<size_t> active;
  uint64_t budget = 1'000'000'000;  // Beyond it the cut itself finds crossings.
  for (size_t i = 0; i < segments.size(); ++i) {
    const Segment& s = segments[i];
    std::erase_if(active, [&](size_t k) { return segments[k].b.x < s.a.x; });
    if (budget < active.size()) return {};
    budget -= active.size();
    for (const size_t k : active) {
      const Segment& t = segments[k];
      if (std::max(t.a.y, t.b.y) < std::min(s.a.y, s.b.y)) continue;
      if (std::min(t.a.y, t.b.y) > std::max(s.a.y, s.b.y)) continue;
      if (!cross_each_other(s, t)) continue;
      const char* fault = s.ring == t.ring ? "the outline crosses itself" : "two rings cross";
      const importer::Vec2d at = crossing_point(s, t);
      return fmt::format("{} near ({:.3f}, {:.3f})", fault, at.x, at.y);
    }
    active.push_back(i);
  }
  return {};
}

// The fault that makes the polygon unusable, in words, or nothing.
std::string find_fault(const Polygon& polygon) {
  const auto ring_fault = [](const Ring& ring) -> std::string {
    if (ring.size() < 3) return fmt::format("a ring has {} corners, needs 3", ring.size());
    for (const Point& p : ring) {
      if (!(std::fabs(p[0]) < 1e12 && std::fabs(p[1]) < 1e12)) return "a corner is not a number";
    }
    return ring_area(ring) != 0 ? "" : "a ring has no area";
  };
  if (std::string fault = ring_fault(polygon.outer); !fault.empty()) return fault;
  for (const Ring& hole : polygon.holes) {
    if (std::string fault = ring_fault(hole); !fault.empty()) return fault;
  }
  return find_crossing(polygon);
}

class PlanWriter {
 public:
  PlanWriter(importer::PlanAxes axes, importer::SceneWriter& writer)
      : axes_(axes), writer_(writer) {}

  // False if the rings overlap without crossing: a hole outside, or inside another hole.
  bool flat(const Polygon& polygon, double height, AreaKind kind) {
    points_.clear();
    rings_ = {0};
    const auto add = [&](const Ring& ring) {
      for (const Point& p : ring) points_.push_back(lift(p, height));
      rings_.push_back(static_cast<uint32_t>(points_.size()));
    };
    add(polygon.outer);
    for (const Ring& hole : polygon.holes) add(hole);
    cut_.clear();
    const bool exact = cutter_.cut(points_, rings_, cut_);
    const auto base = static_cast<uint32_t>(writer_.scene().positions.size());
    for (const Vec3d& p : points_) writer_.add_vertex(p);
    for (const auto& [a, b, c] : cut_) writer_.add_triangle(base + a, base + b, base + c);
    paint(kind);
    return exact;
  }

  void walls(const Ring& line, bool closed, double low, double high) {
    for (size_t i = 0; i + (closed ? 0 : 1) < line.size(); ++i) {
      const Point& p = line[i];
      const Point& q = line[(i + 1) % line.size()];
      const uint32_t a = writer_.add_vertex(lift(p, low));
      const uint32_t b = writer_.add_vertex(lift(q, low));
      const uint32_t c = writer_.add_vertex(lift(q, high));
      const uint32_t d = writer_.add_vertex(lift(p, high));
      writer_.add_triangle(a, b, c);
      writer_.add_triangle(a, c, d);
    }
    paint(kAreaBlocked);
  }

 private:
  [[nodiscard]] Vec3d lift(const Point& p, double height) const {
    return axes_ == importer::PlanAxes::kXZ ? Vec3d{p[0], height, p[1]} : Vec3d{p[0], p[1], height};
  }
  void paint(AreaKind kind) { writer_.scene().area.resize(writer_.scene().triangles.size(), kind); }

  importer::PlanAxes axes_;
  importer::SceneWriter& writer_;
  importer::PolygonCutter cutter_;
  std::vector<Vec3d> points_;
  std::vector<uint32_t> rings_;
  std::vector<std::array<uint32_t, 3>> cut_;
};

}  // namespace

Result<void> importer::write_plan(const importer::Plan& plan, importer::PlanAxes axes,
                                  double ground_height, double plate_height,
                                  importer::SceneWriter& writer) {
  PlanWriter out(axes, writer);
  const auto refuse = [](const importer::Plan::Area& area, const std::string& why) {
    return Error{Errc::kBadInput, fmt::format("{}: {}; draw it again", area.place, why)};
  };
  const char* overlap = "a hole lies outside the polygon or over another hole";
  for (const importer::Plan::Area& area : plan.ground) {
    if (const std::string fault = find_fault(area.polygon); !fault.empty()) {
      return refuse(area, fault);
    }
    writer.begin_part("ground", "ground");
    if (!out.flat(area.polygon, ground_height, kAreaWalkable)) return refuse(area, overlap);
    writer.begin_part("obstacle", "obstacle");
    for (const Ring& hole : area.polygon.holes) {
      out.walls(hole, true, ground_height, ground_height + area.height);
      out.flat({hole, {}}, ground_height + area.height, kAreaBlocked);
    }
  }
  for (const importer::Plan::Area& area : plan.obstacles) {
    if (const std::string fault = find_fault(area.polygon); !fault.empty()) {
      return refuse(area, fault);
    }
    writer.begin_part("obstacle", "obstacle");
    const double top = ground_height + area.height;
    if (!out.flat(area.polygon, top, kAreaBlocked)) return refuse(area, overlap);
    out.flat(area.polygon, ground_height + std::min(plate_height, area.height / 2), kAreaBlocked);
    out.walls(area.polygon.outer, true, ground_height, top);
    for (const Ring& court : area.polygon.holes) out.walls(court, true, ground_height, top);
  }
  if (!plan.walls.empty()) writer.begin_part("wall", "wall");
  for (const importer::Plan::Wall& wall : plan.walls) {
    out.walls(wall.line, false, ground_height, ground_height + wall.height);
  }
  return {};
}

Result<Scene> create_plane_scene(const PlaneConfig& config) {
  if (!(config.obstacle_height > 0 && config.obstacle_height <= 1e6 &&
        std::fabs(config.ground_height) <= 1e6)) {
    return Error{Errc::kBadConfig, "plane: need obstacle_height > 0 and a finite ground_height"};
  }
  importer::Plan plan;
  plan.ground.push_back({config.ground, config.obstacle_height, "plane: the ground"});
  for (size_t i = 0; i < config.obstacles.size(); ++i) {
    plan.obstacles.push_back(
        {config.obstacles[i], config.obstacle_height, fmt::format("plane: obstacle {}", i)});
  }
  importer::ReadOptions options;
  options.name = "plane";
  importer::SceneWriter writer(options);
  constexpr double kPlate = 0.05;  // [m] No avatar fits below it.
  if (auto done =
          importer::write_plan(plan, importer::PlanAxes::kXZ, config.ground_height, kPlate, writer);
      !done) {
    return done.error();
  }
  return writer.finish();
}

}  // namespace throng
