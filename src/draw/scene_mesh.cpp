// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "draw/scene_mesh.h"

#include <algorithm>
#include <cstddef>

// Uploads the corners of a scene and draws all of it or some chunks.
namespace throng::draw {

Result<void> SceneMesh::set(const SceneCorners& scene) {
  bounds_ = scene.bounds;
  chunks_ = scene.chunks;
  array_ = make_vertex_array();
  buffer_ = make_buffer();
  glBindVertexArray(array_.get());
  glBindBuffer(GL_ARRAY_BUFFER, buffer_.get());
  glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(scene.corners.size() * sizeof(SceneCorner)),
               scene.corners.data(), GL_STATIC_DRAW);
  const auto at = [](size_t offset) { return reinterpret_cast<const void*>(offset); };
  glEnableVertexAttribArray(0);
  glVertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, sizeof(SceneCorner), nullptr);
  glEnableVertexAttribArray(1);
  glVertexAttribPointer(1, 3, GL_BYTE, GL_TRUE, sizeof(SceneCorner),
                        at(offsetof(SceneCorner, normal)));
  glEnableVertexAttribArray(2);
  glVertexAttribIPointer(2, 1, GL_UNSIGNED_BYTE, sizeof(SceneCorner),
                         at(offsetof(SceneCorner, edges_tint)));
  has_surfaces_ = !scene.surfaces.empty();
  has_holes_ = scene.has_holes;
  surfaces_ = {};
  if (has_surfaces_) {
    surfaces_ = make_buffer();
    glBindBuffer(GL_ARRAY_BUFFER, surfaces_.get());
    glBufferData(GL_ARRAY_BUFFER,
                 static_cast<GLsizeiptr>(scene.surfaces.size() * sizeof(SurfaceCorner)),
                 scene.surfaces.data(), GL_STATIC_DRAW);
    glEnableVertexAttribArray(3);
    glVertexAttribPointer(3, 2, GL_FLOAT, GL_FALSE, sizeof(SurfaceCorner), nullptr);
    glEnableVertexAttribArray(4);
    glVertexAttribPointer(4, 4, GL_UNSIGNED_BYTE, GL_TRUE, sizeof(SurfaceCorner),
                          at(offsetof(SurfaceCorner, paint)));
    glEnableVertexAttribArray(5);
    glVertexAttribIPointer(5, 2, GL_UNSIGNED_SHORT, sizeof(SurfaceCorner),
                           at(offsetof(SurfaceCorner, look)));
  }
  corners_ = static_cast<GLsizei>(scene.corners.size());
  if (glGetError() == GL_NO_ERROR) return {};
  corners_ = 0;
  chunks_.clear();
  return Error{Errc::kLimit,
               "drawing: the model does not fit into the card's memory; draw a part "
               "of it"};
}

void SceneMesh::draw_corners(uint32_t first, uint32_t count) const {
  if (count == 0) return;
  glBindVertexArray(array_.get());
  glDrawArrays(GL_TRIANGLES, static_cast<GLint>(first), static_cast<GLsizei>(count));
}

void SceneMesh::draw() const { draw_corners(0, static_cast<uint32_t>(corners_)); }

void SceneMesh::draw(std::vector<uint32_t> chunks) const {
  std::sort(chunks.begin(), chunks.end());
  uint32_t first = 0, count = 0;  // Neighbours are drawn in one call.
  for (const uint32_t i : chunks) {
    if (first + count != chunks_[i].first) {
      draw_corners(first, count);
      first = chunks_[i].first, count = 0;
    }
    count += chunks_[i].count;
  }
  draw_corners(first, count);
}

void SceneMesh::draw_ground_plane() const {
  const uint32_t first = chunks_.empty() ? 0 : chunks_.back().first + chunks_.back().count;
  draw_corners(first, static_cast<uint32_t>(corners_) - first);
}

}  // namespace throng::draw
