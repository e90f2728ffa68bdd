// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "command.h"

// throng view and throng film where the viewer was left out when the program was built.
namespace throng::app {
namespace {

void add_missing(CLI::App& parser, Session& session, const std::string& name) {
  CLI::App* command =
      add_command(parser, session, name, "Not in this build: it has no viewer", "throng --help");
  command->allow_extras();
  command->callback([&session, name] {
    session.exit_code =
        fail({Errc::kNotFound, name + ": this program was built without the viewer; install "
                                      "libimgui-dev and libglfw3-dev and build it again"});
  });
}

}  // namespace

void add_view(CLI::App& parser, Session& session) { add_missing(parser, session, "view"); }

void add_film(CLI::App& parser, Session& session) { add_missing(parser, session, "film"); }

}  // namespace throng::app
