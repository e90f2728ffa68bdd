// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "draw/scene_mesh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "core/random.h"

namespace throng {
namespace {

struct Corner {
  std::array<float, 3> position{};
  std::array<int8_t, 4> normal_tint{};
};
static_assert(sizeof(Corner) == 16);

constexpr size_t kMostTriangles = 40'000'000;  // 1.9 GB.

int8_t signed_byte(double value) {
  return static_cast<int8_t>(std::lround(std::clamp(value, -1.0, 1.0) * 127));
}

}  // namespace

Result<void> SceneMesh::set(const Scene& scene, Vec3d origin) {
  if (scene.triangles.size() > kMostTriangles) {
    return Error{Errc::kLimit, "drawing: " + std::to_string(scene.triangles.size()) +
                                   " triangles, more than " + std::to_string(kMostTriangles) +
                                   "; draw a part of the model"};
  }
  std::vector<Corner> corners;
  corners.reserve(3 * scene.triangles.size());
  bounds_ = {};
  size_t part = 0;
  for (size_t t = 0; t < scene.triangles.size(); ++t) {
    while (part + 1 < scene.parts.size() && t >= scene.parts[part + 1].first_triangle) ++part;
    std::array<Vec3d, 3> p;
    for (size_t k = 0; k < 3; ++k) p[k] = scene.positions[scene.triangles[t][k]] - origin;
    Vec3d normal = cross(p[1] - p[0], p[2] - p[0]);
    const double size = length(normal);
    if (!(size > 0)) continue;
    normal = normal * (1 / size);
    const double tint = random_unit(7, 0, part);  // Parts of a model differ a little.
    for (const Vec3d& q : p) {
      bounds_.add(q);
      corners.push_back(
          {{static_cast<float>(q.x), static_cast<float>(q.y), static_cast<float>(q.z)},
           {signed_byte(normal.x), signed_byte(normal.y), signed_byte(normal.z),
            signed_byte(tint)}});
    }
  }
  if (!bounds_.empty()) {
    // A plain just under the lowest point, out to the haze, for the scene to stand on.
    const double reach = 40 * length(bounds_.max - bounds_.min) + 100;
    const auto middle = (bounds_.min + bounds_.max) * 0.5;
    const double y = bounds_.min.y - 0.02;
    const auto corner = [&](double x, double z) {
      corners.push_back({{static_cast<float>(middle.x + x * reach), static_cast<float>(y),
                          static_cast<float>(middle.z + z * reach)},
                         {0, 127, 0, -127}});
    };
    corner(-1, -1), corner(-1, 1), corner(1, 1);
    corner(-1, -1), corner(1, 1), corner(1, -1);
  }
  array_ = make_vertex_array();
  buffer_ = make_buffer();
  glBindVertexArray(array_.get());
  glBindBuffer(GL_ARRAY_BUFFER, buffer_.get());
  glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(corners.size() * sizeof(Corner)),
               corners.data(), GL_STATIC_DRAW);
  glEnableVertexAttribArray(0);
  glVertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, sizeof(Corner), nullptr);
  glEnableVertexAttribArray(1);
  glVertexAttribPointer(1, 4, GL_BYTE, GL_TRUE, sizeof(Corner),
                        reinterpret_cast<const void*>(sizeof(float) * 3));
  corners_ = static_cast<GLsizei>(corners.size());
  if (glGetError() == GL_NO_ERROR) return {};
  corners_ = 0;
  return Error{Errc::kLimit,
               "drawing: the model does not fit into the card's memory; draw a part "
               "of it"};
}

void SceneMesh::draw() const {
  if (corners_ == 0) return;
  glBindVertexArray(array_.get());
  glDrawArrays(GL_TRIANGLES, 0, corners_);
}

}  // namespace throng
