// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "draw/depth_reader.h"

#include <bit>

#include "draw/crowd_pass.h"
#include "draw/shaders.h"

// Reduces the depth buffer to the furthest depth of each block, and reads that back.
namespace throng::draw {

Result<void> DepthReader::make_program() {
  program_ = GlProgram(shaders::furthest_vertex(), shaders::furthest_fragment());
  nothing_ = make_vertex_array();
  return check_linked({&program_});
}

void DepthReader::read(const GlTexture& depth, GLsizei width, GLsizei height, DepthPyramid& out) {
  const GLsizei wide = (width + DepthPyramid::kBlock - 1) / DepthPyramid::kBlock;
  const GLsizei high = (height + DepthPyramid::kBlock - 1) / DepthPyramid::kBlock;
  glActiveTexture(GL_TEXTURE6);
  if (wide != width_ || high != height_) {
    width_ = wide, height_ = high;
    blocks_ = make_texture();
    glBindTexture(GL_TEXTURE_2D, blocks_.get());
    glTexStorage2D(GL_TEXTURE_2D, 1, GL_R32UI, wide, high);
    frame_ = make_framebuffer();
    glBindFramebuffer(GL_FRAMEBUFFER, frame_.get());
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, blocks_.get(), 0);
  }
  glBindFramebuffer(GL_FRAMEBUFFER, frame_.get());
  glViewport(0, 0, wide, high);
  glDisable(GL_DEPTH_TEST);
  glBindTexture(GL_TEXTURE_2D, depth.get());
  program_.use();
  program_.set("depth", 6);
  glBindVertexArray(nothing_.get());
  glDrawArrays(GL_TRIANGLES, 0, 3);
  glBindTexture(GL_TEXTURE_2D, 0);
  const size_t blocks = static_cast<size_t>(wide) * static_cast<size_t>(high);
  words_.resize(4 * blocks);  // The only format that every driver can read back.
  furthest_.resize(blocks);
  glPixelStorei(GL_PACK_ALIGNMENT, 4);
  glReadPixels(0, 0, wide, high, GL_RGBA_INTEGER, GL_UNSIGNED_INT, words_.data());
  for (size_t i = 0; i < blocks; ++i) furthest_[i] = std::bit_cast<float>(words_[4 * i]);
  out.set(furthest_, width, height);
}

}  // namespace throng::draw
