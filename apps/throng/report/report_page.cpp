// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "report/report_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "throng/picture.h"

// The charts and maps of a recording, and one page of HTML that embeds them.
namespace throng::app {
namespace {

constexpr size_t kMaxPoints = 1000;  // of a line: more than the pixels of a chart

// A chart over the frames: every n-th of them, and the last.
class FrameChart {
 public:
  FrameChart(const ReplaySummary& summary, Chart chart) : chart_(std::move(chart)) {
    const size_t frames = summary.time.size();
    const size_t every = frames / kMaxPoints + 1;
    for (size_t f = 0; f < frames; f += every) picked_.push_back(f);
    if (picked_.back() != frames - 1) picked_.push_back(frames - 1);
    for (const size_t f : picked_) chart_.x.push_back(summary.time[f]);
    chart_.x_title = "time [s]";
  }
  template <class T>
  void add(const std::string& name, const std::vector<T>& values) {
    ChartLine line{.name = name};
    for (const size_t f : picked_) line.values.push_back(static_cast<double>(values[f]));
    chart_.lines.push_back(std::move(line));
  }
  [[nodiscard]] const Chart& chart() const { return chart_; }

 private:
  Chart chart_;
  std::vector<size_t> picked_;
};

// Persons a second, as steps of a bin each.
Chart flow_chart(const ReplaySummary& summary, const SummaryConfig& config, size_t index) {
  const LineFlow& flow = summary.lines[index];
  const FlowLine& line = config.lines[index];
  Chart chart{.title = fmt::format("Flow at line {}", index + 1),
              .notes = {fmt::format("From {:.12g}, {:.12g} to {:.12g}, {:.12g}; in bins of {:g} s",
                                    line.x0, line.z0, line.x1, line.z1, config.bin)},
              .x_title = "time [s]",
              .y_title = "persons a second"};
  ChartLine forth{.name = fmt::format("to the right: {} in all", flow.total_forth)};
  ChartLine back{.name = fmt::format("to the left: {} in all", flow.total_back)};
  const size_t together = flow.forth.size() / kMaxPoints + 1;  // bins in one step
  for (size_t b = 0; b < flow.forth.size(); b += together) {
    const size_t end = std::min(b + together, flow.forth.size());
    double counts[2] = {0, 0};
    for (size_t k = b; k < end; ++k) {
      counts[0] += flow.forth[k];
      counts[1] += flow.back[k];
    }
    const double seconds = static_cast<double>(end - b) * config.bin;
    const double from = summary.time.front() + static_cast<double>(b) * config.bin;
    for (const double x : {from, from + seconds * (1 - 1e-6)}) {
      chart.x.push_back(x);
      forth.values.push_back(counts[0] / seconds);
      back.values.push_back(counts[1] / seconds);
    }
  }
  // Room for the legend.
  const double max =
      std::max(*std::ranges::max_element(forth.values), *std::ranges::max_element(back.values));
  chart.max = max > 0 ? max * 1.25 : 1;
  chart.lines = {std::move(forth), std::move(back)};
  return chart;
}

HeatMap heat_map(const SummaryMap& map, const std::vector<double>& values) {
  return {.x0 = map.x0,
          .z0 = map.z0,
          .cell = map.cell,
          .width = map.width,
          .depth = map.depth,
          .values = values};
}

std::string escaped(std::string_view text) {
  std::string out;
  for (const char c : text) {
    switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      default:
        out += c;
    }
  }
  return out;
}

std::string base64(const std::vector<uint8_t>& bytes) {
  constexpr std::string_view kLetters =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  out.reserve(bytes.size() / 3 * 4 + 4);
  for (size_t i = 0; i < bytes.size(); i += 3) {
    const size_t count = std::min<size_t>(3, bytes.size() - i);
    uint32_t word = 0;
    for (size_t k = 0; k < 3; ++k) word = word << 8 | (k < count ? bytes[i + k] : 0u);
    for (size_t k = 0; k < 4; ++k) {
      out += k <= count ? kLetters[word >> (18 - 6 * k) & 63] : '=';
    }
  }
  return out;
}

std::string table(const std::string& title, const std::vector<ReportRow>& rows) {
  std::string out = fmt::format("<h2>{}</h2>\n<table>\n", title);
  for (const auto& [name, value] : rows) {
    out += fmt::format("<tr><th>{}</th><td>{}</td></tr>\n", escaped(name), escaped(value));
  }
  return out + "</table>\n";
}

}  // namespace

Result<std::vector<ReportPicture>> draw_report(const ReplaySummary& summary,
                                               const SummaryConfig& config) {
  std::vector<ReportPicture> pictures;
  Error failed;
  const auto take = [&](const std::string& name, const std::string& caption, Result<Image> image) {
    if (!image && failed.code == Errc::kOk) failed = image.error();
    if (image) pictures.push_back({name, caption, *std::move(image)});
  };
  if (summary.time.size() > 1) {
    FrameChart egress(summary, {.title = "Avatars present", .y_title = "avatars"});
    egress.add("present", summary.present);
    egress.add("left so far", summary.left);
    egress.add("come so far", summary.entered);
    take("egress", "Egress curve: avatars present, left and come, over time.",
         draw_chart(egress.chart()));
    FrameChart speed(summary, {.title = "Mean speed", .y_title = "m/s"});
    speed.add("", summary.speed);
    take("speed", "Mean speed from each frame to the next, of avatars in both.",
         draw_chart(speed.chart()));
    for (size_t l = 0; l < summary.lines.size(); ++l) {
      take(fmt::format("line_{}", l + 1),
           "Crossings, to the right and to the left of the direction from the line's first end to "
           "its second.",
           draw_chart(flow_chart(summary, config, l)));
    }
  }
  // One scale for all storeys.
  double dense = 0, slow = 0;
  for (const SummaryMap& map : summary.maps) {
    dense = std::max(dense, *std::ranges::max_element(map.density));
    slow = std::max(slow, *std::ranges::max_element(map.waiting));
  }
  for (size_t m = 0; m < summary.maps.size(); ++m) {
    const SummaryMap& map = summary.maps[m];
    const std::string where = fmt::format("Feet from {:.12g} to {:.12g} m; cells of {:g} m",
                                          map.lowest, map.highest, map.cell);
    HeatMap density = heat_map(map, map.density);
    density.title = "Density";
    density.notes = {where, "Mean over the whole time"};
    density.unit = "persons / m2";
    density.max = dense;
    take(fmt::format("density_{}", m), "Avatars on a square metre, mean over time.",
         draw_heat_map(density));
    HeatMap waiting = heat_map(map, map.waiting);
    waiting.title = "Waiting";
    waiting.notes = {where, fmt::format("Time of all avatars slower than {:g} m/s", config.slow)};
    waiting.unit = "s / m2";
    waiting.max = slow;
    take(fmt::format("waiting_{}", m), "Time that avatars waited on a square metre, in total.",
         draw_heat_map(waiting));
  }
  if (failed.code != Errc::kOk) return failed;
  return pictures;
}

Result<std::string> report_page(const ReportText& text,
                                const std::vector<ReportPicture>& pictures) {
  std::string page = fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<title>{0}</title>\n"
      "<style>\n"
      "body {{ font: 16px/1.5 sans-serif; color: #1f242e; max-width: 1000px; margin: 2em auto; "
      "padding: 0 1em; }}\n"
      "h1 {{ font-size: 1.6em; }}\nh2 {{ font-size: 1.2em; margin-top: 2em; }}\n"
      "table {{ border-collapse: collapse; }}\n"
      "th, td {{ text-align: left; font-weight: normal; padding: 0.2em 1.5em 0.2em 0; "
      "border-bottom: 1px solid #ced2d8; }}\n"
      "th {{ color: #767c86; }}\n"
      "figure {{ margin: 2em 0; }}\nimg {{ max-width: 100%; border: 1px solid #ced2d8; }}\n"
      "figcaption {{ color: #767c86; font-size: 0.9em; }}\n"
      "</style>\n</head>\n<body>\n<h1>{0}</h1>\n",
      escaped(text.title));
  page += table("Results", text.numbers);
  for (const ReportPicture& picture : pictures) {
    const std::vector<uint8_t> png = png_bytes(picture.image);
    if (png.empty()) return Error{Errc::kLimit, "report: out of memory; take larger cells"};
    page += fmt::format(
        "<figure>\n<img alt=\"{0}\" src=\"data:image/png;base64,{1}\">\n"
        "<figcaption>{0}</figcaption>\n</figure>\n",
        escaped(picture.caption), base64(png));
  }
  page += table("Settings", text.settings);
  return page + "</body>\n</html>\n";
}

}  // namespace throng::app
