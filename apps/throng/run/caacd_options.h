// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "throng/papers.h"

/// Words on the command line for settings of [CAACD].
namespace throng::app {

/// "2.0/0.4/0.06". Fails with kBadConfig.
[[nodiscard]] Result<caacd::ParameterSet> parse_set(const std::string& text);

/// "time" or "state". Fails with kBadConfig.
[[nodiscard]] Result<caacd::Order> parse_order(const std::string& word);

}  // namespace throng::app
