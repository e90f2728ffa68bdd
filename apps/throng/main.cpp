// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "command.h"

// The program throng: registers all commands and runs one.
int main(int argc, char** argv) {
  using namespace throng::app;
  return run_program(argc, argv, [](CLI::App& parser, Session& session) {
    // One line a command, in the order of --help.
    add_atlas(parser, session);
    add_bake(parser, session);
    add_caacd(parser, session);
    add_components(parser, session);
    add_export(parser, session);
    add_film(parser, session);
    add_generate(parser, session);
    add_info(parser, session);
    add_join(parser, session);
    add_path(parser, session);
    add_picture(parser, session);
    add_query(parser, session);
    add_replay(parser, session);
    add_report(parser, session);
    add_run(parser, session);
    add_slices(parser, session);
    add_surface(parser, session);
    add_validate(parser, session);
    add_verify(parser, session);
    add_view(parser, session);
    add_bench(parser, session);
  });
}
