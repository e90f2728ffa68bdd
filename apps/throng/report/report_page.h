// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "throng/base.h"
#include "throng/picture.h"
#include "throng/recording.h"

/// What `throng report` shows: pictures, and one page that holds them all.
namespace throng::app {

struct ReportPicture {
  std::string name;  ///< For a file: "egress", "line_1", "density_0" ...
  std::string caption;
  Image image;
};

/// Draws everything. Fails with kBadConfig or kLimit.
[[nodiscard]] Result<std::vector<ReportPicture>> draw_report(const ReplaySummary& summary,
                                                             const SummaryConfig& config);

using ReportRow = std::pair<std::string, std::string>;

struct ReportText {
  std::string title;
  std::vector<ReportRow> numbers;   ///< Results.
  std::vector<ReportRow> settings;  ///< How the run was made.
};

/// One page of HTML that needs no other file. Fails with kLimit if a picture cannot be packed.
[[nodiscard]] Result<std::string> report_page(const ReportText& text,
                                              const std::vector<ReportPicture>& pictures);

}  // namespace throng::app
