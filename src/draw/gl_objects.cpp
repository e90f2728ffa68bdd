// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "draw/gl_objects.h"

#include <algorithm>

#ifdef __EMSCRIPTEN__
#include <emscripten/html5.h>
#endif

// Shader programs and other OpenGL objects, and what the driver supports.
namespace throng::draw {
namespace {

GLuint compile(GLenum kind, const std::string& source, std::string& fault) {
  const GLuint shader = glCreateShader(kind);
  const char* text = source.c_str();
  glShaderSource(shader, 1, &text, nullptr);
  glCompileShader(shader);
  GLint done = 0;
  glGetShaderiv(shader, GL_COMPILE_STATUS, &done);
  if (done == 0) {
    char log[1000] = {};
    glGetShaderInfoLog(shader, sizeof log, nullptr, log);
    fault += log;
  }
  return shader;
}

}  // namespace

GlProgram::GlProgram(const std::string& vertex, const std::string& fragment) {
  const GLuint v = compile(GL_VERTEX_SHADER, vertex, fault_);
  const GLuint f = compile(GL_FRAGMENT_SHADER, fragment, fault_);
  const GLuint program = glCreateProgram();
  glAttachShader(program, v);
  glAttachShader(program, f);
  glLinkProgram(program);
  glDeleteShader(v);
  glDeleteShader(f);
  GLint done = 0;
  glGetProgramiv(program, GL_LINK_STATUS, &done);
  if (done != 0) {
    name_ = GlName<delete_program>(program);
    return;
  }
  char log[1000] = {};
  glGetProgramInfoLog(program, sizeof log, nullptr, log);
  fault_ += log;
  glDeleteProgram(program);
}

GLint GlProgram::place(const char* uniform) const {
  return glGetUniformLocation(name_.get(), uniform);
}

void GlProgram::set(const char* uniform, int value) const { glUniform1i(place(uniform), value); }

void GlProgram::set(const char* uniform, float value) const { glUniform1f(place(uniform), value); }

void GlProgram::set(const char* uniform, Vec3d v) const {
  glUniform3f(place(uniform), static_cast<float>(v.x), static_cast<float>(v.y),
              static_cast<float>(v.z));
}

void GlProgram::set_size(const char* uniform, float width, float height) const {
  glUniform2f(place(uniform), width, height);
}

void GlProgram::set_matrix(const char* uniform, const float* sixteen) const {
  glUniformMatrix4fv(place(uniform), 1, GL_FALSE, sixteen);
}

void GlProgram::set_colours(const char* uniform, const float* triples, int count) const {
  glUniform3fv(place(uniform), count, triples);
}

void GlProgram::set_numbers(const char* uniform, const float* numbers, int count) const {
  glUniform1fv(place(uniform), count, numbers);
}

bool has_extension(std::initializer_list<std::string_view> names) {
  GLint count = 0;
  glGetIntegerv(GL_NUM_EXTENSIONS, &count);
  for (GLint i = 0; i < count; ++i) {
    const auto* name =
        reinterpret_cast<const char*>(glGetStringi(GL_EXTENSIONS, static_cast<GLuint>(i)));
    if (name != nullptr && std::find(names.begin(), names.end(), name) != names.end()) return true;
  }
  return false;
}

std::string renderer_name() {
#ifdef __EMSCRIPTEN__
  // A browser gives the name only after this extension is enabled; else the query is an error.
  const EMSCRIPTEN_WEBGL_CONTEXT_HANDLE context = emscripten_webgl_get_current_context();
  if (!emscripten_webgl_enable_extension(context, "WEBGL_debug_renderer_info")) return "unknown";
#endif
  const auto* name = reinterpret_cast<const char*>(glGetString(kRendererName));
  return name == nullptr ? "unknown" : name;
}

GlTexture make_texture() {
  GLuint name = 0;
  glGenTextures(1, &name);
  return GlTexture(name);
}

GlBuffer make_buffer() {
  GLuint name = 0;
  glGenBuffers(1, &name);
  return GlBuffer(name);
}

GlVertexArray make_vertex_array() {
  GLuint name = 0;
  glGenVertexArrays(1, &name);
  return GlVertexArray(name);
}

GlFramebuffer make_framebuffer() {
  GLuint name = 0;
  glGenFramebuffers(1, &name);
  return GlFramebuffer(name);
}

GlRenderbuffer make_renderbuffer() {
  GLuint name = 0;
  glGenRenderbuffers(1, &name);
  return GlRenderbuffer(name);
}

}  // namespace throng::draw
