// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "import/formats/plan.h"

#include <gtest/gtest.h>

#include <cmath>

namespace throng {
namespace {

double flat_area(const Scene& scene, double y, AreaKind kind, int up) {
  double area = 0;
  for (size_t t = 0; t < scene.triangles.size(); ++t) {
    const auto& [ia, ib, ic] = scene.triangles[t];
    const Vec3d a = scene.positions[ia];
    const Vec3d b = scene.positions[ib];
    const Vec3d c = scene.positions[ic];
    const auto height = [up](Vec3d p) { return up == 1 ? p.y : p.z; };
    if (scene.area[t] != kind || std::fabs(height(a) - y) > 1e-9 ||
        std::fabs(height(b) - y) > 1e-9 || std::fabs(height(c) - y) > 1e-9) {
      continue;
    }
    area += length(cross(b - a, c - a)) / 2;
  }
  return area;
}

double wall_area(const Scene& scene, int up) {
  double area = 0;
  for (size_t t = 0; t < scene.triangles.size(); ++t) {
    const auto& [a, b, c] = scene.triangles[t];
    const Vec3d n =
        cross(scene.positions[b] - scene.positions[a], scene.positions[c] - scene.positions[a]);
    if (std::fabs(up == 1 ? n.y : n.z) > 1e-9) continue;
    EXPECT_EQ(scene.area[t], kAreaBlocked);
    area += length(n) / 2;
  }
  return area;
}

importer::ReadOptions options(const char* name) {
  importer::ReadOptions out;
  out.name = name;
  return out;
}

Result<importer::RawScene> wkt(const std::string& text) {
  Context context;
  return importer::read_wkt(text, options("p.wkt"), context);
}

Result<importer::RawScene> geojson(const std::string& text) {
  Context context;
  return importer::read_geojson(text, options("p.geojson"), context);
}

const Ring kSquare{{0, 0}, {10, 0}, {10, 10}, {0, 10}};
const Ring kSmall{{4, 4}, {6, 4}, {6, 6}, {4, 6}};

TEST(Plan, APlaneWithAnObstacleHasGroundWallsRoofAndPlate) {
  PlaneConfig config;
  config.ground.outer = kSquare;
  config.obstacles.push_back({kSmall, {}});
  config.ground_height = 1;
  const auto scene = create_plane_scene(config);
  ASSERT_TRUE(scene) << scene.error().message;
  EXPECT_NEAR(flat_area(*scene, 1, kAreaWalkable, 1), 100, 1e-9);
  EXPECT_NEAR(flat_area(*scene, 4, kAreaBlocked, 1), 4, 1e-9);
  EXPECT_NEAR(flat_area(*scene, 1.05, kAreaBlocked, 1), 4, 1e-9);
  EXPECT_NEAR(wall_area(*scene, 1), 4 * 2 * 3, 1e-9);
  EXPECT_EQ(scene->area.size(), scene->triangles.size());
}

TEST(Plan, HolesInTheGroundAreObstacles) {
  PlaneConfig config;
  config.ground = {kSquare, {kSmall}};
  const auto scene = create_plane_scene(config);
  ASSERT_TRUE(scene) << scene.error().message;
  EXPECT_NEAR(flat_area(*scene, 0, kAreaWalkable, 1), 96, 1e-9);
  EXPECT_NEAR(wall_area(*scene, 1), 24, 1e-9);
}

TEST(Plan, UnusablePolygonsAreRefusedByTheirPlace) {
  const auto message = [](Polygon ground, std::vector<Polygon> obstacles = {}) {
    PlaneConfig config;
    config.ground = std::move(ground);
    config.obstacles = std::move(obstacles);
    const auto scene = create_plane_scene(config);
    return scene ? std::string("accepted") : scene.error().message;
  };
  EXPECT_EQ(message({{{0, 0}, {4, 4}, {4, 0}, {0, 5}}, {}}),
            "plane: the ground: the outline crosses itself near (2.222, 2.222); draw it again");
  EXPECT_EQ(message({kSquare, {{{8, 4}, {12, 4}, {12, 6}, {8, 6}}}}),
            "plane: the ground: two rings cross near (10.000, 4.000); draw it again");
  EXPECT_EQ(
      message({kSquare, {{{20, 20}, {21, 20}, {21, 21}}}}),
      "plane: the ground: a hole lies outside the polygon or over another hole; draw it again");
  EXPECT_EQ(message({kSquare, {}}, {{kSmall, {}}, {{{0, 0}, {1, 1}}, {}}}),
            "plane: obstacle 1: a ring has 2 corners, needs 3; draw it again");
  EXPECT_EQ(message({{{0, 0}, {1, 1}, {2, 2}}, {}}),
            "plane: the ground: a ring has no area; draw it again");
  EXPECT_EQ(message({{{0, 0}, {NAN, 1}, {2, 2}}, {}}),
            "plane: the ground: a corner is not a number; draw it again");
  EXPECT_EQ(message({}), "plane: the ground: a ring has 0 corners, needs 3; draw it again");
  EXPECT_EQ(
      create_plane_scene(
          {.ground = {kSquare, {}}, .obstacles = {}, .ground_height = 0, .obstacle_height = 0})
          .error()
          .code,
      Errc::kBadConfig);
}

TEST(Wkt, APolygonIsGroundAndItsHolesAreWalls) {
  const auto raw = wkt("POLYGON ((0 0, 10 0, 10 10, 0 10, 0 0), (4 4, 6 4, 6 6, 4 6, 4 4))\n");
  ASSERT_TRUE(raw) << raw.error().message;
  EXPECT_NEAR(flat_area(raw->scene, 0, kAreaWalkable, 2), 96, 1e-9);
  EXPECT_NEAR(wall_area(raw->scene, 2), 24, 1e-9);
  EXPECT_EQ(raw->up, 'z');
}

TEST(Wkt, CollectionsSeveralLinesDimensionsAndWallsAreRead) {
  const auto raw =
      wkt("# plan\nSRID=0;GEOMETRYCOLLECTION(POLYGON((0 0,1 0,1 1,0 0)),"
          "MultiPolygon Z (((0 0 9, 2 0 9, 2 2 9)), ((5 5 9, 6 5 9, 6 6 9))))\n"
          "LINESTRING (0 0, 3 4)\nPOLYGON EMPTY\n");
  ASSERT_TRUE(raw) << raw.error().message;
  EXPECT_NEAR(flat_area(raw->scene, 0, kAreaWalkable, 2), 3, 1e-9);
  EXPECT_NEAR(wall_area(raw->scene, 2), 15, 1e-9);
}

TEST(Wkt, FaultsAreNamedByLine) {
  const auto message = [](const std::string& text) {
    const auto raw = wkt(text);
    return raw ? std::string("accepted") : raw.error().message;
  };
  EXPECT_EQ(
      message("\nPOINT (1 2)"),
      "p.wkt:2: cannot use a POINT; need POLYGON, MULTIPOLYGON, LINESTRING, MULTILINESTRING or "
      "GEOMETRYCOLLECTION");
  EXPECT_EQ(message("POLYGON ((0 0, 1 0,\n x 1))"), "p.wkt:2: expected two numbers");
  EXPECT_EQ(message("POLYGON ((0 0, 1 0, 1 1"), "p.wkt:1: expected , or )");
  EXPECT_EQ(message("POLYGON ((0 0, 4 4, 4 0, 0 5))").substr(0, 45),
            "p.wkt: POLYGON 1: the outline crosses itself ");
  EXPECT_NE(message(std::string(1000, ' ') + "GEOMETRYCOLLECTION(GEOMETRYCOLLECTION("), "accepted");
  std::string deep;
  for (int i = 0; i < 100000; ++i) deep += "GEOMETRYCOLLECTION(";
  EXPECT_EQ(message(deep), "p.wkt:1: collections nest too deep");
}

TEST(GeoJson, KindsAndHeightsComeFromProperties) {
  const std::string square =
      R"({"type":"Polygon","coordinates":[[[0,0],[10,0],[10,10],[0,10],[0,0]]]})";
  const std::string small = R"({"type":"Polygon","coordinates":[[[4,4],[6,4],[6,6],[4,6],[4,4]]]})";
  const auto feature = [](const std::string& geometry, const std::string& properties) {
    return R"({"type":"Feature","properties":)" + properties + R"(,"geometry":)" + geometry + "}";
  };
  const auto raw = geojson(
      R"({"type":"FeatureCollection","features":[)" + feature(square, R"({"kind":"ground"})") +
      "," + feature(small, R"({"kind":"obstacle","height":1.5})") + "," +
      feature(R"({"type":"LineString","coordinates":[[0,0],[0,5]]})", "null") + "]}");
  ASSERT_TRUE(raw) << raw.error().message;
  EXPECT_NEAR(flat_area(raw->scene, 0, kAreaWalkable, 2), 100, 1e-9);
  EXPECT_NEAR(flat_area(raw->scene, 1.5, kAreaBlocked, 2), 4, 1e-9);
  EXPECT_NEAR(wall_area(raw->scene, 2), 8 * 1.5 + 5 * 3, 1e-9);
  // Without `kind`: ground, unless another polygon says that it is the ground.
  const auto plain = geojson(square);
  ASSERT_TRUE(plain) << plain.error().message;
  EXPECT_NEAR(flat_area(plain->scene, 0, kAreaWalkable, 2), 100, 1e-9);
  const auto mixed = geojson(R"({"type":"FeatureCollection","features":[)" + feature(small, "{}") +
                             "," + feature(square, R"({"kind":"walkable"})") + "]}");
  ASSERT_TRUE(mixed) << mixed.error().message;
  EXPECT_NEAR(flat_area(mixed->scene, 3, kAreaBlocked, 2), 4, 1e-9);
}

TEST(GeoJson, FaultsAreNamedByFeature) {
  const auto message = [](const std::string& text) {
    const auto raw = geojson(text);
    return raw ? std::string("accepted") : raw.error().message;
  };
  EXPECT_EQ(message("{}"), "p.geojson: feature 0: has no \"type\"");
  EXPECT_EQ(message(R"({"type":"Feature","properties":{"kind":"lake"},"geometry":null})"),
            "p.geojson: feature 1: kind 'lake' must be ground, walkable or obstacle");
  EXPECT_EQ(message(R"({"type":"Polygon","coordinates":[[[0,0],[1]]]})"),
            "p.geojson: feature 0: a position needs two numbers");
  EXPECT_NE(message("[[[["), "accepted");
}

}  // namespace
}  // namespace throng
