// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <flatbuffers/flatbuffers.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>

#include "core/hash.h"
#include "impostor/atlas_file.h"
#include "impostor/atlas_generated.h"
#include "impostor/figure_raster.h"
#include "impostor/gait.h"
#include "impostor/view_packer.h"
#include "scratch_folder.h"
#include "throng/impostor.h"

namespace throng {
namespace {

AtlasConfig small_config(int32_t workers = 0) {
  AtlasConfig config;
  config.clips = {"Walk", "Idle"};
  config.frames = 4;
  config.directions = 6;
  config.elevations = 3;
  config.pixels = 32;
  config.workers = workers;
  return config;
}

const Atlas& small_atlas() {
  static const Atlas atlas = [] {
    Context context;
    auto built = create_atlas(built_in_character(), small_config(), context);
    return *std::move(built);
  }();
  return atlas;
}

uint64_t hash_of(const Atlas& atlas) {
  uint64_t sum = 0;
  for (const auto* bytes : {&atlas.colour, &atlas.normal, &atlas.mask}) {
    sum = hash_span(std::span<const uint8_t>(*bytes), sum);
  }
  for (const AtlasView& v : atlas.views) {
    const uint16_t words[] = {v.page, v.x, v.y, v.width, v.height, v.left, v.top};
    sum = hash_span(std::span<const uint16_t>(words), sum);
  }
  return sum;
}

// The texel (x, y) of a view's square, empty where the view does not reach.
std::array<uint8_t, 4> texel(const Atlas& atlas, const AtlasView& view, int32_t x, int32_t y) {
  x -= view.left, y -= view.top;
  if (x < 0 || y < 0 || x >= view.width || y >= view.height) return {};
  const size_t at =
      (static_cast<size_t>(view.page) * atlas.height + view.y + y) * atlas.width + view.x + x;
  return {atlas.colour[at * 4], atlas.colour[at * 4 + 1], atlas.colour[at * 4 + 2],
          atlas.colour[at * 4 + 3]};
}

TEST(Atlas, ViewsKeepToBlocksDoNotOverlapAndHaveAnEmptyBorder) {
  const Atlas& atlas = small_atlas();
  ASSERT_EQ(atlas.views.size(), 8U * 3 * 6);
  std::vector<uint8_t> used(atlas.mask.size());
  for (const AtlasView& v : atlas.views) {
    EXPECT_EQ((v.x | v.y | v.width | v.height) % 4, 0);
    ASSERT_LE(v.x + v.width, atlas.width);
    ASSERT_LE(v.y + v.height, atlas.height);
    bool covered = false;
    for (int32_t y = 0; y < v.height; ++y) {
      for (int32_t x = 0; x < v.width; ++x) {
        const size_t at = static_cast<size_t>(v.page * atlas.height + v.y + y) * atlas.width +
                          static_cast<size_t>(v.x + x);
        EXPECT_EQ(used[at]++, 0);
        const uint8_t alpha = atlas.colour[at * 4 + 3];
        const bool border = x == 0 || y == 0 || x + 1 == v.width || y + 1 == v.height;
        EXPECT_TRUE(!border || alpha == 0);
        covered = covered || alpha == 255;
      }
    }
    EXPECT_TRUE(covered);
  }
}

// Each view must equal the picture of a camera at its place, which is drawn again and compared.
TEST(Atlas, EveryViewIsWhatItsCameraSees) {
  const Atlas& atlas = small_atlas();
  const Character character = built_in_character();
  impostor::FigureRaster raster(character, 32);
  impostor::FigureView view;
  PosedMesh mesh;
  // As an atlas is documented: over the origin, feet at 0, the first clip 1.75 m high.
  const size_t walk = *find_clip(character, "Walk"), idle = *find_clip(character, "Idle");
  Box3d bounds;
  for (int32_t i = 0; i < 4; ++i) {
    impostor::pose_in_place(character, walk, impostor::place_of_clip(character, walk), i / 4.0,
                            mesh);
    for (const Vec3d& p : mesh.positions) bounds.add(p);
  }
  impostor::pose_in_place(character, idle, impostor::place_of_clip(character, idle), 0.25, mesh);
  const double scale = 1.75 / (bounds.max.y - bounds.min.y);
  for (Vec3d& p : mesh.positions) p = Vec3d{p.x, p.y - bounds.min.y, p.z} * scale;
  for (int32_t row = 0; row < 3; ++row) {
    for (int32_t column = 0; column < 6; ++column) {
      impostor::FigureCamera camera = impostor::figure_camera(column, 6, row, 3);
      camera.centre = {0, atlas.shape.centre, 0};
      camera.side = atlas.shape.side;
      raster.draw(mesh, camera, view);
      const AtlasView& packed = atlas.views[atlas.shape.view(4 + 1, row, column)];
      int64_t off = 0, covered = 0;
      for (int32_t y = 0; y < 32; ++y) {
        for (int32_t x = 0; x < 32; ++x) {
          const int alpha = view.colour[static_cast<size_t>(y * 32 + x)][3];
          off += std::abs(alpha - texel(atlas, packed, x, y)[3]);
          covered += alpha == 255 ? 1 : 0;
        }
      }
      EXPECT_GT(covered, 15) << row << " " << column;
      EXPECT_EQ(off, 0) << row << " " << column;
    }
  }
}

// Left and right of the built-in figure are alike, so a mirrored view is a view from the other side
// half a cycle on: here both are drawn, and compared.
TEST(Atlas, AMirroredViewShowsWhatTheOtherSideLooksLike) {
  const Character character = built_in_character();
  const size_t walk = *find_clip(character, "Walk");
  impostor::FigureRaster raster(character, 64);
  impostor::FigureView there, here;
  PosedMesh mesh;
  for (const double share : {0.0, 0.2, 0.35}) {
    for (int32_t column = 0; column < 16; ++column) {
      impostor::FigureCamera camera = impostor::figure_camera(column, 16, 2, 8);
      camera.centre = {0, 0.9, 0};
      camera.side = 2.1;
      pose_character(character, walk, character.clips[walk].seconds * (share + 0.5), mesh);
      raster.draw(mesh, camera, here);
      // The column past the last half turn, which no atlas holds.
      camera = impostor::figure_camera(31 - column, 16, 2, 8);
      camera.centre = {0, 0.9, 0};
      camera.side = 2.1;
      pose_character(character, walk, character.clips[walk].seconds * share, mesh);
      raster.draw(mesh, camera, there);
      int64_t off = 0;
      for (size_t y = 0; y < 64; ++y) {
        for (size_t x = 0; x < 64; ++x) {
          for (size_t c = 0; c < 4; ++c) {
            off += std::abs(there.colour[y * 64 + x][c] - here.colour[y * 64 + 63 - x][c]);
          }
        }
      }
      EXPECT_LT(off, 64 * 64 * 4 / 2) << column << " at " << share;
    }
  }
}

// [TC00]: the view direction picks the row and column, the heading is added, the phase picks the
// frame. Views filled with their own numbers show which one was chosen.
TEST(Atlas, CodedViewsComeBackFromAllDirectionsElevationsAndFrames) {
  Atlas atlas;
  atlas.shape = {.pixels = 8, .directions = 16, .elevations = 8, .frames = 10, .side = 2};
  atlas.clips = {{.name = "Walk", .first_frame = 0, .frames = 10, .seconds = 1, .stride = 1.5}};
  atlas.views.assign(1280, {.width = 8, .height = 8});
  const impostor::PageSize size = impostor::pack_views(atlas.views);
  atlas.width = size.width, atlas.height = size.height, atlas.pages = size.pages;
  atlas.colour.resize(static_cast<size_t>(size.width) * size.height * size.pages * 4);
  for (size_t i = 0; i < atlas.views.size(); ++i) {
    const AtlasView& v = atlas.views[i];
    for (int32_t y = 0; y < 8; ++y) {
      for (int32_t x = 0; x < 8; ++x) {
        const size_t at = static_cast<size_t>(v.page * size.height + v.y + y) * size.width +
                          static_cast<size_t>(v.x + x);
        atlas.colour[at * 4] = static_cast<uint8_t>(i / 16 % 8 * 16 + i % 16);
        atlas.colour[at * 4 + 1] = static_cast<uint8_t>(i / 128);
        atlas.colour[at * 4 + 2] = static_cast<uint8_t>(x);
        atlas.colour[at * 4 + 3] = 255;
      }
    }
  }
  int32_t checked = 0;
  for (int32_t sector = 0; sector < 32; ++sector) {
    for (int32_t row = 0; row < 8; ++row) {
      for (int32_t frame = 0; frame < 10; ++frame) {
        for (const double heading : {0.0, 0.4, 0.97}) {
          const double azimuth = ((sector + 0.5) / 32 + heading) * 2 * M_PI;
          const double elevation = (row + 0.5) / 8 * M_PI / 2;
          const Vec3d to_eye{std::sin(azimuth) * std::cos(elevation), std::sin(elevation),
                             std::cos(azimuth) * std::cos(elevation)};
          const ViewChoice choice =
              choose_view(atlas.shape, atlas.clips[0], to_eye, heading, frame / 10.0);
          const AtlasView& view =
              atlas.views[atlas.shape.view(choice.frame, choice.row, choice.column)];
          const auto shown = texel(atlas, view, choice.mirrored ? 7 - 1 : 1, 3);
          const int32_t column = sector < 16 ? sector : 31 - sector;
          EXPECT_EQ(shown[0], row * 16 + column);
          EXPECT_EQ(shown[1], sector < 16 ? frame : (frame + 5) % 10);
          EXPECT_EQ(shown[2], sector < 16 ? 1 : 6);
          ++checked;
        }
      }
    }
  }
  EXPECT_EQ(checked, 32 * 8 * 10 * 3);
}

TEST(Atlas, SameBytesForAnyNumberOfWorkers) {
  for (const int32_t workers : {1, 2, 3, 0}) {
    Context context;
    const auto atlas = create_atlas(built_in_character(), small_config(workers), context);
    ASSERT_TRUE(atlas) << atlas.error().message;
    EXPECT_EQ(hash_of(*atlas), 8541779138725335988ULL) << "workers = " << workers;
    EXPECT_EQ(hash_of(convert_atlas(*atlas, AtlasFormat::kBc3, workers)), 8726157399351789964ULL);
    EXPECT_EQ(hash_of(convert_atlas(*atlas, AtlasFormat::kEtc2, workers)), 8218502211340427212ULL);
    EXPECT_EQ(hash_of(convert_atlas(*atlas, AtlasFormat::kEtc2a1, workers)),
              15901827884940026803ULL);
  }
}

TEST(Atlas, EachFormatKeepsItsColoursWithinItsLimit) {
  const Atlas& atlas = small_atlas();
  EXPECT_EQ(atlas_psnr(atlas, atlas), INFINITY);
  const double min_psnr[] = {INFINITY, 38, 34, 34, 34, 35};
  for (int32_t f = 0; f < kAtlasFormats; ++f) {
    const auto format = static_cast<AtlasFormat>(f);
    const Atlas other = convert_atlas(atlas, format);
    EXPECT_EQ(other.colour.size(), packed_colour_bytes(atlas, format));
    EXPECT_GE(atlas_psnr(atlas, other), min_psnr[f]) << word_for(format);
    // Back and forth again changes nothing more.
    const Atlas back = convert_atlas(other, AtlasFormat::kRgba8);
    EXPECT_EQ(atlas_psnr(back, other), INFINITY);
    int32_t alpha_off = 0;
    for (size_t i = 0; i < atlas.mask.size(); ++i) {
      const int32_t exact = atlas.colour[i * 4 + 3];
      const int32_t asked = f == 1 || f == 2 || f == 4 ? (exact >= 128 ? 255 : 0) : exact;
      alpha_off = std::max(alpha_off, std::abs(asked - back.colour[i * 4 + 3]));
    }
    const bool whole_alpha = format == AtlasFormat::kBc3 || format == AtlasFormat::kEtc2;
    EXPECT_LE(alpha_off, whole_alpha ? 24 : 0) << word_for(format);
    int32_t furthest = 0;
    for (size_t i = 0; i < atlas.normal.size(); ++i) {
      if (atlas.colour[i / 2 * 4 + 3] < 128) continue;
      furthest = std::max(furthest, std::abs(atlas.normal[i] - back.normal[i]));
    }
    EXPECT_LE(furthest, f < 2 ? 0 : f < 4 ? 20 : 24) << word_for(format);
  }
}

// The figures of the seed: 1024 x 512 texels of 16 bits for each frame.
TEST(Atlas, TheAtlasOfTheSeedIsAMegabyteAFrame) {
  const AtlasShape shape{.pixels = 64, .directions = 16, .elevations = 8, .frames = 10};
  EXPECT_EQ(sheet_colour_bytes(shape, AtlasFormat::kRgb5a1), 10ULL << 20);
  EXPECT_EQ(sheet_colour_bytes(shape, AtlasFormat::kBc1), 10ULL << 18);
}

TEST(Atlas, AFileComesBackAsItWas) {
  const test::ScratchFolder folder;
  const std::string path = folder.path() + "/people.atlas";
  for (int32_t f = 0; f < kAtlasFormats; ++f) {
    const auto format = static_cast<AtlasFormat>(f);
    const Atlas atlas = convert_atlas(small_atlas(), format);
    ASSERT_TRUE(save_atlas(atlas, path));
    const auto back = load_atlas(path);
    ASSERT_TRUE(back) << back.error().message;
    EXPECT_EQ(hash_of(*back), hash_of(atlas));
    EXPECT_EQ(back->views, atlas.views);
    EXPECT_EQ(back->part_colour, atlas.part_colour);
    ASSERT_EQ(back->clips.size(), 2U);
    EXPECT_EQ(back->clips[1].name, "Idle");
    EXPECT_EQ(back->clips[1].first_frame, 4);
    EXPECT_EQ(back->clips[0].stride, atlas.clips[0].stride);
    EXPECT_EQ(back->shape.side, atlas.shape.side);
    EXPECT_EQ(back->format, format);
  }
}

class DamagedAtlas : public testing::TestWithParam<AtlasFormat> {};

TEST_P(DamagedAtlas, IsRefusedWhereverItIsDamaged) {
  const test::ScratchFolder folder;
  const std::string path = folder.path() + "/people.atlas";
  AtlasConfig config = small_config();
  config.clips = {"Idle"};
  config.frames = 1;
  config.directions = 2;
  config.elevations = 1;
  config.pixels = 8;
  Context context;
  const auto tiny = create_atlas(built_in_character(), config, context);
  ASSERT_TRUE(tiny) << tiny.error().message;
  ASSERT_TRUE(save_atlas(convert_atlas(*tiny, GetParam()), path));
  std::ifstream file(path, std::ios::binary);
  std::vector<uint8_t> bytes{std::istreambuf_iterator<char>(file), {}};
  const auto whole = impostor::read_atlas(bytes, "whole");
  ASSERT_TRUE(whole);
  for (size_t size = 0; size < bytes.size(); size += 1 + bytes.size() / 500) {
    EXPECT_FALSE(impostor::read_atlas(std::span(bytes.data(), size), "cut")) << size;
  }
  size_t refused = 0, same = 0;
  for (size_t at = 0; at<bytes.size(); at += bytes.size()> 20000 && at > 600 ? 37 : 1) {
    for (const int flip : {1, 0x80, 0xff}) {
      bytes[at] = static_cast<uint8_t>(bytes[at] ^ flip);
      const auto read = impostor::read_atlas(bytes, "damaged");
      bytes[at] = static_cast<uint8_t>(bytes[at] ^ flip);
      if (!read) {
        EXPECT_NE(read.error().message.find("damaged: "), std::string::npos);
        ++refused;
        continue;
      }
      // Bytes between the fields mean nothing.
      EXPECT_EQ(hash_of(*read), hash_of(*whole)) << at;
      EXPECT_EQ(read->shape.side, whole->shape.side) << at;
      EXPECT_EQ(read->clips[0].stride, whole->clips[0].stride) << at;
      ++same;
    }
  }
  EXPECT_GT(refused, 20 * same);
}

INSTANTIATE_TEST_SUITE_P(Atlas, DamagedAtlas,
                         testing::Values(AtlasFormat::kBc1, AtlasFormat::kEtc2a1,
                                         AtlasFormat::kEtc2),
                         [](const auto& of) { return std::string(word_for(of.param)); });

// Older programs still read the older formats, and report that the others are too new.
TEST(Atlas, OnlyFilesOfNewFormatsAreOfTheNewVersion) {
  const test::ScratchFolder folder;
  const std::string path = folder.path() + "/people.atlas";
  for (int32_t f = 0; f < kAtlasFormats; ++f) {
    const auto format = static_cast<AtlasFormat>(f);
    ASSERT_TRUE(save_atlas(convert_atlas(small_atlas(), format), path));
    std::ifstream file(path, std::ios::binary);
    std::vector<uint8_t> bytes{std::istreambuf_iterator<char>(file), {}};
    auto& table = *flatbuffers::GetMutableRoot<flatbuffers::Table>(bytes.data());
    const auto set_version = [&](uint32_t version) {
      return table.SetField<uint32_t>(format::AtlasFile::VT_VERSION, version, 0);
    };
    const uint32_t own = f < 4 ? 1 : 2;
    EXPECT_EQ(table.GetField<uint32_t>(format::AtlasFile::VT_VERSION, 0), own);
    for (const uint32_t version : {0U, 1U, 2U, 3U, 4U}) {
      ASSERT_TRUE(set_version(version));
      const auto read = impostor::read_atlas(bytes, "people");
      EXPECT_EQ(static_cast<bool>(read), version == own) << word_for(format) << version;
      if (read || (version != 0 && version != 4)) continue;
      EXPECT_NE(read.error().message.find("reads 1 to 3"), std::string::npos);
    }
  }
}

TEST(Atlas, BadSettingsAreRefusedAndNamed) {
  const Character character = built_in_character();
  const auto refused = [&](auto change, Errc code, const char* word) {
    AtlasConfig config = small_config();
    change(config);
    Context context;
    const auto atlas = create_atlas(character, config, context);
    ASSERT_FALSE(atlas) << word;
    EXPECT_EQ(atlas.error().code, code) << word;
    EXPECT_NE(atlas.error().message.find(word), std::string::npos) << atlas.error().message;
  };
  using Config = AtlasConfig&;
  refused([](Config c) { c.pixels = 1; }, Errc::kBadConfig, "pixels 1");
  refused([](Config c) { c.pixels = 257; }, Errc::kBadConfig, "pixels 257");
  refused([](Config c) { c.frames = 0; }, Errc::kBadConfig, "frames 0");
  refused([](Config c) { c.frames = 5; }, Errc::kBadConfig, "even");
  refused([](Config c) { c.directions = 1; }, Errc::kBadConfig, "directions 1");
  refused([](Config c) { c.elevations = 0; }, Errc::kBadConfig, "elevations 0");
  refused([](Config c) { c.clips = {}; }, Errc::kBadConfig, "clips");
  refused([](Config c) { c.height = -1; }, Errc::kBadConfig, "height");
  refused([](Config c) { c.height = NAN; }, Errc::kBadConfig, "height");
  refused([](Config c) { c.clips = {"Swim"}; }, Errc::kNotFound, "Swim");
  Character still = character;
  for (Vec3d& p : still.positions) p = {};
  for (Influence& i : still.influences) i.bone = {};
  for (Clip& clip : still.clips) clip.tracks.clear();
  Context context;
  const auto point = create_atlas(still, small_config(), context);
  ASSERT_FALSE(point);
  EXPECT_EQ(point.error().code, Errc::kBadInput);
}

TEST(Atlas, CancelStops) {
  Context context;
  context.cancel = true;
  const auto atlas = create_atlas(built_in_character(), small_config(), context);
  ASSERT_FALSE(atlas);
  EXPECT_EQ(atlas.error().code, Errc::kCancelled);
}

TEST(ViewPacker, ManyViewsFillPagesWithLittleWaste) {
  std::vector<AtlasView> views(5000);
  uint64_t area = 0;
  for (size_t i = 0; i < views.size(); ++i) {
    views[i].width = static_cast<uint16_t>(16 + i * 7 % 11 * 4);
    views[i].height = static_cast<uint16_t>(40 + i * 5 % 9 * 4);
    area += uint64_t{views[i].width} * views[i].height;
  }
  const impostor::PageSize size = impostor::pack_views(views);
  EXPECT_GT(size.pages, 1);
  const uint64_t total = uint64_t(size.width) * size.height * size.pages;
  EXPECT_LT(total, area + area / 10);
  std::vector<uint8_t> used(total);
  for (const AtlasView& v : views) {
    ASSERT_TRUE(v.page < size.pages && v.x + v.width <= size.width &&
                v.y + v.height <= size.height);
    for (int32_t y = 0; y < v.height; ++y) {
      for (int32_t x = 0; x < v.width; ++x) {
        ASSERT_EQ(
            used[(static_cast<size_t>(v.page) * size.height + v.y + y) * size.width + v.x + x]++,
            0);
      }
    }
  }
}

}  // namespace
}  // namespace throng
