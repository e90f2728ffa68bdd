// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "report/caacd_figures.h"

#include <fmt/format.h>

#include <algorithm>

// The charts of [CAACD] figures 10 and 11: collisions over the number of avatars.
namespace throng::app {
namespace {

using caacd::Study;

const std::vector<caacd::ParameterSet> kNamed = caacd::named_sets();

Chart empty_chart(const Study& study, const std::string& title, int32_t seeds) {
  Chart chart;
  chart.title = title;
  chart.notes = {
      fmt::format("Means over {} seeds; bands: one standard deviation. Dashed: the "
                  "max that [CAACD] reports.",
                  seeds)};
  chart.x_title = "avatars";
  chart.y_title = "collisions a run";
  for (const int32_t n : study.avatars) chart.x.push_back(n);
  return chart;
}

ChartLine line_of(const Study& study, size_t set, LineKind kind) {
  ChartLine line{.name = caacd::name_of(study.sets[set]), .values = {}, .spread = {}, .kind = kind};
  for (size_t i = 0; i < study.avatars.size(); ++i) {
    line.values.push_back(study.at(set, i).mean);
    if (kind != LineKind::kFaint) line.spread.push_back(study.at(set, i).deviation);
  }
  return line;
}

ChartLine bound(const Study& study, const char* name, int32_t caacd::Reported::*which) {
  ChartLine line{.name = name, .values = {}, .spread = {}, .kind = LineKind::kDashed};
  for (const int32_t n : study.avatars) {
    line.values.push_back(caacd::reported_collisions(n).*which);
  }
  return line;
}

bool is_bad(const caacd::ParameterSet& set) { return set == kNamed[0] || set == kNamed[1]; }

}  // namespace

Chart figure_10(const Study& study, int32_t seeds) {
  Chart chart = empty_chart(study, "Collisions: the two bad sets and the mean of all", seeds);
  for (size_t s = 0; s < study.sets.size(); ++s) {
    if (is_bad(study.sets[s])) chart.lines.push_back(line_of(study, s, LineKind::kStrong));
  }
  ChartLine mean{.name = fmt::format("mean of {} sets", study.sets.size()),
                 .values = std::vector<double>(study.avatars.size()),
                 .spread = {},
                 .kind = LineKind::kPlain};
  for (size_t s = 0; s < study.sets.size(); ++s) {
    for (size_t i = 0; i < study.avatars.size(); ++i) {
      mean.values[i] += study.at(s, i).mean / static_cast<double>(study.sets.size());
    }
  }
  chart.lines.push_back(std::move(mean));
  chart.lines.push_back(bound(study, "[CAACD] figure 10", &caacd::Reported::bad));
  return chart;
}

Chart figure_11(const Study& study, int32_t seeds) {
  Chart chart = empty_chart(study, "Collisions: all other sets, 2.0/0.4/0.06 bold", seeds);
  double max = caacd::reported_collisions(study.avatars.back()).others;
  bool first = true;
  for (size_t s = 0; s < study.sets.size(); ++s) {
    const caacd::ParameterSet& set = study.sets[s];
    if (is_bad(set)) continue;
    const bool best = set == kNamed[2];
    chart.lines.push_back(line_of(study, s, best ? LineKind::kStrong : LineKind::kFaint));
    if (best) {
      max = std::max(max, study.at(s, study.avatars.size() - 1).mean);
    } else {
      // One entry of the legend stands for all grey lines.
      chart.lines.back().name = first ? "another set each" : "";
      first = false;
    }
  }
  chart.lines.push_back(bound(study, "[CAACD] figure 11", &caacd::Reported::others));
  chart.max = 3 * max;
  const bool cut = std::ranges::any_of(chart.lines, [&](const ChartLine& line) {
    return std::ranges::max(line.values) > chart.max;
  });
  if (cut) chart.notes.push_back("Sets of little force and much speed leave the chart at the top.");
  return chart;
}

}  // namespace throng::app
