// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "draw/headless.h"

#include <dlfcn.h>
#include <epoxy/egl.h>
#include <epoxy/gl.h>

#include <string>

// Uses EGL's surfaceless platform: Mesa draws on the processor where there is no graphics card, and
// no display server has to run. OpenGL ES, not desktop OpenGL: what compiles here compiles in a
// browser.
namespace throng::draw {
namespace {

Error nothing_draws(const std::string& why) {
  return {Errc::kNotFound, "drawing: " + why +
                               "; on Debian install libegl1, libgles2 and "
                               "libgl1-mesa-dri"};
}

// libepoxy ends the program if a library is missing, so we check first.
bool has_library(const char* name) {
  void* library = dlopen(name, RTLD_LAZY | RTLD_LOCAL);
  if (library == nullptr) return false;
  dlclose(library);
  return true;
}

EGLDisplay open_display() {
  if (epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_MESA_platform_surfaceless")) {
    const EGLDisplay display =
        eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
    if (display != EGL_NO_DISPLAY && eglInitialize(display, nullptr, nullptr) == EGL_TRUE) {
      return display;
    }
  }
  const EGLDisplay display = eglGetDisplay(EGL_DEFAULT_DISPLAY);
  if (display != EGL_NO_DISPLAY && eglInitialize(display, nullptr, nullptr) == EGL_TRUE) {
    return display;
  }
  return EGL_NO_DISPLAY;
}

}  // namespace

Result<std::unique_ptr<Headless>> Headless::create() {
  for (const char* library : {"libEGL.so.1", "libGLESv2.so.2"}) {
    if (!has_library(library))
      return nothing_draws(std::string(library) + " is not on this machine");
  }
  std::unique_ptr<Headless> headless(new Headless);
  headless->display_ = open_display();
  if (headless->display_ == EGL_NO_DISPLAY) {
    return nothing_draws("EGL has no driver that draws without a window");
  }
  const EGLint wanted[] = {EGL_SURFACE_TYPE, EGL_DONT_CARE, EGL_RENDERABLE_TYPE, EGL_OPENGL_ES3_BIT,
                           EGL_NONE};
  const EGLint version[] = {EGL_CONTEXT_MAJOR_VERSION, 3, EGL_CONTEXT_MINOR_VERSION, 0, EGL_NONE};
  EGLConfig config = nullptr;
  EGLint count = 0;
  eglBindAPI(EGL_OPENGL_ES_API);
  if (eglChooseConfig(headless->display_, wanted, &config, 1, &count) != EGL_TRUE || count < 1) {
    return nothing_draws("EGL's driver has no OpenGL ES 3.0");
  }
  headless->context_ = eglCreateContext(headless->display_, config, EGL_NO_CONTEXT, version);
  if (headless->context_ == EGL_NO_CONTEXT ||
      eglMakeCurrent(headless->display_, EGL_NO_SURFACE, EGL_NO_SURFACE, headless->context_) !=
          EGL_TRUE) {
    return nothing_draws("EGL's driver makes no context without a window");
  }
  return headless;
}

Headless::~Headless() {
  if (display_ == nullptr) return;
  if (context_ != nullptr) {
    eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    eglDestroyContext(display_, context_);
  }
  // The display is shared by all of this process's contexts, so it stays open.
}

void Headless::make_current() const {
  eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context_);
}

}  // namespace throng::draw
