// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <cstdio>
#include <exception>

#include "command.h"

int main(int argc, char** argv) {
  using namespace throng::app;
  CLI::App parser{"throng fills any 3D world with moving people", "throng"};
  parser.require_subcommand(1);
  Session session;
  // One line a command, in the order of --help.

  try {
    parser.parse(argc, argv);
  } catch (const CLI::CallForHelp& help) {
    return parser.exit(help);
  } catch (const CLI::ParseError& error) {
    parser.exit(error);
    return kBadUsage;
  }
  return session.exit_code;
}
