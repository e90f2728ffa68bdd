// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "import/formats/city.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>

namespace throng {
namespace {

Result<importer::RawScene> json(const std::string& text) {
  Context context;
  importer::ReadOptions options;
  options.name = "c.json";
  return importer::read_cityjson(text, options, context);
}

Result<importer::RawScene> gml(const std::string& text) {
  Context context;
  importer::ReadOptions options;
  options.name = "c.gml";
  return importer::read_citygml(text, options, context);
}

// Area by "node material": it shows what was read and what was counted twice.
std::map<std::string, double> areas(const Scene& scene) {
  std::map<std::string, double> out;
  for (const ScenePart& part : scene.parts) {
    double& area = out[part.node + " " + part.material];
    for (uint32_t t = part.first_triangle; t < part.first_triangle + part.triangle_count; ++t) {
      const auto& [a, b, c] = scene.triangles[t];
      area += length(cross(scene.positions[b] - scene.positions[a],
                           scene.positions[c] - scene.positions[a])) /
              2;
    }
    area = std::round(area * 1000) / 1000;
  }
  return out;
}

// Twelve corners: a 4 x 4 square at z = 0 with a 1 x 1 hole, and the same square at z = 3.
const char* const kVertices =
    R"("vertices":[[0,0,0],[400,0,0],[400,400,0],[0,400,0],[100,100,0],[200,100,0],[200,200,0],
       [100,200,0],[0,0,300],[400,0,300],[400,400,300],[0,400,300]],
       "transform":{"scale":[0.01,0.01,0.01],"translate":[85000,447000,-1]})";

std::string city(const std::string& version, const std::string& objects,
                 const std::string& more = "") {
  return R"({"type":"CityJSON","version":")" + version + R"(",)" + more + R"("CityObjects":{)" +
         objects + "}," + kVertices + "}";
}

TEST(CityJson, SurfacesWithHolesSemanticsAndTransform) {
  const auto raw = json(city("2.0", R"("b1":{"type":"Building","geometry":[{"type":"MultiSurface",
      "lod":"2.2","boundaries":[[[0,1,2,3],[4,5,6,7]],[[8,9,10,11]]],
      "semantics":{"surfaces":[{"type":"GroundSurface"},{"type":"RoofSurface"}],
      "values":[0,1]}}]})"));
  ASSERT_TRUE(raw) << raw.error().message;
  EXPECT_EQ(areas(raw->scene), (std::map<std::string, double>{{"Building/b1 GroundSurface", 15},
                                                              {"Building/b1 RoofSurface", 16}}));
  EXPECT_EQ(raw->up, 'z');
  EXPECT_EQ(raw->scene.positions[0], (Vec3d{85000, 447000, -1}));
}

TEST(CityJson, SolidsOfAllDepthsAndNullMeanings) {
  const char* const solid = R"("lod":1,"boundaries":[[[[0,1,2,3]],[[8,9,10,11]]]],
      "semantics":{"surfaces":[{"type":"RoofSurface"}],"values":[[null,0]]})";
  const char* const solids = R"("lod":1,"boundaries":[[[[[0,1,2,3]]]],[[[[8,9,10,11]]]]],
      "semantics":{"surfaces":[{"type":"RoofSurface"}],"values":[null,[[0]]]})";
  for (const auto& [type, body] : {std::pair{"Solid", solid}, std::pair{"MultiSolid", solids},
                                   std::pair{"CompositeSolid", solids}}) {
    const auto raw = json(city("1.0", std::string(R"("x":{"type":"Bridge","geometry":[{"type":")") +
                                          type + "\"," + body + "}]}"));
    ASSERT_TRUE(raw) << raw.error().message;
    EXPECT_EQ(areas(raw->scene),
              (std::map<std::string, double>{{"Bridge/x ", 16}, {"Bridge/x RoofSurface", 16}}));
  }
}

TEST(CityJson, TheHighestDetailOfEachObjectAndItsPartsIsRead) {
  const std::string flat = R"({"type":"MultiSurface","lod":"0","boundaries":[[[0,1,2,3]]]})";
  const std::string fine = R"({"type":"MultiSurface","lod":"2.2","boundaries":[[[8,9,10]]]})";
  const std::string mid = R"({"type":"MultiSurface","lod":"1.3","boundaries":[[[8,9,10,11]]]})";
  const std::string line = R"({"type":"MultiLineString","lod":"3","boundaries":[[0,1]]})";
  const auto raw =
      json(city("1.1", R"("b":{"type":"Building","children":["p"],"geometry":[)" + flat + R"(]},
         "p":{"type":"BuildingPart","parents":["b"],"geometry":[)" +
                           mid + "," + fine + "," + line + R"(]},
         "s":{"type":"Building","children":["i"],"geometry":[)" +
                           mid + R"(]},
         "i":{"type":"BuildingInstallation","parents":["s"],"geometry":[)" +
                           fine + "]}"));
  ASSERT_TRUE(raw) << raw.error().message;
  EXPECT_EQ(areas(raw->scene),
            (std::map<std::string, double>{
                {"BuildingPart/p ", 8}, {"Building/s ", 16}, {"BuildingInstallation/i ", 8}}));
}

TEST(CityJson, TemplatesArePlacedByMatrixAndAnchor) {
  const auto raw = json(city(
      "1.1",
      R"("t":{"type":"SolitaryVegetationObject","geometry":[{"type":"GeometryInstance","template":0,
         "boundaries":[1],"transformationMatrix":[2,0,0,0, 0,2,0,0, 0,0,2,5, 0,0,0,1]}]})",
      R"("geometry-templates":{"templates":[{"type":"MultiSurface","lod":"2",
         "boundaries":[[[0,1,2]]]}],"vertices-templates":[[0,0,0],[1,0,0],[0,1,0]]},)"));
  ASSERT_TRUE(raw) << raw.error().message;
  ASSERT_EQ(raw->scene.triangles.size(), 1u);
  EXPECT_EQ(raw->scene.positions[1], (Vec3d{85006, 447000, 4}));
}

TEST(CityJson, BadFilesAreRefusedAndBadSurfacesCounted) {
  EXPECT_NE(json("{").error().message.find("c.json: not JSON"), std::string::npos);
  EXPECT_EQ(json("[1]").error().message, "c.json: not CityJSON: \"type\" must be \"CityJSON\"");
  EXPECT_EQ(json(R"({"type":"CityJSON"})").error().message, "c.json: has no \"vertices\"");
  EXPECT_NE(json(city("2.0", "", R"("metadata":{"referenceSystem":
      "https://www.opengis.net/def/crs/EPSG/0/4979"},)"))
                .error()
                .message.find("degrees"),
            std::string::npos);
  const auto raw = json(city("2.0", R"("b":{"type":"Building","geometry":[{"type":"MultiSurface",
      "lod":"1","boundaries":[[[0,1,99]],[[0,1,-1]],[[0,1]],[7],[[0,1,2]],5,[]]}]})"));
  ASSERT_TRUE(raw) << raw.error().message;
  EXPECT_EQ(raw->scene.triangles.size(), 1u);
  EXPECT_EQ(raw->scene.report.bad_index, 6u);
}

std::string square(const std::string& id, double z, const std::string& hole = "") {
  const std::string h = " " + std::to_string(z) + " ";
  return "<g:Polygon g:id=\"" + id + "\"><g:exterior><g:LinearRing><g:posList>0 0" + h + "4 0" + h +
         "4 4" + h + "0 4" + h + "0 0" + h + "</g:posList></g:LinearRing></g:exterior>" + hole +
         "</g:Polygon>";
}

std::string model(const std::string& body) {
  return "<?xml version=\"1.0\"?><core:CityModel xmlns:core=\"c\" xmlns:g=\"g\" xmlns:b=\"b\" "
         "xmlns:xlink=\"x\"><core:cityObjectMember>" +
         body + "</core:cityObjectMember></core:CityModel>";
}

TEST(CityGml, ThemesHolesAndReferencesCountOnce) {
  const std::string hole =
      "<g:interior><g:LinearRing><g:pos>1 1 0</g:pos><g:pos>2 1 0</g:pos>"
      "<g:pos>2 2 0</g:pos><g:pos>1 2 0</g:pos></g:LinearRing></g:interior>";
  const auto raw = gml(
      model("<b:Building g:id=\"B\"><b:lod2Solid><g:Solid><g:exterior><g:CompositeSurface>"
            "<g:surfaceMember xlink:href=\"#roof\"/><g:surfaceMember xlink:href=\"#ground\"/>"
            "<g:surfaceMember>" +
            square("inner", 2) +
            "</g:surfaceMember>"
            "</g:CompositeSurface></g:exterior></g:Solid></b:lod2Solid>"
            "<b:boundedBy><b:RoofSurface><b:lod2MultiSurface><g:MultiSurface><g:surfaceMember>" +
            square("roof", 3) +
            "</g:surfaceMember></g:MultiSurface></b:lod2MultiSurface></b:RoofSurface>"
            "</b:boundedBy><b:boundedBy><b:GroundSurface><b:lod2MultiSurface><g:MultiSurface>"
            "<g:surfaceMember>" +
            square("ground", 0, hole) +
            "</g:surfaceMember></g:MultiSurface>"
            "</b:lod2MultiSurface></b:GroundSurface></b:boundedBy></b:Building>"));
  ASSERT_TRUE(raw) << raw.error().message;
  EXPECT_EQ(areas(raw->scene), (std::map<std::string, double>{{"Building/B ", 16},
                                                              {"Building/B RoofSurface", 16},
                                                              {"Building/B GroundSurface", 15}}));
  EXPECT_TRUE(raw->scene.report.warnings.empty());
}

TEST(CityGml, AReferencedPolygonOfAnotherObjectIsRead) {
  const auto raw = gml(model(
      "<b:Road g:id=\"R\"><b:lod2MultiSurface><g:MultiSurface><g:surfaceMember xlink:href=\"#p\"/>"
      "<g:surfaceMember xlink:href=\"#nowhere\"/></g:MultiSurface></b:lod2MultiSurface></b:Road>"
      "<b:Other g:id=\"O\"><b:lod1MultiSurface>" +
      square("p", 0) +
      "</b:lod1MultiSurface>"
      "<b:lod3MultiSurface>" +
      square("q", 1) + "</b:lod3MultiSurface></b:Other>"));
  ASSERT_TRUE(raw) << raw.error().message;
  EXPECT_EQ(areas(raw->scene), (std::map<std::string, double>{{"Other/O ", 16}, {"Road/R ", 16}}));
  ASSERT_EQ(raw->scene.report.warnings.size(), 1u);
  EXPECT_NE(raw->scene.report.warnings[0].find("1 references"), std::string::npos);
}

TEST(CityGml, PartsStandInForTheirWhole) {
  const auto raw =
      gml(model("<b:Building g:id=\"B\"><b:lod1Solid>" + square("block", 9) +
                "</b:lod1Solid>"
                "<b:consistsOfBuildingPart><b:BuildingPart g:id=\"P\"><b:lod2Solid>" +
                square("part", 3) +
                "</b:lod2Solid></b:BuildingPart></b:consistsOfBuildingPart></b:Building>"));
  ASSERT_TRUE(raw) << raw.error().message;
  EXPECT_EQ(areas(raw->scene), (std::map<std::string, double>{{"BuildingPart/P ", 16}}));
}

TEST(CityGml, ImplicitGeometriesStandWhereTheirMatrixPutsThem) {
  const std::string place =
      "<core:referencePoint><g:Point><g:pos>100 0 0</g:pos></g:Point>"
      "</core:referencePoint></core:ImplicitGeometry>";
  const std::string matrix =
      "<core:ImplicitGeometry><core:transformationMatrix>2 0 0 7 0 2 0 0 "
      "0 0 2 0 0 0 0 1</core:transformationMatrix>";
  const auto raw = gml(model(
      "<f:CityFurniture g:id=\"A\"><f:lod2ImplicitRepresentation>" + matrix +
      "<core:relativeGMLGeometry><g:MultiSurface g:id=\"lamp\"><g:surfaceMember>" + square("l", 0) +
      "</g:surfaceMember></g:MultiSurface></core:relativeGMLGeometry>" + place +
      "</f:lod2ImplicitRepresentation></f:CityFurniture><f:CityFurniture g:id=\"B\">"
      "<f:lod2ImplicitRepresentation>" +
      matrix + "<core:relativeGMLGeometry xlink:href=\"#lamp\"/>" + place +
      "</f:lod2ImplicitRepresentation></f:CityFurniture>"));
  ASSERT_TRUE(raw) << raw.error().message;
  EXPECT_EQ(areas(raw->scene),
            (std::map<std::string, double>{{"CityFurniture/A ", 64}, {"CityFurniture/B ", 64}}));
  EXPECT_EQ(raw->scene.positions[0], (Vec3d{107, 0, 0}));
}

TEST(CityGml, TwoDimensionsOldCoordinatesAndTrianglesAreUnderstood) {
  const auto raw = gml(model(
      "<d:TINRelief g:id=\"T\"><d:tin><g:TriangulatedSurface><g:trianglePatches><g:Triangle>"
      "<g:exterior><g:LinearRing><g:posList srsDimension=\"2\">0 0 4 0 0 4 0 0</g:posList>"
      "</g:LinearRing></g:exterior></g:Triangle></g:trianglePatches></g:TriangulatedSurface></"
      "d:tin>"
      "</d:TINRelief><b:Old g:id=\"O\"><b:lod1Geometry><g:Polygon><g:outerBoundaryIs><g:LinearRing>"
      "<g:coordinates>0,0,5 4,0,5 4,4,5 0,0,5</g:coordinates></g:LinearRing></g:outerBoundaryIs>"
      "</g:Polygon></b:lod1Geometry></b:Old>"));
  ASSERT_TRUE(raw) << raw.error().message;
  EXPECT_EQ(areas(raw->scene), (std::map<std::string, double>{{"TINRelief/T ", 8}, {"Old/O ", 8}}));
}

TEST(CityGml, BadFilesAreRefused) {
  EXPECT_EQ(gml("<a>\n<b>\n</a>").error().message.substr(0, 8), "c.gml:3:");
  EXPECT_NE(gml("<CityModel><Envelope srsName=\"urn:ogc:def:crs:EPSG::4326\"/></CityModel>")
                .error()
                .message.find("degrees"),
            std::string::npos);
  EXPECT_TRUE(
      gml("<CityModel><Envelope srsName=\"urn:ogc:def:crs,crs:EPSG::28992,crs:EPSG::5709\"/>"
          "</CityModel>"));
  std::string deep;
  for (int i = 0; i < 100000; ++i) deep += "<A>";
  for (int i = 0; i < 100000; ++i) deep += "</A>";
  EXPECT_NE(gml(deep).error().message.find("deep"), std::string::npos);
}

}  // namespace
}  // namespace throng
