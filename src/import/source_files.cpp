// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "import/source_files.h"

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
#include "import/raw/area_rules.h"

// Chooses the reader of a file, and places what it has read in metres with Y up.
namespace throng::importer {
namespace {

using Reader = Result<RawScene> (*)(std::string_view, const ReadOptions&, Context&);

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
    return &read_patch_json;
  return bytes.find("\"CityJSON\"") != std::string_view::npos ? &read_cityjson : &read_geojson;
}

Result<RawScene> read_source(const SceneSource& source, const ReadOptions& options,
                             Context& context) {
  const std::string extension = lower_case(std::filesystem::path(source.path).extension().string());
  for (const char* known : {".gltf", ".glb", ".fbx", ".stl", ".dae", ".ifc", ".3ds"}) {
    if (extension != known) continue;
    // The child reads the file itself; here only the message for a missing file is made.
    std::error_code failure;
    if (!std::filesystem::is_regular_file(source.path, failure)) break;
    return read_with_assimp(source.path, options, context);
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
    reader = &read_obj;
  else if (extension == ".ply")
    reader = &read_ply;
  else if (extension == ".json")
    reader = json_reader(source.path, *bytes);
  else if (extension == ".gml")
    reader = &read_citygml;
  else if (extension == ".bsp")
    reader = &read_bsp;
  else if (extension == ".wkt")
    reader = &read_wkt;
  else if (extension == ".bpt")
    reader = &read_bpt;
  else if (extension == ".zonel")
    reader = &read_zonel;
  else
    reader = &read_geojson;
  return reader(*bytes, options, context);
}

// Into metres with Y up, then the source's own transform, as one matrix.
Transform placement(const SceneSource& source, const RawScene& raw) {
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

}  // namespace

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

Result<void> check_config(const SceneConfig& config) {
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

Result<RawScene> read_placed(const SceneSource& source, const SceneConfig& config,
                             Context& context) {
  ReadOptions options;
  options.name = source.path;
  options.curve_tolerance = config.curve_tolerance;
  options.plan_height = config.plan_height;
  options.metres_per_unit = source.scale;
  options.materials = config.materials;
  auto raw = read_source(source, options, context);
  if (!raw) return raw.error();
  if (auto ok = read_textures(*raw, source.path, context); !ok) return ok.error();
  const Transform place = placement(source, *raw);
  for (Vec3d& p : raw->scene.positions) p = place(p);
  for (BezierPatch& patch : raw->scene.patches.patches) {
    for (Vec3d& p : patch.points) p = place(p);
  }
  apply_rules(raw->scene, config.rules);
  return raw;
}

}  // namespace throng::importer
