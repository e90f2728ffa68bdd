// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "blank_atlas.h"
#include "golden_image.h"
#include "throng/impostor.h"
#include "throng/scene.h"
#include "throng_draw/draw.h"

namespace throng {
namespace {

struct Avatars {
  std::vector<float> x, y, z;
  std::vector<uint16_t> heading, phase, look;
  void add(Vec3d p, double heading_turns, double phase_turns, uint16_t clothes) {
    const auto steps = [](double turns) {
      return static_cast<uint16_t>(static_cast<int64_t>(std::floor(turns * 65536)) & 0xffff);
    };
    x.push_back(static_cast<float>(p.x));
    y.push_back(static_cast<float>(p.y));
    z.push_back(static_cast<float>(p.z));
    heading.push_back(steps(heading_turns));
    phase.push_back(steps(phase_turns));
    look.push_back(clothes);
  }
  [[nodiscard]] DrawnCrowd crowd(size_t atlas = 0) const {
    return {.atlas = atlas, .clip = 0, .avatars = {x, y, z, heading, phase, look}};
  }
};

Drawing made_drawing() {
  Result<Drawing> drawing = Drawing::create();
  EXPECT_TRUE(drawing) << drawing.error().message;
  return *std::move(drawing);
}

// Sixteen blocks of four texels a view, white or black: eleven bits that are the view's number, and
// in the lowest row a white one at the left and a black one at the right.
constexpr int32_t kWhiteBit = 12, kBlackBit = 15;

Atlas coded_atlas() {
  Atlas atlas = test::blank_atlas(10);
  for (size_t i = 0; i < atlas.views.size(); ++i) {
    for (int32_t t = 0; t < 256; ++t) {
      const int32_t bit = t / 64 * 4 + t % 16 / 4;
      if ((i >> bit & 1) != 0 || bit == kWhiteBit) continue;
      std::fill_n(test::texel_of(atlas, atlas.views[i], t), 3, uint8_t{0});
    }
  }
  return atlas;
}

// The card decodes blocks as we do, near and far.
TEST(GlDrawing, AtlasesOfBlocksStayBlocksAndLookTheSame) {
  AtlasConfig made;
  made.frames = 4;
  Context context;
  const auto atlas = create_atlas(built_in_character(), made, context);
  ASSERT_TRUE(atlas);
  Avatars avatars;
  for (int32_t i = 0; i < 200; ++i) {
    avatars.add({(i % 20 - 9.5) * 0.8, 0, -3.0 * (i / 20)}, i * 0.07, i * 0.13,
                static_cast<uint16_t>(i));
  }
  const DrawnCrowd crowd = avatars.crowd();
  DrawingConfig config;
  config.width = 640;
  config.height = 360;
  config.camera.eye = {0, 3, 9};
  config.camera.target = {0, 1, -6};
  for (const AtlasFormat format :
       {AtlasFormat::kBc1, AtlasFormat::kBc3, AtlasFormat::kEtc2a1, AtlasFormat::kEtc2}) {
    const bool small = format == AtlasFormat::kBc1 || format == AtlasFormat::kEtc2a1;
    const Atlas blocks = convert_atlas(*atlas, format);
    Drawing on_card = made_drawing(), unpacked = made_drawing();
    ASSERT_TRUE(on_card.add_atlas(blocks));
    ASSERT_TRUE(unpacked.add_atlas(convert_atlas(blocks, AtlasFormat::kRgba8)));
    EXPECT_FALSE(on_card.takes_blocks(AtlasFormat::kRgba8));
    if (!on_card.takes_blocks(format)) {
      GTEST_SKIP() << on_card.renderer() << " reads no " << word_for(format);
    }
    EXPECT_EQ(on_card.colour_bytes(0), blocks.colour.size());
    EXPECT_EQ(unpacked.colour_bytes(0) / on_card.colour_bytes(0), small ? 8U : 4U);
    const auto a = on_card.draw({&crowd, 1}, config), b = unpacked.draw({&crowd, 1}, config);
    ASSERT_TRUE(a && b);
    size_t differ = 0, people = 0;
    const auto empty = on_card.draw({}, config);
    ASSERT_TRUE(empty);
    for (size_t i = 0; i < a->rgb.size(); i += 3) {
      const auto far = [&](const Image& image, const Image& other) {
        int32_t largest = 0;
        for (size_t c = i; c < i + 3; ++c) {
          largest = std::max(largest, std::abs(image.rgb[c] - other.rgb[c]));
        }
        return largest > 8;
      };
      people += far(*b, *empty) ? 1 : 0;
      differ += far(*a, *b) ? 1 : 0;
    }
    EXPECT_GT(people, 10000U);
    // Smaller levels are made of other blocks than the card would make of the texels.
    EXPECT_LT(differ * 20, people) << word_for(format) << ": " << differ << " of " << people;
  }
}

// [TC00]: all 32 directions, 8 elevations and 10 frames, through the processor, the card's textures
// and shaders, down to the pixels.
TEST(GlDrawing, EveryDirectionElevationAndFrameShowsTheRightView) {
  Drawing drawing = made_drawing();
  const Atlas atlas = coded_atlas();
  ASSERT_TRUE(drawing.add_atlas(atlas));
  int32_t checked = 0;
  for (int32_t row = 0; row < 8; ++row) {
    const double elevation = (row + 0.5) / 32 * 2 * std::numbers::pi;
    DrawingConfig config;
    config.width = 1280;
    config.height = 720;
    config.samples = 1;
    config.avatar_shadows = false;
    const Vec3d towards{std::sin(0.7) * std::cos(elevation), std::sin(elevation),
                        std::cos(0.7) * std::cos(elevation)};
    config.camera.target = {5, 3, -8};
    config.camera.eye = config.camera.target + towards * 400.0;
    config.camera.field_of_view = 0.15;
    config.to_sun = towards;
    const CameraAxes axes = camera_axes(config.camera);
    // 320 avatars in a plane across the view, further apart than cards are wide.
    Avatars avatars;
    std::vector<Vec3d> middles;
    for (int32_t i = 0; i < 320; ++i) {
      const int32_t sector = i % 32, frame = i / 32;
      const Vec3d middle = config.camera.target + axes.right * ((i % 20 - 9.5) * 3.0) +
                           axes.up * ((i / 20 - 7.5) * 3.0);
      const Vec3d to_eye = config.camera.eye - middle;
      const double azimuth = std::atan2(to_eye.x, to_eye.z) / (2 * std::numbers::pi);
      middles.push_back(middle);
      avatars.add(middle - Vec3d{0, 1, 0}, azimuth - (sector + 0.5) / 32, frame / 10.0, 0);
    }
    const DrawnCrowd crowd = avatars.crowd();
    const auto image = drawing.draw({&crowd, 1}, config);
    ASSERT_TRUE(image) << image.error().message;
    const double scale = 360 / std::tan(0.5 * config.camera.field_of_view);
    for (int32_t i = 0; i < 320; ++i) {
      const auto green_at = [&](int32_t bit) {
        // Up and right of a card that faces the eye.
        const Vec3d d =
            (config.camera.eye - middles[i]) * (1 / length(config.camera.eye - middles[i]));
        const double flat = std::hypot(d.x, d.z);
        const Vec3d right{d.z / flat, 0, -d.x / flat}, up = cross(d, right);
        const Vec3d p = middles[i] + right * ((bit % 4 - 1.5) * 0.5) +
                        up * ((1.5 - bit / 4) * 0.5) - config.camera.eye;
        const double depth = dot(p, axes.forward);
        const auto px = static_cast<int32_t>(640 + dot(p, axes.right) / depth * scale);
        const auto py = static_cast<int32_t>(360 - dot(p, axes.up) / depth * scale);
        return image->rgb[static_cast<size_t>(py * 1280 + px) * 3 + 1];
      };
      const int32_t sector = i % 32, frame = i / 32;
      const bool mirrored = sector >= 16;
      const auto bit_at = [&](int32_t bit) { return mirrored ? bit / 4 * 4 + 3 - bit % 4 : bit; };
      const int32_t white = green_at(bit_at(kWhiteBit)), black = green_at(bit_at(kBlackBit));
      ASSERT_GT(white, black + 40) << "row " << row << " avatar " << i;
      size_t code = 0;
      for (int32_t bit = 0; bit < 11; ++bit) {
        if (green_at(bit_at(bit)) > (white + black) / 2) code |= size_t{1} << bit;
      }
      EXPECT_EQ(code, atlas.shape.view(mirrored ? (frame + 5) % 10 : frame, row,
                                       mirrored ? 31 - sector : sector))
          << "row " << row << " sector " << sector << " frame " << frame;
      ++checked;
    }
  }
  EXPECT_EQ(checked, 32 * 8 * 10);
}

const Atlas& people() {
  static const Atlas atlas = [] {
    AtlasConfig config;
    config.frames = 4;
    config.pixels = 48;
    Context context;
    auto built = create_atlas(built_in_character(), config, context);
    return *std::move(built);
  }();
  return atlas;
}

Scene stage_with_wall() {
  Scene scene;
  scene.add_box({-8, -0.5, -8}, {8, 0, 8});
  scene.add_box({-3, 0, 1}, {3, 1.0, 1.3});
  return scene;
}

DrawingConfig stage_config() {
  DrawingConfig config;
  config.width = 320;
  config.height = 180;
  config.camera.eye = {4, 4, 11};
  config.camera.target = {0, 0.8, 0};
  return config;
}

Avatars people_on_stage() {
  Avatars avatars;
  for (int32_t i = 0; i < 24; ++i) {
    avatars.add({i % 6 * 2.2 - 5.5, 0, i / 6 * 2.4 - 5.0}, i * 0.137, i * 0.31,
                static_cast<uint16_t>(i * 85));
  }
  return avatars;
}

// Exact on the llvmpipe of one machine; other vector instructions may round a pixel differently.
TEST(GlDrawing, AStageLooksAsItDid) {
  Drawing drawing = made_drawing();
  ASSERT_TRUE(drawing.set_scene(stage_with_wall(), {}));
  ASSERT_TRUE(drawing.add_atlas(people()));
  const Avatars avatars = people_on_stage();
  const DrawnCrowd crowd = avatars.crowd();
  const auto image = drawing.draw({&crowd, 1}, stage_config());
  ASSERT_TRUE(image) << image.error().message;
  ASSERT_EQ(image->width, 320);
  ASSERT_EQ(image->height, 180);
  test::expect_golden(*image, THRONG_TEST_DATA "/stage.png");
}

size_t pixels_that_differ(const Image& a, const Image& b) {
  size_t count = 0;
  for (size_t i = 0; i < a.rgb.size(); i += 3) {
    count += std::abs(a.rgb[i] - b.rgb[i]) + std::abs(a.rgb[i + 1] - b.rgb[i + 1]) > 24 ? 1 : 0;
  }
  return count;
}

// The card is inclined, the body upright: a wall must cut an avatar behind it in a straight line,
// and no part of the avatar may be visible in front of the wall.
TEST(GlDrawing, AWallHidesAvatarsBehindItAndNothingElse) {
  Drawing drawing = made_drawing();
  ASSERT_TRUE(drawing.add_atlas(people()));
  DrawingConfig config = stage_config();
  config.avatar_shadows = false;
  const auto seen_at = [&](Vec3d place, double wall_height) {
    Scene scene;
    scene.add_box({-8, -0.5, -8}, {8, 0, 8});
    scene.add_box({-3, 0, 1}, {3, wall_height, 1.3});
    EXPECT_TRUE(drawing.set_scene(scene, {}));
    Avatars avatars;
    avatars.add(place, 0.1, 0, 100);
    const DrawnCrowd crowd = avatars.crowd();
    const auto with = drawing.draw({&crowd, 1}, config);
    const auto without = drawing.draw({}, config);
    EXPECT_TRUE(with && without);
    return pixels_that_differ(*with, *without);
  };
  const size_t in_front = seen_at({0, 0, 2.2}, 3), behind_low = seen_at({0, 0, 0.4}, 1.0),
               no_wall = seen_at({0, 0, 0.4}, 0.01), behind_high = seen_at({0, 0, 0.4}, 3.5);
  EXPECT_GT(in_front, 150U);
  EXPECT_GT(no_wall, 150U);
  EXPECT_EQ(behind_high, 0U);
  EXPECT_GT(behind_low, no_wall / 5);
  EXPECT_LT(behind_low, no_wall * 4 / 5);
}

TEST(GlDrawing, ShadowsFallOnTheGround) {
  Drawing drawing = made_drawing();
  ASSERT_TRUE(drawing.set_scene(stage_with_wall(), {}));
  ASSERT_TRUE(drawing.add_atlas(people()));
  Avatars avatars;
  avatars.add({0, 0, 4}, 0.3, 0, 100);
  const DrawnCrowd crowd = avatars.crowd();
  DrawingConfig config = stage_config();
  config.to_sun = {-1, 1, 0};
  const auto with = drawing.draw({&crowd, 1}, config);
  config.avatar_shadows = false;
  const auto without = drawing.draw({&crowd, 1}, config);
  ASSERT_TRUE(with && without);
  EXPECT_GT(pixels_that_differ(*with, *without), 60U);
}

TEST(GlDrawing, SoftAndHardShadowsDifferAtTheirEdgesAlone) {
  Drawing drawing = made_drawing();
  ASSERT_TRUE(drawing.set_scene(stage_with_wall(), {}));
  DrawingConfig config = stage_config();
  const auto soft = drawing.draw({}, config);
  config.soft_shadows = false;
  const auto hard = drawing.draw({}, config);
  ASSERT_TRUE(soft && hard);
  size_t off = 0;
  for (size_t i = 0; i < soft->rgb.size(); i += 3) off += soft->rgb[i] != hard->rgb[i] ? 1 : 0;
  EXPECT_GT(off, 20U);
  EXPECT_LT(off, soft->rgb.size() / 3 / 50);
}

TEST(GlDrawing, TheSamePictureTwiceIsTheSameBytesAndTwoDrawingsDoNotDisturbEachOther) {
  Drawing one = made_drawing(), two = made_drawing();
  for (Drawing* drawing : {&one, &two}) {
    ASSERT_TRUE(drawing->set_scene(stage_with_wall(), {}));
    ASSERT_TRUE(drawing->add_atlas(people()));
  }
  const Avatars avatars = people_on_stage();
  const DrawnCrowd crowd = avatars.crowd();
  DrawingConfig config = stage_config();
  DrawingReport report;
  config.workers = 1;
  const auto first = one.draw({&crowd, 1}, config, &report);
  ASSERT_TRUE(two.draw({}, config));
  config.workers = 2;
  const auto second = one.draw({&crowd, 1}, config);
  const auto other = two.draw({&crowd, 1}, config);
  ASSERT_TRUE(first && second && other);
  EXPECT_EQ(first->rgb, second->rgb);
  EXPECT_EQ(first->rgb, other->rgb);
  EXPECT_EQ(report.avatars, 24U);
  EXPECT_GT(report.drawn, 18U);
}

TEST(GlDrawing, ABuiltInWorldIsDrawnAndBadSettingsAreRefused) {
  Drawing drawing = made_drawing();
  EXPECT_FALSE(drawing.renderer().empty());
  BuiltinWorldConfig world;
  world.name = "stairs";
  const auto scene = create_builtin_world(world);
  ASSERT_TRUE(scene) << scene.error().message;
  ASSERT_TRUE(drawing.set_scene(*scene, {1, 0, 1}));
  DrawingConfig good = stage_config();
  const auto image = drawing.draw({}, good);
  ASSERT_TRUE(image) << image.error().message;
  const auto refused = [&](auto change) {
    DrawingConfig config = good;
    change(config);
    const auto none = drawing.draw({}, config);
    EXPECT_FALSE(none);
    return none ? Errc::kOk : none.error().code;
  };
  using Config = DrawingConfig&;
  EXPECT_EQ(refused([](Config c) { c.width = 8; }), Errc::kBadConfig);
  EXPECT_EQ(refused([](Config c) { c.samples = 5; }), Errc::kBadConfig);
  EXPECT_EQ(refused([](Config c) { c.camera.target = c.camera.eye; }), Errc::kBadConfig);
  EXPECT_EQ(refused([](Config c) { c.camera.eye.x = NAN; }), Errc::kBadConfig);
  EXPECT_EQ(refused([](Config c) { c.camera.field_of_view = 3.2; }), Errc::kBadConfig);
  EXPECT_EQ(refused([](Config c) { c.to_sun = {1, 0, 0}; }), Errc::kBadConfig);
}

TEST(GlDrawing, PropsAndMarksAreShownUntilTheyAreReplaced) {
  Drawing drawing = made_drawing();
  Scene floor;
  floor.add_box({-20, -0.2, -20}, {20, 0, 20});
  ASSERT_TRUE(drawing.set_scene(floor, {}));
  const DrawingConfig config = stage_config();
  const auto shown = [&] {
    auto image = drawing.draw({}, config);
    EXPECT_TRUE(image) << image.error().message;
    return *std::move(image);
  };
  const Image empty = shown();
  Scene crate;
  crate.add_box({-1, 0, -1}, {1, 2, 1});
  ASSERT_TRUE(drawing.set_props(crate, {}));
  const Image with_crate = shown();
  EXPECT_GT(pixels_that_differ(empty, with_crate), 100u);
  ASSERT_TRUE(drawing.set_props({}, {}));
  EXPECT_EQ(pixels_that_differ(empty, shown()), 0u);
  const Rgba red = rgba(255, 0, 0);
  Marks marks;
  marks.triangles = {{-2, 0.1F, -2, red}, {2, 0.1F, 2, red}, {2, 0.1F, -2, red}};
  ASSERT_TRUE(drawing.set_marks(3, marks));
  EXPECT_GT(pixels_that_differ(empty, shown()), 100u);
  EXPECT_FALSE(drawing.set_marks(kMarkSlots, marks));
  marks.triangles.pop_back();
  EXPECT_FALSE(drawing.set_marks(3, marks)) << "no whole triangle";
  Marks line;
  line.lines.resize(3);
  EXPECT_FALSE(drawing.set_marks(3, line));
  ASSERT_TRUE(drawing.set_marks(3, {}));
  EXPECT_EQ(pixels_that_differ(empty, shown()), 0u);
}

TEST(GlDrawing, APanelIsDrawnWithItsTexture) {
  Drawing drawing = made_drawing();
  const DrawingConfig config = stage_config();
  const std::vector<uint8_t> half{255, 0, 255, 0};  // the left column
  ASSERT_TRUE(drawing.set_panel_texture(2, 2, half));
  const Rgba green = rgba(0, 255, 0);
  const std::vector<PanelVertex> corners{
      {0, 0, 0, 0, green}, {64, 0, 1, 0, green}, {64, 64, 1, 1, green}, {0, 64, 0, 1, green}};
  const std::vector<uint32_t> indices{0, 1, 2, 0, 2, 3};
  const std::vector<PanelRun> runs{{0, 6, 0, 0, 64, 64}};
  const auto image = drawing.draw({}, config, nullptr, {corners, indices, runs});
  ASSERT_TRUE(image) << image.error().message;
  const auto green_at = [&](size_t x, size_t y) {
    const uint8_t* pixel = &image->rgb[3 * (y * static_cast<size_t>(config.width) + x)];
    return pixel[1] > 250 && pixel[0] < 5 && pixel[2] < 5;
  };
  EXPECT_TRUE(green_at(16, 32));
  EXPECT_FALSE(green_at(48, 32)) << "its texels there are clear";
  EXPECT_FALSE(green_at(16, 80)) << "below the panel";
  EXPECT_FALSE(drawing.set_panel_texture(2, 2, std::span(half).first(3)));
  EXPECT_FALSE(drawing.set_panel_texture(0, 0, {}));
  EXPECT_FALSE(drawing.set_panel_texture(-2, -2, half));
}

TEST(GlDrawing, AtlasesThatAreClearedAreNumberedAgain) {
  Drawing drawing = made_drawing();
  EXPECT_EQ(*drawing.add_atlas(coded_atlas()), 0u);
  EXPECT_EQ(*drawing.add_atlas(coded_atlas()), 1u);
  Avatars avatars;
  avatars.add({0, 0, 0}, 0, 0, 0);
  const DrawnCrowd crowd = avatars.crowd(1);
  EXPECT_TRUE(drawing.draw({&crowd, 1}, stage_config()));
  drawing.clear_atlases();
  const auto refused = [&](const DrawnCrowd& one) {
    const auto image = drawing.draw({&one, 1}, stage_config());
    EXPECT_FALSE(image);
    return image ? Errc::kOk : image.error().code;
  };
  EXPECT_EQ(refused(crowd), Errc::kBadInput);
  EXPECT_EQ(*drawing.add_atlas(coded_atlas()), 0u);
  DrawnCrowd bad = avatars.crowd();
  bad.clip = 99;
  EXPECT_EQ(refused(bad), Errc::kBadInput);
  bad = avatars.crowd();
  bad.avatars.phase = {};
  EXPECT_EQ(refused(bad), Errc::kBadInput);
}

// One avatar, nearer and nearer: point, view, mesh. Neighbours in size look alike, and in a fade
// both are there.
TEST(GlDrawing, LevelsOfDetailLookAlike) {
  Drawing drawing = made_drawing();
  Context context;
  AtlasConfig atlas_config;
  const auto atlas = create_atlas(built_in_character(), atlas_config, context);
  ASSERT_TRUE(atlas);
  ASSERT_TRUE(drawing.add_atlas(*atlas));
  AtlasConfig pose_config = atlas_config;
  pose_config.frames = 24;
  const auto model = create_figure_model(built_in_character(), pose_config, context);
  ASSERT_TRUE(model);
  ASSERT_TRUE(drawing.set_model(0, *model));
  FigureModel other = *model;
  other.clips.clear();
  EXPECT_EQ(drawing.set_model(0, other).error().code, Errc::kBadInput);
  Avatars avatars;
  avatars.add({0, 0, 0}, 0.1, 0.3, 77);
  const DrawnCrowd crowd = avatars.crowd();
  const auto seen = [&](double distance, double mesh_texel, double point_pixels) {
    DrawingConfig config;
    config.width = config.height = 200;
    config.samples = 1;
    config.avatar_shadows = false;
    config.mesh_texel = mesh_texel;
    config.point_pixels = point_pixels;
    config.camera.eye = {0, 0.875 + 0.2 * distance, distance};
    config.camera.target = {0, 0.875, 0};
    config.camera.field_of_view = 2 * std::atan(1.2 / distance);
    DrawingReport report;
    auto image = drawing.draw({&crowd, 1}, config, &report);
    EXPECT_TRUE(image) << image.error().message;
    EXPECT_EQ(report.avatars, 1U);
    return std::pair(*std::move(image), report.drawn);
  };
  const auto none = drawing.draw({}, {.camera = {.eye = {0, 2.875, 10},
                                                 .target = {0, 0.875, 0},
                                                 .field_of_view = 2 * std::atan(0.12)},
                                      .width = 200,
                                      .height = 200,
                                      .samples = 1});
  ASSERT_TRUE(none);
  const auto covered = [&](const Image& image) {
    int64_t count = 0;
    for (size_t i = 0; i < image.rgb.size(); i += 3) {
      int32_t off = 0;
      for (size_t c = 0; c < 3; ++c) off += std::abs(image.rgb[i + c] - none->rgb[i + c]);
      count += off > 40 ? 1 : 0;
    }
    return count;
  };
  // A side of 2.07 m is 172 pixels of the picture's 200: texels of 2.7 pixels.
  const auto [mesh, one_mesh] = seen(10, 1, 0);
  const auto [view, one_view] = seen(10, 0, 0);
  const auto [point, one_point] = seen(10, 0, 2000);
  const auto [both, one_of_both] = seen(10, 2.5, 0);
  EXPECT_EQ(one_mesh, 1U);
  EXPECT_EQ(one_view, 1U);
  EXPECT_EQ(one_point, 1U);
  EXPECT_EQ(one_of_both, 1U);
  EXPECT_NE(both.rgb, mesh.rgb);
  EXPECT_NE(both.rgb, view.rgb);
  const auto area = static_cast<double>(covered(view));
  EXPECT_GT(area, 2000);
  EXPECT_NEAR(static_cast<double>(covered(mesh)) / area, 1, 0.12);
  EXPECT_NEAR(static_cast<double>(covered(both)) / area, 1, 0.12);
  EXPECT_NEAR(static_cast<double>(covered(point)) / area, 1.2, 0.5);
  // Mesh and view show the same colours at the same places, but for texels' edges.
  int64_t off = 0;
  for (size_t i = 0; i < mesh.rgb.size(); ++i) off += std::abs(mesh.rgb[i] - view.rgb[i]) > 40;
  EXPECT_LT(static_cast<double>(off), 0.35 * 3 * area);
}

}  // namespace
}  // namespace throng
