// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "run/memory_bound.h"

#include <fmt/format.h>

#include "command.h"
#include "number_checks.h"

// --memory: bounds what a command takes, or ends it.
namespace throng::app {

Result<void> MemoryBound::check(const std::string& when, const std::string& remedy) const {
  if (bytes == 0) return {};
  const uint64_t peak = peak_memory();
  if (peak <= bytes) return {};
  return Error{Errc::kBadConfig, fmt::format("--memory: {} MiB are not enough, {} MiB were needed "
                                             "when {}; {}",
                                             bytes >> 20, (peak >> 20) + 1, when, remedy)};
}

void add_memory(CLI::App& command, MemoryBound& bound, const std::string& text) {
  command
      .add_option_function<uint32_t>(
          "--memory", [&bound](uint32_t mebibytes) { bound.bytes = uint64_t{mebibytes} << 20; },
          text)
      ->check(between(40, 1 << 20))
      ->type_name("MIB");
}

}  // namespace throng::app
