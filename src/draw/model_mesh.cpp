// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "draw/model_mesh.h"

#include <algorithm>
#include <string>

// Uploads the poses and vertices of a figure model.
namespace throng::draw {
namespace {

constexpr GLsizei kPosesWide = 2048;
constexpr GLenum kPoseUnit = 6;

}  // namespace

Result<ModelMesh> ModelMesh::create(const FigureModel& model) {
  GLint largest = 0;
  glGetIntegerv(GL_MAX_TEXTURE_SIZE, &largest);
  const auto rows = static_cast<GLsizei>((model.poses.size() + kPosesWide - 1) / kPosesWide);
  if (rows > largest) {
    return Error{Errc::kLimit, "drawing: the figure has more poses than a texture of " +
                                   std::to_string(largest) + " rows holds; take fewer frames"};
  }
  ModelMesh out;
  out.clips_ = model.clips;
  out.vertices_ = model.vertices;
  out.low_ = model.low;
  out.high_ = model.high;
  std::vector<PosedVertex> whole = model.poses;
  whole.resize(static_cast<size_t>(rows) * kPosesWide);
  out.poses_ = make_texture();
  glBindTexture(GL_TEXTURE_2D, out.poses_.get());
  glTexStorage2D(GL_TEXTURE_2D, 1, GL_RGBA16UI, kPosesWide, std::max(rows, GLsizei{1}));
  glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, kPosesWide, rows, GL_RGBA_INTEGER, GL_UNSIGNED_SHORT,
                  whole.data());
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
  out.array_ = make_vertex_array();
  glBindVertexArray(out.array_.get());
  out.paint_ = make_buffer();
  glBindBuffer(GL_ARRAY_BUFFER, out.paint_.get());
  glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(model.paint.size() * sizeof(ModelPaint)),
               model.paint.data(), GL_STATIC_DRAW);
  glEnableVertexAttribArray(0);
  glVertexAttribIPointer(0, 4, GL_UNSIGNED_BYTE, sizeof(ModelPaint), nullptr);
  out.index_ = make_buffer();
  glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, out.index_.get());
  glBufferData(GL_ELEMENT_ARRAY_BUFFER,
               static_cast<GLsizeiptr>(model.triangles.size() * sizeof model.triangles[0]),
               model.triangles.data(), GL_STATIC_DRAW);
  out.first_index_ = {0};
  for (const WornPart& part : model.worn) {
    out.first_index_.push_back(size_t{3} * part.first_triangle);
  }
  out.first_index_.push_back(3 * model.triangles.size());
  glBindVertexArray(0);
  return out;
}

void ModelMesh::draw(const GlProgram& program, size_t clip, size_t layer, size_t instances) const {
  const AtlasClip& moves = clips_[clip];
  program.set("poses", static_cast<int>(kPoseUnit));
  program.set("vertices", static_cast<int>(vertices_));
  program.set("first_frame", static_cast<int>(moves.first_frame));
  program.set("frames", static_cast<int>(moves.frames));
  program.set("low", low_);
  program.set("extent", high_ - low_);
  glActiveTexture(GL_TEXTURE0 + kPoseUnit);
  glBindTexture(GL_TEXTURE_2D, poses_.get());
  glBindVertexArray(array_.get());
  const size_t first = first_index_[layer];
  glDrawElementsInstanced(GL_TRIANGLES, static_cast<GLsizei>(first_index_[layer + 1] - first),
                          GL_UNSIGNED_INT, reinterpret_cast<const void*>(first * sizeof(uint32_t)),
                          static_cast<GLsizei>(instances));
}

double ModelMesh::extent(double centre) const {
  const auto larger = [](double low, double high) {
    return std::max(std::fabs(low), std::fabs(high));
  };
  return std::hypot(larger(low_.x, high_.x), larger(low_.y - centre, high_.y - centre),
                    larger(low_.z, high_.z));
}

}  // namespace throng::draw
