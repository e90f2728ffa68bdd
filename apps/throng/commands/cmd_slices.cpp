// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <memory>

#include "command.h"
#include "sources.h"
#include "throng/papers.h"
#include "throng/picture.h"

// throng slices: height slices of a model as in [ML06], for comparison.
namespace throng::app {
namespace {

struct SlicesOptions {
  SourceOptions sources;
  std::string images;
  SliceConfig config;
};

// Bytes of the kept slices as [ML06] section 3.3 stores them: depths below the slice's height, 16
// bits a cell where the deepest is at most 65.534 m (65535 mm stands for an empty cell), else 32.
uint64_t stored_bytes(const SliceSet& set) {
  constexpr int32_t kMaxDepth = 65534;
  uint64_t bytes = 0;
  for (const Slice& slice : set.kept) {
    const bool fits = std::all_of(slice.surface.begin(), slice.surface.end(), [&](int32_t value) {
      return value == set.far_plane || slice.height - value <= kMaxDepth;
    });
    bytes += slice.surface.size() * (fits ? 2 : 4);
  }
  return bytes;
}

Result<void> write_images(const SliceSet& set, const std::string& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) {
    return Error{Errc::kIo,
                 fmt::format("{}: cannot make this folder: {}; give --images another one", folder,
                             error.message())};
  }
  for (size_t i = 0; i < set.kept.size(); ++i) {
    const std::string name = fmt::format("slice_{:03}.png", i);
    if (auto done = write_png(draw_slice(set, i), folder + "/" + name); !done) return done.error();
  }
  return {};
}

int slices(Session& session, const SlicesOptions& options) {
  const Result<Scene> scene = read_sources(options.sources, session.context);
  if (!scene) return fail(scene.error());
  const auto start = std::chrono::steady_clock::now();
  const Result<SliceSet> set = slice_scene(*scene, options.config, session.context);
  if (!set) return fail(set.error());
  const double seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  if (!options.images.empty()) {
    if (auto done = write_images(*set, options.images); !done) return fail(done.error());
  }

  Json heights = Json::array();
  std::string listed;
  for (const Slice& slice : set->kept) {
    heights.push_back(slice.height / 1000.0);
    listed += fmt::format(" {:.3f}", slice.height / 1000.0);
  }
  const Json json = {{"triangles", scene->triangles.size()},
                     {"import", report_json(scene->report)},
                     {"avatar_height", options.config.avatar_height},
                     {"resolution", options.config.resolution},
                     {"cell", options.config.cell},
                     {"width", set->width},
                     {"depth", set->depth},
                     {"taken", set->taken},
                     {"kept", set->kept.size()},
                     {"heights", heights},
                     {"bytes", stored_bytes(*set)},
                     {"seconds", seconds},
                     {"peak_bytes", peak_memory()}};
  print_result(session, json,
               fmt::format("{} slices taken, {} kept, {} in {} x {} cells, {:.3f} s\nkept at{} m\n",
                           set->taken, set->kept.size(), human_bytes(stored_bytes(*set)),
                           set->width, set->depth, seconds, listed));
  return kDone;
}

}  // namespace

void add_slices(CLI::App& parser, Session& session) {
  CLI::App* command = add_command(parser, session, "slices", "Cut models into height slices",
                                  "throng slices builtin:garage --images slices");
  const auto options = std::make_shared<SlicesOptions>();
  add_source_options(command, options->sources);
  SliceConfig& config = options->config;
  command->add_option("--avatar-height", config.avatar_height, "Height of the smallest avatar [m]")
      ->capture_default_str();
  command->add_option("--resolution", config.resolution, "Headroom that may be lost [m]")
      ->capture_default_str();
  command->add_option("--cell", config.cell, "Side of a cell [m]")->capture_default_str();
  command->add_option("--images", options->images, "Folder for a picture of each kept slice")
      ->type_name("DIR");
  add_threads(*command, config.workers);
  command->callback([&session, options] { session.exit_code = slices(session, *options); });
}

}  // namespace throng::app
