// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "view/overlays.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <tuple>

#include "core/random.h"
#include "throng/path.h"
#include "throng/surface.h"

// Each overlay is a list of triangles and lines, linear in cells, nodes or avatars.
namespace throng::view {
namespace {

constexpr double kOverlayHeight = 0.04;      // [m] over the ground
constexpr size_t kMaxVertices = 12'000'000;  // Vertices; further marks are left out.

MarkVertex at(Vec3d p, Rgba colour) {
  return {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z), colour};
}

void add_quad(Marks& marks, Vec3d a, Vec3d b, Vec3d c, Vec3d d, Rgba colour) {
  for (const Vec3d& p : {a, b, c, a, c, d}) marks.triangles.push_back(at(p, colour));
}

void add_line(Marks& marks, Vec3d a, Vec3d b, Rgba colour) {
  marks.lines.push_back(at(a, colour));
  marks.lines.push_back(at(b, colour));
}

// From red over yellow and green to blue, as 0 goes to 1.
Rgba ramp(double share, uint32_t alpha) {
  const double hue = std::clamp(share, 0.0, 1.0) * 4;
  const auto byte = [](double v) {
    return static_cast<uint32_t>(std::lround(std::clamp(v, 0.0, 1.0) * 235));
  };
  return rgba(byte(2 - hue), byte(hue < 2 ? 0.15 + hue * 0.8 : 3.6 - hue), byte(hue - 2.4), alpha);
}

Rgba own_colour(uint64_t number, uint32_t alpha) {
  const double hue = 6 * random_unit(21, 0, number);
  const auto byte = [hue](double middle) {
    const double away = std::min(std::abs(hue - middle), 6 - std::abs(hue - middle));
    return static_cast<uint32_t>(70 + std::lround(170 * std::clamp(2 - away, 0.0, 1.0)));
  };
  return rgba(byte(0), byte(2), byte(4), alpha);
}

// Runs of cells of one colour along x whose floors lie on a line become one quad.
template <class ColourOf>
void add_tile(Marks& marks, const LevelTileContent& tile, const WorldSummary& summary, Vec3d origin,
              ColourOf colour_of) {
  const double cell = summary.cell;
  const auto height = [&](size_t i) { return tile.floor[i] * 1e-3 + kOverlayHeight; };
  for (int32_t row = 0; row < kTileCells; ++row) {
    int32_t end = 0;
    for (int32_t begin = 0; begin < kTileCells; begin = std::max(end, begin + 1)) {
      const auto first = static_cast<size_t>(row * kTileCells + begin);
      const Rgba colour = colour_of(first);
      end = begin;
      if (colour == 0) continue;
      double rise = 0;
      while (end < kTileCells) {
        const auto i = static_cast<size_t>(row * kTileCells + end);
        if (colour_of(i) != colour) break;
        const int32_t run = end - begin;
        if (run == 1) rise = height(i) - height(first);
        if (std::abs(height(i) - height(first) - rise * run) > 0.015 || std::abs(rise) > cell) {
          break;
        }
        ++end;
      }
      if (end == begin) end = begin + 1;
      if (end == begin + 1) rise = 0;
      const double x0 = summary.origin.x + (tile.tile_x * kTileCells + begin) * cell - origin.x;
      const double z0 = summary.origin.z + (tile.tile_z * kTileCells + row) * cell - origin.z;
      const double x1 = x0 + (end - begin) * cell, z1 = z0 + cell;
      const double y0 = summary.origin.y - origin.y + height(first) - 0.5 * rise;
      const double y1 = y0 + (end - begin) * rise;
      add_quad(marks, {x0, y0, z0}, {x0, y0, z1}, {x1, y1, z1}, {x1, y1, z0}, colour);
    }
  }
}

}  // namespace

const char* word_for(Overlay overlay) {
  static constexpr std::array<const char*, kOverlays> kWords = {
      "Clearance", "Levels",     "Nodes",   "Links",  "Air",       "Density",
      "Path",      "Neighbours", "Painted", "Fields", "Cylinders", "Boxes"};
  return kWords[static_cast<size_t>(overlay)];
}

const char* legend_of(Overlay overlay) {
  static constexpr std::array<const char*, kOverlays> kLegends = {
      "Where the first class may stand: red beside blockers, blue where the clearance is largest",
      "Levels, each in its colour",
      "Terminal nodes: green level, red steep. A world baked with --nodes has them",
      "Between nodes: white walk, orange step, magenta climb, blue off-mesh link, red drop link",
      "Where a flyer's feet may be, at the height of the cut. A world baked with a flying class "
      "has it",
      "Avatars per square metre, over 2 m: blue few, red four and more",
      "The shortest path of the picked avatar to its goal",
      "The avatars within 5 m of the picked avatar",
      "Weights of goals, painted with the brush or by the scenario; the larger, the more opaque",
      "Protection fields of [CAACD] and the probe ahead: green tolerable, yellow alert, orange "
      "critical, red collision",
      "Cylinders of terminal nodes: as wide and as high as these promise; green level, red steep",
      "Free boxes of the air's octree: red small, blue large. A world baked with a flying class "
      "has "
      "them"};
  return kLegends[static_cast<size_t>(overlay)];
}

Marks clearance_marks(const World& world, int32_t avatar_class, Vec3d origin, Context& context) {
  Marks marks;
  const WorldSummary summary = world.summary();
  const uint32_t tiles = world.level_tile_count();
  for (uint32_t t = 0; t < tiles && !context.cancel && marks.triangles.size() < kMaxVertices; ++t) {
    const LevelTileContent tile = world.level_tile(t);
    const auto& clearance = tile.clearance[static_cast<size_t>(avatar_class)];
    add_tile(marks, tile, summary, origin,
             [&](size_t i) { return clearance[i] == 0 ? 0 : ramp((clearance[i] - 1) / 7.0, 150); });
    if (context.on_progress) context.on_progress({"clearance", t, tiles});
  }
  return marks;
}

Marks level_marks(const World& world, Vec3d origin, Context& context) {
  Marks marks;
  const WorldSummary summary = world.summary();
  const std::vector<int32_t> storeys = world.storeys();
  const uint32_t tiles = world.level_tile_count();
  for (uint32_t t = 0; t < tiles && !context.cancel && marks.triangles.size() < kMaxVertices; ++t) {
    const LevelTileContent tile = world.level_tile(t);
    const Rgba colour = own_colour(static_cast<uint64_t>(storeys[t]), 150);
    add_tile(marks, tile, summary, origin, [&](size_t i) {
      const bool is_legal = std::any_of(tile.clearance.begin(), tile.clearance.end(),
                                        [i](const auto& of_class) { return of_class[i] > 0; });
      return is_legal ? colour : 0;
    });
    if (context.on_progress) context.on_progress({"levels", t, tiles});
  }
  return marks;
}

namespace {

// Of the ground between four corners, in the order around it. [degrees]
double inclination_of(const std::array<Vec3d, 4>& c) {
  const Vec3d normal = cross(c[2] - c[0], c[3] - c[1]);
  const double size = length(normal);
  return size > 0 ? std::acos(std::min(1.0, std::fabs(normal.y) / size)) * 180 / std::numbers::pi
                  : 0;
}

}  // namespace

Marks node_marks(const Nodes& nodes, Vec3d origin, DrawnNodes& drawn, Context& context) {
  Marks marks;
  const NodeBins& bins = drawn.bins;
  const Vec3d lift{0, kOverlayHeight, 0};
  std::vector<std::array<Vec3d, 4>> squares;
  for (uint32_t n = 0; n < nodes.node_count() && !context.cancel; ++n) {
    const NodeInfo info = nodes.node(n);
    if (!info.terminal || info.classes == 0 || marks.triangles.size() > kMaxVertices) continue;
    squares.clear();
    // A partial node is drawn row by row.
    for_node_squares(nodes, n, info, [&](std::array<Vec3d, 4> c) {
      squares.push_back(c);
      for (Vec3d& p : c) p = p - origin + lift;
      // The inclination of a node of a level tile is a limit of a class: the floor may be less
      // steep.
      double steep = bins.inclination_of(info.inclination);
      if (info.kind == PatchKind::kLevelTile) steep = std::min(steep, inclination_of(c));
      const Rgba colour = ramp(0.5 - 0.5 * std::min(1.0, steep / 90), 110);
      add_quad(marks, c[0], c[1], c[2], c[3], colour);
      if (info.cells != 0) return;
      const Rgba rim = rgba(255, 255, 255, 150);
      for (size_t k = 0; k < 4; ++k) add_line(marks, c[k], c[(k + 1) % 4], rim);
    });
    drawn.add(n, squares);
  }
  marks.line_width = 1;
  return marks;
}

Marks cylinder_marks(const Nodes& nodes, Vec3d origin, Context& context) {
  Marks marks;
  const NodeBins bins = nodes.summary().bins;
  for (uint32_t n = 0; n < nodes.node_count() && !context.cancel; ++n) {
    const NodeInfo info = nodes.node(n);
    if (!info.terminal || marks.triangles.size() > kMaxVertices / 2) continue;
    const auto cylinder = nodes.cylinder(n);
    if (!cylinder) continue;
    const double steep = info.kind == PatchKind::kLevelTile
                             ? 0
                             : std::min(1.0, bins.inclination_of(info.inclination) / 90);
    const double share = 0.5 - 0.5 * steep;
    add_cylinder(marks, *cylinder, origin, ramp(share, 45), ramp(share, 190));
  }
  marks.line_width = 1;
  return marks;
}

Result<Marks> box_marks(const World& world, Vec3d origin) {
  const Result<std::vector<Box3d>> boxes = air_boxes(world);
  if (!boxes) return boxes.error();
  Marks marks;
  for (const Box3d& box : *boxes) {
    if (marks.lines.size() > kMaxVertices) break;
    const double side = box.max.x - box.min.x;
    // Neighbours' edges lie beside each other.
    const double in = 0.04 * side;
    const Vec3d inset{in, std::min(in, 0.2 * (box.max.y - box.min.y)), in};
    const Vec3d low = box.min + inset - origin, high = box.max - inset - origin;
    const Rgba colour = ramp(std::log2(side / 0.25) / 6, 200);
    const auto corner = [&](int32_t k) {
      return Vec3d{(k & 1) != 0 ? high.x : low.x, (k & 2) != 0 ? high.y : low.y,
                   (k & 4) != 0 ? high.z : low.z};
    };
    for (int32_t k = 0; k < 8; ++k) {
      for (const int32_t axis : {1, 2, 4}) {
        if ((k & axis) == 0) add_line(marks, corner(k), corner(k | axis), colour);
      }
    }
  }
  marks.line_width = 1;
  return marks;
}

Marks link_marks(const Nodes& nodes, Vec3d origin, Context& context) {
  Marks marks;
  const Vec3d lift = Vec3d{0, 3 * kOverlayHeight, 0} - origin;
  for (uint32_t n = 0; n < nodes.node_count() && !context.cancel; ++n) {
    for (const NodeArc& arc : nodes.arcs(n)) {
      // An undirected link has two arcs: one is drawn. Drop links have one.
      const bool drops = arc.kind == LinkKind::kDrop;
      if ((arc.to < n && !drops) || marks.lines.size() > kMaxVertices) continue;
      if (drops) {
        const Rgba colour = rgba(230, 40, 40, 255);
        const Vec3d from = nodes.point(n, arc.from_s, arc.from_t) + lift;
        const Vec3d to = nodes.point(arc.to, arc.to_s, arc.to_t) + lift, over{to.x, from.y, to.z};
        add_line(marks, from, over, colour);
        add_line(marks, over, to, colour);
        continue;
      }
      Rgba colour = rgba(255, 255, 255, 170);
      if (arc.kind == LinkKind::kStep) colour = rgba(255, 150, 30, 220);
      if (arc.kind == LinkKind::kClimb) colour = rgba(240, 60, 220, 220);
      if (arc.kind == LinkKind::kOffMesh) colour = rgba(60, 130, 255, 255);
      add_line(marks, nodes.middle(n) + lift, nodes.middle(arc.to) + lift, colour);
    }
  }
  marks.line_width = 1.2F;
  return marks;
}

Result<Marks> air_marks(const World& world, double height, Vec3d origin, Context& context) {
  const WorldSummary summary = world.summary();
  const auto flyer = std::find_if(summary.classes.begin(), summary.classes.end(),
                                  [](const AvatarClass& c) { return c.flies; });
  if (flyer == summary.classes.end()) {
    return Error{Errc::kNotFound, "air: no class of this world flies; bake it with one that does"};
  }
  PathConfig config;
  config.avatar_class = static_cast<int32_t>(flyer - summary.classes.begin());
  Result<PathFinder> finder = PathFinder::create(world, config, context);
  if (!finder) return finder.error();
  const Result<AirSummary> air = air_summary(world);
  if (!air) return air.error();
  // At most a million cells: larger worlds get a coarser lattice.
  const Box3d& box = summary.bounds;
  const double area = (box.max.x - box.min.x) * (box.max.z - box.min.z);
  const double cell = std::max(air->cell, std::sqrt(area / 1e6));
  Marks marks;
  const double y = height - origin.y;
  for (double z = box.min.z; z < box.max.z && !context.cancel; z += cell) {
    double begin = box.min.x;
    bool open = false;
    for (double x = box.min.x; x < box.max.x + cell; x += cell) {
      const bool legal =
          x < box.max.x && finder->is_free(Vec3d{x + cell / 2, height, z + cell / 2}, 0);
      if (legal && !open) begin = x;
      if (!legal && open) {
        const double x0 = begin - origin.x, x1 = x - origin.x, z0 = z - origin.z;
        add_quad(marks, {x0, y, z0}, {x0, y, z0 + cell}, {x1, y, z0 + cell}, {x1, y, z0},
                 rgba(90, 170, 255, 95));
      }
      open = legal;
    }
  }
  return marks;
}

Marks density_marks(const TimelineFrame& crowd) {
  constexpr double kSide = 2, kStorey = 2.5, kMaxDensity = 4;
  struct Square {
    uint32_t avatars = 0;
    float lowest = 1e30F;
  };
  std::map<std::tuple<int32_t, int32_t, int32_t>, Square> squares;
  const auto step = [](double v, double side) {
    return static_cast<int32_t>(std::floor(v / side));
  };
  for (size_t i = 0; i < crowd.size(); ++i) {
    Square& square = squares[{step(crowd.y[i] + 0.5, kStorey), step(crowd.z[i], kSide),
                              step(crowd.x[i], kSide)}];
    ++square.avatars;
    square.lowest = std::min(square.lowest, crowd.y[i]);
  }
  Marks marks;
  for (const auto& [key, square] : squares) {
    const double x = std::get<2>(key) * kSide, z = std::get<1>(key) * kSide;
    const double y = square.lowest + kOverlayHeight, density = square.avatars / (kSide * kSide);
    add_quad(marks, {x, y, z}, {x, y, z + kSide}, {x + kSide, y, z + kSide}, {x + kSide, y, z},
             ramp(1 - density / kMaxDensity, 150));
  }
  return marks;
}

Marks painted_marks(const World& world, const std::vector<DensityMap>& maps, Vec3d origin,
                    Context& context) {
  Marks marks;
  const auto classes = static_cast<int32_t>(world.summary().classes.size());
  for (const DensityMap& map : maps) {
    const double wide = (map.x1 - map.x0) / map.width, deep = (map.z1 - map.z0) / map.height;
    // A map of all heights is shown on the highest floor of each place.
    const double low = std::max(map.low, world.summary().bounds.min.y - 1);
    const double high = std::min(map.high, world.summary().bounds.max.y + 1);
    const double middle = 0.5 * (low + high), tolerance = 0.5 * (high - low);
    for (size_t i = 0; i < map.weights.size() && !context.cancel; ++i) {
      if (map.weights[i] == 0 || marks.triangles.size() > kMaxVertices) continue;
      const auto column = static_cast<double>(i % static_cast<size_t>(map.width));
      const auto row = static_cast<double>(i / static_cast<size_t>(map.width));
      const double x = map.x0 + column * wide, z = map.z0 + row * deep;
      Place place;
      for (int32_t c = 0; c < classes && !place; ++c) {
        place = world.find_place(c, {x + wide / 2, middle, z + deep / 2}, tolerance);
      }
      if (!place) continue;
      const double y = place.position.y + kOverlayHeight;
      const Vec3d o = origin;
      const auto alpha = static_cast<uint32_t>(60 + 130 * map.weights[i] / 255);
      add_quad(marks, Vec3d{x, y, z} - o, Vec3d{x, y, z + deep} - o,
               Vec3d{x + wide, y, z + deep} - o, Vec3d{x + wide, y, z} - o,
               rgba(235, 60, 170, alpha));
    }
  }
  return marks;
}

Marks brush_marks(Vec3d where, double radius, Rgba colour) {
  Marks marks;
  constexpr int32_t kSides = 48;
  const auto rim = [&](int32_t n) {
    const double angle = 2 * std::numbers::pi * n / kSides;
    return where + Vec3d{radius * std::cos(angle), 0.1, radius * std::sin(angle)};
  };
  for (int32_t k = 0; k < kSides; ++k) add_line(marks, rim(k), rim(k + 1), colour);
  marks.line_width = 2;
  marks.through_walls = true;
  return marks;
}

Marks path_marks(const std::vector<Vec3d>& points, Vec3d origin) {
  Marks marks;
  const Vec3d lift = Vec3d{0, 0.12, 0} - origin;
  const Rgba colour = rgba(255, 190, 40);
  for (size_t i = 0; i + 1 < points.size(); ++i) {
    add_line(marks, points[i] + lift, points[i + 1] + lift, colour);
  }
  if (!points.empty()) {  // A pole at the goal.
    add_line(marks, points.back() + lift, points.back() + lift + Vec3d{0, 2.2, 0},
             rgba(255, 80, 60));
  }
  marks.line_width = 4;
  marks.through_walls = true;
  return marks;
}

Marks neighbour_marks(const TimelineFrame& crowd, size_t picked, double sight) {
  Marks marks;
  const auto place = [&](size_t i) { return Vec3d{crowd.x[i], crowd.y[i] + 0.08, crowd.z[i]}; };
  const Vec3d me = place(picked);
  constexpr int32_t kSides = 48;
  for (int32_t k = 0; k < kSides; ++k) {
    const auto rim = [&](int32_t n) {
      const double angle = 2 * std::numbers::pi * n / kSides;
      return me + Vec3d{sight * std::cos(angle), 0, sight * std::sin(angle)};
    };
    add_line(marks, rim(k), rim(k + 1), rgba(255, 255, 255, 190));
  }
  for (size_t i = 0; i < crowd.size(); ++i) {
    const Vec3d other = place(i);
    const double away = std::hypot(other.x - me.x, other.z - me.z);
    if (i == picked || away > sight || std::abs(other.y - me.y) > 2) continue;
    add_line(marks, me, other, ramp(away / sight, 255));
  }
  marks.line_width = 2.5F;
  marks.through_walls = true;
  return marks;
}

}  // namespace throng::view
