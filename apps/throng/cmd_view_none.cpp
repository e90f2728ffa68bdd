// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "command.h"

// throng view where the viewer was left out when the program was built.
namespace throng::app {

void add_view(CLI::App& parser, Session& session) {
  CLI::App* command = add_command(parser, session, "view",
                                  "Show a world in a window (not in this build)", "throng --help");
  command->allow_extras();
  command->callback([&session] {
    session.exit_code =
        fail({Errc::kNotFound,
              "view: this program was built without the viewer; install libimgui-dev "
              "and libglfw3-dev and build it again"});
  });
}

}  // namespace throng::app
