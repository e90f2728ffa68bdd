// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "draw/shaders.h"

// Shaders of what is unlit: marks over the scene, and the panel.
namespace throng::draw::shaders {
namespace {

constexpr const char* kFlatHead = R"(#version 300 es
precision highp float;
precision highp int;
uniform mat4 clip_from_world;
)";

}  // namespace

// The corners of a line are moved apart across it, in pixels. All is drawn a little nearer than the
// surface that it lies on.
std::string mark_vertex() {
  return std::string(kFlatHead) + R"(
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 other;
layout(location = 2) in vec4 paint;
layout(location = 3) in float side;
uniform vec2 half_picture; // [px of this target]
uniform float half_width;  // [px of this target]
uniform float nearer;      // In clip space: a share of the distance to the eye.
out vec4 tint;
out float height;
void main() {
  tint = paint;
  height = position.y;
  gl_Position = clip_from_world * vec4(position, 1.0);
  if (side != 0.0) {
    vec4 end = clip_from_world * vec4(other, 1.0);
    // A point behind the eye has no place in the picture: move along the line in front of it.
    const float kNear = 0.05;
    if (gl_Position.w < kNear && end.w > kNear)
      gl_Position = mix(gl_Position, end, (kNear - gl_Position.w) / (end.w - gl_Position.w));
    if (end.w < kNear && gl_Position.w > kNear)
      end = mix(end, gl_Position, (kNear - end.w) / (gl_Position.w - end.w));
    vec2 along = (end.xy / end.w - gl_Position.xy / gl_Position.w) * half_picture;
    float size = length(along);
    vec2 across = size > 1e-4 ? vec2(-along.y, along.x) / size : vec2(0.0, 1.0);
    gl_Position.xy += across * side * half_width / half_picture * gl_Position.w;
  }
  gl_Position.z += nearer;
}
)";
}

std::string mark_fragment() {
  return std::string(kFlatHead) + R"(
in vec4 tint;
in float height;
uniform float opacity;
uniform float cut;
out vec4 colour;
void main() {
  if (height > cut) discard;
  colour = vec4(tint.rgb, tint.a * opacity);
}
)";
}

std::string panel_vertex() {
  return std::string(kFlatHead) + R"(
layout(location = 0) in vec2 position;
layout(location = 1) in vec2 texel;
layout(location = 2) in vec4 paint;
uniform vec2 picture; // [px]
out vec2 at;
out vec4 tint;
void main() {
  at = texel;
  tint = paint;
  gl_Position = vec4(position / picture * vec2(2.0, -2.0) + vec2(-1.0, 1.0), 0.0, 1.0);
}
)";
}

std::string panel_fragment() {
  return std::string(kFlatHead) + R"(
in vec2 at;
in vec4 tint;
uniform sampler2D letters;
out vec4 colour;
void main() { colour = vec4(tint.rgb, tint.a * texture(letters, at).r); }
)";
}

}  // namespace throng::draw::shaders
