// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "core/access.h"
#include "core/stopwatch.h"
#include "draw/crowd_pass.h"
#include "draw/depth_reader.h"
#include "draw/gl.h"
#include "draw/gl_objects.h"
#include "draw/headless.h"
#include "draw/mark_mesh.h"
#include "draw/matrix.h"
#include "draw/panel_mesh.h"
#include "draw/scene_chunks.h"
#include "draw/scene_mesh.h"
#include "draw/shaders.h"
#include "draw/texture_layers.h"
#include "throng_draw/draw.h"

// A picture in six passes: the sun's depth of scene and avatars, the scene, the avatars, the sky,
// the marks, the panel. All instances of a picture are uploaded at once: those that the eye sees,
// then the same as the sun sees them.
namespace throng {
namespace {

constexpr size_t kTextureBudget = size_t{128} << 20;  // Bytes, without smaller levels.
constexpr int kPictureUnit = 8;
// Share of the distance to the eye by which marks are drawn nearer.
constexpr double kMarkOffset = 0.002;

// Colour and depth of an offscreen target.
struct Target {
  draw::GlFramebuffer frame;
  draw::GlRenderbuffer colour;
  draw::GlTexture depth;
  GLsizei width = 0, height = 0;
};

// The mean of samples x samples pixels, in linear light, rows from the top.
Image reduce(const std::vector<uint8_t>& rgba, int32_t width, int32_t height, int32_t samples) {
  Image image{.width = width, .height = height, .rgb = {}};
  image.rgb.resize(static_cast<size_t>(width) * static_cast<size_t>(height) * 3);
  const auto wide = static_cast<size_t>(width * samples);
  for (int32_t y = 0; y < height; ++y) {
    for (int32_t x = 0; x < width; ++x) {
      for (size_t c = 0; c < 3; ++c) {
        uint32_t sum = 0;
        for (int32_t s = 0; s < samples * samples; ++s) {
          const auto row = static_cast<size_t>((height - 1 - y) * samples + s / samples);
          const auto column = static_cast<size_t>(x * samples + s % samples);
          const uint32_t value = rgba[(row * wide + column) * 4 + c];
          sum += value * value;
        }
        const double mean = static_cast<double>(sum) / (samples * samples);
        image.rgb[(static_cast<size_t>(y) * static_cast<size_t>(width) + x) * 3 + c] =
            static_cast<uint8_t>(std::sqrt(mean) + 0.5);
      }
    }
  }
  return image;
}

}  // namespace

struct PreparedScene::State {
  draw::SceneCorners corners;
  draw::TextureLayers textures;
};

PreparedScene::PreparedScene(std::unique_ptr<State> state) : state_(std::move(state)) {}
PreparedScene::PreparedScene(PreparedScene&&) noexcept = default;
PreparedScene& PreparedScene::operator=(PreparedScene&&) noexcept = default;
PreparedScene::~PreparedScene() = default;

Result<PreparedScene> PreparedScene::create(const Scene& scene, Vec3d origin) {
  draw::TextureLayers textures = draw::make_texture_layers(scene, kTextureBudget);
  Result<draw::SceneCorners> corners = draw::scene_corners(scene, origin, textures.of_texture);
  if (!corners) return corners.error();
  draw::sort_into_chunks(*corners);
  draw::add_ground_plane(*corners);
  return PreparedScene(std::make_unique<State>(State{*std::move(corners), std::move(textures)}));
}

const Box3d& PreparedScene::bounds() const { return state_->corners.bounds; }
Vec3d PreparedScene::origin() const { return state_->corners.origin; }

struct Drawing::State {
  std::unique_ptr<draw::Headless> context;  // None: a window's, which its owner keeps current.
  draw::GlProgram sky, scene, surfaced, depth, surfaced_depth, mark, panel_program;
  draw::GlVertexArray nothing;  // Vertices by number alone.
  draw::SceneMesh mesh, props;
  draw::SurfaceTextures textures;
  std::array<draw::MarkMesh, kMarkSlots> marks;
  draw::PanelMesh panel;
  draw::CrowdPass crowd;
  draw::DepthReader depth_reader;
  draw::DepthPyramid depths;
  bool is_software = false;  // A processor draws.
  draw::GlTexture sun_depth;
  draw::GlFramebuffer sun_frame;
  GLsizei sun_pixels = 0;
  Target target;
  std::vector<uint8_t> texels;  // Of the target, kept from picture to picture.

  void make_current() const {
    if (context) context->make_current();
  }

  Result<void> make_programs();
  Result<void> fit_sun(GLsizei pixels);
  Result<void> fit_target(GLsizei width, GLsizei height);
  [[nodiscard]] const draw::GlProgram& scene_program() const {
    return mesh.has_surfaces() ? surfaced : scene;
  }
  void draw_sun_depth(const draw::Matrix& sun_from_world, Vec3d to_sun, Vec3d sun_right,
                      Vec3d sun_up, float cut) const;
  // `read_depths` reads those of the near parts; null: no part is tested.
  template <class ReadDepths>
  size_t draw_scene(const draw::Matrix& clip_from_world, Vec3d eye, const ReadDepths* read_depths);
  void draw_marks(const draw::Matrix& clip_from_world, const DrawingConfig& config) const;
  // Does the window have depths, so that a picture can be drawn there directly?
  [[nodiscard]] bool window_has_depth() const;
  [[nodiscard]] bool culls(const DrawingConfig& config) const;
  void draw_sky(const DrawingConfig& config, const CameraAxes& axes) const;
  // Everything but the panel, into the target, or into the window.
  Result<void> paint(std::span<const DrawnCrowd> crowds, const DrawingConfig& config,
                     bool into_window, DrawingReport& report);
};

Result<void> Drawing::State::make_programs() {
  sky = draw::GlProgram(draw::shaders::sky_vertex(), draw::shaders::sky_fragment());
  scene = draw::GlProgram(draw::shaders::scene_vertex(), draw::shaders::scene_fragment());
  surfaced = draw::GlProgram(draw::shaders::surface_vertex(), draw::shaders::surface_fragment());
  depth = draw::GlProgram(draw::shaders::depth_vertex(), draw::shaders::depth_fragment());
  surfaced_depth = draw::GlProgram(draw::shaders::surface_depth_vertex(),
                                   draw::shaders::surface_depth_fragment());
  mark = draw::GlProgram(draw::shaders::mark_vertex(), draw::shaders::mark_fragment());
  panel_program = draw::GlProgram(draw::shaders::panel_vertex(), draw::shaders::panel_fragment());
  if (auto ok = draw::check_linked(
          {&sky, &scene, &surfaced, &depth, &surfaced_depth, &mark, &panel_program});
      !ok)
    return ok;
  nothing = draw::make_vertex_array();
  const std::string renderer = draw::renderer_name();
  for (const char* one : {"llvmpipe", "SwiftShader", "softpipe", "Software"}) {
    is_software = is_software || renderer.find(one) != std::string::npos;
  }
  if (auto ok = depth_reader.make_program(); !ok) return ok;
  return crowd.make_programs();
}

Result<void> Drawing::State::fit_sun(GLsizei pixels) {
  if (sun_pixels == pixels) return {};
  GLint largest = 0;
  glGetIntegerv(GL_MAX_TEXTURE_SIZE, &largest);
  if (pixels > largest) {
    return Error{Errc::kLimit, "drawing: this card's textures have at most " +
                                   std::to_string(largest) + " pixels a side; set sun_pixels"};
  }
  sun_pixels = pixels;
  sun_depth = draw::make_texture();
  glBindTexture(GL_TEXTURE_2D, sun_depth.get());
  glTexStorage2D(GL_TEXTURE_2D, 1, GL_DEPTH_COMPONENT24, pixels, pixels);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  // Its border must not be compared with the opposite one.
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_COMPARE_MODE, GL_COMPARE_REF_TO_TEXTURE);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_COMPARE_FUNC, GL_LEQUAL);
  sun_frame = draw::make_framebuffer();
  glBindFramebuffer(GL_FRAMEBUFFER, sun_frame.get());
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, sun_depth.get(), 0);
  return {};
}

Result<void> Drawing::State::fit_target(GLsizei width, GLsizei height) {
  GLint largest = 0;
  glGetIntegerv(GL_MAX_RENDERBUFFER_SIZE, &largest);
  if (width > largest || height > largest) {
    return Error{Errc::kLimit, "drawing: this card draws at most " + std::to_string(largest) +
                                   " samples a side; make a smaller picture, or take fewer samples "
                                   "a pixel"};
  }
  if (target.width == width && target.height == height) return {};
  target = {draw::make_framebuffer(), draw::make_renderbuffer(), draw::make_texture(), width,
            height};
  glBindRenderbuffer(GL_RENDERBUFFER, target.colour.get());
  glRenderbufferStorage(GL_RENDERBUFFER, GL_RGBA8, width, height);
  glBindTexture(GL_TEXTURE_2D, target.depth.get());
  glTexStorage2D(GL_TEXTURE_2D, 1, GL_DEPTH_COMPONENT24, width, height);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
  glBindFramebuffer(GL_FRAMEBUFFER, target.frame.get());
  glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER,
                            target.colour.get());
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, target.depth.get(), 0);
  if (glCheckFramebufferStatus(GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE) return {};
  target = {};
  return Error{Errc::kLimit,
               "drawing: the picture does not fit into the card's memory; make it "
               "smaller"};
}

void Drawing::State::draw_sun_depth(const draw::Matrix& sun_from_world, Vec3d to_sun,
                                    Vec3d sun_right, Vec3d sun_up, float cut) const {
  glBindFramebuffer(GL_FRAMEBUFFER, sun_frame.get());
  glViewport(0, 0, sun_pixels, sun_pixels);
  glClear(GL_DEPTH_BUFFER_BIT);
  const auto begin = [&](const draw::GlProgram& program) {
    program.use();
    program.set_matrix("clip_from_world", sun_from_world.data());
    program.set("cut", cut);
  };
  glEnable(GL_POLYGON_OFFSET_FILL);
  glPolygonOffset(1.5F, 2.0F);
  begin(mesh.has_holes() ? surfaced_depth : depth);
  if (mesh.has_holes()) surfaced_depth.set("pictures", kPictureUnit);
  mesh.draw(draw::chunks_in_view(mesh.chunks(), sun_from_world, {}));
  mesh.draw_ground_plane();
  if (mesh.has_holes()) begin(depth);
  props.draw();
  glDisable(GL_POLYGON_OFFSET_FILL);
  crowd.draw_shadows(sun_from_world, to_sun, sun_right, sun_up);
}

// Near parts first: they hide much of the rest, which is tested before it is drawn. The order is
// the same with and without culling, because where surfaces coincide the last one shows. Returns
// the number of triangles drawn.
template <class ReadDepths>
size_t Drawing::State::draw_scene(const draw::Matrix& clip_from_world, Vec3d eye,
                                  const ReadDepths* read_depths) {
  constexpr size_t kMinQueried = 8'000, kNearShare = 8;
  const std::span<const draw::SceneChunk> chunks = mesh.chunks();
  std::vector<uint32_t> near = draw::chunks_in_view(chunks, clip_from_world, eye), rest;
  const auto triangles = [&](const std::vector<uint32_t>& indices) {
    size_t corners = 0;
    for (const uint32_t i : indices) corners += chunks[i].count;
    return corners / 3;
  };
  const size_t all = triangles(near);
  if (all > kMinQueried) {
    size_t first = 0, corners = 0;
    while (corners / 3 < all / kNearShare) corners += chunks[near[first++]].count;
    rest.assign(near.begin() + static_cast<ptrdiff_t>(first), near.end());
    near.resize(first);
  }
  mesh.draw(near);
  size_t drawn = triangles(near);
  if (!rest.empty()) {
    if (read_depths != nullptr) {
      (*read_depths)();
      draw::drop_hidden_chunks(chunks, clip_from_world, depths, rest);
      scene_program().use();
    }
    mesh.draw(rest);
    drawn += triangles(rest);
  }
  mesh.draw_ground_plane();
  return drawn;
}

void Drawing::State::draw_marks(const draw::Matrix& clip_from_world,
                                const DrawingConfig& config) const {
  mark.use();
  mark.set_matrix("clip_from_world", clip_from_world.data());
  mark.set("cut", static_cast<float>(std::min(config.cut_height, 1e9)));
  mark.set_size("half_picture", 0.5F * static_cast<float>(config.width * config.samples),
                0.5F * static_cast<float>(config.height * config.samples));
  // Depth is a + b / w: adding to b moves a mark nearer by a share of w.
  const double n = config.camera.nearest, f = config.camera.furthest;
  mark.set("nearer", static_cast<float>(-kMarkOffset * 2 * f * n / (f - n)));
  glEnable(GL_BLEND);
  glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
  glDepthMask(GL_FALSE);
  for (const draw::MarkMesh& mesh_of_slot : marks) {
    mesh_of_slot.draw(mark, static_cast<float>(config.samples));
  }
  glDepthMask(GL_TRUE);
  glDisable(GL_BLEND);
}

Drawing::Drawing(std::unique_ptr<State> state) : state_(std::move(state)) {}
Drawing::Drawing(Drawing&&) noexcept = default;
Drawing& Drawing::operator=(Drawing&&) noexcept = default;

Drawing::~Drawing() {
  if (!state_) return;
  state_->make_current();
  std::unique_ptr<draw::Headless> last = std::move(state_->context);
  state_.reset();  // OpenGL names first, then their context.
}

Result<Drawing> Drawing::create() {
  auto state = std::make_unique<State>();
  Result<std::unique_ptr<draw::Headless>> context = draw::Headless::create();
  if (!context) return context.error();
  state->context = *std::move(context);
  Drawing drawing(std::move(state));
  if (auto made = drawing.state_->make_programs(); !made) return made.error();
  return drawing;
}

Result<Drawing> Drawing::create_in_current_context() {
  Drawing drawing(std::make_unique<State>());
  if (auto made = drawing.state_->make_programs(); !made) return made.error();
  return drawing;
}

Result<void> Drawing::check(const DrawingConfig& c) {
  const EyeCamera& camera = c.camera;
  const auto finite = [](Vec3d v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
  };
  const bool sound = c.width >= 16 && c.width <= 8192 && c.height >= 16 && c.height <= 8192 &&
                     c.samples >= 1 && c.samples <= 4 && c.workers >= 0 && c.sun_pixels >= 256 &&
                     c.sun_pixels <= 8192 && c.edges >= 0 && c.edges <= 1 && c.view_blend >= 0 &&
                     c.view_blend <= 1 && c.mesh_texel >= 0 && c.point_pixels >= 0;
  if (!sound) {
    return Error{Errc::kBadConfig,
                 "drawing: need 16 to 8192 pixels a side, 1 to 4 samples, 256 to 8192 pixels for "
                 "the sun, edges and blends of views of 0 to 1, and mesh_texel, point_pixels and "
                 "workers of 0 or more"};
  }
  if (std::isnan(c.cut_height)) {
    return Error{Errc::kBadConfig, "drawing: the height of the cut must be a number"};
  }
  if (!finite(camera.eye) || !finite(camera.target) || camera.eye == camera.target) {
    return Error{Errc::kBadConfig, "drawing: the camera's eye and target must be two points"};
  }
  if (!(camera.field_of_view > 0.01 && camera.field_of_view < 3 && camera.nearest > 0 &&
        camera.furthest > camera.nearest)) {
    return Error{Errc::kBadConfig,
                 "drawing: need a field of view of 0.01 to 3 rad, and "
                 "0 < nearest < furthest"};
  }
  if (!finite(c.to_sun) || !(c.to_sun.y > 0)) {
    return Error{Errc::kBadConfig, "drawing: the sun must be over the horizon"};
  }
  return {};
}

std::string Drawing::renderer() const {
  state_->make_current();
  return draw::renderer_name();
}

Result<void> Drawing::set_scene(const Scene& scene, Vec3d origin) {
  const Result<PreparedScene> prepared = PreparedScene::create(scene, origin);
  if (!prepared) return prepared.error();
  return set_scene(*prepared);
}

Result<void> Drawing::set_scene(const PreparedScene& scene) {
  state_->make_current();
  if (auto ok = state_->textures.set(Access::state(scene)->textures, !state_->is_software); !ok)
    return ok;
  return state_->mesh.set(Access::state(scene)->corners);
}

Result<void> Drawing::set_props(const Scene& props, Vec3d origin) {
  const Result<draw::SceneCorners> corners = draw::scene_corners(props, origin);
  if (!corners) return corners.error();
  state_->make_current();
  return state_->props.set(*corners);
}

Result<void> Drawing::set_marks(size_t slot, const Marks& marks) {
  if (slot >= kMarkSlots) {
    return Error{Errc::kBadInput, "drawing: marks have " + std::to_string(kMarkSlots) +
                                      " slots, and none is " + std::to_string(slot)};
  }
  if (marks.triangles.size() % 3 != 0 || marks.lines.size() % 2 != 0) {
    return Error{Errc::kBadInput, "drawing: marks have 3 vertices a triangle and 2 a line"};
  }
  state_->make_current();
  return state_->marks[slot].set(marks);
}

Result<void> Drawing::set_panel_texture(int32_t width, int32_t height,
                                        std::span<const uint8_t> alpha) {
  if (width < 1 || height < 1 ||
      alpha.size() != static_cast<size_t>(width) * static_cast<size_t>(height)) {
    return Error{Errc::kBadInput, "drawing: the panel's texture needs width * height bytes"};
  }
  state_->make_current();
  return state_->panel.set_texture(width, height, alpha);
}

Result<size_t> Drawing::add_atlas(const Atlas& atlas) {
  state_->make_current();
  return state_->crowd.add_atlas(atlas);
}

size_t Drawing::colour_bytes(size_t atlas) const { return state_->crowd.colour_bytes(atlas); }

bool Drawing::takes_blocks(AtlasFormat format) const {
  state_->make_current();
  return draw::takes_blocks(format);
}

Result<void> Drawing::set_model(size_t atlas, const FigureModel& model) {
  state_->make_current();
  return state_->crowd.set_model(atlas, model);
}

void Drawing::clear_atlases() {
  state_->make_current();
  state_->crowd.clear_atlases();
}

bool Drawing::State::window_has_depth() const {
  if (context) return false;  // There is no window.
  glBindFramebuffer(GL_FRAMEBUFFER, 0);
  GLint kind = GL_NONE, bits = 0;
  glGetFramebufferAttachmentParameteriv(GL_FRAMEBUFFER, GL_DEPTH,
                                        GL_FRAMEBUFFER_ATTACHMENT_OBJECT_TYPE, &kind);
  if (kind == GL_NONE) return false;
  glGetFramebufferAttachmentParameteriv(GL_FRAMEBUFFER, GL_DEPTH,
                                        GL_FRAMEBUFFER_ATTACHMENT_DEPTH_SIZE, &bits);
  return bits >= 24;
}

bool Drawing::State::culls(const DrawingConfig& config) const {
  const bool is_wanted = config.culling == HiddenCulling::kAlways ||
                         (config.culling == HiddenCulling::kWhereItPays && is_software);
  return is_wanted && !(mesh.bounds().empty() && props.bounds().empty());
}

// `sky` is in use.
void Drawing::State::draw_sky(const DrawingConfig& config, const CameraAxes& axes) const {
  const double up = std::tan(0.5 * config.camera.field_of_view);
  sky.set("right", axes.right * (up * config.camera.aspect));
  sky.set("up", axes.up * up);
  sky.set("forward", axes.forward);
  glDepthMask(GL_FALSE);
  glBindVertexArray(nothing.get());
  glDrawArrays(GL_TRIANGLES, 0, 6 * 8 * 64);
  glDepthMask(GL_TRUE);
}

namespace {

// What the shadow map covers: what is near the camera's target, as far as shadows can be
// distinguished.
struct SunView {
  double scene_radius = 1, half_side = 1;  // [m]
  Vec3d right, up;
  draw::Matrix from_world;
};

SunView sun_view(const Box3d& bounds, const EyeCamera& camera, const Vec3d& to_sun) {
  SunView sun;
  sun.scene_radius = bounds.empty() ? 1 : 0.5 * length(bounds.max - bounds.min) + 1;
  const Vec3d scene_middle = bounds.empty() ? Vec3d{} : (bounds.min + bounds.max) * 0.5;
  sun.half_side = std::min(sun.scene_radius, 1.6 * length(camera.target - camera.eye) + 20);
  const Vec3d middle = sun.half_side < sun.scene_radius ? camera.target : scene_middle;
  sun.right = cross({0, 1, 0}, to_sun) * (1 / std::max(1e-9, length(cross({0, 1, 0}, to_sun))));
  sun.up = cross(to_sun, sun.right);
  sun.from_world = draw::parallel_view(sun.right, sun.up, to_sun, middle, sun.half_side,
                                       2 * sun.scene_radius + sun.half_side);
  return sun;
}

}  // namespace

Result<void> Drawing::State::paint(std::span<const DrawnCrowd> crowds, const DrawingConfig& config,
                                   bool into_window, DrawingReport& report) {
  if (auto ok = crowd.check(crowds); !ok) return ok.error();
  const GLsizei wide = config.width * config.samples, high = config.height * config.samples;
  if (!into_window) {
    if (auto fits = fit_target(wide, high); !fits) return fits.error();
  }
  const GLuint canvas = into_window ? 0 : target.frame.get();
  if (auto fits = fit_sun(config.sun_pixels); !fits) return fits.error();

  const Vec3d to_sun = config.to_sun * (1 / length(config.to_sun));
  const auto start = Clock::now();
  crowd.pack(crowds, config, to_sun);
  const double seconds_pack = seconds_since(start);
  const auto draw_start = Clock::now();
  crowd.upload_shadows();

  const EyeCamera& camera = config.camera;
  const CameraAxes axes = camera_axes(camera);
  const SunView sun = sun_view(mesh.bounds(), camera, to_sun);
  const draw::Matrix clip_from_world = draw::perspective(camera);
  // Little haze over the scene, however large it is, and the sky's colour at the end of the ground.
  const auto haze = static_cast<float>(
      0.15 / std::max({150.0, sun.scene_radius, length(camera.target - camera.eye)}));

  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_LEQUAL);
  glDepthMask(GL_TRUE);
  glDisable(GL_BLEND);
  const double cut_given = std::min(config.cut_height, 1e9);
  const auto cut = static_cast<float>(cut_given);
  textures.bind(kPictureUnit);
  draw_sun_depth(sun.from_world, to_sun, sun.right, sun.up, cut);

  glBindFramebuffer(GL_FRAMEBUFFER, canvas);
  glViewport(0, 0, wide, high);
  glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
  glActiveTexture(GL_TEXTURE4);
  glBindTexture(GL_TEXTURE_2D, sun_depth.get());
  const auto begin = [&](const draw::GlProgram& program) {
    program.use();
    program.set_matrix("clip_from_world", clip_from_world.data());
    program.set_matrix("sun_from_world", sun.from_world.data());
    program.set("eye", camera.eye);
    program.set("to_sun", to_sun);
    program.set("haze", haze);
    program.set("instances", 3);
    program.set("sun_depth", 4);
    program.set("sun_texel", 1.0F / static_cast<float>(sun_pixels));
  };
  double seconds_cull = 0;
  const bool hides = culls(config);
  const auto read_depths = [&] {
    const auto cull_start = Clock::now();
    depth_reader.read(target.depth, wide, high, depths);
    glBindFramebuffer(GL_FRAMEBUFFER, canvas);
    glViewport(0, 0, wide, high);
    glEnable(GL_DEPTH_TEST);
    seconds_cull += seconds_since(cull_start);
  };

  const auto begin_scene = [&](const draw::GlProgram& program, float prop) {
    begin(program);
    program.set("bias", static_cast<float>(2.5 * sun.half_side / sun_pixels));
    program.set("soft", config.soft_shadows ? 1.0F : 0.0F);
    program.set("cut", cut);
    program.set("edges", static_cast<float>(config.edges));
    program.set("edge_wide", 0.5F * static_cast<float>(config.samples));
    program.set("prop", prop);
  };
  begin_scene(scene_program(), 0);
  if (mesh.has_surfaces()) surfaced.set("pictures", kPictureUnit);
  const size_t triangles = draw_scene(clip_from_world, camera.eye, hides ? &read_depths : nullptr);
  if (!props.bounds().empty()) {
    begin_scene(scene, 1);
    props.draw();
  }

  if (hides && crowd.drawn() > 0) {
    read_depths();
    const auto cull_start = Clock::now();
    crowd.drop_hidden(config, depths);
    seconds_cull += seconds_since(cull_start);
  }
  crowd.upload_seen();
  crowd.draw(config, begin);

  begin(sky);  // Only where nothing else is: it costs nothing over most of a picture.
  draw_sky(config, axes);
  draw_marks(clip_from_world, config);

  report.seconds_pack = seconds_pack;
  report.seconds_cull = seconds_cull;
  report.seconds_draw = seconds_since(draw_start) - seconds_cull;
  report.hidden = crowd.hidden();
  report.triangles = triangles;
  for (const DrawnCrowd& of_atlas : crowds) report.avatars += of_atlas.avatars.x.size();
  report.drawn = crowd.drawn();
  return {};
}

namespace {

// With the aspect of the picture.
DrawingConfig completed(const DrawingConfig& given) {
  DrawingConfig config = given;
  config.camera.aspect = static_cast<double>(config.width) / config.height;
  return config;
}

Result<void> no_driver_error() {
  if (const GLenum error = glGetError(); error != GL_NO_ERROR) {
    return Error{Errc::kLimit, "drawing: the driver failed with error " + std::to_string(error) +
                                   "; make a smaller picture"};
  }
  return {};
}

}  // namespace

Result<Image> Drawing::draw(std::span<const DrawnCrowd> crowds, const DrawingConfig& given,
                            DrawingReport* report, const PanelView& panel) {
  if (auto sound = check(given); !sound) return sound.error();
  const DrawingConfig config = completed(given);
  State& state = *state_;
  state.make_current();
  DrawingReport done;
  if (auto ok = state.paint(crowds, config, false, done); !ok) return ok.error();
  state.panel.draw(state.panel_program, panel, config.width, config.height, config.samples);
  const auto start = Clock::now();
  const GLsizei wide = state.target.width, high = state.target.height;
  state.texels.resize(static_cast<size_t>(wide) * static_cast<size_t>(high) * 4);
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glReadPixels(0, 0, wide, high, GL_RGBA, GL_UNSIGNED_BYTE, state.texels.data());
  done.seconds_draw += seconds_since(start);
  if (report != nullptr) *report = done;
  if (auto ok = no_driver_error(); !ok) return ok.error();
  return reduce(state.texels, config.width, config.height, config.samples);
}

Result<void> Drawing::show(std::span<const DrawnCrowd> crowds, const DrawingConfig& given,
                           DrawingReport* report, const PanelView& panel) {
  if (auto sound = check(given); !sound) return sound.error();
  const DrawingConfig config = completed(given);
  State& state = *state_;
  state.make_current();
  DrawingReport done;
  // On a processor, copying a picture costs as much as drawing its sky.
  const bool at_once = config.samples == 1 && !state.culls(config) && state.window_has_depth();
  if (auto ok = state.paint(crowds, config, at_once, done); !ok) return ok.error();
  if (!at_once) {
    glBindFramebuffer(GL_READ_FRAMEBUFFER, state.target.frame.get());
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, 0);
    glBlitFramebuffer(0, 0, state.target.width, state.target.height, 0, 0, config.width,
                      config.height, GL_COLOR_BUFFER_BIT,
                      config.samples == 1 ? GL_NEAREST : GL_LINEAR);
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
  }
  glViewport(0, 0, config.width, config.height);
  state.panel.draw(state.panel_program, panel, config.width, config.height, 1);
  if (report != nullptr) *report = done;
  return no_driver_error();
}

}  // namespace throng
