// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "run/caacd_options.h"

#include <fmt/format.h>

#include <array>
#include <charconv>

// Reads them; nothing is guessed.
namespace throng::app {

// "2.0/0.4/0.06"
Result<caacd::ParameterSet> parse_set(const std::string& text) {
  std::array<double, 3> values{};
  const char* at = text.data();
  const char* const end = text.data() + text.size();
  for (size_t i = 0; i < values.size(); ++i) {
    const auto [next, error] = std::from_chars(at, end, values[i]);
    const bool last = i + 1 == values.size();
    if (error != std::errc() || (last ? next != end : next == end || *next != '/')) {
      return Error{Errc::kBadConfig,
                   fmt::format("--set {}: write MASS/SPEED/FORCE, as in 2.0/0.4/0.06", text)};
    }
    at = next + 1;
  }
  return caacd::ParameterSet{values[0], values[1], values[2]};
}

Result<caacd::Order> parse_order(const std::string& word) {
  if (word == "time") return caacd::Order::kTime;
  if (word == "state") return caacd::Order::kState;
  return Error{Errc::kBadConfig, fmt::format("--order {}: choose from state, time", word)};
}

}  // namespace throng::app
