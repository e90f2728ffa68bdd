// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "sources.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <string_view>
#include <utility>

#include "number_checks.h"

// Reads model files, scene files and built-in worlds into one Scene.
namespace throng::app {
namespace {

constexpr std::string_view kBuiltin = "builtin:";

Error bad_builtin(const std::string& text, const std::string& what) {
  return {Errc::kBadConfig,
          fmt::format("{}: {}; write builtin:NAME[,size=M][,levels=N][,triangles=N]"
                      "[,seed=N]",
                      text, what)};
}

template <class T>
bool parse_number(std::string_view text, T& value) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && end == text.data() + text.size();
}

bool set_field(BuiltinWorldConfig& config, std::string_view key, std::string_view value) {
  if (key == "size") return parse_number(value, config.size);
  if (key == "levels") return parse_number(value, config.levels);
  if (key == "triangles") return parse_number(value, config.triangles);
  return key == "seed" && parse_number(value, config.seed);
}

// Does half of the longer of two ranges lie in the other, or are both short?
bool share_half(double low, double high, double other_low, double other_high) {
  constexpr double kMaxShortRange = 2;  // [m]
  const double longer = std::max(high - low, other_high - other_low);
  return longer <= kMaxShortRange ||
         std::min(high, other_high) - std::max(low, other_low) >= longer / 2;
}

std::string box_text(const Box3d& box) {
  return fmt::format("x {:.1f} to {:.1f}, y {:.1f} to {:.1f}, z {:.1f} to {:.1f} m", box.min.x,
                     box.max.x, box.min.y, box.max.y, box.min.z, box.max.z);
}

}  // namespace

void add_source_options(CLI::App* command, SourceOptions& options, const std::string& name) {
  CLI::Option* files = command->add_option(
      name, options.files,
      "Model files, or builtin:NAME[,size=M][,levels=N][,triangles=N][,seed=N]");
  files->type_name("FILE");
  command->add_option("--up", options.up, "Axis that points up in the files")
      ->check(CLI::IsMember({"y", "z"}));
  command->add_option("--scale", options.scale, "Metres per unit of the files")->check(above(0));
  command->add_option("--scene", options.scene, "Scene file (TOML or JSON): sources and area rules")
      ->type_name("FILE");
}

Result<BuiltinWorldConfig> parse_builtin(const std::string& text) {
  std::string_view rest = std::string_view(text).substr(kBuiltin.size());
  BuiltinWorldConfig config;
  for (bool first = true; first || !rest.empty(); first = false) {
    const size_t comma = rest.find(',');
    const std::string_view word = rest.substr(0, comma);
    rest = comma == std::string_view::npos ? std::string_view() : rest.substr(comma + 1);
    const size_t equals = word.find('=');
    if (first) {
      if (word.empty() || equals != std::string_view::npos)
        return bad_builtin(text, "no world's name");
      config.name = word;
    } else if (equals == std::string_view::npos ||
               !set_field(config, word.substr(0, equals), word.substr(equals + 1))) {
      return bad_builtin(text, fmt::format("cannot use '{}'", word));
    }
  }
  return config;
}

Result<void> check_units(const SourceOptions& options) {
  const char* option = !options.up.empty() ? "--up" : options.scale > 0 ? "--scale" : nullptr;
  if (option == nullptr) return {};
  for (const std::string& file : options.files) {
    if (!file.starts_with(kBuiltin)) return {};
  }
  std::string what = "is for model files; name one, or leave it out";
  if (!options.files.empty()) {
    what = fmt::format("is for model files; {} has metres and y up, leave it out",
                       options.files.front());
  } else if (!options.scene.empty()) {
    what = fmt::format("is for files named beside --scene; write it into {}", options.scene);
  }
  return Error{Errc::kBadConfig, fmt::format("{} {}", option, what)};
}

namespace {

// What the options name: models, then built-in worlds.
struct Models {
  SceneConfig config;
  std::vector<BuiltinWorldConfig> builtins;
};

Result<Models> list_models(const SourceOptions& options) {
  Models models;
  if (!options.scene.empty()) {
    Result<SceneConfig> loaded = load_scene_config(options.scene);
    if (!loaded) return loaded.error();
    models.config = *std::move(loaded);
  }
  for (const std::string& file : options.files) {
    if (file.starts_with(kBuiltin)) {
      Result<BuiltinWorldConfig> builtin = parse_builtin(file);
      if (!builtin) return builtin.error();
      models.builtins.push_back(*std::move(builtin));
      continue;
    }
    SceneSource source{.path = file, .up = {}, .scale = {}, .transform = {}};
    if (!options.up.empty()) source.up = options.up.front();
    if (options.scale > 0) source.scale = options.scale;
    models.config.sources.push_back(std::move(source));
  }
  if (models.config.sources.empty() && models.builtins.empty()) {
    return Error{Errc::kBadConfig, "no model given; name a file, a scene file or builtin:garage"};
  }
  if (auto ok = check_units(options); !ok) return ok.error();
  return models;
}

}  // namespace

Result<Scene> read_sources(const SourceOptions& options, Context& context,
                           SceneMaterials materials) {
  Result<Models> models = list_models(options);
  if (!models) return models.error();
  models->config.materials = materials;
  Scene scene;
  if (!models->config.sources.empty()) {
    Result<Scene> loaded = load_scene(models->config, context);
    if (!loaded) return loaded.error();
    scene = *std::move(loaded);
  }
  for (const BuiltinWorldConfig& builtin : models->builtins) {
    Result<Scene> made = create_builtin_world(builtin);
    if (!made) return made.error();
    if (scene.triangles.empty() && scene.report.triangles_read == 0) {
      scene = *std::move(made);
    } else {
      scene.append(*made);
    }
  }
  for (const std::string& warning : scene.report.warnings) note(warning);
  return scene;
}

Result<std::unique_ptr<SceneRegions>> read_regions(const SourceOptions& options,
                                                   const std::string& folder, Context& context) {
  const Result<Models> models = list_models(options);
  if (!models) return models.error();
  auto regions = load_scene_regions(models->config, models->builtins, folder, context);
  if (!regions) return regions.error();
  for (const std::string& warning : (*regions)->facts().report.warnings) note(warning);
  return regions;
}

void note_if_elsewhere(const Scene& scene, const Box3d& world) {
  const Box3d box = scene.bounds();
  if (box.empty() || world.empty()) return;
  if (share_half(box.min.x, box.max.x, world.min.x, world.max.x) &&
      share_half(box.min.y, box.max.y, world.min.y, world.max.y) &&
      share_half(box.min.z, box.max.z, world.min.z, world.max.z)) {
    return;
  }
  note(
      fmt::format("the model given by --source ({}) does not lie where the world does ({}); give "
                  "it the --scale and --up of the bake, or the files that it was baked from",
                  box_text(box), box_text(world)));
}

Json report_json(const SceneReport& report) {
  Json json = {{"triangles_read", report.triangles_read}};
  const auto add = [&](const char* name, uint64_t count) {
    if (count > 0) json[name] = count;
  };
  add("non_finite", report.non_finite);
  add("bad_index", report.bad_index);
  add("degenerate", report.degenerate);
  add("duplicate", report.duplicate);
  add("ignored", report.ignored);
  add("spikes", report.spikes);
  json["warnings"] = report.warnings;
  return json;
}

}  // namespace throng::app
