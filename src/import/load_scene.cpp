// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "core/arrays/release.h"
#include "import/formats/zonel.h"
#include "import/patches/patch_scene.h"
#include "import/raw/clean.h"
#include "import/raw/name_colour.h"
#include "import/raw/raw_scene.h"
#include "import/source_files.h"

// The one entry for all formats: reads and places each file, joins the files and cleans the result.
namespace throng {
namespace {

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
  release(one.positions);
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

}  // namespace

Result<Scene> load_scene(const SceneConfig& config, Context& context) {
  if (const auto checked = importer::check_config(config); !checked) return checked.error();
  const auto sources = importer::open_folders(config.sources);
  if (!sources) return sources.error();
  Scene all;
  std::vector<importer::PatchZone> zones;
  for (size_t i = 0; i < sources->size(); ++i) {
    const SceneSource& source = (*sources)[i];
    if (context.on_progress) context.on_progress({"read", i, sources->size()});
    if (context.cancel) return Error{Errc::kCancelled, "cancelled while reading"};
    auto raw = importer::read_placed(source, config, context);
    if (!raw) return raw.error();
    if (raw->zone) {
      raw->zone->first_patch = static_cast<uint32_t>(all.patches.size());
      zones.push_back(*std::move(raw->zone));
    }
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
