// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>

#include "command.h"
#include "throng/papers.h"

/// One run of the experiment of [CAACD], to look at.
namespace throng::app {

struct OneRunFiles {
  std::string picture;       ///< As figure 9, or empty.
  int64_t at = 300;          ///< Frame of the picture.
  bool is_at_given = false;  ///< Then a run that ends before fails.
  std::string record;        ///< CSV, or empty.
  [[nodiscard]] bool any() const { return !picture.empty() || !record.empty(); }
};

/// Runs the last set with the last number of avatars from the first seed. Returns the exit code.
int run_once(Session& session, const caacd::StudyConfig& study, const OneRunFiles& files);

}  // namespace throng::app
