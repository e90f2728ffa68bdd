// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <mutex>
#include <new>
#include <string>
#include <thread>
#include <vector>

#include "bad_usage.h"
#include "command.h"
#include "number_checks.h"
#include "old_names.h"
#include "option_values.h"
#include "output_checks.h"
#include "throng/bake.h"
#include "throng/path.h"

// What all commands share: parsing, progress, Ctrl-C, results, errors and notes.
namespace throng::app {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

// A signal handler can reach nothing but globals; these are the program's only ones.
std::atomic<std::atomic<bool>*> g_cancel = nullptr;
std::atomic<const char*> g_last_words = nullptr;

// The first Ctrl-C asks the work to stop and clean up; the second does not wait for it.
extern "C" void on_interrupt(int) {
  if (const char* const words = g_last_words.load(); words != nullptr) {
    [[maybe_unused]] const ssize_t written = write(STDERR_FILENO, words, std::strlen(words));
    _exit(kInterrupted);
  }
  std::atomic<bool>* const cancel = g_cancel.load();
  if (cancel == nullptr || cancel->exchange(true)) _exit(kInterrupted);
}

// Draws the progress: on a terminal one line that redraws itself; elsewhere a line at each tenth
// (at most one a second), and one after five seconds without any.
class ProgressLine {
 public:
  void show(const Progress& progress) {
    const std::lock_guard lock(mutex_);
    if (progress.stage != stage_) begin(progress.stage);
    const double percent =
        progress.total > 0 ? 100.0 * static_cast<double>(std::min(progress.done, progress.total)) /
                                 static_cast<double>(progress.total)
                           : 0;
    const double quiet = seconds_since(last_);
    if (terminal_) {
      if (drawn_ && quiet < 0.1 && progress.done != progress.total) return;
      draw(progress, percent);
    } else {
      const int tenth = static_cast<int>(percent / 10);
      if (!(quiet >= 5 || (quiet >= 1 && tenth > tenth_))) return;
      tenth_ = tenth;
      fmt::print(stderr, "{}: {}\n", stage_, describe(progress, percent));
    }
    last_ = Clock::now();
  }

  void clear() {
    const std::lock_guard lock(mutex_);
    if (drawn_) fmt::print(stderr, "\r\x1b[K");
    drawn_ = false;
  }

 private:
  void begin(std::string_view stage) {
    stage_ = stage;
    start_ = last_ = Clock::now();
    tenth_ = 0;
  }

  [[nodiscard]] std::string describe(const Progress& progress, double percent) const {
    if (progress.total == 0)
      return fmt::format("{}, {:.0f} s", progress.done, seconds_since(start_));
    return fmt::format("{:.0f} %, {:.0f} s", percent, seconds_since(start_));
  }

  void draw(const Progress& progress, double percent) {
    constexpr size_t kWidth = 30;
    const auto filled = static_cast<size_t>(percent / 100 * kWidth);
    const std::string bar = std::string(filled, '#') + std::string(kWidth - filled, '.');
    fmt::print(stderr, "\r\x1b[K{:<10} [{}] {}", stage_, bar, describe(progress, percent));
    std::fflush(stderr);
    drawn_ = true;
  }

  const bool terminal_ = isatty(STDERR_FILENO) != 0;
  std::mutex mutex_;
  std::string stage_;
  Clock::time_point start_ = Clock::now();
  Clock::time_point last_ = Clock::now();
  int tenth_ = 0;
  bool drawn_ = false;
};

ProgressLine& progress_line() {
  static ProgressLine line;
  return line;
}

std::string name_in_use(const CLI::App& parser) {
  const CLI::App* command = command_in_use(parser);
  return command == nullptr ? "throng" : "throng " + command->get_name();
}

}  // namespace

int run_program(int argc, const char* const* argv,
                const std::function<void(CLI::App&, Session&)>& add) {
  CLI::App parser{"throng fills any 3D world with moving people", "throng"};
  parser.require_subcommand(1);
  parser.set_version_flag("--version", "throng " THRONG_VERSION);
  Session session;
  if (rank_info().rank == 0) {
    session.context.on_progress = [](const Progress& progress) { progress_line().show(progress); };
  }
  add(parser, session);
  for (CLI::App* command : parser.get_subcommands({})) read_base_10(*command);

  g_cancel = &session.context.cancel;
  std::signal(SIGINT, on_interrupt);
  std::signal(SIGTERM, on_interrupt);
  try {
    session.words = with_new_names(argc, argv);
    std::vector<const char*> words;
    for (const std::string& argument : session.words) words.push_back(argument.c_str());
    parser.parse(static_cast<int>(words.size()), words.data());
  } catch (const CLI::Success& success) {  // --help and --version
    session.exit_code = parser.exit(success);
  } catch (const CLI::ParseError& error) {
    session.exit_code =
        fail({Errc::kBadConfig,
              fmt::format("{}; see {} --help", what_is_wrong(error, parser, session.words),
                          name_in_use(parser))});
  } catch (const std::bad_alloc&) {
    session.exit_code = fail(
        {Errc::kLimit, fmt::format("{}: out of memory; use larger cells, a smaller world or fewer "
                                   "avatars",
                                   name_in_use(parser))});
  }
  progress_line().clear();
  g_cancel = nullptr;
  return session.exit_code;
}

void last_words(const std::string& sentence) {
  // The one that a signal may just be writing, and the next. They outlive what ends at exit, where
  // ranks wait for each other once more.
  static auto* const kept = new std::string[2];
  static int next = 0;
  if (sentence.empty() || rank_info().rank > 1) {  // As fail() does.
    g_last_words = sentence.empty() ? nullptr : "";
    return;
  }
  kept[next] = "throng: " + sentence + "\n";
  g_last_words = kept[next].c_str();
  next = 1 - next;
}

void show_progress(Session& session, std::string_view stage, uint64_t done, uint64_t total) {
  if (session.context.on_progress) session.context.on_progress({stage, done, total});
}

void print_result(const Session& session, const Json& object, const std::string& text) {
  progress_line().clear();
  if (session.json) {
    fmt::print("{}\n", object.dump());
  } else {
    fmt::print("{}", text);
  }
}

int fail(const Error& error) {
  progress_line().clear();
  // One of several processes: rank 0 speaks for all. If it is the one that died, rank 1 does.
  const int32_t rank = rank_info().rank;
  const bool silent = rank > 1 || (rank == 1 && error.code != Errc::kCancelled);
  if (!silent && !error.message.empty()) fmt::print(stderr, "throng: {}\n", error.message);
  return error.code == Errc::kCancelled ? kInterrupted : kBadUsage;
}

void note(const std::string& sentence) {
  if (rank_info().rank > 0) return;
  progress_line().clear();
  fmt::print(stderr, "throng: note: {}\n", sentence);
}

CLI::App* add_command(CLI::App& parser, Session& session, const std::string& name,
                      const std::string& summary, const std::string& example) {
  CLI::App* command = parser.add_subcommand(name, summary);
  command->add_flag("--json", session.json, "Print one JSON object on standard output");
  std::string indented = "Example:\n  ";
  for (const char c : example) indented += c == '\n' ? std::string("\n  ") : std::string(1, c);
  command->footer(indented);
  command->parse_complete_callback([command, &session] {
    check_values(*command, session.words);
    check_outputs(*command, session.outputs);
    check_image_folders(*command, session.folders, session.outputs);
  });
  return command;
}

CLI::Option* add_speedup(CLI::App& command, const std::string& flag, PathSpeedup chosen,
                         PathSpeedup& speedup, const std::string& text) {
  return command.add_flag_callback(
      flag, [chosen, &speedup] { speedup = chosen; }, text);
}

CLI::Option* add_threads(CLI::App& command, int32_t& threads, const std::string& text) {
  // TBB has 256 threads on machines of up to 64 cores, and prints a warning of its own above that.
  constexpr uint32_t kMaxThreads = 256;
  return command.add_option("--threads", threads, text)
      ->check(between(0, std::max(kMaxThreads, std::thread::hardware_concurrency())));
}

void add_part(CLI::App& command, std::vector<double>& part, const std::string& text) {
  command.add_option("--part", part, text)->delimiter(',')->expected(4)->type_name("X,Z,X,Z");
}

Box3d box_of_part(const std::vector<double>& part) {
  Box3d box;
  box.add({part[0], 0, part[1]});
  box.add({part[2], 0, part[3]});
  return box;
}

void add_search_memory(CLI::App& command, uint64_t& bytes) {
  command
      .add_option_function<double>(
          "--search-memory",
          [&bytes](double mebibytes) { bytes = static_cast<uint64_t>(mebibytes * (1 << 20)); },
          fmt::format("Max memory of the search for one path, {} unless given [MiB]",
                      SearchBudget::kDefaultBytes >> 20))
      ->check(between(1, 1 << 20))
      ->type_name("MIB");
}

CLI::Option* add_output(CLI::App& command, Session& session, const std::string& names,
                        std::string& path, const std::string& text) {
  CLI::Option* output = command.add_option(names, path, text);
  session.outputs.push_back(output);
  return output;
}

CLI::Option* add_image_folder(CLI::App& command, Session& session, const std::string& names,
                              std::string& path, const std::string& prefix,
                              const std::string& text) {
  CLI::Option* folder = command.add_option(names, path, text)->type_name("FOLDER");
  session.folders.push_back({folder, prefix});
  return folder;
}

void add_model(CLI::App& command, SteeringModel& model) {
  command
      .add_option_function<std::string>(
          "--model",
          [&model](const std::string& name) {
            const auto found = find_steering_model(name);
            if (!found) {
              throw CLI::ValidationError("--model",
                                         std::string("must be ") + steering_model_names());
            }
            model = *found;
          },
          "Steering model of avatars on foot: sampled (ours), caacd or social-force")
      ->type_name("MODEL");
}

Result<int32_t> class_named(const World& world, const std::string& name, const char* option) {
  if (const auto index = world.find_class(name)) return *index;
  std::string known;
  for (const AvatarClass& avatar : world.summary().classes)
    known += (known.empty() ? "" : ", ") + avatar.name;
  return Error{Errc::kNotFound, fmt::format("{} {}: the world has no such class; choose from {}",
                                            option, name, known)};
}

std::string note_of_nodes(const AvatarClass& avatar) {
  if (!goes_over_nodes(avatar)) return {};
  return fmt::format(
      "  on level tiles alone, where it stands upright; for what {} climbs or drops to, use "
      "`throng surface` and `throng path`\n",
      avatar.name);
}

uint64_t peak_memory() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<uint64_t>(usage.ru_maxrss) * 1024;  // Linux counts in kB.
}

std::string counted(uint64_t count, const std::string& noun) {
  return fmt::format("{} {}{}", count, noun, count == 1 ? "" : "s");
}

std::string human_bytes(uint64_t bytes) {
  const auto value = static_cast<double>(bytes);
  if (bytes < 1000) return fmt::format("{} B", bytes);
  if (value < 1e6) return fmt::format("{:.1f} kB", value / 1e3);
  if (value < 1e9) return fmt::format("{:.1f} MB", value / 1e6);
  return fmt::format("{:.2f} GB", value / 1e9);
}

const char* word_for(Blocker blocker) {
  switch (blocker) {
    case Blocker::kNone:
      return "nothing";
    case Blocker::kGap:
      return "a gap";
    case Blocker::kStep:
      return "too high a step";
    case Blocker::kLow:
      return "too low";
    case Blocker::kSteep:
      return "too steep";
    case Blocker::kNarrow:
      return "a wall, or too narrow";
    case Blocker::kObstacle:
      return "an obstacle";
    case Blocker::kClosed:
      return "an area of infinite cost";
  }
  return "";
}

const char* word_for(LinkKind kind) {
  switch (kind) {
    case LinkKind::kWalk:
      return "walk";
    case LinkKind::kStep:
      return "step";
    case LinkKind::kClimb:
      return "climb";
    case LinkKind::kDrop:
      return "drop";
    case LinkKind::kOffMesh:
      return "off-mesh link";
  }
  return "";
}

Json numbers(const Vec3d& p) { return {p.x, p.y, p.z}; }

std::string where(const Vec3d& p) {
  // Far beyond any world, digits after the point are noise.
  const auto metres = [](double v) {
    return std::fabs(v) < 1e9 ? fmt::format("{:.3f}", v) : fmt::format("{:g}", v);
  };
  return fmt::format("{}, {}, {}", metres(p.x), metres(p.y), metres(p.z));
}

}  // namespace throng::app
