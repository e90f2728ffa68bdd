// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "core/random.h"
#include "core/stopwatch.h"
#include "throng/bake.h"
#include "throng/papers.h"
#include "throng/scene.h"
#include "throng_draw/draw.h"

// A point of [TC00] figures 3 and 4: frames of a plain city of a given number of polygons with
// avatars that walk, in the three modes of the paper, in turn: straight on through everything and
// drawn as plain quads; with collision; with collision and as impostors. All of the city is in the
// picture. A frame is a step of all avatars, culling, packing, upload, drawing and reading back.
// With --fill: frames of avatars at one distance, by the packed views of an atlas and by the equal
// squares of the paper, and how many pixels of both are shaded.
namespace throng {
namespace {

struct Options {
  double size = 316, cell = 0.5, dt = 0.04;
  uint64_t polygons = 2368;
  uint32_t avatars = 10'000;
  int32_t runs = 9, workers = 2, width = 1280, height = 720;
  double fill = 0;
  std::string picture;
};

// Arrays for the card, relative to the middle of the city.
struct Arrays {
  std::vector<float> x, y, z;
  std::vector<uint16_t> heading, phase, appearance;
  void resize(size_t n) {
    x.resize(n), y.resize(n), z.resize(n);
    heading.resize(n), phase.resize(n), appearance.resize(n);
  }
  [[nodiscard]] ImpostorArrays view() const { return {x, y, z, heading, phase, appearance}; }
};

uint16_t turns16(double turns) {
  return static_cast<uint16_t>(static_cast<int64_t>(std::floor(turns * 65536 + 0.5)) & 0xffff);
}

// Avatars without collision: straight on, and back at the border.
class StraightWalkers {
 public:
  StraightWalkers(const std::vector<AvatarState>& from, double size, double step)
      : states_(from), size_(size), step_(step) {}
  void step() {
    for (AvatarState& s : states_) {
      const double x = s.position.x + s.heading_x * step_, z = s.position.z + s.heading_z * step_;
      if (x < 0 || x > size_) s.heading_x = -s.heading_x;
      if (z < 0 || z > size_) s.heading_z = -s.heading_z;
      s.position.x = std::clamp(x, 0.0, size_);
      s.position.z = std::clamp(z, 0.0, size_);
    }
  }
  void read(std::vector<AvatarState>& out) const { out = states_; }

 private:
  std::vector<AvatarState> states_;
  double size_, step_;
};

// What is drawn of avatars that have walked `distance`.
void fill(const std::vector<AvatarState>& states, const AtlasClip& clip, double size,
          double distance, Arrays& out) {
  out.resize(states.size());
  for (size_t i = 0; i < states.size(); ++i) {
    const AvatarState& s = states[i];
    out.x[i] = static_cast<float>(s.position.x - size / 2);
    out.y[i] = static_cast<float>(s.position.y);
    out.z[i] = static_cast<float>(s.position.z - size / 2);
    out.heading[i] = turns16(std::atan2(s.heading_x, s.heading_z) / 6.283185307179586);
    out.phase[i] = turns16(walk_phase(clip, distance, random_unit(1, s.id, 3)));
    out.appearance[i] = static_cast<uint16_t>(random_below(1, s.id, 4, 2048));
  }
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

DrawingConfig config_of(const Options& options) {
  DrawingConfig config;
  config.width = options.width, config.height = options.height;
  config.samples = 1;
  config.avatar_shadows = false;
  config.sun_pixels = 1024;
  config.culling = HiddenCulling::kNever;
  config.workers = options.workers;
  const double half = 0.5 * options.size;
  config.camera.eye = {0.35 * half, 1.5 * half, 1.75 * half};
  config.camera.target = {0, 0, 0.1 * half};
  config.camera.furthest = 20 * half;
  config.camera.nearest = 0.002 * half;
  return config;
}

// The frames of one point.
class Point {
 public:
  Point(const Options& options, Drawing& drawing, const Atlas& atlas,
        std::optional<Wanderers> crowd, double speed)
      : options_(options),
        drawing_(drawing),
        atlas_(atlas),
        config_(config_of(options)),
        crowd_(std::move(crowd)),
        straight_(start(), options.size, speed * options.dt),
        step_(speed * options.dt) {}

  enum class Kind { kPlain, kCollision, kTextured, kDetail };
  static constexpr const char* kNames[] = {"plain", "collision", "textured", "detail"};

  // Seconds of a frame, or less than 0.
  double frame(Kind kind) {
    const bool is_textured = kind == Kind::kTextured || kind == Kind::kDetail;
    config_.avatars = is_textured ? AvatarStyle::kPeople : AvatarStyle::kPlainQuads;
    // As printed: each avatar by its nearest view, however small.
    config_.point_pixels = kind == Kind::kDetail ? DrawingConfig{}.point_pixels : 0;
    config_.view_blend = kind == Kind::kDetail ? DrawingConfig{}.view_blend : 0;
    const Clock::time_point started = Clock::now();
    if (kind == Kind::kPlain) {
      straight_.step();
    } else if (crowd_) {
      crowd_->step();
      walked_ += step_;
    }
    const double stepped = seconds_since(started);
    if (kind == Kind::kPlain) {
      straight_.read(states_);
    } else if (crowd_) {
      crowd_->read(states_);
    }
    fill(states_, atlas_.clips[0], options_.size, walked_, arrays_);
    const DrawnCrowd drawn{.atlas = 0, .clip = 0, .avatars = arrays_.view()};
    const auto image = drawing_.draw({&drawn, states_.empty() ? 0U : 1U}, config_, &report_);
    if (!image) return -1;
    seconds_step_ = stepped;
    if (kind == Kind::kTextured) image_ = *image;
    return seconds_since(started);
  }
  [[nodiscard]] double seconds_step() const { return seconds_step_; }
  [[nodiscard]] size_t drawn() const { return report_.drawn; }
  [[nodiscard]] const Image& image() const { return image_; }
  [[nodiscard]] CrowdCheck check() const { return crowd_ ? crowd_->check() : CrowdCheck{}; }

 private:
  std::vector<AvatarState> start() {
    if (crowd_) crowd_->read(states_);
    return states_;
  }

  const Options& options_;
  Drawing& drawing_;
  const Atlas& atlas_;
  DrawingConfig config_;
  std::optional<Wanderers> crowd_;
  std::vector<AvatarState> states_;
  StraightWalkers straight_;
  double step_ = 0, walked_ = 0, seconds_step_ = 0;
  Arrays arrays_;
  DrawingReport report_;
  Image image_;
};

int run(const Options& options) {
  const auto fail = [](const std::string& message) {
    std::fprintf(stderr, "bench_figures: %s\n", message.c_str());
    return 2;
  };
  Context context;
  const Result<Scene> scene =
      create_builtin_world({.name = "blocks", .size = options.size, .triangles = options.polygons});
  if (!scene) return fail(scene.error().message);
  const Clock::time_point baking = Clock::now();
  BakeConfig bake;
  bake.cell = options.cell;
  bake.classes = {AvatarClass{}};
  bake.workers = options.workers;
  const Result<World> world = bake_world(*scene, bake, context);
  if (!world) return fail(world.error().message);
  const double seconds_bake = seconds_since(baking);
  std::optional<Wanderers> crowd;
  if (options.avatars > 0) {
    auto made = Wanderers::create(
        *world, {.avatars = options.avatars, .dt = options.dt, .workers = options.workers});
    if (!made) return fail(made.error().message);
    crowd.emplace(*std::move(made));
  }
  Result<Drawing> drawing = Drawing::create();
  if (!drawing) return fail(drawing.error().message);
  const double half = options.size / 2;
  if (auto ok = drawing->set_scene(*scene, {half, 0, half}); !ok) return fail(ok.error().message);
  const auto atlas = create_atlas(built_in_character(), {}, context);
  if (!atlas) return fail(atlas.error().message);
  if (const auto number = drawing->add_atlas(*atlas); !number) return fail(number.error().message);

  using Kind = Point::Kind;
  Point point(options, *drawing, *atlas, std::move(crowd), AvatarClass{}.speed);
  std::vector<double> times[4], steps;
  for (int32_t r = -2; r < options.runs; ++r) {  // Two to warm up.
    for (const Kind kind : {Kind::kPlain, Kind::kCollision, Kind::kTextured, Kind::kDetail}) {
      const double seconds = point.frame(kind);
      if (seconds < 0) return fail("a frame was not drawn");
      if (r < 0) continue;
      times[static_cast<size_t>(kind)].push_back(seconds);
      if (kind != Kind::kPlain) steps.push_back(point.seconds_step());
    }
  }
  const CrowdCheck check = point.check();
  if (!options.picture.empty()) {
    if (auto ok = write_png(point.image(), options.picture); !ok) return fail(ok.error().message);
  }
  nlohmann::ordered_json json = {{"renderer", drawing->renderer()},
                                 {"size", options.size},
                                 {"polygons", scene->triangles.size()},
                                 {"avatars", options.avatars},
                                 {"drawn", point.drawn()},
                                 {"faults", check.wall_entries + check.overlaps},
                                 {"seconds_bake", seconds_bake},
                                 {"ms_step", median(steps) * 1e3},
                                 {"min_step", *std::min_element(steps.begin(), steps.end()) * 1e3}};
  for (size_t k = 0; k < 4; ++k) {
    json[std::string("ms_") + Point::kNames[k]] = median(times[k]) * 1e3;
    json[std::string("min_") + Point::kNames[k]] =
        *std::min_element(times[k].begin(), times[k].end()) * 1e3;
  }
  std::printf("%s\n", json.dump().c_str());
  return 0;
}

// The atlas as [TC00] has it: each view is a whole square.
Atlas in_squares(const Atlas& packed) {
  Atlas out = packed;
  const int32_t side = packed.shape.pixels;
  const int32_t columns = 1024 / side, rows = 2048 / side;
  const auto a_page = static_cast<size_t>(columns) * static_cast<size_t>(rows);
  out.width = columns * side, out.height = rows * side;
  out.pages = static_cast<int32_t>((packed.views.size() + a_page - 1) / a_page);
  const auto texels = static_cast<size_t>(out.width) * static_cast<size_t>(out.height) *
                      static_cast<size_t>(out.pages);
  out.colour.assign(texels * 4, 0);
  out.normal.assign(texels * 2, 128);
  out.mask.assign(texels, 0);
  const auto at = [](const Atlas& atlas, const AtlasView& view, int32_t x, int32_t y) {
    return (static_cast<size_t>(view.page) * static_cast<size_t>(atlas.height) +
            static_cast<size_t>(view.y + y)) *
               static_cast<size_t>(atlas.width) +
           static_cast<size_t>(view.x + x);
  };
  for (size_t i = 0; i < packed.views.size(); ++i) {
    const AtlasView& from = packed.views[i];
    const auto n = static_cast<int32_t>(i % a_page);
    AtlasView& to = out.views[i];
    to.page = static_cast<uint16_t>(i / a_page);
    to.x = static_cast<uint16_t>(n % columns * side);
    to.y = static_cast<uint16_t>(n / columns * side);
    to.width = to.height = static_cast<uint16_t>(side);
    to.left = to.top = 0;
    for (int32_t y = 0; y < std::min<int32_t>(from.height, side - from.top); ++y) {
      for (int32_t x = 0; x < std::min<int32_t>(from.width, side - from.left); ++x) {
        const size_t source = at(packed, from, x, y);
        const size_t target = at(out, to, from.left + x, from.top + y);
        std::copy_n(&packed.colour[source * 4], 4, &out.colour[target * 4]);
        std::copy_n(&packed.normal[source * 2], 2, &out.normal[target * 2]);
        out.mask[target] = packed.mask[source];
      }
    }
  }
  return out;
}

// Avatars at one distance, within a twentieth, spread over the picture: their squares cover it four
// times.
struct FillScene {
  DrawingConfig config;
  Arrays arrays;
  double view_pixels = 0;    // Along a view's side.
  double pixels_packed = 0;  // Of the rectangle of the chosen view, mean.
  double pixels_square = 0;
};

FillScene fill_scene(const Options& options, const Atlas& atlas) {
  constexpr double kCover = 4;
  FillScene out;
  out.config = config_of(options);
  out.config.point_pixels = 0, out.config.view_blend = 0;
  out.config.camera = EyeCamera{.eye = {0, 0, 0}, .target = {0, 0, -1}};
  const double up = std::tan(0.5 * out.config.camera.field_of_view) * options.fill;
  const double right = up * options.width / options.height;
  const double pixel = 2 * up / options.height;  // At that distance. [m]
  out.view_pixels = atlas.shape.side / pixel;
  const auto count = static_cast<size_t>(
      kCover * options.width * options.height / (out.view_pixels * out.view_pixels) + 0.5);
  out.arrays.resize(count);
  for (size_t i = 0; i < count; ++i) {
    const Vec3d middle{(2 * random_unit(1, i, 0) - 1) * right, (2 * random_unit(1, i, 1) - 1) * up,
                       -options.fill * (0.95 + 0.1 * random_unit(1, i, 5))};
    out.arrays.x[i] = static_cast<float>(middle.x);
    out.arrays.y[i] = static_cast<float>(middle.y - atlas.shape.centre);
    out.arrays.z[i] = static_cast<float>(middle.z);
    out.arrays.heading[i] = static_cast<uint16_t>(random_u64(1, i, 2));
    out.arrays.phase[i] = static_cast<uint16_t>(random_u64(1, i, 3));
    out.arrays.appearance[i] = static_cast<uint16_t>(random_below(1, i, 4, 2048));
    const ViewChoice choice =
        choose_view(atlas.shape, atlas.clips[0], middle * -1.0, out.arrays.heading[i] / 65536.0,
                    out.arrays.phase[i] / 65536.0);
    const AtlasView& view = atlas.views[atlas.shape.view(choice.frame, choice.row, choice.column)];
    const double texel = out.view_pixels / atlas.shape.pixels;
    out.pixels_packed += view.width * texel * view.height * texel / static_cast<double>(count);
  }
  out.pixels_square = out.view_pixels * out.view_pixels;
  return out;
}

int run_fill(const Options& options) {
  const auto fail = [](const std::string& message) {
    std::fprintf(stderr, "bench_figures: %s\n", message.c_str());
    return 2;
  };
  Context context;
  const auto packed = create_atlas(built_in_character(), {}, context);
  if (!packed) return fail(packed.error().message);
  const Atlas squares = in_squares(*packed);
  Result<Drawing> drawing = Drawing::create();
  if (!drawing) return fail(drawing.error().message);
  // A piece of ground far below, because a drawing has a scene.
  const Result<Scene> scene = create_builtin_world({.name = "cube", .size = 1});
  if (!scene) return fail(scene.error().message);
  if (auto ok = drawing->set_scene(*scene, {0, 1e4, 0}); !ok) return fail(ok.error().message);
  for (const Atlas* atlas : {&*packed, &squares}) {
    if (const auto number = drawing->add_atlas(*atlas); !number) {
      return fail(number.error().message);
    }
  }
  const FillScene fill = fill_scene(options, *packed);
  std::vector<double> times[3];
  Image images[3];
  for (int32_t r = -2; r < options.runs; ++r) {
    for (size_t kind = 0; kind < 3; ++kind) {  // Packed, squares, no avatar.
      const DrawnCrowd drawn{.atlas = kind % 2, .clip = 0, .avatars = fill.arrays.view()};
      const Clock::time_point started = Clock::now();
      auto image = drawing->draw({&drawn, kind < 2 ? 1U : 0U}, fill.config);
      if (!image) return fail(image.error().message);
      if (r >= 0) times[kind].push_back(seconds_since(started));
      images[kind] = *std::move(image);
    }
  }
  if (!options.picture.empty()) {
    if (auto ok = write_png(images[0], options.picture); !ok) return fail(ok.error().message);
  }
  size_t differ = 0;
  for (size_t i = 0; i < images[0].rgb.size(); ++i) differ += images[0].rgb[i] != images[1].rgb[i];
  nlohmann::ordered_json json = {
      {"renderer", drawing->renderer()},
      {"distance", options.fill},
      {"avatars", fill.arrays.x.size()},
      {"view_pixels", fill.view_pixels},
      {"pixels_packed", fill.pixels_packed},
      {"pixels_square", fill.pixels_square},
      {"differing_share", static_cast<double>(differ) / static_cast<double>(images[0].rgb.size())}};
  constexpr const char* kNames[] = {"packed", "square", "empty"};
  for (size_t k = 0; k < 3; ++k) {
    json[std::string("ms_") + kNames[k]] = median(times[k]) * 1e3;
    json[std::string("min_") + kNames[k]] =
        *std::min_element(times[k].begin(), times[k].end()) * 1e3;
  }
  std::printf("%s\n", json.dump().c_str());
  return 0;
}

}  // namespace
}  // namespace throng

int main(int argc, char** argv) {
  CLI::App app{"A point of [TC00] figures 3 and 4: plain, with collision, with impostors"};
  throng::Options options;
  app.add_option("--size", options.size, "Side of the city [m]");
  app.add_option("--polygons", options.polygons, "Triangles of the city");
  app.add_option("--avatars", options.avatars, "Number of avatars");
  app.add_option("--runs", options.runs, "Frames of each kind")->check(CLI::Range(1, 1000));
  app.add_option("--cell", options.cell, "Of the ground [m]");
  app.add_option("--threads", options.workers, "For steps, culling and packing");
  app.add_option("--width", options.width, "[px]");
  app.add_option("--height", options.height, "[px]");
  app.add_option("--picture", options.picture, "Keep the last frame of impostors");
  app.add_option("--fill", options.fill, "Packed views beside squares, at this distance [m]");
  CLI11_PARSE(app, argc, argv);
  return options.fill > 0 ? throng::run_fill(options) : throng::run(options);
}
