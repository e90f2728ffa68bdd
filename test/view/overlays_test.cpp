// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "view/overlays.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <optional>
#include <string>

#include "golden_image.h"
#include "throng/bake.h"
#include "throng_view/viewer.h"
#include "view/density_brush.h"

// Golden pictures of all overlays, and marks against the world that they show.
namespace throng {
namespace {

struct Baked {
  Scene scene;
  World world;
  Nodes nodes;
};

// A hall with a gallery, a ramp up to it and a crate; a flyer is among the classes.
const Baked& hall() {
  static const Baked baked = [] {
    Baked b;
    b.scene.add_box({0, -0.3, 0}, {16, 0, 12});
    b.scene.add_box({0, 2.7, 0}, {16, 3, 4});
    b.scene.add_quad({15, 3, 4}, {15, 0, 11}, {13, 0, 11}, {13, 3, 4});
    b.scene.add_box({6, 0, 6}, {7.5, 1.2, 7.5});
    BakeConfig config;
    config.classes = {AvatarClass{}, flyer_class()};
    Context context;
    auto world = bake_world(b.scene, config, context);
    EXPECT_TRUE(world) << world.error().message;
    b.world = *std::move(world);
    auto nodes = Nodes::create(b.world, b.scene, {}, context);
    EXPECT_TRUE(nodes) << nodes.error().message;
    b.nodes = *std::move(nodes);
    return b;
  }();
  return baked;
}

// Weights are set only for the overlay that shows them: they would change the goals.
Viewer made_viewer(const std::string& overlay) {
  Result<Drawing> drawing = Drawing::create();
  EXPECT_TRUE(drawing) << drawing.error().message;
  Result<Viewer> viewer =
      Viewer::create(*std::move(drawing), {.settings = {}, .font = {}, .panel = false});
  EXPECT_TRUE(viewer) << viewer.error().message;
  viewer->load("hall", [overlay](StageParts& parts, Context& context) -> Result<void> {
    if (auto ok = parts.set_scene(hall().scene); !ok) return ok;
    parts.set_world(hall().world, hall().nodes);
    AtlasConfig config;
    config.clips = {"Walk", "Idle"};
    config.frames = 2;
    config.pixels = 32;
    auto atlas = create_atlas(built_in_character(), config, context);
    if (!atlas) return atlas.error();
    parts.set_atlases({{*atlas}});
    CrowdStart start;
    start.avatars = 40;
    start.near = 10;
    start.mix = {1, 0};
    if (overlay == "Painted") {
      view::paint(view::map_at(start.density, hall().scene.bounds(), 0), {4, 0, 9}, 2.5, 90);
      view::paint(view::map_at(start.density, hall().scene.bounds(), 3), {9, 3, 2}, 1.5, 255);
    }
    parts.set_crowd(start);
    return {};
  });
  viewer->wait_until_loaded();
  EXPECT_EQ(viewer->status().error, "");
  viewer->look_at({23, 12, 22}, {8, 0.5, 6});
  viewer->play_for(1);
  return *std::move(viewer);
}

Image picture(Viewer& viewer) {
  auto image = viewer.picture(0, 320, 200);
  EXPECT_TRUE(image) << image.error().message;
  return *std::move(image);
}

size_t pixels_that_differ(const Image& a, const Image& b) {
  size_t count = 0;
  for (size_t i = 0; i < a.rgb.size(); i += 3) {
    count += std::abs(a.rgb[i] - b.rgb[i]) + std::abs(a.rgb[i + 1] - b.rgb[i + 1]) > 24 ? 1 : 0;
  }
  return count;
}

class Overlays : public testing::TestWithParam<std::string> {};

TEST_P(Overlays, LooksAsItDid) {
  Viewer viewer = made_viewer(GetParam());
  const Image without = picture(viewer);
  viewer.pick(7);
  viewer.show_overlay(GetParam());
  viewer.wait_for_overlays();
  EXPECT_EQ(viewer.status().error, "");
  const Image with = picture(viewer);
  EXPECT_GT(pixels_that_differ(with, without), 40U) << GetParam();
  test::expect_golden(with, THRONG_TEST_DATA "/overlay_" + GetParam() + ".png");
}

INSTANTIATE_TEST_SUITE_P(All, Overlays, testing::ValuesIn(Viewer::overlay_names()),
                         [](const auto& test) { return test.param; });

// Looks down at a point from a little beside it and clicks on it.
int64_t node_picked_at(Viewer& viewer, Vec3d point, double& now) {
  viewer.look_at(point + Vec3d{0.4, 9, 1.1}, point);
  EXPECT_TRUE(viewer.picture(now += 0.1, 320, 200));
  for (const ViewEventKind kind : {ViewEventKind::kMouseDown, ViewEventKind::kMouseUp}) {
    ViewEvent event{.kind = kind};
    event.x = 160;
    event.y = 100;
    viewer.handle(event);
  }
  EXPECT_TRUE(viewer.picture(now += 0.1, 320, 200));
  return viewer.status().picked_node;
}

TEST(Overlays, AClickPicksTheNodeThatIsDrawnThere) {
  Result<Drawing> drawing = Drawing::create();
  ASSERT_TRUE(drawing) << drawing.error().message;
  Result<Viewer> made =
      Viewer::create(*std::move(drawing), {.settings = {}, .font = {}, .panel = false});
  ASSERT_TRUE(made) << made.error().message;
  Viewer viewer = *std::move(made);
  viewer.load("hall", [](StageParts& parts, Context&) -> Result<void> {
    if (auto ok = parts.set_scene(hall().scene); !ok) return ok;
    parts.set_world(hall().world, hall().nodes);
    return {};
  });
  viewer.wait_until_loaded();
  double now = 0;
  EXPECT_EQ(node_picked_at(viewer, {3, 0, 9}, now), -1) << "the overlay is off";
  viewer.show_overlay("Nodes");
  viewer.wait_for_overlays();
  const Nodes& nodes = hall().nodes;
  const Vec3d points[] = {
      {3.1, 0, 9.2}, {10.4, 0, 10.3}, {8.2, 3, 2.1}, {14.1, 1.5, 7.5}, {0.3, 0, 6.2}};
  for (const Vec3d& point : points) {
    const int64_t picked = node_picked_at(viewer, point, now);
    ASSERT_GE(picked, 0) << point.x << ", " << point.z;
    EXPECT_TRUE(nodes.node(static_cast<uint32_t>(picked)).terminal);
    // Of all terminal nodes, one whose ground lies under the point.
    bool is_there = false;
    const NodeInfo info = nodes.node(static_cast<uint32_t>(picked));
    view::for_node_squares(nodes, static_cast<uint32_t>(picked), info, [&](const auto& c) {
      Box3d box;
      for (const Vec3d& p : c) box.add(p);
      constexpr double kNear = 0.06;  // The picture has pixels.
      is_there = is_there || (point.x > box.min.x - kNear && point.x < box.max.x + kNear &&
                              point.z > box.min.z - kNear && point.z < box.max.z + kNear &&
                              point.y > box.min.y - 0.3 && point.y < box.max.y + 0.3);
    });
    EXPECT_TRUE(is_there) << point.x << ", " << point.z;
  }
  const Image with = picture(viewer);
  EXPECT_EQ(node_picked_at(viewer, {40, 0, 6}, now), -1) << "there is no ground";
  (void)node_picked_at(viewer, points[0], now);
  const Image first = picture(viewer);
  ViewEvent escape{.kind = ViewEventKind::kKeyDown};
  escape.key = Key::kEscape;
  viewer.handle(escape);
  const Image without = picture(viewer);
  EXPECT_EQ(viewer.status().picked_node, -1);
  EXPECT_GT(pixels_that_differ(first, without), 40U);
  EXPECT_EQ(node_picked_at(viewer, points[2], now) == node_picked_at(viewer, points[0], now),
            false);
  ViewEvent off{.kind = ViewEventKind::kKeyDown};
  off.key = key_of('N');
  viewer.handle(off);
  (void)picture(viewer);
  EXPECT_EQ(viewer.status().picked_node, -1) << "what is not drawn is not picked";
}

TEST(NodePick, CylindersAndDetailsAreThoseOfTheNode) {
  const Nodes& nodes = hall().nodes;
  const NodeBins bins = nodes.summary().bins;
  size_t cylinders = 0;
  for (uint32_t n = 0; n < nodes.node_count(); ++n) {
    const NodeInfo info = nodes.node(n);
    const view::NodeDetail detail = view::detail_of(nodes, bins, n);
    EXPECT_EQ(detail.width, bins.width_of(info.width));
    EXPECT_EQ(detail.headroom, bins.height_of(info.headroom));
    EXPECT_EQ(detail.inclination, bins.inclination_of(info.inclination));
    const auto cylinder = nodes.cylinder(n);
    EXPECT_EQ(cylinder.has_value(), detail.width > 0 && detail.height > 0) << n;
    if (!cylinder) continue;
    ++cylinders;
    // The ground is open in it, for each class of the node.
    for (int32_t c = 0; c < 2; ++c) {
      if ((info.classes >> c & 1) == 0) continue;
      for (int32_t k = 0; k < 8; ++k) {
        const double angle = 0.785 * k, far = 0.85 * cylinder->radius;
        const Vec3d at = cylinder->feet + Vec3d{far * std::cos(angle), 0, far * std::sin(angle)};
        EXPECT_TRUE(hall().world.find_place(c, at, 1 + far)) << n << ", class " << c;
      }
    }
  }
  EXPECT_GT(cylinders, 20U);
}

TEST(OverlayNames, UnknownOnesAreIgnored) {
  Viewer viewer = made_viewer("");
  const Image without = picture(viewer);
  for (const std::string& name : {std::string(), std::string("levels"), std::string("Levels "),
                                  std::string("All"), std::string(1000, 'x')}) {
    viewer.show_overlay(name);
  }
  viewer.wait_for_overlays();
  EXPECT_EQ(viewer.status().error, "");
  EXPECT_EQ(picture(viewer).rgb, without.rgb);
  viewer.show_overlay("Levels");
  viewer.wait_for_overlays();
  EXPECT_GT(pixels_that_differ(picture(viewer), without), 40U) << "the one that is known";
}

// Area of a mark's triangles seen from above.
double area_of(const Marks& marks) {
  double area = 0;
  for (size_t i = 0; i + 2 < marks.triangles.size(); i += 3) {
    const MarkVertex &a = marks.triangles[i], &b = marks.triangles[i + 1],
                     &c = marks.triangles[i + 2];
    area += 0.5 * std::abs((b.x - a.x) * (c.z - a.z) - (c.x - a.x) * (b.z - a.z));
  }
  return area;
}

TEST(OverlayMarks, FieldsAreColouredByTheStateOfTheAvatar) {
  // Two that walk towards each other, one far off, one on another storey.
  view::TimelineFrame crowd;
  crowd.resize(4);
  crowd.ids = {1, 2, 3, 4};
  crowd.x = {0, 1, 50, 0};
  crowd.y = {0, 0, 0, 3};
  crowd.z = {0, 0, 0, 0};
  crowd.heading = {0.25F, 0.75F, 0, 0};
  crowd.speed = {1, 1, 1, 0};
  const Marks all = view::field_marks(crowd, 4, {}, {0.25});
  const size_t each = 3 * 32 * 2;
  ASSERT_EQ(all.lines.size(), 4 * each);
  const auto rgb = [](Rgba colour) { return colour & 0xffffff; };
  const auto state_at = [&](size_t n) { return rgb(all.lines[n * each].colour); };
  EXPECT_EQ(state_at(0), state_at(1));  // Critical, from both sides.
  EXPECT_EQ(state_at(0), rgb(rgba(250, 130, 40)));
  EXPECT_EQ(state_at(2), rgb(rgba(90, 200, 110)));  // The storey above: nearer than the far one.
  EXPECT_EQ(state_at(3), rgb(rgba(90, 200, 110)));
  EXPECT_EQ(view::field_marks(crowd, 0, {}, {0.25}).lines.size(),
            3 * each);  // Without the far one.
  crowd.x[1] = 0.45F;
  EXPECT_EQ(rgb(view::field_marks(crowd, 0, {}, {0.25}).lines[0].colour), rgb(rgba(230, 40, 40)));
}

TEST(OverlayMarks, ClearanceCoversWhatAClassCanWalkOnAndNothingElse) {
  Context context;
  const World& world = hall().world;
  const Marks marks = view::clearance_marks(world, 0, {}, context);
  const double walkable = world.summary().walkable_area[0];
  EXPECT_NEAR(area_of(marks), walkable, 0.001 * walkable);
  // The middle of every triangle's box lies just over a place of the class.
  for (size_t i = 0; i + 5 < marks.triangles.size(); i += 6) {
    const MarkVertex &a = marks.triangles[i], &c = marks.triangles[i + 2];
    const Vec3d middle{0.5 * (a.x + c.x), 0.5 * (a.y + c.y), 0.5 * (a.z + c.z)};
    const Place place = world.find_place(0, middle, 0.12);
    EXPECT_TRUE(place) << middle.x << " " << middle.y << " " << middle.z;
  }
}

TEST(OverlayMarks, CylindersAreAsWideAndHighAsTheirNodesPromise) {
  Context context;
  const Nodes& nodes = hall().nodes;
  const NodeBins bins = nodes.summary().bins;
  const Marks marks = view::cylinder_marks(nodes, {}, context);
  size_t v = 0;
  constexpr size_t kVertices = 16 * 6;
  for (uint32_t n = 0; n < nodes.node_count(); ++n) {
    const NodeInfo info = nodes.node(n);
    const double width = bins.width_of(info.width), height = bins.height_of(info.height);
    if (!info.terminal || width == 0 || height == 0) continue;
    ASSERT_LE(v + kVertices, marks.triangles.size());
    const Vec3d middle = nodes.middle(n);
    double top = 0;
    for (size_t i = v; i < v + kVertices; ++i) {
      const MarkVertex& p = marks.triangles[i];
      EXPECT_NEAR(std::hypot(p.x - middle.x, p.z - middle.z), width, 1e-4) << n;
      top = std::max(top, p.y - middle.y);
    }
    EXPECT_NEAR(top, height, 1e-4) << n;
    v += kVertices;
  }
  EXPECT_EQ(v, marks.triangles.size());
  EXPECT_GT(v, 20 * kVertices);
}

TEST(OverlayMarks, DensityCountsHeadsByStorey) {
  view::TimelineFrame crowd;
  crowd.resize(9);
  for (size_t i = 0; i < 9; ++i) {
    crowd.ids[i] = i;
    crowd.x[i] = 0.5F;
    crowd.z[i] = 0.5F;
    crowd.y[i] = i < 8 ? 0.0F : 3.0F;
  }
  const Marks marks = view::density_marks(crowd);
  ASSERT_EQ(marks.triangles.size(), 12U);  // A square each.
  EXPECT_NE(marks.triangles[0].colour, marks.triangles[6].colour);
  EXPECT_NEAR(area_of(marks), 8, 1e-5);
}

TEST(OverlayMarks, NeighboursAreThoseInSightOnTheSameStorey) {
  view::TimelineFrame crowd;
  crowd.resize(5);
  for (size_t i = 0; i < 5; ++i) crowd.ids[i] = i;
  crowd.x = {0, 3, 4.9F, 5.2F, 1};
  crowd.y = {0, 0, 0, 0, 3};
  const Marks marks = view::neighbour_marks(crowd, 0, 5);
  EXPECT_EQ(marks.lines.size(), 2 * (48U + 2U));  // The circle, and two neighbours.
}

TEST(OverlayMarks, MissingPartsOfAWorldAreReported) {
  Result<Drawing> drawing = Drawing::create();
  ASSERT_TRUE(drawing);
  Result<Viewer> viewer =
      Viewer::create(*std::move(drawing), {.settings = {}, .font = {}, .panel = false});
  ASSERT_TRUE(viewer);
  viewer->load("plain", [](StageParts& parts, Context& context) -> Result<void> {
    Scene scene;
    scene.add_box({0, -0.3, 0}, {5, 0, 5});
    if (auto ok = parts.set_scene(scene); !ok) return ok;
    auto world = bake_world(scene, {}, context);
    if (!world) return world.error();
    parts.set_world(*world);
    return {};
  });
  viewer->wait_until_loaded();
  for (const auto& [name, says] : {std::pair{"Nodes", "--nodes"},
                                   {"Air", "flies"},
                                   {"Cylinders", "--nodes"},
                                   {"Boxes", "--fly"}}) {
    viewer->show_overlay(name);
    viewer->wait_for_overlays();
    EXPECT_NE(viewer->status().error.find(says), std::string::npos) << viewer->status().error;
  }
}

}  // namespace
}  // namespace throng
