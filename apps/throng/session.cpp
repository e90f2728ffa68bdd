// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <cstdio>

#include "command.h"

namespace throng::app {

void print_result(const Session& session, const Json& object, const std::string& text) {
  if (session.json) {
    fmt::print("{}\n", object.dump());
  } else {
    fmt::print("{}", text);
  }
}

int fail(const Error& error) {
  fmt::print(stderr, "throng: {}\n", error.message);
  return error.code == Errc::kCancelled ? 130 : kBadUsage;
}

CLI::App* add_command(CLI::App& parser, Session& session, const std::string& name,
                      const std::string& summary, const std::string& example) {
  CLI::App* command = parser.add_subcommand(name, summary);
  command->add_flag("--json", session.json, "Print one JSON object on standard output");
  command->footer("Example:\n  " + example);
  return command;
}

}  // namespace throng::app
