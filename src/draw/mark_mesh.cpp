// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "draw/mark_mesh.h"

#include <array>
#include <cstddef>
#include <vector>

// Uploads marks and draws them; each line is two triangles.
namespace throng::draw {
namespace {

struct Vertex {
  std::array<float, 3> at{}, other{};  // The same: no line.
  Rgba colour = 0;
  float side = 0;  // -1 or 1: of a line, to its left or right.
};

}  // namespace

Result<void> MarkMesh::set(const Marks& marks) {
  THRONG_ASSERT(marks.triangles.size() % 3 == 0 && marks.lines.size() % 2 == 0);
  std::vector<Vertex> vertices;
  vertices.reserve(marks.triangles.size() + 3 * marks.lines.size());
  for (const MarkVertex& v : marks.triangles) {
    vertices.push_back({{v.x, v.y, v.z}, {v.x, v.y, v.z}, v.colour, 0});
  }
  for (size_t i = 0; i + 1 < marks.lines.size(); i += 2) {
    const MarkVertex &a = marks.lines[i], &b = marks.lines[i + 1];
    // At the other end the direction is reversed, and so are left and right.
    const Vertex a0{{a.x, a.y, a.z}, {b.x, b.y, b.z}, a.colour, -1};
    const Vertex a1{{a.x, a.y, a.z}, {b.x, b.y, b.z}, a.colour, 1};
    const Vertex b0{{b.x, b.y, b.z}, {a.x, a.y, a.z}, b.colour, 1};
    const Vertex b1{{b.x, b.y, b.z}, {a.x, a.y, a.z}, b.colour, -1};
    for (const Vertex& v : {a0, a1, b0, b0, a1, b1}) vertices.push_back(v);
  }
  vertices_ = static_cast<GLsizei>(vertices.size());
  line_width_ = marks.line_width;
  through_walls_ = marks.through_walls;
  if (vertices_ == 0) return {};
  if (array_.get() == 0) {
    array_ = make_vertex_array();
    buffer_ = make_buffer();
  }
  glBindVertexArray(array_.get());
  glBindBuffer(GL_ARRAY_BUFFER, buffer_.get());
  glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(vertices.size() * sizeof(Vertex)),
               vertices.data(), GL_DYNAMIC_DRAW);
  const auto at = [](size_t offset) { return reinterpret_cast<const void*>(offset); };
  for (GLuint i = 0; i < 4; ++i) glEnableVertexAttribArray(i);
  glVertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, sizeof(Vertex), at(offsetof(Vertex, at)));
  glVertexAttribPointer(1, 3, GL_FLOAT, GL_FALSE, sizeof(Vertex), at(offsetof(Vertex, other)));
  glVertexAttribPointer(2, 4, GL_UNSIGNED_BYTE, GL_TRUE, sizeof(Vertex),
                        at(offsetof(Vertex, colour)));
  glVertexAttribPointer(3, 1, GL_FLOAT, GL_FALSE, sizeof(Vertex), at(offsetof(Vertex, side)));
  if (glGetError() == GL_NO_ERROR) return {};
  vertices_ = 0;
  return Error{Errc::kLimit, "drawing: the marks do not fit into the card's memory; show less"};
}

void MarkMesh::draw(const GlProgram& program, float samples) const {
  if (vertices_ == 0) return;
  glBindVertexArray(array_.get());
  program.set("half_width", 0.5F * line_width_ * samples);
  program.set("opacity", 1.0F);
  glDrawArrays(GL_TRIANGLES, 0, vertices_);
  if (!through_walls_) return;
  program.set("opacity", 0.3F);
  glDepthFunc(GL_GREATER);
  glDrawArrays(GL_TRIANGLES, 0, vertices_);
  glDepthFunc(GL_LEQUAL);
}

}  // namespace throng::draw
