// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "draw/panel_mesh.h"

#include <algorithm>
#include <cstddef>

// Uploads and draws a panel.
namespace throng::draw {

Result<void> PanelMesh::set_texture(int32_t width, int32_t height, std::span<const uint8_t> alpha) {
  THRONG_ASSERT(alpha.size() == static_cast<size_t>(width) * static_cast<size_t>(height));
  texture_ = make_texture();
  glActiveTexture(GL_TEXTURE0);
  glBindTexture(GL_TEXTURE_2D, texture_.get());
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  glTexImage2D(GL_TEXTURE_2D, 0, GL_R8, width, height, 0, GL_RED, GL_UNSIGNED_BYTE, alpha.data());
  glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
  for (const GLenum name : {GL_TEXTURE_MIN_FILTER, GL_TEXTURE_MAG_FILTER}) {
    glTexParameteri(GL_TEXTURE_2D, name, GL_LINEAR);
  }
  if (glGetError() == GL_NO_ERROR) return {};
  return Error{Errc::kLimit, "drawing: the panel's texture is larger than this card's textures"};
}

void PanelMesh::draw(const GlProgram& program, const PanelView& panel, int32_t width,
                     int32_t height, int32_t samples) {
  if (panel.runs.empty() || texture_.get() == 0) return;
  if (array_.get() == 0) {
    array_ = make_vertex_array();
    vertices_ = make_buffer();
    indices_ = make_buffer();
  }
  glBindVertexArray(array_.get());
  glBindBuffer(GL_ARRAY_BUFFER, vertices_.get());
  glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(panel.vertices.size_bytes()),
               panel.vertices.data(), GL_STREAM_DRAW);
  glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, indices_.get());
  glBufferData(GL_ELEMENT_ARRAY_BUFFER, static_cast<GLsizeiptr>(panel.indices.size_bytes()),
               panel.indices.data(), GL_STREAM_DRAW);
  const auto at = [](size_t offset) { return reinterpret_cast<const void*>(offset); };
  for (GLuint i = 0; i < 3; ++i) glEnableVertexAttribArray(i);
  glVertexAttribPointer(0, 2, GL_FLOAT, GL_FALSE, sizeof(PanelVertex),
                        at(offsetof(PanelVertex, x)));
  glVertexAttribPointer(1, 2, GL_FLOAT, GL_FALSE, sizeof(PanelVertex),
                        at(offsetof(PanelVertex, u)));
  glVertexAttribPointer(2, 4, GL_UNSIGNED_BYTE, GL_TRUE, sizeof(PanelVertex),
                        at(offsetof(PanelVertex, colour)));
  program.use();
  program.set_size("picture", static_cast<float>(width), static_cast<float>(height));
  program.set("letters", 0);
  glActiveTexture(GL_TEXTURE0);
  glBindTexture(GL_TEXTURE_2D, texture_.get());
  glDisable(GL_DEPTH_TEST);
  glEnable(GL_BLEND);
  glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
  glEnable(GL_SCISSOR_TEST);
  for (const PanelRun& run : panel.runs) {
    const int32_t left = std::max(run.left, 0), top = std::max(run.top, 0);
    const int32_t right = std::min(run.right, width), bottom = std::min(run.bottom, height);
    if (left >= right || top >= bottom) continue;
    glScissor(left * samples, (height - bottom) * samples, (right - left) * samples,
              (bottom - top) * samples);
    glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(run.count), GL_UNSIGNED_INT,
                   at(run.first * sizeof(uint32_t)));
  }
  glDisable(GL_SCISSOR_TEST);
  glDisable(GL_BLEND);
}

}  // namespace throng::draw
