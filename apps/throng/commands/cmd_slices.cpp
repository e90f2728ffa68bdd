// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <chrono>
#include <memory>
#include <string>
#include <vector>

#include "command.h"
#include "input_file.h"
#include "report/image_folder.h"
#include "sources.h"
#include "throng/papers.h"
#include "throng/picture.h"

// throng slices: height slices of a model as in [ML06], to save, open, look at, and walk on.
namespace throng::app {
namespace {

constexpr const char* kSliceImages = "slice_";

struct SlicesOptions {
  SourceOptions sources;
  std::string images;
  std::string output;
  SliceConfig config;
};

// Lists the slices; `json` and `line` say how they came about.
int print_slices(Session& session, const SlicesOptions& options, const DepthSlices& set, Json json,
                 const std::string& line) {
  if (!options.images.empty()) {
    const auto draw = [&](size_t i) { return draw_slice(set, i); };
    if (auto done = write_images(options.images, kSliceImages, set.slices.size(), draw); !done) {
      return fail(done.error());
    }
  }
  if (!options.output.empty()) {
    if (auto done = save_slices(set, options.output); !done) return fail(done.error());
  }
  Json heights = Json::array();
  std::string listed;
  for (const DepthSlice& slice : set.slices) {
    heights.push_back(slice.height / 1000.0);
    listed += fmt::format(" {:.3f}", slice.height / 1000.0);
  }
  json.update({{"avatar_height", set.avatar_height / 1000.0},
               {"resolution", set.resolution / 1000.0},
               {"cell", set.cell},
               {"width", set.width},
               {"depth", set.depth},
               {"taken", set.taken},
               {"kept", set.slices.size() - static_cast<size_t>(set.extra)},
               {"extra", set.extra},
               {"heights", heights},
               {"bytes", set.bytes()},
               {"peak_bytes", peak_memory()}});
  print_result(session, json,
               fmt::format("{} slices taken, {} kept{}, {} in {} x {} cells{}\ncut at{} m\n",
                           set.taken, set.slices.size() - static_cast<size_t>(set.extra),
                           set.extra > 0 ? fmt::format(" and {} more for their depth", set.extra)
                                         : std::string(),
                           human_bytes(set.bytes()), set.width, set.depth, line, listed));
  return kDone;
}

// Opens what -o wrote.
int open_slices(Session& session, const CLI::App& command, const SlicesOptions& options) {
  const std::string& file = options.sources.files.front();
  for (const char* name : {"--avatar-height", "--resolution", "--cell", "--up", "--scale",
                           "--scene", "--threads", "--output"}) {
    if (command.count(name) == 0) continue;
    return fail({Errc::kBadConfig,
                 fmt::format("{}: {} is for models; these slices are already cut", file, name)});
  }
  if (auto ok = check_file(file, kNoSlices); !ok) return fail(ok.error());
  const Result<DepthSlices> set = load_slices(file);
  if (!set) return fail(set.error());
  return print_slices(session, options, *set, {{"file", file}}, "");
}

int slices(Session& session, const CLI::App& command, const SlicesOptions& options) {
  const std::vector<std::string>& files = options.sources.files;
  if (files.size() == 1 && names_slices(files.front())) {
    return open_slices(session, command, options);
  }
  const Result<Scene> scene = read_sources(options.sources, session.context);
  if (!scene) return fail(scene.error());
  const auto start = std::chrono::steady_clock::now();
  const Result<SliceSet> set = slice_scene(*scene, options.config, session.context);
  if (!set) return fail(set.error());
  const double seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  const Json json = {{"triangles", scene->triangles.size()},
                     {"import", report_json(scene->report)},
                     {"seconds", seconds}};
  const Result<DepthSlices> stored = store_depths(*set);
  if (!stored) return fail(stored.error());
  return print_slices(session, options, *stored, json, fmt::format(", {:.3f} s", seconds));
}

}  // namespace

void add_slices(CLI::App& parser, Session& session) {
  CLI::App* command = add_command(parser, session, "slices", "Cut models into height slices",
                                  "throng slices builtin:garage -o garage.slices --images slices\n"
                                  "throng run garage.slices --wander --steps 50");
  const auto options = std::make_shared<SlicesOptions>();
  add_source_options(command, options->sources);
  SliceConfig& config = options->config;
  command
      ->add_option("--avatar-height", config.avatar_height,
                   "Height of the smallest avatar, 1.1 for children [m]")
      ->capture_default_str();
  command->add_option("--resolution", config.resolution, "Headroom that may be lost [m]")
      ->capture_default_str();
  command->add_option("--cell", config.cell, "Side of a cell [m]")->capture_default_str();
  add_image_folder(*command, session, "--images", options->images, kSliceImages,
                   "Folder for a picture of each kept slice; replaces those of before");
  add_output(*command, session, "-o,--output", options->output, "File of slices to write")
      ->type_name("FILE.slices");
  add_threads(*command, config.workers);
  command->callback(
      [&session, options, command] { session.exit_code = slices(session, *command, *options); });
}

}  // namespace throng::app
