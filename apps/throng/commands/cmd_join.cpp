// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "command.h"
#include "throng/bake.h"

// throng join: makes one world of worlds of parts of one scene.
namespace throng::app {
namespace {

struct JoinOptions {
  std::vector<std::string> worlds;
  std::string output;
  int32_t threads = 0;
};

int join(Session& session, const JoinOptions& options) {
  bool had_nodes = false;
  for (const std::string& world : options.worlds) {
    std::error_code ignored;
    had_nodes = had_nodes || std::filesystem::exists(world + "/nodes", ignored);
  }
  const Result<BakeReport> report =
      join_worlds(options.worlds, options.output, options.threads, session.context);
  if (!report) return fail(report.error());
  if (had_nodes) note("nodes are not joined; make them with throng bake --nodes");
  Json json = {{"world", options.output},
               {"worlds", options.worlds},
               {"zones", report->zones},
               {"zones_relinked", report->zones_relinked},
               {"air_zones", report->air_zones},
               {"bytes", report->bytes},
               {"seconds_total", report->seconds_total}};
  print_result(
      session, json,
      fmt::format("{}: {} of {}, {} linked again, {} in {:.2f} s\n", options.output,
                  counted(report->zones, "zone"), counted(options.worlds.size(), "world"),
                  report->zones_relinked, human_bytes(report->bytes), report->seconds_total));
  return kDone;
}

}  // namespace

void add_join(CLI::App& parser, Session& session) {
  CLI::App* command = add_command(
      parser, session, "join", "Make one world of worlds that were baked of parts of one scene",
      "throng bake builtin:city,size=300 --cell 0.5 --part 0,0,150,300 -o west.throng\n"
      "throng bake builtin:city,size=300 --cell 0.5 --part 150,0,300,300 -o east.throng\n"
      "throng join west.throng east.throng -o city.throng");
  const auto options = std::make_shared<JoinOptions>();
  command->add_option("worlds", options->worlds, "World folders")
      ->required()
      ->type_name("WORLD.throng");
  command->add_option("-o,--output", options->output, "World folder to write")
      ->required()
      ->type_name("WORLD.throng");
  add_threads(*command, options->threads);
  command->callback([&session, options] { session.exit_code = join(session, *options); });
}

}  // namespace throng::app
