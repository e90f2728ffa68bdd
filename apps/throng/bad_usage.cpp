// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "bad_usage.h"

#include <fmt/format.h>

#include <algorithm>

#include "option_values.h"

// Words the faults of a command line in one sentence each, in place of the messages of CLI11.
//
// CLI11 counts values ("6 required X,Y,Z,X,Y,Z missing") and prints them as it split them
// ("7,abc" for 7=abc). These messages name the type of the value, as --help does.
namespace throng::app {
namespace {

// CLI11 ends some messages with a full stop or a line of help: one sentence is enough.
std::string one_sentence(const std::string& message) {
  const std::string line = message.substr(0, message.find('\n'));
  const size_t end = line.find_last_not_of(" .");
  return end == std::string::npos ? "bad usage" : line.substr(0, end + 1);
}

const CLI::Option* option_named(const std::string& name, const CLI::App& parser) {
  const CLI::App* command = command_in_use(parser);
  if (command == nullptr) return nullptr;
  for (const CLI::Option* option : command->get_options()) {
    if (option->get_name() == name) return option;
  }
  return nullptr;
}

std::string kind_of(const CLI::Option& option) {
  std::string name = option.get_type_name();
  name = name.substr(0, name.find(':'));  // Its limits come after that.
  if (name == "FLOAT") return "a number";
  if (name == "INT") return "a whole number";
  if (name == "UINT") return "a whole number, 0 or more";
  return name == "TEXT" ? "one value" : name;
}

std::string given(const CLI::Option& option, const std::vector<std::string>& words) {
  const std::string typed = typed_values(option, words);
  if (!typed.empty()) return typed;
  const char between = option.get_delimiter() != '\0' ? option.get_delimiter() : ' ';
  const std::string parsed = CLI::detail::join(option.results(), std::string(1, between));
  return parsed.empty() ? "nothing" : parsed;
}

std::string about(const CLI::ParseError& error, const CLI::Option& option,
                  const std::vector<std::string>& words) {
  if (dynamic_cast<const CLI::ConversionError*>(&error) != nullptr) {
    return fmt::format("{}: wants {}, not {}", option.get_name(), kind_of(option),
                       given(option, words));
  }
  const bool too_many =
      option.results().size() > static_cast<size_t>(option.get_items_expected_max());
  return fmt::format("{}: wants {}{}, and got {}", option.get_name(), kind_of(option),
                     too_many ? ", once" : "", given(option, words));
}

// Words that the command has no use for. CLI11 lists them all, the last one first.
std::string about_extra(const CLI::App& parser) {
  const CLI::App* command = command_in_use(parser);
  const std::vector<std::string> extra = parser.remaining(true);
  if (extra.empty()) return "bad usage";
  const std::string name = command == nullptr ? "throng" : "throng " + command->get_name();
  return extra.front().starts_with('-')
             ? fmt::format("{}: {} has no such option", extra.front(), name)
             : fmt::format("{}: {} takes fewer words", extra.front(), name);
}

}  // namespace

const CLI::App* command_in_use(const CLI::App& parser) {
  const auto commands = parser.get_subcommands();
  return commands.empty() ? nullptr : commands.front();
}

std::string what_is_wrong(const CLI::ParseError& error, const CLI::App& parser,
                          const std::vector<std::string>& words) {
  if (dynamic_cast<const CLI::ExtrasError*>(&error) != nullptr) return about_extra(parser);
  const std::string message = one_sentence(error.what());
  std::string name;
  const std::string could_not = "Could not convert: ";
  if (message.starts_with(could_not)) {
    name = message.substr(could_not.size(), message.find(" = ") - could_not.size());
  } else if (dynamic_cast<const CLI::ArgumentMismatch*>(&error) != nullptr) {
    name = message.substr(0, message.find(':'));
  }
  const CLI::Option* option = name.empty() ? nullptr : option_named(name, parser);
  return option != nullptr ? about(error, *option, words) : message;
}

}  // namespace throng::app
