// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <epoxy/egl.h>
#include <epoxy/gl.h>
#include <gtest/gtest.h>

#include <array>
#include <cstdlib>
#include <vector>

#include "throng/impostor.h"
#include "throng/scene.h"
#include "throng_draw/draw.h"

// A picture is drawn directly into a window that has depths, unless something else needs them; else
// it is copied from an offscreen target. Both give the same picture.
namespace throng {
namespace {

constexpr int32_t kWide = 200, kHigh = 120;

// An invisible window, current as long as it lives.
class Window {
 public:
  explicit Window(EGLint depth_bits) {
    display_ =
        eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
    if (display_ == EGL_NO_DISPLAY || eglInitialize(display_, nullptr, nullptr) != EGL_TRUE) return;
    eglBindAPI(EGL_OPENGL_ES_API);
    const std::array<EGLint, 13> wanted{EGL_SURFACE_TYPE,
                                        EGL_PBUFFER_BIT,
                                        EGL_RENDERABLE_TYPE,
                                        EGL_OPENGL_ES3_BIT,
                                        EGL_RED_SIZE,
                                        8,
                                        EGL_GREEN_SIZE,
                                        8,
                                        EGL_BLUE_SIZE,
                                        8,
                                        EGL_DEPTH_SIZE,
                                        depth_bits,
                                        EGL_NONE};
    std::array<EGLConfig, 64> configs{};
    EGLint count = 0;
    eglChooseConfig(display_, wanted.data(), configs.data(), static_cast<EGLint>(configs.size()),
                    &count);
    const std::array<EGLint, 5> size{EGL_WIDTH, kWide, EGL_HEIGHT, kHigh, EGL_NONE};
    const std::array<EGLint, 3> version{EGL_CONTEXT_MAJOR_VERSION, 3, EGL_NONE};
    for (EGLint i = 0; i < count && !works_; ++i) {
      EGLint bits = 0, samples = 0;
      eglGetConfigAttrib(display_, configs[i], EGL_DEPTH_SIZE, &bits);
      eglGetConfigAttrib(display_, configs[i], EGL_SAMPLES, &samples);
      if (bits != depth_bits || samples != 0) continue;
      surface_ = eglCreatePbufferSurface(display_, configs[i], size.data());
      context_ = eglCreateContext(display_, configs[i], EGL_NO_CONTEXT, version.data());
      works_ = surface_ != EGL_NO_SURFACE && context_ != EGL_NO_CONTEXT &&
               eglMakeCurrent(display_, surface_, surface_, context_) == EGL_TRUE;
    }
  }
  ~Window() {
    if (!works_) return;
    eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    eglDestroyContext(display_, context_);
    eglDestroySurface(display_, surface_);
  }
  Window(const Window&) = delete;
  Window& operator=(const Window&) = delete;

  [[nodiscard]] bool works() const { return works_; }

 private:
  EGLDisplay display_ = EGL_NO_DISPLAY;
  EGLSurface surface_ = EGL_NO_SURFACE;
  EGLContext context_ = EGL_NO_CONTEXT;
  bool works_ = false;
};

// What show() leaves in a window, rows from the top.
std::vector<uint8_t> shown(EGLint depth_bits, HiddenCulling culling, const Scene& scene,
                           const Atlas& atlas) {
  const Window window(depth_bits);
  if (!window.works()) return {};
  auto drawing = Drawing::create_in_current_context();
  EXPECT_TRUE(drawing) << drawing.error().message;
  EXPECT_TRUE(drawing->add_atlas(atlas));
  EXPECT_TRUE(drawing->set_scene(scene, {}));
  DrawingConfig config;
  config.width = kWide;
  config.height = kHigh;
  config.samples = 1;
  config.culling = culling;
  config.camera.eye = {40, 14, 46};
  config.camera.target = {22, 2, 22};
  std::vector<float> x, y(40, 0.0F), z;
  std::vector<uint16_t> turns;
  for (uint16_t i = 0; i < 40; ++i) {
    x.push_back(16.0F + static_cast<float>(i % 8) * 2);
    z.push_back(16.0F + static_cast<float>(i / 8) * 3);
    turns.push_back(static_cast<uint16_t>(i * 1700));
  }
  const DrawnCrowd crowd{
      .avatars = {.x = x, .y = y, .z = z, .heading = turns, .phase = turns, .appearance = turns}};
  glClearColor(1, 0, 1, 1);
  for (int32_t again = 0; again < 2; ++again) {
    const auto ok = drawing->show({&crowd, 1}, config);
    EXPECT_TRUE(ok) << ok.error().message;
  }
  std::vector<uint8_t> rgba(size_t{kWide} * kHigh * 4), out;
  glReadPixels(0, 0, kWide, kHigh, GL_RGBA, GL_UNSIGNED_BYTE, rgba.data());
  for (size_t row = kHigh; row-- > 0;) {
    for (size_t i = row * kWide; i < (row + 1) * kWide; ++i) {
      out.insert(out.end(), &rgba[i * 4], &rgba[i * 4] + 3);
    }
  }
  return out;
}

// A driver may store a window's rows in reverse order, and then decides ties at edges differently.
void expect_alike(const std::vector<uint8_t>& a, const std::vector<uint8_t>& b) {
  ASSERT_EQ(a.size(), b.size());
  size_t far = 0;
  for (size_t i = 0; i < a.size(); ++i) far += std::abs(a[i] - b[i]) > 8 ? 1 : 0;
  EXPECT_LT(far, a.size() / 100);
}

TEST(GlWindow, ShowsTheSamePictureWithDepthsOfItsOwnAndWithout) {
  if (!epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_MESA_platform_surfaceless")) GTEST_SKIP();
  const auto garage = create_builtin_world({.name = "garage"});
  ASSERT_TRUE(garage);
  Context quiet;
  const auto atlas = create_atlas(built_in_character(), {}, quiet);
  ASSERT_TRUE(atlas);
  const auto copied = shown(0, HiddenCulling::kNever, *garage, *atlas);
  const auto at_once = shown(24, HiddenCulling::kNever, *garage, *atlas);
  const auto culled = shown(24, HiddenCulling::kAlways, *garage, *atlas);
  if (copied.empty() || at_once.empty()) GTEST_SKIP() << "EGL has no such windows";
  expect_alike(at_once, copied);
  EXPECT_EQ(culled, copied);
  // Nothing of what was there before, and no empty picture.
  size_t pink = 0, other = 0;
  for (size_t i = 0; i < copied.size(); i += 3) {
    pink += copied[i] == 255 && copied[i + 1] == 0 && copied[i + 2] == 255 ? 1 : 0;
    other += std::abs(copied[i] - copied[0]) > 20 ? 1 : 0;
  }
  EXPECT_EQ(pink, 0U);
  EXPECT_GT(other, copied.size() / 3 / 4);
}

}  // namespace
}  // namespace throng
