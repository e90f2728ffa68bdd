// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "old_names.h"

#include <fmt/format.h>

#include <string_view>

#include "command.h"

// Old names of commands and options, one table each. Remove an entry after the next version.
namespace throng::app {
namespace {

struct OldCommand {
  std::string_view before, now;
};

constexpr OldCommand kCommands[] = {
    {"nodes", "surface"}, {"place", "query"}, {"region", "components"}, {"world", "generate"}};

struct OldOption {
  std::string_view command;  // by its name of today
  std::string_view before, now;
};

constexpr OldOption kOptions[] = {{"bake", "--fresh", "--rebuild"},
                                  {"bake", "--jumps", "--off-mesh-links"},
                                  {"path", "--jump", "--off-mesh-link"},
                                  {"path", "--reach", "--tolerance"},
                                  {"run", "--visits", "--trips"}};

// Replaces the first `before.size()` characters of an argument.
void rename(std::string& argument, std::string_view before, std::string_view now) {
  note(fmt::format("'{}' is now '{}'", before, now));
  argument.replace(0, before.size(), now);
}

}  // namespace

std::vector<std::string> with_new_names(int argc, const char* const* argv) {
  std::vector<std::string> arguments(argv, argv + argc);
  if (argc < 2) return arguments;
  std::string& command = arguments[1];
  for (const OldCommand& old : kCommands) {
    if (command != old.before) continue;
    rename(command, old.before, old.now);
    break;
  }
  for (size_t i = 2; i < arguments.size() && arguments[i] != "--"; ++i) {
    // --NAME VALUE or --NAME=VALUE
    const std::string name = arguments[i].substr(0, arguments[i].find('='));
    for (const OldOption& old : kOptions) {
      if (old.command != command || old.before != name) continue;
      rename(arguments[i], old.before, old.now);
      break;
    }
  }
  return arguments;
}

}  // namespace throng::app
