// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "core/random.h"
#include "core/stopwatch.h"
#include "throng/scene.h"
#include "throng_draw/draw.h"

// Frames of a city with a crowd on its ground: as people, as plain quads at the same places,
// without avatars, and as people without the query of what is hidden; frame by frame in turn, so
// that other load on the machine affects all alike. A frame is culling, packing, upload, drawing
// and reading back.
namespace throng {
namespace {

struct Options {
  uint64_t polygons = 30'000;
  size_t avatars = 10'000;
  int32_t runs = 15, samples = 1, workers = 2, width = 1280, height = 720;
  bool hard = false, shadows = false, street = false;
  double point_pixels = DrawingConfig{}.point_pixels, view_blend = DrawingConfig{}.view_blend;
  std::string picture;
};

struct Crowd {
  std::vector<float> x, y, z;
  std::vector<uint16_t> heading, phase, look;
  void add(Vec3d p, uint64_t n) {
    x.push_back(static_cast<float>(p.x));
    y.push_back(static_cast<float>(p.y));
    z.push_back(static_cast<float>(p.z));
    heading.push_back(static_cast<uint16_t>(random_u64(1, n, 2)));
    phase.push_back(static_cast<uint16_t>(random_u64(1, n, 3)));
    look.push_back(static_cast<uint16_t>(random_below(1, n, 4, 2048)));
  }
};

// Where nothing but ground is: cells of a metre over which no triangle rises.
struct OpenGround {
  Box3d bounds;
  int32_t width = 0, depth = 0;
  std::vector<uint8_t> built;
  explicit OpenGround(const Scene& scene) : bounds(scene.bounds()) {
    width = static_cast<int32_t>(std::ceil(bounds.max.x - bounds.min.x));
    depth = static_cast<int32_t>(std::ceil(bounds.max.z - bounds.min.z));
    built.assign(static_cast<size_t>(width) * static_cast<size_t>(depth), 0);
    for (const auto& corners : scene.triangles) {
      Box3d box;
      for (const uint32_t c : corners) box.add(scene.positions[c]);
      if (box.max.y < bounds.min.y + 1.2) continue;
      const auto cell = [](double v, int32_t size) {
        return std::clamp(static_cast<int32_t>(std::floor(v)), 0, size - 1);
      };
      for (int32_t z = cell(box.min.z - bounds.min.z, depth);
           z <= cell(box.max.z - bounds.min.z, depth); ++z) {
        for (int32_t x = cell(box.min.x - bounds.min.x, width);
             x <= cell(box.max.x - bounds.min.x, width); ++x) {
          built[static_cast<size_t>(z) * static_cast<size_t>(width) + static_cast<size_t>(x)] = 1;
        }
      }
    }
  }
  // The n-th place: any place, if there is no open one in a hundred tries.
  [[nodiscard]] Vec3d place(uint64_t n) const {
    double x = 0, z = 0;
    for (uint64_t k = 0; k < 100; ++k) {
      x = random_unit(7, n, 2 * k) * width;
      z = random_unit(7, n, 2 * k + 1) * depth;
      const auto at = static_cast<size_t>(z) * static_cast<size_t>(width) + static_cast<size_t>(x);
      if (built[std::min(at, built.size() - 1)] == 0) break;
    }
    return {bounds.min.x + x, 0, bounds.min.z + z};
  }
};

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

double min_of(const std::vector<double>& values) {
  return *std::min_element(values.begin(), values.end());
}

DrawingConfig config_of(const Options& options, const Box3d& bounds, const Crowd& crowd) {
  DrawingConfig config;
  config.width = options.width, config.height = options.height;
  config.samples = options.samples;
  config.avatar_shadows = options.shadows;
  config.sun_pixels = 1024;
  config.soft_shadows = !options.hard;
  config.point_pixels = options.point_pixels;
  config.view_blend = options.view_blend;
  config.workers = options.workers;
  // All of the city is in the picture.
  const double half = 0.5 * std::max(bounds.max.x - bounds.min.x, bounds.max.z - bounds.min.z);
  config.camera.eye = {0.35 * half, 1.5 * half, 1.75 * half};
  config.camera.target = {0, 0, 0.1 * half};
  config.camera.furthest = 20 * half;
  config.camera.nearest = 0.002 * half;
  if (options.street) {  // From an avatar near the middle, along the street.
    size_t middle = 0;
    for (size_t i = 0; i < crowd.x.size(); ++i) {
      if (std::hypot(crowd.x[i], crowd.z[i]) < std::hypot(crowd.x[middle], crowd.z[middle]))
        middle = i;
    }
    config.camera = EyeCamera{.eye = {crowd.x[middle], crowd.y[middle] + 1.7, crowd.z[middle]},
                              .target = {crowd.x[middle] + 10.0, 1.5, crowd.z[middle] + 1.0}};
  }
  return config;
}

int run(const Options& options) {
  const auto fail = [](const Error& error) {
    std::fprintf(stderr, "bench_draw: %s\n", error.message.c_str());
    return 2;
  };
  // Small cities are parts of one.
  constexpr uint64_t kWhole = 30'000;
  Result<Scene> scene =
      create_builtin_world({.name = "city", .triangles = std::max(kWhole, options.polygons)});
  if (!scene) return fail(scene.error());
  if (options.polygons < kWhole && scene->triangles.size() > options.polygons) {
    scene->triangles.resize(options.polygons);
    scene->area.resize(options.polygons);
  }
  const Box3d bounds = scene->bounds();
  const Vec3d origin = (bounds.min + bounds.max) * 0.5;
  Result<Drawing> drawing = Drawing::create();
  if (!drawing) return fail(drawing.error());
  if (auto ok = drawing->set_scene(*scene, {origin.x, 0, origin.z}); !ok) return fail(ok.error());
  Context context;
  AtlasConfig atlas_config;
  const auto atlas = create_atlas(built_in_character(), atlas_config, context);
  if (!atlas) return fail(atlas.error());
  const auto number = drawing->add_atlas(*atlas);
  if (!number) return fail(number.error());
  const OpenGround ground(*scene);
  Crowd crowd;
  for (size_t i = 0; i < options.avatars; ++i) {
    crowd.add(ground.place(i) - Vec3d{origin.x, 0, origin.z}, i);
  }
  const DrawnCrowd drawn{
      .atlas = *number,
      .clip = 0,
      .avatars = {crowd.x, crowd.y, crowd.z, crowd.heading, crowd.phase, crowd.look}};
  DrawingConfig config = config_of(options, bounds, crowd);
  std::vector<double> people, quads, without_avatars, whole, pack, cull, ratio;
  DrawingReport last, seen, uncut;
  const auto frame = [&](AvatarStyle style, bool with, double& packing) -> double {
    config.avatars = style;
    DrawingReport report;
    const auto image =
        drawing->draw(with ? std::span(&drawn, 1) : std::span<const DrawnCrowd>(), config, &report);
    if (!image) return -1;
    packing = report.seconds_pack;
    if (with) last = report;
    return report.seconds_pack + report.seconds_cull + report.seconds_draw;
  };
  double packing = 0, none = 0;
  for (int32_t r = -2; r < options.runs; ++r) {  // Two to warm up.
    const double b = frame(AvatarStyle::kPlainQuads, true, none);
    config.culling = HiddenCulling::kNever;
    const double d = frame(AvatarStyle::kPeople, true, none);
    uncut = last;
    config.culling = HiddenCulling::kWhereItPays;
    const double a = frame(AvatarStyle::kPeople, true, packing);
    const double c = frame(AvatarStyle::kPeople, false, none);
    if (r < 0) continue;
    people.push_back(a), quads.push_back(b), without_avatars.push_back(c), pack.push_back(packing);
    whole.push_back(d), cull.push_back(last.seconds_cull);
    seen = last;
    ratio.push_back(a / b);
  }
  if (!options.picture.empty()) {
    config.avatars = AvatarStyle::kPeople;
    const auto image = drawing->draw({&drawn, 1}, config);
    if (image) (void)write_png(*image, options.picture);
  }
  const nlohmann::ordered_json json = {{"renderer", drawing->renderer()},
                                       {"triangles", scene->triangles.size()},
                                       {"avatars", options.avatars},
                                       {"seen", seen.drawn + seen.hidden},
                                       {"hidden", seen.hidden},
                                       {"triangles_seen", uncut.triangles},
                                       {"triangles_drawn", seen.triangles},
                                       {"runs", options.runs},
                                       {"ms_people", median(people) * 1e3},
                                       {"ms_quads", median(quads) * 1e3},
                                       {"ms_empty", median(without_avatars) * 1e3},
                                       {"least_people", min_of(people) * 1e3},
                                       {"least_quads", min_of(quads) * 1e3},
                                       {"min_empty", min_of(without_avatars) * 1e3},
                                       {"ms_all", median(whole) * 1e3},
                                       {"ms_cull", median(cull) * 1e3},
                                       {"ms_pack", median(pack) * 1e3},
                                       {"ratio", median(ratio)}};
  std::printf("%s\n", json.dump().c_str());
  return 0;
}

}  // namespace
}  // namespace throng

int main(int argc, char** argv) {
  CLI::App app{"A city from above: avatars as people and as plain quads, in one run"};
  throng::Options options;
  app.add_option("--polygons", options.polygons, "Triangles of the city, about");
  app.add_option("--avatars", options.avatars, "Number of avatars");
  app.add_option("--runs", options.runs, "Frames of each kind")->check(CLI::Range(1, 1000));
  app.add_option("--samples", options.samples, "Along a side of a pixel");
  app.add_option("--threads", options.workers, "For culling and packing");
  app.add_option("--point-pixels", options.point_pixels,
                 "Avatars up to this height are points, 0: none");
  app.add_option("--view-blend", options.view_blend, "Share of the angle between views, 0: none");
  app.add_flag("--hard", options.hard, "One sample for shadows, not nine");
  app.add_flag("--street", options.street, "From a street, not from above");
  app.add_flag("--shadows", options.shadows, "Of avatars");
  app.add_option("--width", options.width, "[px]");
  app.add_option("--height", options.height, "[px]");
  app.add_option("--picture", options.picture, "Keep the last frame");
  CLI11_PARSE(app, argc, argv);
  return throng::run(options);
}
