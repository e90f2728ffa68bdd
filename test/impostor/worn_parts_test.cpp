// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "core/hash.h"
#include "impostor/figure_frames.h"
#include "impostor/figure_raster.h"
#include "scratch_folder.h"
#include "throng/impostor.h"

namespace throng {
namespace {

AtlasConfig small_config() {
  AtlasConfig config;
  config.frames = 4;
  config.directions = 6;
  config.elevations = 3;
  config.pixels = 32;
  return config;
}

Atlas atlas_of(const Character& character, int32_t workers = 0) {
  Context context;
  AtlasConfig config = small_config();
  config.workers = workers;
  auto made = create_atlas(character, config, context);
  EXPECT_TRUE(made) << made.error().message;
  return *std::move(made);
}

const Atlas& dressed() {
  static const Atlas atlas = atlas_of(built_in_character_with_parts());
  return atlas;
}

struct Texel {
  std::array<uint8_t, 4> colour{};
  uint8_t mask = 0;
  friend bool operator==(const Texel&, const Texel&) = default;
};

// The texel (x, y) of a view's square, empty where the view does not reach.
Texel texel(const Atlas& atlas, const AtlasView& view, int32_t x, int32_t y) {
  x -= view.left, y -= view.top;
  if (x < 0 || y < 0 || x >= view.width || y >= view.height) return {};
  const size_t at = (static_cast<size_t>(view.page) * static_cast<size_t>(atlas.height) + view.y +
                     static_cast<size_t>(y)) *
                        static_cast<size_t>(atlas.width) +
                    view.x + static_cast<size_t>(x);
  Texel out;
  std::copy_n(&atlas.colour[at * 4], 4, out.colour.begin());
  out.mask = atlas.mask[at];
  return out;
}

TEST(WornParts, TheBodyIsTheSameWhateverItWears) {
  const Atlas bare = atlas_of(built_in_character());
  EXPECT_TRUE(bare.parts.empty());
  ASSERT_EQ(dressed().parts.size(), 7U);
  EXPECT_EQ(dressed().views.size(), 8 * bare.views.size());
  EXPECT_EQ(dressed().shape.side, bare.shape.side);
  EXPECT_EQ(dressed().shape.height, bare.shape.height);
  EXPECT_EQ(dressed().clips[0].stride, bare.clips[0].stride);
  for (size_t v = 0; v < bare.views.size(); ++v) {
    for (int32_t i = 0; i < 32 * 32; ++i) {
      ASSERT_EQ(texel(bare, bare.views[v], i % 32, i / 32),
                texel(dressed(), dressed().views[v], i % 32, i / 32));
    }
  }
}

// Where along the ray a triangle is met, the larger the nearer to the eye.
double met_at(const std::array<Vec3d, 3>& t, Vec3d from, Vec3d along) {
  const Vec3d normal = cross(t[1] - t[0], t[2] - t[0]);
  const double slope = dot(normal, along);
  if (slope == 0) return -INFINITY;
  const double at = dot(normal, t[0] - from) / slope;
  const Vec3d p = from + along * at;
  for (size_t k = 0; k < 3; ++k) {
    if (dot(cross(t[(k + 1) % 3] - t[k], p - t[k]), normal) < 0) return -INFINITY;
  }
  return at;
}

// Sixteen rays a texel, against all triangles.
TEST(WornParts, ATexelOfAPartCoversWhatIsNotBehindTheBody) {
  const Character character = built_in_character_with_parts();
  const Atlas& atlas = dressed();
  const auto frames = impostor::pose_frames(character, small_config());
  ASSERT_TRUE(frames);
  const size_t count = atlas.shape.view(atlas.shape.frames, 0, 0);
  size_t covered = 0, hidden = 0, wrong = 0, rays = 0;
  for (const auto& [part, frame, row, column] : std::vector<std::array<int32_t, 4>>{{0, 0, 0, 0},
                                                                                    {0, 0, 1, 5},
                                                                                    {2, 0, 2, 3},
                                                                                    {4, 1, 0, 1},
                                                                                    {5, 0, 0, 5},
                                                                                    {5, 0, 1, 0},
                                                                                    {6, 2, 0, 3}}) {
    const WornPart& worn = character.worn[static_cast<size_t>(part)];
    const PosedMesh& mesh = frames->frames[static_cast<size_t>(frame)];
    const impostor::FigureCamera camera = impostor::figure_camera(column, 6, row, 3);
    const AtlasView& view =
        atlas.views[(1 + static_cast<size_t>(part)) * count + atlas.shape.view(frame, row, column)];
    const auto nearest = [&](size_t first, size_t triangles, Vec3d from) {
      double at = -INFINITY;
      for (size_t t = first; t < first + triangles; ++t) {
        const auto& c = character.triangles[t];
        at = std::max(at, met_at({mesh.positions[c[0]], mesh.positions[c[1]], mesh.positions[c[2]]},
                                 from, camera.towards));
      }
      return at;
    };
    for (int32_t i = 0; i < 32 * 32; i += 7) {
      int32_t samples = 0;
      for (int32_t s = 0; s < 16; ++s, ++rays) {
        const double x = (i % 32 + (s % 4 + 0.5) / 4) / 32 - 0.5;
        const double y = (i / 32 + (s / 4 + 0.5) / 4) / 32 - 0.5;
        const Vec3d from = Vec3d{0, atlas.shape.centre, 0} + camera.right * (x * atlas.shape.side) -
                           camera.up * (y * atlas.shape.side);
        const double own = nearest(worn.first_triangle, worn.triangle_count, from);
        if (own == -INFINITY) continue;
        const bool is_hidden = nearest(0, character.body_triangles(), from) >= own;
        samples += is_hidden ? 0 : 1;
        hidden += is_hidden ? 1 : 0;
      }
      const int32_t stored = (texel(atlas, view, i % 32, i / 32).colour[3] * 16 + 254) / 255;
      covered += static_cast<size_t>(samples);
      wrong += static_cast<size_t>(std::abs(stored - samples));
    }
  }
  EXPECT_GT(covered, 300U);
  EXPECT_GT(hidden, 30U);
  EXPECT_LE(wrong * 200, rays) << wrong << " of " << rays;  // Rays along an edge.
}

// A hat keeps its shape: its pictures are those of the first frame, where the head has moved it.
TEST(WornParts, RigidPartsAreDrawnOnceAndMoved) {
  const Character character = built_in_character_with_parts();
  AtlasConfig config = small_config();
  config.pixels = 128;  // Texels of 1.6 cm.
  Context context;
  const auto made = create_atlas(character, config, context);
  ASSERT_TRUE(made);
  const Atlas& atlas = *made;
  const AtlasShape& shape = atlas.shape;
  const auto frames = impostor::pose_frames(character, config);
  ASSERT_TRUE(frames);
  const size_t count = shape.view(shape.frames, 0, 0);
  size_t moved = 0;
  for (const size_t part : {0, 1, 2, 3, 5}) {
    const WornPart& worn = character.worn[part];
    const auto middle = [&](int32_t frame) {
      Box3d box;
      for (uint32_t t = 0; t < worn.triangle_count; ++t) {
        for (const uint32_t c : character.triangles[worn.first_triangle + t]) {
          box.add(frames->frames[static_cast<size_t>(frame)].positions[c]);
        }
      }
      return (box.min + box.max) * 0.5;
    };
    for (int32_t i = 0; i < 3 * 3 * 6; ++i) {
      const int32_t frame = 1 + i / 18, row = i / 6 % 3, column = i % 6;
      const AtlasView& first = atlas.views[(1 + part) * count + shape.view(0, row, column)];
      const AtlasView& view = atlas.views[(1 + part) * count + shape.view(frame, row, column)];
      EXPECT_EQ(view.x, first.x);
      EXPECT_EQ(view.y, first.y);
      EXPECT_EQ(view.width, first.width);
      if (view.width == 4 && view.height == 4) continue;
      const impostor::FigureCamera camera = impostor::figure_camera(column, 6, row, 3);
      const Vec3d by = (middle(frame) - middle(0)) * (shape.pixels / shape.side);
      EXPECT_NEAR(view.left - first.left, dot(by, camera.right), 0.75);
      EXPECT_NEAR(view.top - first.top, -dot(by, camera.up), 0.75);
      moved += view.left != first.left || view.top != first.top ? 1 : 0;
    }
  }
  EXPECT_GT(moved, 20U);
}

TEST(WornParts, AnAvatarWearsAtMostOneOfAKindAndKindsDoNotDependOnEachOther) {
  const std::vector<AtlasPart>& parts = dressed().parts;
  std::array<double, kWornKinds> wears{};
  std::array<std::array<double, kWornKinds>, kWornKinds> both{};
  std::array<double, 7> of_part{};
  for (uint32_t look = 0; look < 2048; ++look) {
    const uint32_t worn = worn_by(parts, look);
    std::array<int, kWornKinds> count{};
    for (size_t i = 0; i < parts.size(); ++i) {
      if ((worn >> i & 1) == 0) continue;
      ++count[static_cast<size_t>(parts[i].kind)];
      of_part[i] += 1.0 / 2048;
    }
    EXPECT_LE(*std::max_element(count.begin(), count.end()), 1);
    EXPECT_EQ(worn >> parts.size(), 0U);
    for (size_t a = 0; a < kWornKinds; ++a) {
      wears[a] += count[a] / 2048.0;
      for (size_t b = 0; b < kWornKinds; ++b) both[a][b] += count[a] * count[b] / 2048.0;
    }
  }
  // Four deviations of 2048 draws.
  for (size_t a = 0; a < kWornKinds; ++a) {
    EXPECT_GT(wears[a], 0.2);
    EXPECT_LT(wears[a], 0.6);
    for (size_t b = 0; b < a; ++b) EXPECT_NEAR(both[a][b], wears[a] * wears[b], 0.04);
  }
  for (const double share : of_part) EXPECT_GT(share, 0.1);
  EXPECT_EQ(worn_by({}, 5), 0U);
}

TEST(WornParts, AFileKeepsThem) {
  const test::ScratchFolder folder;
  const std::string path = folder.path() + "/people.atlas";
  const Atlas packed = convert_atlas(dressed(), AtlasFormat::kBc3);
  ASSERT_TRUE(save_atlas(packed, path));
  const auto back = load_atlas(path);
  ASSERT_TRUE(back) << back.error().message;
  EXPECT_EQ(back->views, packed.views);
  EXPECT_EQ(back->colour, packed.colour);
  ASSERT_EQ(back->parts.size(), 7U);
  EXPECT_EQ(back->parts[0].name, "long hair");
  EXPECT_EQ(back->parts[5].name, "rucksack");
  EXPECT_EQ(back->parts[5].kind, WornKind::kBag);
}

TEST(WornParts, APartOfOneFigureGoesOnTheBodyOfAnother) {
  const Character from = built_in_character_with_parts();
  Character onto = built_in_character();
  ASSERT_TRUE(wear_part(onto, from, BodyPart::kPants, WornKind::kSkirt));
  ASSERT_TRUE(wear_part(onto, from, BodyPart::kHair, WornKind::kHair));
  ASSERT_EQ(onto.worn.size(), 2U);
  // The same pictures as on its own body.
  const Atlas atlas = atlas_of(onto);
  const size_t count = atlas.shape.view(atlas.shape.frames, 0, 0);
  for (size_t v = 0; v < count; ++v) {
    for (int32_t i = 0; i < 32 * 32; i += 3) {
      ASSERT_EQ(texel(atlas, atlas.views[count + v], i % 32, i / 32),
                texel(dressed(), dressed().views[7 * count + v], i % 32, i / 32));
    }
  }
  // A figure without parts gives what it has of the body part.
  Character twice = built_in_character();
  ASSERT_TRUE(wear_part(twice, built_in_character(), BodyPart::kShoes, WornKind::kBag));
  EXPECT_GT(twice.worn[0].triangle_count, 300U);
}

TEST(WornParts, WhatDoesNotFitIsRefused) {
  Character onto = built_in_character();
  const Character before = onto;
  Character other = built_in_character_with_parts();
  for (Joint& joint : other.joints) joint.name = "x " + joint.name;
  EXPECT_EQ(wear_part(onto, other, BodyPart::kHair, WornKind::kHat).error().message,
            "part: the body has no joint x head; take a part of a figure with the same skeleton");
  EXPECT_EQ(onto.triangles, before.triangles);
  Character bald = built_in_character();
  for (CharacterMaterial& material : bald.materials) material.part = BodyPart::kSkin;
  EXPECT_EQ(wear_part(onto, bald, BodyPart::kHair, WornKind::kHair).error().message,
            "part: the figure has no hair");
  // Ranges that a caller has mixed up.
  Character mixed = built_in_character_with_parts();
  mixed.worn[1].first_triangle += 1;
  Context context;
  EXPECT_EQ(create_atlas(mixed, small_config(), context).error().message,
            "atlas: worn parts must follow one another, and have triangles");
}

TEST(WornParts, SameBytesForAnyNumberOfWorkers) {
  for (const int32_t workers : {1, 3}) {
    const Atlas atlas = atlas_of(built_in_character_with_parts(), workers);
    EXPECT_EQ(atlas.colour, dressed().colour);
    EXPECT_EQ(atlas.mask, dressed().mask);
    EXPECT_EQ(atlas.views, dressed().views);
  }
  uint64_t sum = 0;
  for (const auto* bytes : {&dressed().colour, &dressed().normal, &dressed().mask}) {
    sum = hash_span(std::span<const uint8_t>(*bytes), sum);
  }
  EXPECT_EQ(sum, 0x6fdb94f8e9e45a97U);
}

}  // namespace
}  // namespace throng
