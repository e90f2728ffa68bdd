// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "draw/scene_mesh.h"

#include <cstddef>

namespace throng {

Result<void> SceneMesh::set(const SceneCorners& scene) {
  bounds_ = scene.bounds;
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
  corners_ = static_cast<GLsizei>(scene.corners.size());
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
