// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "throng/avatar.h"
#include "throng/base.h"
#include "throng/path.h"
#include "throng/surface.h"
#include "throng/world.h"

/// Shared by all commands of the program. One file per command: it adds its options to the parser
/// and a callback that sets the exit code.
namespace throng::app {

enum ExitCode : int { kDone = 0, kAnswerIsNo = 1, kBadUsage = 2, kInterrupted = 130 };

using Json = nlohmann::ordered_json;

/// An option for a folder of pictures, and how their names begin.
struct ImageFolder {
  const CLI::Option* option = nullptr;
  std::string prefix;
};

/// The state of one run of the program. There is one; commands get a reference to it.
struct Session {
  bool json = false;  ///< --json: one object on standard output, all else on standard error.
  int exit_code = kDone;
  std::vector<std::string> words;           ///< The command line, as typed.
  std::vector<const CLI::Option*> outputs;  ///< Those of add_output.
  std::vector<ImageFolder> folders;         ///< Those of add_image_folder.
  Context context;  ///< Draws progress on a terminal, lines elsewhere; Ctrl-C cancels.
};

/// The program: registers all commands, parses, runs one. Returns the exit code.
int run_program(int argc, const char* const* argv,
                const std::function<void(CLI::App&, Session&)>& add);

/// Shows progress of work that a command does itself; library calls use session.context.
void show_progress(Session& session, std::string_view stage, uint64_t done, uint64_t total);

/// Prints a result: the object as JSON, or `text` for people.
void print_result(const Session& session, const Json& object, const std::string& text);

/// Prints "throng: <message>" on standard error and returns kBadUsage (130 if cancelled).
int fail(const Error& error);

/// Prints "throng: note: <sentence>" on standard error.
void note(const std::string& sentence);
/// What the program says if a signal ends it from now on, at once and wherever it is; empty: the
/// first signal asks it to stop. Of several ranks the first two speak.
void last_words(const std::string& sentence);

/// A subcommand with --json and an example that `--help` shows and that works as printed: one
/// command per line, run in order in an empty folder by scripts/tests/test_examples.
CLI::App* add_command(CLI::App& parser, Session& session, const std::string& name,
                      const std::string& summary, const std::string& example);

/// An option for a file to write. It is refused if it is a folder, a device, a file of a world, or
/// one that another option of the command reads or writes.
CLI::Option* add_output(CLI::App& command, Session& session, const std::string& names,
                        std::string& path, const std::string& text);

/// An option for a folder to write pictures PREFIX*.png into. It is refused if it is a file or lies
/// in a world, or if another option of the command names one of its pictures.
CLI::Option* add_image_folder(CLI::App& command, Session& session, const std::string& names,
                              std::string& path, const std::string& prefix,
                              const std::string& text);

/// The option --model.
void add_model(CLI::App& command, SteeringModel& model);
/// A flag that chooses how paths are found faster.
CLI::Option* add_speedup(CLI::App& command, const std::string& flag, PathSpeedup chosen,
                         PathSpeedup& speedup, const std::string& text);
/// --threads, 0 for all cores, with its limit.
CLI::Option* add_threads(CLI::App& command, int32_t& threads,
                         const std::string& text = "Threads, 0 for all cores");
/// --part: two corners of a district as seen from above, for box_of_part. [m]
void add_part(CLI::App& command, std::vector<double>& part, const std::string& text);
[[nodiscard]] Box3d box_of_part(const std::vector<double>& part);
/// --search-memory, in MiB.
void add_search_memory(CLI::App& command, uint64_t& bytes);

/// Index of the class that an option names. Fails with kNotFound and the names to choose from.
Result<int32_t> class_named(const World& world, const std::string& name,
                            const char* option = "--class");

/// A line for results of level tiles alone, if the class also climbs or drops; else nothing.
std::string note_of_nodes(const AvatarClass& avatar);

/// "nothing", "too low", ...
const char* word_for(Blocker blocker);
/// "walk", "climb", "off-mesh link", ...
const char* word_for(LinkKind kind);

/// A position as JSON and for people, in millimetres.
Json numbers(const Vec3d& p);
std::string where(const Vec3d& p);

/// Peak memory of this process. [bytes]
uint64_t peak_memory();

/// "1 zone", "2 zones".
std::string counted(uint64_t count, const std::string& noun);

/// "1.2 MB", "35 kB".
std::string human_bytes(uint64_t bytes);

void add_atlas(CLI::App& parser, Session& session);
void add_bake(CLI::App& parser, Session& session);
void add_caacd(CLI::App& parser, Session& session);
void add_components(CLI::App& parser, Session& session);
void add_export(CLI::App& parser, Session& session);
void add_film(CLI::App& parser, Session& session);
void add_generate(CLI::App& parser, Session& session);
void add_info(CLI::App& parser, Session& session);
void add_join(CLI::App& parser, Session& session);
void add_path(CLI::App& parser, Session& session);
void add_picture(CLI::App& parser, Session& session);
void add_query(CLI::App& parser, Session& session);
void add_replay(CLI::App& parser, Session& session);
void add_report(CLI::App& parser, Session& session);
void add_run(CLI::App& parser, Session& session);
void add_slices(CLI::App& parser, Session& session);
void add_surface(CLI::App& parser, Session& session);
void add_validate(CLI::App& parser, Session& session);
void add_verify(CLI::App& parser, Session& session);
void add_view(CLI::App& parser, Session& session);
void add_bench(CLI::App& parser, Session& session);

}  // namespace throng::app
