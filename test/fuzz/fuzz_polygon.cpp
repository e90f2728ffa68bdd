// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <cstdlib>
#include <cstring>

#include "import/raw/polygon.h"

// Bytes become rings of small whole numbers: touching, crossing and degenerate rings are then
// common. A byte of 255 begins a new ring, 254 makes the next corner arbitrary.
extern "C" int LLVMFuzzerTestOneInput(const uint8_t* bytes, size_t size) {
  std::vector<throng::Vec3d> points;
  std::vector<uint32_t> rings{0};
  for (size_t i = 0; i + 1 < size; i += 2) {
    if (bytes[i] == 255) {
      rings.push_back(static_cast<uint32_t>(points.size()));
    } else if (bytes[i] == 254 && i + 26 <= size) {
      throng::Vec3d p;
      std::memcpy(&p, bytes + i + 2, sizeof p);
      points.push_back(p);
      i += 24;
    } else {
      points.push_back({bytes[i] * 0.1, bytes[i + 1] * 0.1, 0});
    }
  }
  rings.push_back(static_cast<uint32_t>(points.size()));
  throng::importer::PolygonCutter cutter;
  std::vector<std::array<uint32_t, 3>> triangles;
  cutter.cut(points, rings, triangles);
  for (const auto& corners : triangles) {
    for (const uint32_t corner : corners) {
      if (corner >= points.size()) std::abort();
    }
  }
  return 0;
}
