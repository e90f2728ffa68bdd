// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "view/eye_sight.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "core/random.h"
#include "rays.h"
#include "throng/scene.h"

// EyeSight against rays: what a ray reaches must not be hidden.
namespace throng {
namespace {

double drawn(uint64_t stream, uint64_t k, double low, double high) {
  return low + (high - low) * random_unit(77, stream, k);
}

// By rays against triangles: is the line free of triangles beyond the near plane?
bool is_free(const Scene& scene, Vec3d eye, Vec3d point, double nearest) {
  const Vec3d ray = point - eye;
  const double far = length(ray);
  return std::none_of(
      scene.triangles.begin(), scene.triangles.end(), [&](const std::array<uint32_t, 3>& t) {
        const auto at = meet(scene, t, eye, ray);
        // Slightly wider than the triangle: the oracle's rays must not slip through seams.
        return at && at->u >= -1e-9 && at->v >= -1e-9 && at->u + at->v <= 1 + 1e-9 &&
               at->along * far > nearest && at->along < 1;
      });
}

Vec3d point_in(const Box3d& box, uint64_t stream) {
  return {drawn(stream, 0, box.min.x, box.max.x), drawn(stream, 1, box.min.y, box.max.y),
          drawn(stream, 2, box.min.z, box.max.z)};
}

struct Count {
  size_t hidden = 0, truly = 0, wrong = 0;
};

// Random eyes, and boxes of the sizes of avatars and tiles.
Count compare(const Scene& scene, uint64_t seed, int32_t eyes, int32_t boxes, int32_t pixels) {
  Count out;
  const Box3d all = scene.bounds();
  const Vec3d origin{std::round(all.min.x), std::round(all.min.y), std::round(all.min.z)};
  view::EyeSight sight(view::occluders_of(scene, origin), pixels);
  uint64_t n = seed << 32;
  for (int32_t e = 0; e < eyes; ++e) {
    const view::EyePlace place{.eye = point_in(all, n++), .nearest = 0.05, .cut = 1e9};
    sight.look_from(place, 1e6);
    for (int32_t k = 0; k < boxes; ++k) {
      const Vec3d low = point_in(all, n++);
      const double side = k % 2 == 0 ? 1 : 4;
      const Box3d box{low, low + Vec3d{side, 2, side}};
      const bool seen = sight.sees(box);
      bool free = false;
      for (uint64_t r = 0; r < 24 && !free; ++r) {
        free = is_free(scene, place.eye, point_in(box, n++), 0.125);
      }
      out.hidden += seen ? 0 : 1;
      out.truly += free ? 0 : 1;
      out.wrong += !seen && free ? 1 : 0;
    }
  }
  return out;
}

TEST(EyeSight, NeverHidesWhatARayReaches) {
  for (const char* name : {"city", "garage"}) {
    BuiltinWorldConfig world;
    world.name = name;
    if (world.name == "city") world.size = 120;
    const Result<Scene> scene = create_builtin_world(world);
    ASSERT_TRUE(scene) << scene.error().message;
    for (const int32_t pixels : {64, 512}) {
      const Count c = compare(*scene, static_cast<uint64_t>(pixels), 6, 120, pixels);
      std::printf("%s, %d pixels: of %zu boxes that 24 rays do not reach, %zu are hidden\n", name,
                  pixels, c.truly, c.hidden);
      EXPECT_EQ(c.wrong, 0U);
      EXPECT_GT(c.hidden * (pixels == 512 ? 2U : 20U), c.truly);
    }
  }
}

TEST(EyeSight, NeverHidesWhatARayReachesAmongScatteredTriangles) {
  Scene scene;
  for (uint64_t i = 0; i < 400; ++i) {
    const Vec3d at = point_in({{0, 0, 0}, {40, 20, 40}}, i);
    const auto near = [&](uint64_t k) {
      return at + point_in({{-6, -6, -6}, {6, 6, 6}}, 1000 * (k + 1) + i);
    };
    scene.add_triangle(near(0), near(1), near(2));
    if (i % 3 == 0) scene.add_quad(near(3), near(4), near(5), near(6));
  }
  const Count c = compare(scene, 5, 20, 200, 128);
  EXPECT_EQ(c.wrong, 0U);
  EXPECT_GT(c.hidden, 20U);
}

TEST(EyeSight, SeesThroughSlitsThinnerThanAPixelAndOverWhatIsCut) {
  Scene scene;  // Two walls, a millimetre apart.
  scene.add_box({-20, -5, 10}, {-0.0005, 8, 10.2});
  scene.add_box({0.0005, -5, 10}, {20, 8, 10.2});
  view::EyeSight sight(view::occluders_of(scene, {}), 64);
  const Box3d behind{{-1, 0, 20}, {1, 2, 21}}, beside{{4, 0, 20}, {5, 2, 21}};
  view::EyePlace place{.eye = {0, 1, 0}};
  sight.look_from(place, 100);
  EXPECT_TRUE(sight.sees(behind));
  EXPECT_FALSE(sight.sees(beside));
  EXPECT_TRUE(sight.sees({{4, 0, 8}, {5, 2, 9}}));       // In front of the wall.
  EXPECT_TRUE(sight.sees({{4, 0, 20}, {5, 20, 21}}));    // Visible over the wall.
  EXPECT_TRUE(sight.sees({{-1, 0, -21}, {1, 2, -20}}));  // Behind the eye.
  place.cut = 7;  // The walls are higher: they are not drawn.
  sight.look_from(place, 100);
  EXPECT_TRUE(sight.sees(beside));
}

}  // namespace
}  // namespace throng
