// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "textured_models.h"

#include <array>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <string_view>
#include <utility>

#include "throng/picture.h"
#include "throng/scene.h"

// Written by hand, after the formats' descriptions, independent of what the library's readers and
// writers take for up in a picture.
namespace throng::test {
namespace {

// Corners of the square: low left, low right, high right, high left. Where the picture's lower left
// corner is, by formats that count up from there:
constexpr std::array<std::array<float, 2>, 4> kUpwards{{{0, 0}, {1, 0}, {1, 1}, {0, 1}}};
constexpr std::array<std::array<float, 3>, 4> kCorners{
    {{-2, 0, 0}, {2, 0, 0}, {2, 4, 0}, {-2, 4, 0}}};

std::string png_of_quarters() {
  const Texture texture = texture_of_quarters();
  Image image{.width = texture.width, .height = texture.height, .rgb = {}};
  for (size_t i = 0; i < texture.rgba.size(); ++i) {
    if (i % 4 != 3) image.rgb.push_back(texture.rgba[i]);
  }
  const std::vector<uint8_t> bytes = png_bytes(image);
  return {bytes.begin(), bytes.end()};
}

std::string base64(std::string_view bytes) {
  static constexpr char kLetters[] =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  for (size_t i = 0; i < bytes.size(); i += 3) {
    uint32_t word = 0;
    for (size_t k = 0; k < 3; ++k) {
      word = word << 8 | (i + k < bytes.size() ? static_cast<uint8_t>(bytes[i + k]) : 0U);
    }
    for (size_t k = 0; k < 4; ++k) {
      const size_t used = bytes.size() - i;  // n bytes make n + 1 letters.
      out += k <= used ? kLetters[word >> (18 - 6 * k) & 63] : '=';
    }
  }
  return out;
}

template <class T>
void put(std::string& out, const T& value) {
  char bytes[sizeof(T)];
  std::memcpy(bytes, &value, sizeof value);
  out.append(bytes, sizeof bytes);
}

// --- glTF: pictures count down from the upper edge -----------------------------------------------

struct Gltf {
  std::string json, binary;
};

// `image` is the JSON of the image; with `picture`, the buffer holds it behind the rest.
Gltf gltf(const std::string& image, const std::string& picture, const std::string& buffer_uri) {
  Gltf out;
  for (const auto& corner : kCorners) put(out.binary, corner);
  for (const auto& place : kUpwards) put(out.binary, std::array<float, 2>{place[0], 1 - place[1]});
  put(out.binary, std::to_array<uint16_t>({0, 1, 2, 0, 2, 3}));
  const size_t at = out.binary.size();
  out.binary += picture;
  const std::string size = std::to_string(out.binary.size());
  out.json =
      R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0,)"
      R"("name":"sign"}],)"
      R"("meshes":[{"primitives":[{"attributes":{"POSITION":0,"TEXCOORD_0":1},"indices":2,)"
      R"("material":0}]}],)"
      R"("materials":[{"name":"paint","pbrMetallicRoughness":{"baseColorTexture":{"index":0}}}],)"
      R"("textures":[{"source":0}],"images":[)" +
      image + R"(],"buffers":[{"byteLength":)" + size +
      (buffer_uri.empty() ? "" : R"(,"uri":")" + buffer_uri + '"') +
      R"(}],"bufferViews":[{"buffer":0,"byteOffset":0,"byteLength":48},)"
      R"({"buffer":0,"byteOffset":48,"byteLength":32},{"buffer":0,"byteOffset":80,)"
      R"("byteLength":12})" +
      (picture.empty() ? ""
                       : R"(,{"buffer":0,"byteOffset":)" + std::to_string(at) +
                             R"(,"byteLength":)" + std::to_string(picture.size()) + "}") +
      R"(],"accessors":[{"bufferView":0,"componentType":5126,"count":4,"type":"VEC3",)"
      R"("min":[-2,0,0],"max":[2,4,0]},)"
      R"({"bufferView":1,"componentType":5126,"count":4,"type":"VEC2"},)"
      R"({"bufferView":2,"componentType":5123,"count":6,"type":"SCALAR"}]})";
  return out;
}

std::string gltf_with_files(const ScratchFolder& folder) {
  folder.write("old wall.png", png_of_quarters());
  const Gltf file = gltf(R"({"uri":"old%20wall.png"})", {}, "sign.bin");
  folder.write("sign.bin", file.binary);
  return folder.write("sign.gltf", file.json);
}

std::string gltf_with_all_inside(const ScratchFolder& folder) {
  const std::string image =
      R"({"uri":"data:image/png;base64,)" + base64(png_of_quarters()) + R"("})";
  const std::string binary = gltf(image, {}, {}).binary;
  return folder.write(
      "sign.gltf", gltf(image, {}, "data:application/octet-stream;base64," + base64(binary)).json);
}

std::string glb(const ScratchFolder& folder, const std::string& image, const std::string& picture) {
  Gltf file = gltf(image, picture, {});
  while (file.json.size() % 4 != 0) file.json += ' ';
  while (file.binary.size() % 4 != 0) file.binary += '\0';
  std::string out("glTF");
  put(out, uint32_t{2});
  put(out, static_cast<uint32_t>(28 + file.json.size() + file.binary.size()));
  put(out, static_cast<uint32_t>(file.json.size()));
  out += "JSON" + file.json;
  put(out, static_cast<uint32_t>(file.binary.size()));
  out += std::string("BIN\0", 4) + file.binary;
  return folder.write("sign.glb", out);
}

std::string glb_with_picture(const ScratchFolder& folder) {
  return glb(folder, R"({"bufferView":3,"mimeType":"image/png","name":"wall"})", png_of_quarters());
}

std::string glb_beside_picture(const ScratchFolder& folder) {
  folder.write("wall.png", png_of_quarters());
  return glb(folder, R"({"uri":"wall.png"})", {});
}

std::string glb_of_ours(const ScratchFolder& folder) {
  Scene scene;
  const auto corner = [](size_t k) {
    return Vec3d{kCorners[k][0], kCorners[k][1], kCorners[k][2]};
  };
  scene.add_quad(corner(0), corner(1), corner(2), corner(3));
  scene.textures = {texture_of_quarters()};
  scene.materials = {{.name = "paint", .texture1 = 1}};
  scene.parts = {{.file = {},
                  .node = "sign",
                  .material = "paint",
                  .first_triangle = 0,
                  .triangle_count = 2,
                  .material1 = 1}};
  for (const auto& triangle : scene.triangles) {
    TextureCorners& places = scene.texture_corners.emplace_back();
    for (size_t k = 0; k < 3; ++k) {
      const Vec3d& p = scene.positions[triangle[k]];
      places[k] = {static_cast<float>(p.x / 4 + 0.5), static_cast<float>(1 - p.y / 4)};
    }
  }
  std::string path = folder.path() + "/sign.glb";
  if (!write_glb(scene, path)) return {};
  return path;
}

// --- The others: pictures count up from the lower edge -------------------------------------------

std::string numbers(bool places) {
  std::string out;
  for (size_t k = 0; k < 4; ++k) {
    for (size_t c = 0; c < (places ? 2U : 3U); ++c) {
      out += std::to_string(places ? kUpwards[k][c] : kCorners[k][c]) + ' ';
    }
  }
  return out;
}

std::string obj(const ScratchFolder& folder) {
  folder.write("wall.tga", tga_bytes(texture_of_quarters()));
  folder.write("sign.mtl", "newmtl paint\nKd 1 1 1\nmap_Kd wall.tga\n");
  std::string out = "mtllib sign.mtl\no sign\n";
  for (size_t k = 0; k < 4; ++k) {
    out += "v";
    for (const float c : kCorners[k]) out += ' ' + std::to_string(c);
    out += "\nvt " + std::to_string(kUpwards[k][0]) + ' ' + std::to_string(kUpwards[k][1]) + '\n';
  }
  return folder.write("sign.obj", out + "usemtl paint\nf 1/1 2/2 3/3 4/4\n");
}

// As SketchUp and 3ds Max write them: the picture in a folder below, by a sampler.
std::string dae(const ScratchFolder& folder, bool z_up) {
  std::filesystem::create_directories(folder.path() + "/sign");
  folder.write("sign/old wall.tga", tga_bytes(texture_of_quarters()));
  std::string positions = numbers(false);
  if (z_up) {
    positions.clear();
    for (const auto& c : kCorners) {
      for (const float part : {c[0], -c[2], c[1]}) positions += std::to_string(part) + ' ';
    }
  }
  const std::string out =
      R"(<?xml version="1.0" encoding="utf-8"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><unit name="meter" meter="1"/><up_axis>)" +
      std::string(z_up ? "Z_UP" : "Y_UP") + R"(</up_axis></asset>
<library_images><image id="wall"><init_from>sign/old%20wall.tga</init_from></image></library_images>
<library_effects><effect id="paint_effect"><profile_COMMON>
<newparam sid="surface"><surface type="2D"><init_from>wall</init_from></surface></newparam>
<newparam sid="sampler"><sampler2D><source>surface</source></sampler2D></newparam>
<technique sid="common"><lambert><diffuse><texture texture="sampler" texcoord="UVSET0"/></diffuse>
</lambert></technique></profile_COMMON></effect></library_effects>
<library_materials><material id="paint" name="paint"><instance_effect url="#paint_effect"/>
</material>
</library_materials>
<library_geometries><geometry id="square"><mesh>
<source id="p"><float_array id="pa" count="12">)" +
      positions + R"(</float_array><technique_common>
<accessor source="#pa" count="4" stride="3"><param name="X" type="float"/>
<param name="Y" type="float"/>
<param name="Z" type="float"/></accessor></technique_common></source>
<source id="t"><float_array id="ta" count="8">)" +
      numbers(true) + R"(</float_array><technique_common>
<accessor source="#ta" count="4" stride="2"><param name="S" type="float"/>
<param name="T" type="float"/>
</accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<triangles count="2" material="slot"><input semantic="VERTEX" source="#v" offset="0"/>
<input semantic="TEXCOORD" source="#t" offset="1" set="0"/><p>0 0 1 1 2 2 0 0 2 2 3 3</p>
</triangles>
</mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="s"><node id="sign" name="sign">
<instance_geometry url="#square">
<bind_material><technique_common><instance_material symbol="slot" target="#paint">
<bind_vertex_input semantic="UVSET0" input_semantic="TEXCOORD" input_set="0"/></instance_material>
</technique_common></bind_material></instance_geometry></node></visual_scene>
</library_visual_scenes>
<scene><instance_visual_scene url="#s"/></scene></COLLADA>
)";
  return folder.write("sign.dae", out);
}

std::string fbx_square() {
  std::string positions = numbers(false), places = numbers(true);
  for (std::string* text : {&positions, &places}) {
    text->pop_back();
    for (char& c : *text) c = c == ' ' ? ',' : c;
  }
  return R"(Objects:  {
  Geometry: 10, "Geometry::square", "Mesh" {
    Vertices: *12 {
      a: )" +
         positions + R"(
    }
    PolygonVertexIndex: *4 {
      a: 0,1,2,-4
    }
    GeometryVersion: 124
    LayerElementUV: 0 {
      Version: 101
      Name: "UVChannel_1"
      MappingInformationType: "ByPolygonVertex"
      ReferenceInformationType: "IndexToDirect"
      UV: *8 {
        a: )" +
         places + R"(
      }
      UVIndex: *4 {
        a: 0,1,2,3
      }
    }
    LayerElementMaterial: 0 {
      Version: 101
      Name: ""
      MappingInformationType: "AllSame"
      ReferenceInformationType: "IndexToDirect"
      Materials: *1 {
        a: 0
      }
    }
    Layer: 0 {
      Version: 100
      LayerElement:  {
        Type: "LayerElementMaterial"
        TypedIndex: 0
      }
      LayerElement:  {
        Type: "LayerElementUV"
        TypedIndex: 0
      }
    }
  }
)";
}

// The picture of another machine's path, or within the file.
std::string fbx(const ScratchFolder& folder, bool holds_picture) {
  if (!holds_picture) folder.write("wall.png", png_of_quarters());
  const std::string content =
      holds_picture ? "    Content: , \"" + base64(png_of_quarters()) + "\"\n" : "";
  const std::string file_names =
      "    FileName: \"C:\\models\\wall.png\"\n    RelativeFilename: \"..\\models\\wall.png\"\n";
  return folder.write("sign.fbx",
                      R"(; FBX 7.4.0 project file
FBXHeaderExtension:  {
  FBXHeaderVersion: 1003
  FBXVersion: 7400
}
GlobalSettings:  {
  Version: 1000
  Properties70:  {
    P: "UpAxis", "int", "Integer", "",1
    P: "UpAxisSign", "int", "Integer", "",1
    P: "FrontAxis", "int", "Integer", "",2
    P: "FrontAxisSign", "int", "Integer", "",1
    P: "CoordAxis", "int", "Integer", "",0
    P: "CoordAxisSign", "int", "Integer", "",1
    P: "UnitScaleFactor", "double", "Number", "",100
  }
}
)" + fbx_square() + R"(  Model: 20, "Model::sign", "Mesh" {
    Version: 232
    Shading: W
    Culling: "CullingOff"
  }
  Material: 30, "Material::paint", "" {
    Version: 102
    ShadingModel: "lambert"
    MultiLayer: 0
    Properties70:  {
      P: "DiffuseColor", "Color", "", "A",1,1,1
    }
  }
  Texture: 40, "Texture::wall", "" {
    Type: "TextureVideoClip"
    Version: 202
    TextureName: "Texture::wall"
    Media: "Video::wall"
)" + file_names + R"(    ModelUVTranslation: 0,0
    ModelUVScaling: 1,1
    Texture_Alpha_Source: "None"
    Cropping: 0,0,0,0
  }
  Video: 50, "Video::wall", "Clip" {
    Type: "Clip"
    UseMipMap: 0
)" + file_names + content +
                          R"(  }
}
Connections:  {
  C: "OO",20,0
  C: "OO",10,20
  C: "OO",30,20
  C: "OP",40,30, "DiffuseColor"
  C: "OO",50,40
}
)");
}

// Chunks of a number, a size and what is in them.
std::string chunk(uint16_t kind, const std::string& inside) {
  std::string out;
  put(out, kind);
  put(out, static_cast<uint32_t>(6 + inside.size()));
  return out + inside;
}

std::string words(const std::string& text) { return text + '\0'; }

// Up is z; names of files are of eight letters and three.
std::string three_ds(const ScratchFolder& folder) {
  folder.write("WALL.TGA", tga_bytes(texture_of_quarters()));
  std::string vertices, places, faces;
  put(vertices, uint16_t{4});
  put(places, uint16_t{4});
  for (size_t k = 0; k < 4; ++k) {
    put(vertices, std::array<float, 3>{kCorners[k][0], -kCorners[k][2], kCorners[k][1]});
    put(places, kUpwards[k]);
  }
  put(faces, uint16_t{2});
  put(faces, std::to_array<uint16_t>({0, 1, 2, 7, 0, 2, 3, 7}));
  std::string of_faces = words("paint");
  put(of_faces, std::to_array<uint16_t>({2, 0, 1}));
  std::string percent, version;
  put(percent, uint16_t{100});
  put(version, uint32_t{3});
  const std::string material =
      chunk(0xA000, words("paint")) + chunk(0xA020, chunk(0x0011, "\xff\xff\xff")) +
      chunk(0xA200, chunk(0x0030, percent) + chunk(0xA300, words("WALL.TGA")));
  const std::string mesh = chunk(0x4110, vertices) + chunk(0x4140, places) +
                           chunk(0x4120, faces + chunk(0x4130, of_faces));
  return folder.write(
      "sign.3ds",
      chunk(0x4D4D, chunk(0x0002, version) +
                        chunk(0x3D3D, chunk(0x3D3E, version) + chunk(0xAFFF, material) +
                                          chunk(0x4000, words("sign") + chunk(0x4100, mesh)))));
}

}  // namespace

Texture texture_of_quarters() {
  Texture out{.name = "quarters", .width = 16, .height = 16, .rgba = {}};
  for (int32_t i = 0; i < 256; ++i) {
    const bool right = i % 16 >= 8, low = i / 16 >= 8;
    const std::array<uint8_t, 4> texel = right ? low ? std::array<uint8_t, 4>{230, 230, 230, 255}
                                                     : std::array<uint8_t, 4>{0, 200, 0, 255}
                                         : low ? std::array<uint8_t, 4>{0, 0, 220, 255}
                                               : std::array<uint8_t, 4>{220, 0, 0, 255};
    out.rgba.insert(out.rgba.end(), texel.begin(), texel.end());
  }
  return out;
}

std::string tga_bytes(const Texture& texture) {
  std::string out("\0\0\2\0\0\0\0\0\0\0\0\0", 12);
  put(out, static_cast<uint16_t>(texture.width));
  put(out, static_cast<uint16_t>(texture.height));
  out += "\x20\x28";
  for (size_t i = 0; i < texture.rgba.size(); i += 4) {
    for (const size_t c : {2, 1, 0, 3}) out += static_cast<char>(texture.rgba[i + c]);
  }
  return out;
}

std::vector<TexturedModel> textured_models() {
  return {
      {"obj", &obj},
      {"gltf, files beside it", &gltf_with_files},
      {"gltf, all inside", &gltf_with_all_inside},
      {"glb, picture inside", &glb_with_picture},
      {"glb, picture beside it", &glb_beside_picture},
      {"glb of ours", &glb_of_ours},
      {"dae, y up", [](const ScratchFolder& folder) { return dae(folder, false); }},
      {"dae, z up", [](const ScratchFolder& folder) { return dae(folder, true); }},
      {"fbx, picture beside it", [](const ScratchFolder& folder) { return fbx(folder, false); }},
      {"fbx, picture inside", [](const ScratchFolder& folder) { return fbx(folder, true); }},
      {"3ds", &three_ds}};
}

}  // namespace throng::test
