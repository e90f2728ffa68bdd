// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "throng/scene.h"

/// Landscape zones made by hand, for the reader's tests.
namespace throng::test {

struct TinyBind {
  uint8_t kind = 0;
  uint16_t zone = 0;
  std::array<uint16_t, 4> next{};
  std::array<uint8_t, 4> edge{};
};

struct TinyZone {
  uint8_t version = 3;
  uint8_t patch_version = 4;
  uint8_t connect_version = 1;
  uint16_t id = 514;
  float scale = 0.25f;
  std::vector<std::array<uint16_t, 3>> border;
  std::vector<BezierPatch> patches;  ///< Z up, whole multiples of `scale`.
  std::vector<std::array<uint16_t, 4>> corners;
  std::vector<std::array<TinyBind, 4>> binds;
};

inline std::string make_zonel(const TinyZone& zone) {
  std::string out;
  const auto put = [&](const auto& value) {
    out.append(reinterpret_cast<const char*>(&value), sizeof value);
  };
  const auto put_list = [&](int32_t count, size_t size) {
    put(count);
    out.append(static_cast<size_t>(count) * size, '\x11');
  };
  put(zone.version);
  out += "ZONE";
  put(zone.id);
  put(uint8_t{0});
  for (int i = 0; i < 9; ++i) put(0.0f);  // Box and bias.
  put(zone.scale);
  put(int32_t{4});
  put(static_cast<int32_t>(zone.border.size()));
  for (const auto& corner : zone.border) {
    put(uint8_t{0});
    put(corner);
  }
  put(static_cast<int32_t>(zone.patches.size()));
  // Where the file's A B C D, ab ba bc cb cd dc da ad, ia ib ic id stand among our rows of t.
  constexpr std::array<size_t, 16> kOrder{0, 12, 15, 3, 4, 8, 13, 14, 11, 7, 2, 1, 5, 9, 10, 6};
  for (const BezierPatch& patch : zone.patches) {
    put(zone.patch_version);
    for (const size_t i : kOrder) {
      const Vec3d& p = patch.points[i];
      for (const double c : {p.x, p.y, p.z}) put(static_cast<int16_t>(c / zone.scale));
    }
    put_list(2, 8);
    put_list(3, zone.patch_version <= 6 ? 5 : 2);
    put(uint16_t{0x0202});
    put_list(5, 1);
    if (zone.patch_version >= 3) put(uint16_t{0});
    if (zone.patch_version >= 4) put(uint8_t{0});
    if (zone.patch_version >= 5) put_list(2, 3);
  }
  put(static_cast<int32_t>(zone.binds.size()));
  for (size_t p = 0; p < zone.binds.size(); ++p) {
    put(zone.connect_version);
    if (zone.connect_version == 0) put(uint16_t{0});
    put(0.0f);
    put(zone.corners[p]);
    for (const TinyBind& bind : zone.binds[p]) {
      put(uint8_t{0});
      put(bind.kind);
      put(bind.zone);
      put(bind.next);
      put(bind.edge);
    }
  }
  if (zone.version >= 4) out += "lights that are not read";
  return out;
}

/// A flat square at (x, y) with Z up and its normal up. Edge 0 is its left side (low x), from top
/// to bottom; then bottom (low y), right, top.
inline BezierPatch square(double x, double y, double side) {
  BezierPatch patch;
  for (size_t j = 0; j < 4; ++j) {
    for (size_t i = 0; i < 4; ++i) {
      patch.points[4 * j + i] = {x + side * static_cast<double>(i) / 3,
                                 y + side * (1 - static_cast<double>(j) / 3), 0};
    }
  }
  return patch;
}

/// Zone 514 (3_AC): a square of 12 m (patch 0), bound 1 : 4 to a column of four of 3 m (patches 1
/// to 4, from below), and another of 12 m above it (5). Zone 515 (3_AD): a square of 12 m (0) bound
/// 4 : 1 to that column across the border and 1 : 2 to two of 6 m (1 and 2), and one of 12 m bound
/// 1 : 1 to patch 5 of the other zone (3).
inline std::array<TinyZone, 2> tiny_landscape() {
  std::array<TinyZone, 2> zones;
  const auto add = [](TinyZone& zone, BezierPatch patch, std::array<uint16_t, 4> corners) {
    zone.patches.push_back(patch);
    zone.corners.push_back(corners);
    zone.binds.emplace_back();
  };
  TinyZone& west = zones[0];
  TinyZone& east = zones[1];
  west.id = 514;
  east.id = 515;
  add(west, square(0, 0, 12), {0, 1, 2, 3});
  for (uint16_t k = 0; k < 4; ++k) {
    const auto right = static_cast<uint16_t>(10 + k);
    const auto left = static_cast<uint16_t>(15 + k);
    add(west, square(12, 3 * k, 3),
        {k == 3 ? uint16_t{3} : left, k == 0 ? uint16_t{2} : static_cast<uint16_t>(left - 1), right,
         static_cast<uint16_t>(right + 1)});
  }
  add(west, square(0, 12, 12), {20, 0, 3, 21});
  west.binds[0][2] = {4, 514, {1, 2, 3, 4}, {0, 0, 0, 0}};
  for (uint16_t k = 1; k <= 4; ++k) {
    west.binds[k][0] = {5, 514, {0}, {2}};
    west.binds[k][2] = {5, 515, {0}, {0}};
    if (k < 4) west.binds[k][3] = {1, 514, {static_cast<uint16_t>(k + 1)}, {1}};
    if (k > 1) west.binds[k][1] = {1, 514, {static_cast<uint16_t>(k - 1)}, {3}};
  }
  west.binds[0][3] = {1, 514, {5}, {1}};
  west.binds[5][1] = {1, 514, {0}, {3}};
  west.binds[5][2] = {1, 515, {3}, {0}};
  west.border = {{3, 515, 23}, {21, 515, 22}};

  add(east, square(15, 0, 12), {0, 1, 2, 3});
  add(east, square(27, 0, 6), {4, 2, 5, 6});
  add(east, square(27, 6, 6), {3, 4, 6, 7});
  BezierPatch rising = square(12, 12, 12);  // Else it would touch patches that are no neighbours.
  for (Vec3d& p : rising.points) p.z = (p.x - 12) / 4;
  add(east, rising, {22, 23, 24, 25});
  east.binds[0][0] = {4, 514, {4, 3, 2, 1}, {2, 2, 2, 2}};  // From above.
  east.binds[0][2] = {2, 515, {1, 2}, {0, 0}};
  east.binds[1][0] = {5, 515, {0}, {2}};
  east.binds[2][0] = {5, 515, {0}, {2}};
  east.binds[1][3] = {1, 515, {2}, {1}};
  east.binds[2][1] = {1, 515, {1}, {3}};
  east.binds[3][0] = {1, 514, {5}, {2}};
  east.border = {{22, 514, 21}, {23, 514, 3}};
  return zones;
}

}  // namespace throng::test
