// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <epoxy/gl.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "draw/atlas_textures.h"
#include "draw/gl_objects.h"
#include "draw/headless.h"
#include "draw/matrix.h"
#include "draw/scene_mesh.h"
#include "draw/shaders.h"
#include "draw/wardrobe.h"
#include "throng_draw/draw.h"

// A picture in four passes: the sun's depth of scene and avatars, the sky, the scene, the avatars.
// All instances of a picture go up in one upload: those that the eye sees,
// then the same as the sun sees them.
namespace throng {
namespace {

constexpr GLsizei kInstancesWide = 2048;
constexpr GLsizei kSunPixels = 4096;

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

// A run of instances of one crowd, in the one upload.
struct Run {
  size_t atlas = 0;
  size_t first = 0, count = 0;
};

// Colour and depth that are no window's.
struct Target {
  GlFramebuffer frame;
  GlRenderbuffer colour, depth;
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

struct Drawing::State {
  std::unique_ptr<Headless> context;
  GlProgram sky, scene, depth, impostor, shadow;
  GlVertexArray nothing;  // Vertices by number alone.
  SceneMesh mesh;
  std::vector<AtlasTextures> atlases;
  std::vector<ImpostorInstance> instances;
  std::vector<Run> seen, thrown;
  GlTexture instance_texture, sun_depth;
  GlFramebuffer sun_frame;
  GLsizei instance_rows = 0;
  Target target;

  Result<void> make_programs();
  Result<void> fit_target(GLsizei width, GLsizei height);
  void pack(std::span<const DrawnCrowd> crowds, const DrawingConfig& config, Vec3d to_sun);
  void upload_instances();
  void draw_sun_depth(const Matrix& sun_from_world, Vec3d sun_right, Vec3d sun_up) const;
  void draw_crowd(const GlProgram& program, const std::vector<Run>& runs) const;
};

Result<void> Drawing::State::make_programs() {
  sky = GlProgram(shaders::sky_vertex(), shaders::sky_fragment());
  scene = GlProgram(shaders::scene_vertex(), shaders::scene_fragment());
  depth = GlProgram(shaders::depth_vertex(), shaders::depth_fragment());
  impostor = GlProgram(shaders::impostor_vertex(), shaders::impostor_fragment());
  shadow = GlProgram(shaders::shadow_vertex(), shaders::shadow_fragment());
  for (const GlProgram* program : {&sky, &scene, &depth, &impostor, &shadow}) {
    if (program->is_linked()) continue;
    const std::string fault = program->fault().substr(0, program->fault().find('\n'));
    return Error{Errc::kNotFound,
                 "drawing: the driver refuses a shader (" + fault + "); use another driver"};
  }
  nothing = make_vertex_array();
  sun_depth = make_texture();
  glBindTexture(GL_TEXTURE_2D, sun_depth.get());
  glTexStorage2D(GL_TEXTURE_2D, 1, GL_DEPTH_COMPONENT24, kSunPixels, kSunPixels);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_COMPARE_MODE, GL_COMPARE_REF_TO_TEXTURE);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_COMPARE_FUNC, GL_LEQUAL);
  sun_frame = make_framebuffer();
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
  target = {make_framebuffer(), make_renderbuffer(), make_renderbuffer(), width, height};
  glBindRenderbuffer(GL_RENDERBUFFER, target.colour.get());
  glRenderbufferStorage(GL_RENDERBUFFER, GL_RGBA8, width, height);
  glBindRenderbuffer(GL_RENDERBUFFER, target.depth.get());
  glRenderbufferStorage(GL_RENDERBUFFER, GL_DEPTH_COMPONENT24, width, height);
  glBindFramebuffer(GL_FRAMEBUFFER, target.frame.get());
  glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER,
                            target.colour.get());
  glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER,
                            target.depth.get());
  if (glCheckFramebufferStatus(GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE) return {};
  target = {};
  return Error{Errc::kLimit,
               "drawing: the picture does not fit into the card's memory; make it "
               "smaller"};
}

void Drawing::State::pack(std::span<const DrawnCrowd> crowds, const DrawingConfig& config,
                          Vec3d to_sun) {
  size_t most = 0;
  for (const DrawnCrowd& crowd : crowds) most += crowd.avatars.x.size();
  if (instances.size() < 2 * most) instances.resize(2 * most);
  seen.clear();
  thrown.clear();
  size_t used = 0;
  const auto add = [&](const DrawnCrowd& crowd, std::optional<Vec3d> from, std::vector<Run>& runs) {
    const PackConfig pack_config{.camera = config.camera,
                                 .clip = crowd.clip,
                                 .from_direction = from,
                                 .workers = config.workers};
    const size_t count = pack_impostors(atlases[crowd.atlas].shape, crowd.avatars, pack_config,
                                        std::span(instances).subspan(used));
    if (count > 0) runs.push_back({crowd.atlas, used, count});
    used += count;
  };
  for (const DrawnCrowd& crowd : crowds) add(crowd, {}, seen);
  if (!config.avatar_shadows) return;
  for (const DrawnCrowd& crowd : crowds) add(crowd, to_sun, thrown);
}

void Drawing::State::upload_instances() {
  size_t used = 0;
  for (const auto* runs : {&seen, &thrown}) {
    for (const Run& run : *runs) used = std::max(used, run.first + run.count);
  }
  const auto rows = static_cast<GLsizei>((used + kInstancesWide - 1) / kInstancesWide);
  glActiveTexture(GL_TEXTURE3);
  if (instance_rows == 0 || instance_rows < rows) {
    instance_rows = std::max(rows, GLsizei{1});
    instance_texture = make_texture();
    glBindTexture(GL_TEXTURE_2D, instance_texture.get());
    glTexStorage2D(GL_TEXTURE_2D, 1, GL_RGBA32UI, kInstancesWide, instance_rows);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
  }
  glBindTexture(GL_TEXTURE_2D, instance_texture.get());
  if (rows == 0) return;
  const size_t whole = static_cast<size_t>(rows) * kInstancesWide;
  if (instances.size() < whole) instances.resize(whole);
  glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, kInstancesWide, rows, GL_RGBA_INTEGER, GL_UNSIGNED_INT,
                  instances.data());
}

void Drawing::State::draw_sun_depth(const Matrix& sun_from_world, Vec3d sun_right,
                                    Vec3d sun_up) const {
  glBindFramebuffer(GL_FRAMEBUFFER, sun_frame.get());
  glViewport(0, 0, kSunPixels, kSunPixels);
  glClear(GL_DEPTH_BUFFER_BIT);
  depth.use();
  depth.set_matrix("clip_from_world", sun_from_world.data());
  glEnable(GL_POLYGON_OFFSET_FILL);
  glPolygonOffset(1.5F, 2.0F);
  mesh.draw();
  glDisable(GL_POLYGON_OFFSET_FILL);
  if (thrown.empty()) return;
  shadow.use();
  shadow.set_matrix("clip_from_world", sun_from_world.data());
  shadow.set("sun_right", sun_right);
  shadow.set("sun_up", sun_up);
  shadow.set("instances", 3);
  draw_crowd(shadow, thrown);
}

void Drawing::State::draw_crowd(const GlProgram& program, const std::vector<Run>& runs) const {
  glBindVertexArray(nothing.get());
  for (const Run& run : runs) {
    atlases[run.atlas].bind(program);
    program.set("first", static_cast<int>(run.first));
    glDrawArrays(GL_TRIANGLES, 0, static_cast<GLsizei>(6 * run.count));
  }
}

Drawing::Drawing(std::unique_ptr<State> state) : state_(std::move(state)) {}
Drawing::Drawing(Drawing&&) noexcept = default;
Drawing& Drawing::operator=(Drawing&&) noexcept = default;

Drawing::~Drawing() {
  if (!state_) return;
  state_->context->make_current();
  std::unique_ptr<Headless> last = std::move(state_->context);
  state_.reset();  // Names first, then the context that they are of.
}

Result<Drawing> Drawing::create() {
  auto state = std::make_unique<State>();
  Result<std::unique_ptr<Headless>> context = Headless::create();
  if (!context) return context.error();
  state->context = *std::move(context);
  Drawing drawing(std::move(state));
  if (auto made = drawing.state_->make_programs(); !made) return made.error();
  return drawing;
}

Result<void> Drawing::check(const DrawingConfig& c) {
  const EyeCamera& camera = c.camera;
  const auto finite = [](Vec3d v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
  };
  const bool sound = c.width >= 16 && c.width <= 8192 && c.height >= 16 && c.height <= 8192 &&
                     c.samples >= 1 && c.samples <= 4 && c.workers >= 0;
  if (!sound) {
    return Error{Errc::kBadConfig, "drawing: need 16 to 8192 pixels a side and 1 to 4 samples"};
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
  state_->context->make_current();
  const auto* name = reinterpret_cast<const char*>(glGetString(GL_RENDERER));
  return name == nullptr ? "unknown" : name;
}

Result<void> Drawing::set_scene(const Scene& scene, Vec3d origin) {
  state_->context->make_current();
  return state_->mesh.set(scene, origin);
}

Result<size_t> Drawing::add_atlas(const Atlas& atlas) {
  state_->context->make_current();
  Result<AtlasTextures> made = AtlasTextures::make(atlas);
  if (!made) return made.error();
  state_->atlases.push_back(*std::move(made));
  return state_->atlases.size() - 1;
}

Result<Image> Drawing::draw(std::span<const DrawnCrowd> crowds, const DrawingConfig& given,
                            DrawingReport* report) {
  if (auto sound = check(given); !sound) return sound.error();
  DrawingConfig config = given;
  config.camera.aspect = static_cast<double>(config.width) / config.height;
  State& state = *state_;
  state.context->make_current();
  const GLsizei wide = config.width * config.samples, high = config.height * config.samples;
  if (auto fits = state.fit_target(wide, high); !fits) return fits.error();

  const Vec3d to_sun = config.to_sun * (1 / length(config.to_sun));
  const auto start = std::chrono::steady_clock::now();
  state.pack(crowds, config, to_sun);
  const double seconds_pack = seconds_since(start);
  const auto draw_start = std::chrono::steady_clock::now();
  state.upload_instances();

  // The sun's picture covers what is near the target, as far as shadows can be told apart.
  const EyeCamera& camera = config.camera;
  const CameraAxes axes = camera_axes(camera);
  const Box3d& bounds = state.mesh.bounds();
  const double scene_radius = bounds.empty() ? 1 : 0.5 * length(bounds.max - bounds.min) + 1;
  const Vec3d scene_middle = bounds.empty() ? Vec3d{} : (bounds.min + bounds.max) * 0.5;
  const double reach = std::min(scene_radius, 1.6 * length(camera.target - camera.eye) + 20);
  const Vec3d middle = reach < scene_radius ? camera.target : scene_middle;
  const Vec3d sun_right =
      cross({0, 1, 0}, to_sun) * (1 / std::max(1e-9, length(cross({0, 1, 0}, to_sun))));
  const Vec3d sun_up = cross(to_sun, sun_right);
  const Matrix sun_from_world =
      parallel_view(sun_right, sun_up, to_sun, middle, reach, 2 * scene_radius + reach);
  const Matrix clip_from_world = perspective(camera);
  // Little of it over the scene, whatever its size, and the sky's colour at the end of the plain.
  const auto haze = static_cast<float>(
      0.15 / std::max({150.0, scene_radius, length(camera.target - camera.eye)}));

  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_LEQUAL);
  glDepthMask(GL_TRUE);
  glDisable(GL_BLEND);
  state.draw_sun_depth(sun_from_world, sun_right, sun_up);

  glBindFramebuffer(GL_FRAMEBUFFER, state.target.frame.get());
  glViewport(0, 0, wide, high);
  glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
  glActiveTexture(GL_TEXTURE4);
  glBindTexture(GL_TEXTURE_2D, state.sun_depth.get());
  const auto begin = [&](const GlProgram& program) {
    program.use();
    program.set_matrix("clip_from_world", clip_from_world.data());
    program.set_matrix("sun_from_world", sun_from_world.data());
    program.set("eye", camera.eye);
    program.set("to_sun", to_sun);
    program.set("haze", haze);
    program.set("instances", 3);
    program.set("sun_depth", 4);
    program.set("sun_texel", 1.0F / kSunPixels);
  };
  begin(state.sky);
  const double up = std::tan(0.5 * camera.field_of_view);
  state.sky.set("right", axes.right * (up * camera.aspect));
  state.sky.set("up", axes.up * up);
  state.sky.set("forward", axes.forward);
  glDepthMask(GL_FALSE);
  glBindVertexArray(state.nothing.get());
  glDrawArrays(GL_TRIANGLES, 0, 3);
  glDepthMask(GL_TRUE);

  begin(state.scene);
  state.scene.set("bias", static_cast<float>(2.5 * reach / kSunPixels));
  state.mesh.draw();

  begin(state.impostor);
  static const auto kWardrobe = wardrobe();
  state.impostor.set_colours("wardrobe", kWardrobe.data(), kColoursAPart * kBodyParts);
  state.draw_crowd(state.impostor, state.seen);

  std::vector<uint8_t> rgba(static_cast<size_t>(wide) * static_cast<size_t>(high) * 4);
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glReadPixels(0, 0, wide, high, GL_RGBA, GL_UNSIGNED_BYTE, rgba.data());
  if (report != nullptr) {
    *report = {.seconds_pack = seconds_pack, .seconds_draw = seconds_since(draw_start)};
    for (const DrawnCrowd& crowd : crowds) report->avatars += crowd.avatars.x.size();
    for (const Run& run : state.seen) report->drawn += run.count;
  }
  if (const GLenum error = glGetError(); error != GL_NO_ERROR) {
    return Error{Errc::kLimit, "drawing: the driver failed with error " + std::to_string(error) +
                                   "; make a smaller picture"};
  }
  return reduce(rgba, config.width, config.height, config.samples);
}

}  // namespace throng
