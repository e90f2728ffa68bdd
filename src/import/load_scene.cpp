// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <utility>

#include "core/files/read_file.h"
#include "import/formats/assimp_reader.h"
#include "import/formats/bpt.h"
#include "import/formats/bsp.h"
#include "import/formats/city.h"
#include "import/formats/obj.h"
#include "import/formats/patch_json.h"
#include "import/formats/plan.h"
#include "import/formats/ply.h"
#include "import/formats/texture_reader.h"
#include "import/formats/zonel.h"
#include "import/patches/patch_scene.h"
#include "import/raw/area_rules.h"
#include "import/raw/clean.h"
#include "import/raw/name_colour.h"
#include "import/raw/raw_scene.h"

// The one entry for all formats: reads each file as it is, places it in metres with Y up, sets area
// kinds, joins the files and cleans the result.
namespace throng {
namespace {

using Reader = Result<importer::RawScene> (*)(std::string_view, const importer::ReadOptions&,
                                              Context&);

std::string lower_case(std::string text) {
  for (char& c : text) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return text;
}

// A .json file may hold patches, a city or a plan. Patches and cities are recognised by a key or by
// the file's name; all else is a plan.
Reader json_reader(const std::string& path, std::string_view bytes) {
  if (lower_case(path).ends_with(".patches.json") ||
      bytes.find("\"throng-patches\"") != std::string_view::npos)
    return &importer::read_patch_json;
  return bytes.find("\"CityJSON\"") != std::string_view::npos ? &importer::read_cityjson
                                                              : &importer::read_geojson;
}

Result<importer::RawScene> read_source(const SceneSource& source,
                                       const importer::ReadOptions& options, Context& context) {
  const std::string extension = lower_case(std::filesystem::path(source.path).extension().string());
  for (const char* known : {".gltf", ".glb", ".fbx", ".stl", ".dae", ".ifc", ".3ds"}) {
    if (extension != known) continue;
    // The child reads the file itself; here only the message for a missing file is made.
    std::error_code failure;
    if (!std::filesystem::is_regular_file(source.path, failure)) break;
    return importer::read_with_assimp(source.path, options, context);
  }
  const bool known = extension == ".obj" || extension == ".ply" || extension == ".json" ||
                     extension == ".gml" || extension == ".bsp" || extension == ".wkt" ||
                     extension == ".geojson" || extension == ".bpt" || extension == ".zonel";
  const auto bytes = read_file(source.path);
  if (!bytes) return bytes.error();
  if (!known) {
    return Error{Errc::kBadFile,
                 fmt::format("{}: unknown kind of file '{}'; readable are obj gltf glb fbx ply stl "
                             "dae ifc 3ds city.json gml bsp wkt geojson bpt zonel patches.json",
                             source.path, extension)};
  }
  Reader reader = nullptr;
  if (extension == ".obj")
    reader = &importer::read_obj;
  else if (extension == ".ply")
    reader = &importer::read_ply;
  else if (extension == ".json")
    reader = json_reader(source.path, *bytes);
  else if (extension == ".gml")
    reader = &importer::read_citygml;
  else if (extension == ".bsp")
    reader = &importer::read_bsp;
  else if (extension == ".wkt")
    reader = &importer::read_wkt;
  else if (extension == ".bpt")
    reader = &importer::read_bpt;
  else if (extension == ".zonel")
    reader = &importer::read_zonel;
  else
    reader = &importer::read_geojson;
  return reader(*bytes, options, context);
}

// Into metres with Y up, then the source's own transform, as one matrix.
Transform placement(const SceneSource& source, const importer::RawScene& raw) {
  const double s = source.scale.value_or(raw.metres_per_unit);
  const bool z_up = source.up.value_or(raw.up) == 'z';
  Transform out;
  for (size_t row = 0; row < 3; ++row) {
    const auto& m = source.transform.m[row];
    // Z up: (x, y, z) lies at (x, z, -y).
    out.m[row] = {m[0] * s, (z_up ? -m[2] : m[1]) * s, (z_up ? m[1] : m[2]) * s, m[3]};
  }
  return out;
}

void append(Scene& all, Scene&& one) {
  if (all.triangles.empty() && all.positions.empty() && all.patches.empty()) {
    const SceneReport report = std::move(all.report);
    all = std::move(one);
    all.report.triangles_read += report.triangles_read;
    all.report.bad_index += report.bad_index;
    all.report.ignored += report.ignored;
    all.report.warnings.insert(all.report.warnings.begin(), report.warnings.begin(),
                               report.warnings.end());
    return;
  }
  const auto first_vertex = static_cast<uint32_t>(all.positions.size());
  const auto first_triangle = static_cast<uint32_t>(all.triangles.size());
  all.positions.insert(all.positions.end(), one.positions.begin(), one.positions.end());
  one.positions = {};
  for (const auto& corners : one.triangles) {
    auto& moved = all.triangles.emplace_back(corners);
    for (uint32_t& corner : moved)
      corner = corner == importer::kNoVertex ? importer::kNoVertex : corner + first_vertex;
  }
  all.area.insert(all.area.end(), one.area.begin(), one.area.end());
  const auto first_material = static_cast<uint32_t>(all.materials.size());
  for (ScenePart& part : one.parts) {
    part.first_triangle += first_triangle;
    if (part.material1 != 0) part.material1 += first_material;
    all.parts.push_back(std::move(part));
  }
  const auto first_texture = static_cast<uint32_t>(all.textures.size());
  for (Material& material : one.materials) {
    if (material.texture1 != 0) material.texture1 += first_texture;
    all.materials.push_back(std::move(material));
  }
  std::move(one.textures.begin(), one.textures.end(), std::back_inserter(all.textures));
  if (!all.texture_corners.empty() || !one.texture_corners.empty()) {
    all.texture_corners.resize(first_triangle);
    all.texture_corners.insert(all.texture_corners.end(), one.texture_corners.begin(),
                               one.texture_corners.end());
    all.texture_corners.resize(all.triangles.size());
  }
  all.patches.append(one.patches);
  all.report.triangles_read += one.report.triangles_read;
  all.report.bad_index += one.report.bad_index;
  all.report.ignored += one.report.ignored;
  std::move(one.report.warnings.begin(), one.report.warnings.end(),
            std::back_inserter(all.report.warnings));
}

// A folder stands for the landscape zones in it, in order of their names.
Result<std::vector<SceneSource>> open_folders(const std::vector<SceneSource>& sources) {
  std::vector<SceneSource> files;
  for (const SceneSource& source : sources) {
    std::error_code failure;
    if (!std::filesystem::is_directory(source.path, failure)) {
      files.push_back(source);
      continue;
    }
    std::vector<std::string> paths;
    for (const auto& entry : std::filesystem::directory_iterator(source.path, failure)) {
      if (lower_case(entry.path().extension().string()) == ".zonel") {
        paths.push_back(entry.path().string());
      }
    }
    if (failure) return Error{Errc::kIo, source.path + ": cannot be listed; check its permissions"};
    if (paths.empty()) {
      return Error{Errc::kBadFile,
                   source.path + ": is a folder without .zonel files; name a file inside it"};
    }
    std::sort(paths.begin(), paths.end());
    for (std::string& path : paths) {
      files.push_back(source);
      files.back().path = std::move(path);
    }
  }
  return files;
}

Result<void> check(const SceneConfig& config) {
  const auto bad = [](std::string what) { return Error{Errc::kBadConfig, "scene: " + what}; };
  if (config.sources.empty()) return bad("no source; name at least one file");
  if (!(config.plan_height > 0 && config.plan_height <= 1e6)) return bad("need plan_height > 0");
  if (!(config.curve_tolerance > 0 && config.curve_tolerance <= 1e6)) {
    return bad("need curve_tolerance > 0");
  }
  for (const SceneSource& source : config.sources) {
    if (source.up && *source.up != 'y' && *source.up != 'z') {
      return bad(source.path + ": up must be y or z");
    }
    if (source.scale && !(*source.scale > 0 && *source.scale <= 1e9)) {
      return bad(source.path + ": need scale > 0");
    }
    for (const auto& row : source.transform.m) {
      for (const double value : row) {
        if (!std::isfinite(value)) return bad(source.path + ": the transform is not finite");
      }
    }
  }
  return {};
}

}  // namespace

Result<Scene> load_scene(const SceneConfig& config, Context& context) {
  if (const auto checked = check(config); !checked) return checked.error();
  const auto sources = open_folders(config.sources);
  if (!sources) return sources.error();
  Scene all;
  std::vector<importer::PatchZone> zones;
  for (size_t i = 0; i < sources->size(); ++i) {
    const SceneSource& source = (*sources)[i];
    if (context.on_progress) context.on_progress({"read", i, sources->size()});
    if (context.cancel) return Error{Errc::kCancelled, "cancelled while reading"};
    importer::ReadOptions options;
    options.name = source.path;
    options.curve_tolerance = config.curve_tolerance;
    options.plan_height = config.plan_height;
    options.metres_per_unit = source.scale;
    options.materials = config.materials;
    auto raw = read_source(source, options, context);
    if (!raw) return raw.error();
    if (auto ok = importer::read_textures(*raw, source.path, context); !ok) return ok.error();
    const Transform place = placement(source, *raw);
    for (Vec3d& p : raw->scene.positions) p = place(p);
    for (BezierPatch& patch : raw->scene.patches.patches) {
      for (Vec3d& p : patch.points) p = place(p);
    }
    if (raw->zone) {
      raw->zone->first_patch = static_cast<uint32_t>(all.patches.size());
      zones.push_back(*std::move(raw->zone));
    }
    importer::apply_rules(raw->scene, config.rules);
    if (raw->scene.patches.size() + all.patches.size() >= kNoPatch / 4) {
      return Error{Errc::kLimit,
                   "scene: more than 1.07 thousand million patches; bake it in parts"};
    }
    const uint64_t vertices = uint64_t{all.positions.size()} + raw->scene.positions.size();
    const uint64_t triangles = uint64_t{all.triangles.size()} + raw->scene.triangles.size();
    if (vertices >= importer::kNoVertex || triangles >= importer::kNoVertex) {
      return Error{Errc::kLimit,
                   "scene: more than 4.29 thousand million vertices; bake it in parts"};
    }
    append(all, std::move(raw->scene));
  }
  if (const auto joined = importer::join_zones(all.patches, zones, all.report); !joined)
    return joined.error();
  if (const auto cut = importer::cut_patches(all, config, context); !cut) return cut.error();
  for (const AreaVolume& volume : config.volumes) {
    if (const auto marked = mark_volume(all, volume); !marked) return marked.error();
  }
  const std::string name = sources->size() == 1 ? sources->front().path
                                                : fmt::format("scene of {} files", sources->size());
  if (auto cleaned = importer::clean_scene(all, name, context); !cleaned) return cleaned.error();
  if (config.materials == SceneMaterials::kRead) importer::add_named_materials(all);
  if (context.on_progress) {
    context.on_progress({"read", sources->size(), sources->size()});
  }
  return all;
}

}  // namespace throng
