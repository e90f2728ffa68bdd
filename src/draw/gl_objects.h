// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <initializer_list>
#include <string>
#include <string_view>
#include <utility>

#include "draw/gl.h"
#include "throng/base.h"

/// Names that OpenGL allocates, released when their owner is destroyed. A context must be current.
namespace throng::draw {

template <void (*kDelete)(GLuint)>
class GlName {
 public:
  GlName() = default;
  explicit GlName(GLuint name) : name_(name) {}
  GlName(GlName&& other) noexcept : name_(std::exchange(other.name_, 0)) {}
  GlName& operator=(GlName&& other) noexcept {
    std::swap(name_, other.name_);
    return *this;
  }
  ~GlName() {
    if (name_ != 0) kDelete(name_);
  }
  [[nodiscard]] GLuint get() const { return name_; }

 private:
  GLuint name_ = 0;
};

inline void delete_texture(GLuint name) { glDeleteTextures(1, &name); }
inline void delete_buffer(GLuint name) { glDeleteBuffers(1, &name); }
inline void delete_array(GLuint name) { glDeleteVertexArrays(1, &name); }
inline void delete_framebuffer(GLuint name) { glDeleteFramebuffers(1, &name); }
inline void delete_renderbuffer(GLuint name) { glDeleteRenderbuffers(1, &name); }
inline void delete_program(GLuint name) { glDeleteProgram(name); }

using GlTexture = GlName<delete_texture>;
using GlBuffer = GlName<delete_buffer>;
using GlVertexArray = GlName<delete_array>;
using GlFramebuffer = GlName<delete_framebuffer>;
using GlRenderbuffer = GlName<delete_renderbuffer>;

/// A linked pair of shaders.
class GlProgram {
 public:
  GlProgram() = default;
  /// The sources are ours: if one does not compile, this library or the driver is at fault, and
  /// fault() returns the driver's message.
  GlProgram(const std::string& vertex, const std::string& fragment);
  void use() const { glUseProgram(name_.get()); }
  [[nodiscard]] bool is_linked() const { return name_.get() != 0; }
  [[nodiscard]] const std::string& fault() const { return fault_; }
  void set(const char* uniform, int value) const;
  void set(const char* uniform, float value) const;
  void set(const char* uniform, Vec3d value) const;
  void set_size(const char* uniform, float width, float height) const;
  void set_matrix(const char* uniform, const float* sixteen) const;
  void set_colours(const char* uniform, const float* triples, int count) const;
  void set_numbers(const char* uniform, const float* numbers, int count) const;

 private:
  [[nodiscard]] GLint place(const char* uniform) const;
  GlName<delete_program> name_;
  std::string fault_;
};

/// Does the current context have an extension by one of its names? Browsers have others.
bool has_extension(std::initializer_list<std::string_view> names);

/// The driver's name for itself; "unknown" if it gives none.
std::string renderer_name();
GlTexture make_texture();
GlBuffer make_buffer();
GlVertexArray make_vertex_array();
GlFramebuffer make_framebuffer();
GlRenderbuffer make_renderbuffer();

}  // namespace throng::draw
