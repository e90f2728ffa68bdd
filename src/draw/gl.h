// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

/// OpenGL ES 3.0: through libepoxy, or as a browser's WebGL 2.
#ifdef __EMSCRIPTEN__
#include <GLES3/gl3.h>
#else
#include <epoxy/gl.h>
#endif

namespace throng::draw {

/// The query for the driver's name. In a browser GL_RENDERER does not give it.
#ifdef __EMSCRIPTEN__
inline constexpr GLenum kRendererName = 0x9246;  // UNMASKED_RENDERER_WEBGL
#else
inline constexpr GLenum kRendererName = GL_RENDERER;
#endif

}  // namespace throng::draw
