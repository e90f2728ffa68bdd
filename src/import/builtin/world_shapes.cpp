// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "import/builtin/world_shapes.h"

#include <algorithm>
#include <cmath>

namespace throng::importer::shapes {
namespace {

// Cuts a rectangle with holes into rectangles: strips along x between the holes' z edges.
template <class Emit>
void for_each_piece(const Rect& r, std::span<const Rect> holes, Emit emit) {
  std::vector<double> cuts{r.z0, r.z1};
  for (const Rect& hole : holes) cuts.insert(cuts.end(), {hole.z0, hole.z1});
  std::sort(cuts.begin(), cuts.end());
  cuts.erase(std::unique(cuts.begin(), cuts.end()), cuts.end());
  std::vector<Rect> row;
  for (size_t i = 0; i + 1 < cuts.size(); ++i) {
    row.clear();
    for (const Rect& hole : holes) {
      if (hole.z0 <= cuts[i] && cuts[i + 1] <= hole.z1) row.push_back(hole);
    }
    std::sort(row.begin(), row.end(), [](const Rect& a, const Rect& c) { return a.x0 < c.x0; });
    double x = r.x0;
    for (const Rect& hole : row) {
      if (hole.x0 > x) emit(Rect{x, cuts[i], hole.x0, cuts[i + 1]});
      x = std::max(x, hole.x1);
    }
    if (x < r.x1) emit(Rect{x, cuts[i], r.x1, cuts[i + 1]});
  }
}

// Side directions for a tube whose axis is `axis`: two unit vectors across it, right-handed.
std::array<Vec3d, 2> across(Vec3d axis) {
  const Vec3d other = std::fabs(axis.y) < 0.9 * length(axis) ? Vec3d{0, 1, 0} : Vec3d{1, 0, 0};
  Vec3d u = cross(other, axis);
  u = u * (1 / length(u));
  Vec3d v = cross(axis, u);
  v = v * (1 / length(v));
  return {u, v};
}

}  // namespace

void hexahedron(WorldBuilder& b, Mat material, const std::array<Vec3d, 8>& corners,
                uint32_t faces) {
  std::array<uint32_t, 8> v{};
  for (size_t i = 0; i < 8; ++i) v[i] = b.vertex(corners[i]);
  if (faces & kLowX) b.quad(material, v[0], v[1], v[5], v[4]);
  if (faces & kHighZ) b.quad(material, v[1], v[2], v[6], v[5]);
  if (faces & kHighX) b.quad(material, v[2], v[3], v[7], v[6]);
  if (faces & kLowZ) b.quad(material, v[3], v[0], v[4], v[7]);
  if (faces & kHighY) b.quad(material, v[4], v[5], v[6], v[7]);
  if (faces & kLowY) b.quad(material, v[0], v[3], v[2], v[1]);
}

void box(WorldBuilder& b, Mat material, Vec3d low, Vec3d high, uint32_t faces) {
  hexahedron(b, material,
             {{{low.x, low.y, low.z},
               {low.x, low.y, high.z},
               {high.x, low.y, high.z},
               {high.x, low.y, low.z},
               {low.x, high.y, low.z},
               {low.x, high.y, high.z},
               {high.x, high.y, high.z},
               {high.x, high.y, low.z}}},
             faces);
}

void floor_rect(WorldBuilder& b, Mat material, const Rect& r, double y) {
  const uint32_t v0 = b.vertex({r.x0, y, r.z0});
  const uint32_t v1 = b.vertex({r.x0, y, r.z1});
  const uint32_t v2 = b.vertex({r.x1, y, r.z1});
  b.quad(material, v0, v1, v2, b.vertex({r.x1, y, r.z0}));
}

void thin_wall(WorldBuilder& b, Mat material, double x0, double z0, double x1, double z1, double y0,
               double y1) {
  const uint32_t v0 = b.vertex({x0, y0, z0});
  const uint32_t v1 = b.vertex({x1, y0, z1});
  const uint32_t v2 = b.vertex({x1, y1, z1});
  b.quad(material, v0, v1, v2, b.vertex({x0, y1, z0}));
}

void floor_with_holes(WorldBuilder& b, Mat material, const Rect& r, std::span<const Rect> holes,
                      double y) {
  for_each_piece(r, holes, [&](const Rect& piece) { floor_rect(b, material, piece, y); });
}

void slab(WorldBuilder& b, Mat top, Mat below, const Rect& r, std::span<const Rect> holes,
          double y0, double y1) {
  // Each piece is a closed box: the faces between pieces lie inside the solid and are harmless.
  for_each_piece(r, holes, [&](const Rect& p) {
    std::array<uint32_t, 8> v{};
    for (size_t i = 0; i < 8; ++i) {
      v[i] = b.vertex({i & 1 ? p.x1 : p.x0, i & 4 ? y1 : y0, i & 2 ? p.z1 : p.z0});
    }
    b.quad(top, v[4], v[6], v[7], v[5]);
    b.quad(below, v[0], v[1], v[3], v[2]);
    b.quad(below, v[0], v[2], v[6], v[4]);
    b.quad(below, v[3], v[1], v[5], v[7]);
    b.quad(below, v[1], v[0], v[4], v[5]);
    b.quad(below, v[2], v[3], v[7], v[6]);
  });
}

void wall(WorldBuilder& b, Mat material, double x0, double z0, double x1, double z1, double y0,
          double y1, double thickness, std::span<const Opening> openings) {
  const double run = std::sqrt((x1 - x0) * (x1 - x0) + (z1 - z0) * (z1 - z0));
  const Frame outer = b.frame();
  const double lx = (x1 - x0) / run;
  const double lz = (z1 - z0) / run;
  b.place({outer({x0, 0, z0}), outer.ux * lx - outer.uz * lz, outer.ux * lz + outer.uz * lx});
  const double half = thickness / 2;
  double at = 0;
  for (const Opening& o : openings) {
    if (o.from > at) box(b, material, {at, y0, -half}, {o.from, y1, half});
    if (o.low > 0) box(b, material, {o.from, y0, -half}, {o.to, y0 + o.low, half});
    if (y0 + o.high < y1) box(b, material, {o.from, y0 + o.high, -half}, {o.to, y1, half});
    at = o.to;
  }
  if (at < run) box(b, material, {at, y0, -half}, {run, y1, half});
  b.place(outer);
}

void flight(WorldBuilder& b, Mat material, const Flight& f) {
  const double end = f.length();
  const double soffit = f.risers * f.rise - f.thickness;  // Of the waist's end over its beginning.
  const auto pair = [&](double x, double y) {
    const uint32_t near = b.vertex({f.x + x, f.y + y, f.z});
    return std::array<uint32_t, 2>{near, b.vertex({f.x + x, f.y + y, f.z + f.width})};
  };
  std::array<uint32_t, 2> foot = pair(0, 0);  // Of the riser.
  std::array<uint32_t, 2> under = foot;       // Of the waist below the riser.
  for (int32_t i = 0; i < f.risers; ++i) {
    const auto nosing = pair(i * f.run, (i + 1) * f.rise);
    b.quad(material, foot[0], foot[1], nosing[1], nosing[0]);
    if (i + 1 == f.risers) {
      b.quad(material, under[1], under[0], foot[0], foot[1]);
      break;
    }
    const auto back = pair((i + 1) * f.run, (i + 1) * f.rise);
    const auto next = pair((i + 1) * f.run, soffit * (i + 1) * f.run / end);
    b.quad(material, nosing[0], nosing[1], back[1], back[0]);
    b.quad(material, under[1], under[0], next[0], next[1]);
    b.quad(material, under[0], nosing[0], back[0], next[0]);
    b.quad(material, under[1], next[1], back[1], nosing[1]);
    foot = back;
    under = next;
  }
}

void dogleg(WorldBuilder& b, Mat material, const Dogleg& d) {
  const double rise = d.height / (2 * d.risers);
  Flight up{.x = d.x,
            .y = d.y,
            .z = d.z,
            .width = d.width,
            .rise = rise,
            .run = d.run,
            .risers = d.risers,
            .thickness = 0.3};
  flight(b, material, up);
  const double half = d.y + d.height / 2;
  const double end = d.x + up.length();
  box(b, material, {end, half - 0.2, d.z}, {end + d.landing, half, d.z + d.depth()});
  const Frame outer = b.frame();
  b.place({outer({end, 0, d.z + d.depth()}), -outer.ux, -outer.uz});
  up.x = 0;
  up.y = half;
  up.z = 0;
  flight(b, material, up);
  b.place(outer);
}

void spiral(WorldBuilder& b, Mat material, const Spiral& s) {
  const double rise = s.height / s.risers;
  const auto at = [&](int32_t i, double radius, double y) {
    const auto [c, n] = unit_circle(s.from + s.turn * i / s.risers);
    return b.vertex({s.x + radius * c, y, s.z + radius * n});
  };
  const bool left = s.turn < 0;
  const auto quad = [&](uint32_t v0, uint32_t v1, uint32_t v2, uint32_t v3) {
    if (left) {
      b.quad(material, v0, v3, v2, v1);
    } else {
      b.quad(material, v0, v1, v2, v3);
    }
  };
  const auto soffit = [&](int32_t i) { return std::max(s.y, s.y + i * rise - s.thickness); };
  for (int32_t i = 0; i < s.risers; ++i) {
    const double y = s.y + (i + 1) * rise;
    const uint32_t i0 = at(i, s.inner, y);
    const uint32_t o0 = at(i, s.outer, y);
    const uint32_t i1 = at(i + 1, s.inner, y);
    const uint32_t o1 = at(i + 1, s.outer, y);
    const uint32_t fi = at(i, s.inner, soffit(i));
    const uint32_t fo = at(i, s.outer, soffit(i));
    const uint32_t bi = at(i + 1, s.inner, soffit(i + 1));
    const uint32_t bo = at(i + 1, s.outer, soffit(i + 1));
    quad(i0, i1, o1, o0);
    quad(fi, i0, o0, fo);
    quad(fo, o0, o1, bo);
    quad(fi, fo, bo, bi);
    if (s.inner > 0.5) quad(i0, fi, bi, i1);  // A newel covers it otherwise.
  }
}

void sector(WorldBuilder& b, Mat material, double x, double z, double inner, double outer,
            double from, double turn, double y0, double y1) {
  const int32_t parts = std::max(1, static_cast<int32_t>(std::fabs(turn) * 16 + 0.5));
  const double start = turn < 0 ? from + turn : from;
  const double span = std::fabs(turn);
  std::array<uint32_t, 4> last{};
  for (int32_t i = 0; i <= parts; ++i) {
    const auto [c, n] = unit_circle(start + span * i / parts);
    std::array<uint32_t, 4> now{};
    now[0] = b.vertex({x + inner * c, y0, z + inner * n});
    now[1] = b.vertex({x + outer * c, y0, z + outer * n});
    now[2] = b.vertex({x + outer * c, y1, z + outer * n});
    now[3] = b.vertex({x + inner * c, y1, z + inner * n});
    if (i > 0) {
      b.quad(material, last[3], now[3], now[2], last[2]);
      b.quad(material, last[0], last[1], now[1], now[0]);
      b.quad(material, last[1], last[2], now[2], now[1]);
      b.quad(material, last[0], now[0], now[3], last[3]);
    }
    if (i == 0) b.quad(material, now[0], now[3], now[2], now[1]);
    if (i == parts) b.quad(material, now[0], now[1], now[2], now[3]);
    last = now;
  }
}

void cylinder(WorldBuilder& b, Mat material, Vec3d from, Vec3d to, double radius, int32_t sides,
              bool caps) {
  const auto [u, v] = across(to - from);
  std::vector<uint32_t> low;
  std::vector<uint32_t> high;
  for (int32_t i = 0; i < sides; ++i) {
    const auto [c, n] = unit_circle((i + 0.5) / sides);
    const Vec3d d = u * (radius * c) + v * (radius * n);
    low.push_back(b.vertex(from + d));
    high.push_back(b.vertex(to + d));
  }
  for (size_t i = 0; i < low.size(); ++i) {
    const size_t j = (i + 1) % low.size();
    b.quad(material, low[i], low[j], high[j], high[i]);
  }
  if (!caps) return;
  b.polygon(material, high);
  std::reverse(low.begin(), low.end());
  b.polygon(material, low);
}

void pipe(WorldBuilder& b, Mat material, std::span<const Vec3d> path, double radius,
          int32_t sides) {
  // One ring for each corner, in the plane that halves its angle.
  std::vector<uint32_t> last;
  Vec3d u{};
  for (size_t p = 0; p < path.size(); ++p) {
    const Vec3d in = p > 0 ? path[p] - path[p - 1] : path[1] - path[0];
    const Vec3d out = p + 1 < path.size() ? path[p + 1] - path[p] : in;
    const Vec3d a = in * (1 / length(in));
    const Vec3d c = out * (1 / length(out));
    if (p == 0) u = across(a)[0];
    const Vec3d w = cross(a, u);
    Vec3d normal = a + c;
    normal = normal * (1 / length(normal));
    std::vector<uint32_t> ring;
    for (int32_t i = 0; i < sides; ++i) {
      const auto [cosine, sine] = unit_circle((i + 0.5) / sides);
      const Vec3d d = u * (radius * cosine) + w * (radius * sine);
      ring.push_back(b.vertex(path[p] + d - a * (dot(d, normal) / dot(a, normal))));
    }
    for (size_t i = 0; i < last.size(); ++i) {
      const size_t j = (i + 1) % last.size();
      b.quad(material, last[i], last[j], ring[j], ring[i]);
    }
    last = std::move(ring);
    // Carries the ring's first direction around the corner.
    u = u - c * (dot(u, c));
    if (length(u) < 1e-6) u = a * -1.0;
    u = u * (1 / length(u));
  }
}

void frustum(WorldBuilder& b, Mat material, Vec3d foot, double radius0, double radius1,
             double height, int32_t sides, bool caps) {
  std::vector<uint32_t> low;
  std::vector<uint32_t> high;
  const uint32_t tip = radius1 > 0 ? 0 : b.vertex({foot.x, foot.y + height, foot.z});
  for (int32_t i = 0; i < sides; ++i) {
    const auto [c, n] = unit_circle((i + 0.5) / sides);
    low.push_back(b.vertex({foot.x + radius0 * c, foot.y, foot.z + radius0 * n}));
    if (radius1 > 0) {
      high.push_back(b.vertex({foot.x + radius1 * c, foot.y + height, foot.z + radius1 * n}));
    }
  }
  for (size_t i = 0; i < low.size(); ++i) {
    const size_t j = (i + 1) % low.size();
    if (radius1 > 0) {
      b.quad(material, low[j], low[i], high[i], high[j]);
    } else {
      b.triangle(material, low[j], low[i], tip);
    }
  }
  if (!caps) return;
  b.polygon(material, low);
  std::reverse(high.begin(), high.end());
  b.polygon(material, high);
}

}  // namespace throng::importer::shapes
