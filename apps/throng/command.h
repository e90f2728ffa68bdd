// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>

#include "throng/context.h"
#include "throng/result.h"

/// What every command of the program shares. One file a command: it adds its options to the parser
/// and returns an exit code: 0 done, 1 the answer is no, 2 bad usage or bad input.
namespace throng::app {

enum ExitCode : int { kDone = 0, kAnswerIsNo = 1, kBadUsage = 2 };

using Json = nlohmann::ordered_json;

/// Registers one command: `add` gives it options and a callback that sets the exit code.
struct Session {
  bool json = false;       ///< --json: one object on standard output, all else on standard error.
  int exit_code = kDone;
  Context context;         ///< Draws progress on a terminal, lines elsewhere; Ctrl-C cancels.
};

/// Prints a result: the object as JSON, or `text` for people.
void print_result(const Session& session, const Json& object, const std::string& text);

/// Prints "throng: <message>" on standard error and returns kBadUsage (130 if cancelled).
int fail(const Error& error);

/// A subcommand with --json and an example that `--help` shows and that works as printed.
CLI::App* add_command(CLI::App& parser, Session& session, const std::string& name,
                      const std::string& summary, const std::string& example);

void add_bake(CLI::App& parser, Session& session);
void add_info(CLI::App& parser, Session& session);
void add_picture(CLI::App& parser, Session& session);
void add_run(CLI::App& parser, Session& session);
void add_slices(CLI::App& parser, Session& session);
void add_verify(CLI::App& parser, Session& session);
void add_world(CLI::App& parser, Session& session);
void add_bench(CLI::App& parser, Session& session);

}  // namespace throng::app
