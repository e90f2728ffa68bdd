// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <epoxy/gl.h>
#include <gtest/gtest.h>

#include <array>
#include <string>
#include <vector>

#include "core/random.h"
#include "impostor/etc2_codec.h"
#include "throng_draw/draw.h"

// A driver decodes random blocks as we do, texel by texel.
namespace throng {
namespace {

constexpr uint64_t kSeed = 29;
constexpr GLsizei kBlocks = 128;        // A side of the texture.
constexpr GLsizei kSide = 4 * kBlocks;  // [texels]

std::vector<uint8_t> random_blocks(size_t bytes_each) {
  std::vector<uint8_t> bytes(static_cast<size_t>(kBlocks) * kBlocks * bytes_each);
  for (size_t i = 0; i < bytes.size(); ++i) {
    bytes[i] = static_cast<uint8_t>(random_u64(kSeed, i, bytes_each));
  }
  return bytes;
}

impostor::Bytes8 bytes_at(const std::vector<uint8_t>& from, size_t offset) {
  impostor::Bytes8 out;
  std::copy_n(from.begin() + static_cast<ptrdiff_t>(offset), 8, out.begin());
  return out;
}

GLuint shader(GLenum kind, const char* text) {
  const GLuint name = glCreateShader(kind);
  glShaderSource(name, 1, &text, nullptr);
  glCompileShader(name);
  GLint done = 0;
  glGetShaderiv(name, GL_COMPILE_STATUS, &done);
  EXPECT_NE(done, 0);
  return name;
}

// Uploads blocks to the current context and reads texels as whole numbers up to `max_value`; rows
// from the first block's.
std::vector<uint32_t> read_back(GLenum kind, const std::vector<uint8_t>& blocks, int max_value) {
  GLuint textures[2] = {};
  glGenTextures(2, textures);
  glActiveTexture(GL_TEXTURE0);
  glBindTexture(GL_TEXTURE_2D, textures[1]);
  glTexStorage2D(GL_TEXTURE_2D, 1, GL_RGBA32UI, kSide, kSide);
  GLuint frame = 0;
  glGenFramebuffers(1, &frame);
  glBindFramebuffer(GL_FRAMEBUFFER, frame);
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, textures[1], 0);
  glBindTexture(GL_TEXTURE_2D, textures[0]);
  glCompressedTexImage2D(GL_TEXTURE_2D, 0, kind, kSide, kSide, 0,
                         static_cast<GLsizei>(blocks.size()), blocks.data());
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
  const GLuint program = glCreateProgram();
  glAttachShader(program, shader(GL_VERTEX_SHADER, R"(#version 300 es
    void main() {
      gl_Position = vec4(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0, 0.0, 1.0);
    })"));
  glAttachShader(program, shader(GL_FRAGMENT_SHADER, R"(#version 300 es
    precision highp float;
    precision highp int;
    uniform highp sampler2D blocks;
    uniform float max_value;
    out highp uvec4 texel;
    void main() {
      texel = uvec4(texelFetch(blocks, ivec2(gl_FragCoord.xy), 0) * max_value + 0.5);
    })"));
  glLinkProgram(program);
  glUseProgram(program);
  glUniform1i(glGetUniformLocation(program, "blocks"), 0);
  glUniform1f(glGetUniformLocation(program, "max_value"), static_cast<float>(max_value));
  GLuint vertices = 0;
  glGenVertexArrays(1, &vertices);
  glBindVertexArray(vertices);
  glDisable(GL_BLEND);
  glDisable(GL_DEPTH_TEST);
  glDisable(GL_CULL_FACE);
  glDisable(GL_SCISSOR_TEST);
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  glViewport(0, 0, kSide, kSide);
  glDrawArrays(GL_TRIANGLES, 0, 3);
  std::vector<uint32_t> texels(static_cast<size_t>(kSide) * kSide * 4);
  glReadPixels(0, 0, kSide, kSide, GL_RGBA_INTEGER, GL_UNSIGNED_INT, texels.data());
  EXPECT_EQ(glGetError(), static_cast<GLenum>(GL_NO_ERROR));
  glDeleteVertexArrays(1, &vertices);
  glDeleteFramebuffers(1, &frame);
  glDeleteProgram(program);
  glDeleteTextures(2, textures);
  return texels;
}

// Calls body(block, texel of the block by row, the card's four numbers).
template <class Body>
void for_each_texel(const std::vector<uint32_t>& texels, Body body) {
  for (size_t y = 0; y < kSide; ++y) {
    for (size_t x = 0; x < kSide; ++x) {
      body(y / 4 * kBlocks + x / 4, y % 4 * 4 + x % 4, texels.data() + 4 * (y * kSide + x));
    }
  }
}

TEST(Etc2Card, ColoursOfRandomBlocksAreTheDrivers) {
  Result<Drawing> drawing = Drawing::create();
  ASSERT_TRUE(drawing) << drawing.error().message;
  for (const AtlasFormat format : {AtlasFormat::kEtc2a1, AtlasFormat::kEtc2}) {
    if (!drawing->takes_blocks(format)) GTEST_SKIP() << drawing->renderer();
    const bool holes = format == AtlasFormat::kEtc2a1;
    const size_t bytes_each = holes ? 8 : 16;
    const std::vector<uint8_t> blocks = random_blocks(bytes_each);
    const auto texels = read_back(
        holes ? GL_COMPRESSED_RGB8_PUNCHTHROUGH_ALPHA1_ETC2 : GL_COMPRESSED_RGBA8_ETC2_EAC, blocks,
        255);
    size_t differ = 0;
    for_each_texel(texels, [&](size_t block, size_t texel, const uint32_t* card) {
      impostor::ColourBlock ours;
      impostor::decode_etc2(bytes_at(blocks, block * bytes_each + bytes_each - 8), holes, ours);
      if (!holes) {
        impostor::ChannelBlock alpha;
        impostor::decode_eac(bytes_at(blocks, block * bytes_each), alpha);
        ours[texel][3] = alpha[texel];
      }
      for (size_t c = 0; c < 4; ++c) differ += ours[texel][c] != card[c] ? 1 : 0;
    });
    EXPECT_EQ(differ, 0U) << word_for(format) << " on " << drawing->renderer();
  }
}

TEST(Etc2Card, ChannelsOfRandomBlocksAreTheDrivers) {
  Result<Drawing> drawing = Drawing::create();
  ASSERT_TRUE(drawing) << drawing.error().message;
  if (!drawing->takes_blocks(AtlasFormat::kEtc2)) GTEST_SKIP() << drawing->renderer();
  const std::vector<uint8_t> blocks = random_blocks(16);
  const auto texels = read_back(GL_COMPRESSED_RG11_EAC, blocks, 2047);
  size_t differ = 0;
  for_each_texel(texels, [&](size_t block, size_t texel, const uint32_t* card) {
    for (size_t c = 0; c < 2; ++c) {
      impostor::WideChannelBlock ours;
      impostor::decode_eac11(bytes_at(blocks, block * 16 + c * 8), ours);
      differ += ours[texel] != card[c] ? 1 : 0;
    }
  });
  EXPECT_EQ(differ, 0U) << drawing->renderer();
}

}  // namespace
}  // namespace throng
