// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "import/builtin/world_shapes.h"

// Furniture of the built-in worlds: railings, ladders, cars, trees.
namespace throng::importer::shapes {
namespace {

using Profile = std::vector<std::array<double, 2>>;

// A convex profile in (x, y), clockwise seen from +z, drawn out over |z| <= half.
void extrude(WorldBuilder& b, Mat material, const Profile& profile, double half) {
  std::vector<uint32_t> near;
  std::vector<uint32_t> far;
  for (const auto& [x, y] : profile) {
    near.push_back(b.vertex({x, y, -half}));
    far.push_back(b.vertex({x, y, half}));
  }
  for (size_t i = 0; i < near.size(); ++i) {
    const size_t j = (i + 1) % near.size();
    b.quad(material, near[i], far[i], far[j], near[j]);
  }
  b.polygon(material, near);
  std::reverse(far.begin(), far.end());
  b.polygon(material, far);
}

struct CarShape {
  double nose, tail, bonnet, deck;  // x of the ends, y of bonnet and boot.
  double glass_nose, glass_tail, roof_nose, roof_tail, roof;
};

constexpr std::array<CarShape, 4> kCars = {{
    {2.15, -2.15, 0.90, 0.98, 0.95, -1.65, 0.25, -1.05, 1.43},  // saloon
    {1.95, -1.95, 0.92, 1.00, 0.95, -1.85, 0.30, -1.45, 1.48},  // hatchback
    {2.25, -2.25, 0.95, 1.02, 1.05, -2.15, 0.40, -1.95, 1.50},  // estate
    {2.35, -2.35, 1.05, 1.10, 1.65, -2.30, 1.15, -2.20, 1.95},  // van
}};

}  // namespace

void railing(WorldBuilder& b, Vec3d from, Vec3d to, double height, double spacing) {
  const Vec3d along = to - from;
  const double run = std::sqrt(along.x * along.x + along.z * along.z);
  if (!(run > 0.05)) return;
  const double sx = -along.z / run * 0.025;  // Half a rail's thickness, sideways.
  const double sz = along.x / run * 0.025;
  const auto bar = [&](double y0, double y1) {
    const auto at = [&](Vec3d p, double side, double y) {
      return Vec3d{p.x + side * sx, p.y + y, p.z + side * sz};
    };
    hexahedron(b, Mat::kRailing,
               {{at(from, -1, y0), at(from, 1, y0), at(to, 1, y0), at(to, -1, y0), at(from, -1, y1),
                 at(from, 1, y1), at(to, 1, y1), at(to, -1, y1)}});
  };
  bar(height - 0.06, height);
  bar(height * 0.5 - 0.03, height * 0.5);
  const int32_t posts = std::max(1, static_cast<int32_t>(std::ceil(run / spacing - 1e-9)));
  for (int32_t i = 0; i <= posts; ++i) {
    const Vec3d p = from + along * (static_cast<double>(i) / posts);
    box(b, Mat::kRailing, {p.x - 0.03, p.y, p.z - 0.03}, {p.x + 0.03, p.y + height, p.z + 0.03},
        kSides);
  }
}

void ladder(WorldBuilder& b, Vec3d foot, double height, double along_x, double along_z) {
  const Vec3d half{along_x * 0.22, 0, along_z * 0.22};
  const Vec3d up{0, height, 0};
  cylinder(b, Mat::kRailing, foot - half, foot - half + up, 0.025, 4, false);
  cylinder(b, Mat::kRailing, foot + half, foot + half + up, 0.025, 4, false);
  for (double y = 0.3; y < height; y += 0.3) {
    const Vec3d rung{0, y, 0};
    cylinder(b, Mat::kRailing, foot - half + rung, foot + half + rung, 0.016, 4, false);
  }
}

void car(WorldBuilder& b, uint32_t variant, CarDetail detail) {
  constexpr std::array<Mat, 3> kPaint = {Mat::kCar, Mat::kCarDark, Mat::kCarLight};
  const CarShape& c = kCars[variant % 4];
  const Mat paint = kPaint[variant / 4 % 3];
  const bool full = detail == CarDetail::kFull;
  if (full) {
    extrude(b, paint,
            {{c.tail, 0.40},
             {c.tail + 0.02, 0.75},
             {c.tail + 0.12, c.deck},
             {c.glass_nose, c.deck},
             {c.nose - 0.20, c.bonnet - 0.14},
             {c.nose, 0.62},
             {c.nose - 0.02, 0.34},
             {c.tail + 0.25, 0.30}},
            0.86);
  } else {
    extrude(
        b, paint,
        {{c.tail, 0.30}, {c.tail, c.deck}, {c.glass_nose, c.deck}, {c.nose, 0.70}, {c.nose, 0.30}},
        0.86);
  }
  const double foot = c.deck - 0.01;
  const std::array<Vec3d, 8> cabin{{{c.glass_tail, foot, -0.80},
                                    {c.glass_tail, foot, 0.80},
                                    {c.glass_nose, foot, 0.80},
                                    {c.glass_nose, foot, -0.80},
                                    {c.roof_tail, c.roof, -0.63},
                                    {c.roof_tail, c.roof, 0.63},
                                    {c.roof_nose, c.roof, 0.63},
                                    {c.roof_nose, c.roof, -0.63}}};
  hexahedron(b, Mat::kGlass, cabin, kSides);
  hexahedron(b, paint, cabin, kHighY);
  for (const double x : {c.tail + 0.80, c.nose - 0.85}) {
    if (!full) {
      box(b, Mat::kTyre, {x - 0.30, 0, -0.82}, {x + 0.30, 0.45, 0.82}, kSides);
      continue;
    }
    for (const double side : {-1.0, 1.0}) {
      cylinder(b, Mat::kTyre, {x, 0.32, side * 0.68}, {x, 0.32, side * 0.89}, 0.32, 8, true);
    }
  }
}

void tree(WorldBuilder& b, Vec3d foot, uint64_t random) {
  const double size = 0.8 + 0.4 * static_cast<double>(random & 255) / 255;
  const double trunk = 2.4 * size;
  frustum(b, Mat::kTrunk, foot, 0.17 * size, 0.12 * size, trunk + 0.3, 5, false);
  const Vec3d crown{foot.x, foot.y + trunk, foot.z};
  if ((random >> 8 & 3) == 0) {  // A conifer.
    frustum(b, Mat::kCrown, crown, 1.5 * size, 0, 4.2 * size, 6, true);
    return;
  }
  const double r = 1.7 * size;
  frustum(b, Mat::kCrown, crown, 0.55 * r, r, 0.8 * r, 6, false);
  frustum(b, Mat::kCrown, {crown.x, crown.y + 0.8 * r, crown.z}, r, 0, 1.2 * r, 6, false);
}

}  // namespace throng::importer::shapes
