// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "import/builtin/patch_world.h"
#include "import/formats/zonel.h"
#include "import/raw/clean.h"
#include "import/regions/patch_regions.h"
#include "import/regions/triangle_store.h"
#include "import/source_files.h"

// Scenes region by region: triangles of files in a store on disk, then the patches of files, as
// load_scene orders them, then built-in worlds.
namespace throng {
namespace {

class StoredScene : public SceneRegions {
 public:
  [[nodiscard]] const SceneFacts& facts() const override { return facts_; }

  [[nodiscard]] uint64_t estimate(const Box3d& box) const override {
    uint64_t sum = 0;
    for (const auto& part : parts_) sum += part->estimate(box);
    return sum;
  }

  [[nodiscard]] Result<SceneRegion> region(const Box3d& box, Context& context) const override {
    SceneRegion out;
    for (const double value : {box.min.x, box.min.z, box.max.x, box.max.z}) {
      if (std::isnan(value)) return Error{Errc::kBadConfig, "scene: the box is no box"};
    }
    uint32_t first_patch = 0;
    for (const auto& part : parts_) {
      if (auto ok = part->append(box, first_patch, out, context); !ok) return ok.error();
      first_patch += static_cast<uint32_t>(part->patches());
    }
    return out;
  }

  Result<void> add(std::unique_ptr<importer::RegionPart> part) {
    facts_.triangles += part->triangles();
    facts_.patches += part->patches();
    if (part->patches() > 0) facts_.patch_triangles += part->triangles();
    if (facts_.triangles > UINT32_MAX || facts_.patches >= kNoPatch / 4) {
      return Error{Errc::kLimit, "scene: more than 4.29 thousand million triangles"};
    }
    if (!part->bounds().empty()) {
      facts_.bounds.add(part->bounds().min);
      facts_.bounds.add(part->bounds().max);
    }
    parts_.push_back(std::move(part));
    return {};
  }

  void warn_of_size(const std::string& name) {
    const Vec3d size = facts_.bounds.max - facts_.bounds.min;
    importer::warn_of_size(facts_.report, name, std::max({size.x, size.y, size.z}));
  }

  void count(const SceneReport& report) {
    Scene sum;
    sum.report = std::move(facts_.report);
    Scene more;
    more.report = report;
    sum.append(more);
    facts_.report = std::move(sum.report);
  }

 private:
  SceneFacts facts_;
  std::vector<std::unique_ptr<importer::RegionPart>> parts_;  // in order of their triangles
};

// Triangles and patches of the files, each file in memory alone.
class FileReader {
 public:
  FileReader(const SceneConfig& config, StoredScene& out) : config_(config), out_(out) {}

  Result<void> read(const std::string& folder, Context& context) {
    if (auto ok = importer::check_config(config_); !ok) return ok;
    const auto sources = importer::open_folders(config_.sources);
    if (!sources) return sources.error();
    auto store = importer::TriangleStore::create(folder);
    if (!store) return store.error();
    for (size_t i = 0; i < sources->size(); ++i) {
      if (context.on_progress) context.on_progress({"read", i, sources->size()});
      if (context.cancel) return Error{Errc::kCancelled, "cancelled while reading"};
      if (auto ok = read_file((*sources)[i], **store, context); !ok) return ok;
    }
    if (auto ok = (*store)->finish(); !ok) return ok;
    if ((*store)->triangles() > 0) {
      if (auto ok = out_.add(*std::move(store)); !ok) return ok;
    }
    if (auto ok = add_patches(context); !ok) return ok;
    const std::string name = sources->size() == 1
                                 ? sources->front().path
                                 : fmt::format("scene of {} files", sources->size());
    if (out_.facts().triangles == 0) return importer::nothing_left(out_.facts().report, name);
    out_.warn_of_size(name);
    return {};
  }

 private:
  Result<void> read_file(const SceneSource& source, importer::TriangleStore& store,
                         Context& context) {
    auto raw = importer::read_placed(source, config_, context);
    if (!raw) return raw.error();
    Scene& scene = raw->scene;
    if (raw->zone) {
      raw->zone->first_patch = static_cast<uint32_t>(patches_.size());
      zones_.push_back(*std::move(raw->zone));
    }
    if (scene.patches.size() + patches_.size() >= kNoPatch / 4) {
      return Error{Errc::kLimit, "scene: more than 1.07 thousand million patches"};
    }
    patches_.append(scene.patches);
    scene.patches = {};
    if (auto ok = importer::clean_part(scene, source.path, context); !ok) return ok;
    out_.count(scene.report);
    return store.add(scene);
  }

  Result<void> add_patches(Context& context) {
    SceneReport report;
    if (auto ok = importer::join_zones(patches_, zones_, report); !ok) return ok;
    out_.count(report);
    if (patches_.empty()) return {};
    auto regions = importer::PatchRegions::create(std::move(patches_), config_, context);
    if (!regions) return regions.error();
    return out_.add(*std::move(regions));
  }

  const SceneConfig& config_;
  StoredScene& out_;
  PatchSet patches_;
  std::vector<importer::PatchZone> zones_;
};

Result<void> add_builtin(const BuiltinWorldConfig& config, const std::string& folder,
                         StoredScene& out, Context& context) {
  auto curved = importer::builtin::create_patch_world(config);
  if (!curved) return curved.error();
  if (!curved->patches.empty()) {
    SceneConfig how;
    how.curve_tolerance = curved->tolerance;
    auto regions = importer::PatchRegions::create(std::move(curved->patches), how, context);
    if (!regions) return regions.error();
    return out.add(*std::move(regions));
  }
  const auto scene = create_builtin_world(config);
  if (!scene) return scene.error();
  auto store = importer::TriangleStore::create(folder);
  if (!store) return store.error();
  if (auto ok = (*store)->add(*scene); !ok) return ok;
  if (auto ok = (*store)->finish(); !ok) return ok;
  out.count(scene->report);
  return out.add(*std::move(store));
}

}  // namespace

Result<std::unique_ptr<SceneRegions>> load_scene_regions(
    const SceneConfig& config, std::span<const BuiltinWorldConfig> builtin,
    const std::string& folder, Context& context) {
  if (!config.volumes.empty()) {
    return Error{Errc::kBadConfig,
                 "scene: volumes are of scenes in memory; leave them out, or leave the bound of "
                 "memory out"};
  }
  if (config.materials == SceneMaterials::kRead) {
    return Error{Errc::kBadConfig, "scene: materials are of scenes in memory; leave them out"};
  }
  auto scene = std::make_unique<StoredScene>();
  if (!config.sources.empty() || builtin.empty()) {
    FileReader reader(config, *scene);
    if (auto ok = reader.read(folder, context); !ok) return ok.error();
  }
  for (const BuiltinWorldConfig& world : builtin) {
    if (auto ok = add_builtin(world, folder, *scene, context); !ok) return ok.error();
  }
  return std::unique_ptr<SceneRegions>(std::move(scene));
}

}  // namespace throng
