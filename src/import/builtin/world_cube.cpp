// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "import/builtin/builtin_table.h"
#include "import/builtin/world_shapes.h"

// The cube of [ML06] table 2: six surfaces without thickness, closed on all sides. A 5.8 m one
// gives 42 slices taken and 2 kept for an avatar of 1.75 m at a resolution of 0.1 m.
namespace throng::importer::builtin {

void build_cube(WorldBuilder& b, const BuiltinWorldConfig& config) {
  const double s = config.size;
  b.node("cube");
  std::array<uint32_t, 8> v{};
  for (size_t i = 0; i < 8; ++i) {
    v[i] = b.vertex({i & 1 ? s : 0, i & 4 ? s : 0, i & 2 ? s : 0});
  }
  b.quad(Mat::kFloor, v[0], v[2], v[3], v[1]);
  b.quad(Mat::kRoof, v[4], v[6], v[7], v[5]);
  b.quad(Mat::kWall, v[0], v[4], v[6], v[2]);
  b.quad(Mat::kWall, v[1], v[3], v[7], v[5]);
  b.quad(Mat::kWall, v[0], v[1], v[5], v[4]);
  b.quad(Mat::kWall, v[2], v[6], v[7], v[3]);
}

}  // namespace throng::importer::builtin
