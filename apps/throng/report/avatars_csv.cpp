// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "report/avatars_csv.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <string_view>
#include <unordered_map>
#include <utility>

#include "input_file.h"
#include "throng/avatar.h"
#include "throng/recording.h"

// Parser of trajectory files: the avatars of the last step, and headings from the steps before.
namespace throng::app {
namespace {

constexpr size_t kFields = 7, kFieldsWithUp = 10;

std::vector<std::string_view> split(std::string_view line) {
  std::vector<std::string_view> fields;
  for (size_t comma = 0; comma != std::string_view::npos;) {
    comma = line.find(',');
    fields.push_back(line.substr(0, comma));
    line = comma == std::string_view::npos ? line : line.substr(comma + 1);
  }
  return fields;
}

template <class T>
bool parse(std::string_view text, T& value) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && end == text.data() + text.size();
}

struct CsvRow {
  uint64_t step = 0;
  uint64_t id = 0;
  PictureAvatar avatar;
  Vec3d up{0, 1, 0};
};

// One line of the file, or its fault.
Result<CsvRow> parse_row(const std::string& where, std::string_view line, size_t wanted) {
  const std::vector<std::string_view> fields = split(line);
  if (fields.size() != wanted) {
    return Error{Errc::kBadFile,
                 fmt::format("{}: {} fields; write {}: {}{}", where, fields.size(), wanted,
                             kCsvColumns, wanted == kFields ? "" : kCsvUpColumns)};
  }
  CsvRow row;
  if (!parse(fields[0], row.step)) {
    return Error{Errc::kBadFile,
                 fmt::format("{}: step is '{}'; write a whole number", where, fields[0])};
  }
  if (!parse(fields[1], row.id)) {
    return Error{Errc::kBadFile,
                 fmt::format("{}: id is '{}'; write a whole number", where, fields[1])};
  }
  Vec3d& p = row.avatar.position;
  const std::pair<const char*, double*> numbers[] = {
      {"x", &p.x},         {"y", &p.y},         {"z", &p.z},        {"radius", &row.avatar.radius},
      {"up_x", &row.up.x}, {"up_y", &row.up.y}, {"up_z", &row.up.z}};
  for (size_t i = 0; i + 3 < wanted; ++i) {
    if (parse(fields[3 + i], *numbers[i].second) && std::isfinite(*numbers[i].second)) continue;
    return Error{Errc::kBadFile, fmt::format("{}: {} is '{}'; write a number in metres", where,
                                             numbers[i].first, fields[3 + i])};
  }
  if (!(row.avatar.radius > 0)) {
    return Error{Errc::kBadFile,
                 fmt::format("{}: radius is {}; write more than 0", where, fields[6])};
  }
  const double size = length(row.up);
  if (!(size > 1e-3 && size < 1e3)) {
    return Error{Errc::kBadFile, fmt::format("{}: up is {},{},{}; write a direction", where,
                                             fields[7], fields[8], fields[9])};
  }
  row.up = row.up * (1 / size);
  return row;
}

// Calls take(row) for each line of the file.
template <class Take>
Result<void> read_rows(const std::string& path, Take take) {
  const std::string remedy = "write one with `throng run --trajectories`";
  if (auto ok = check_file(path, remedy); !ok) return ok;
  std::ifstream file(path);
  uint64_t number = 0;
  size_t fields = kFields;
  const std::string leaning = std::string(kCsvColumns) + kCsvUpColumns;
  for (std::string line; std::getline(file, line);) {
    ++number;
    if (!line.empty() && line.back() == '\r') line.pop_back();
    if (number == 1) {
      fields = line == leaning ? kFieldsWithUp : kFields;
      if (line == kCsvColumns || line == leaning) continue;
      return Error{Errc::kBadFile, fmt::format("{}:1: the columns are '{}'; write {}", path,
                                               line.substr(0, 60), kCsvColumns)};
    }
    if (line.empty()) continue;
    const Result<CsvRow> row = parse_row(fmt::format("{}:{}", path, number), line, fields);
    if (!row) return row.error();
    take(*row);
  }
  if (file.bad()) {
    return Error{Errc::kBadFile,
                 fmt::format("{}: reading it failed after line {}; {}", path, number, remedy)};
  }
  if (number == 0) {
    return Error{Errc::kBadFile,
                 fmt::format("{}:1: the file is empty; write {}", path, kCsvColumns)};
  }
  return {};
}

}  // namespace

Result<std::vector<PictureAvatar>> read_avatars(const std::string& path) {
  std::vector<PictureAvatar> avatars;
  uint64_t last = 0;
  const auto done = read_rows(path, [&](const CsvRow& row) {
    if (row.step > last) avatars.clear();
    if (row.step >= last) avatars.push_back(row.avatar);
    last = std::max(last, row.step);
  });
  if (!done) return done.error();
  return avatars;
}

Result<std::vector<CsvWalker>> read_walkers(const std::string& path) {
  std::unordered_map<uint64_t, CsvWalker> known;
  std::vector<uint64_t> order;
  uint64_t last = 0;
  const auto done = read_rows(path, [&](const CsvRow& row) {
    if (row.step > last) order.clear();
    if (row.step < last) return;
    last = row.step;
    order.push_back(row.id);
    const auto [it, is_new] = known.try_emplace(row.id);
    CsvWalker& walker = it->second;
    const Vec3d before = is_new ? row.avatar.position : walker.position;
    walker.id = row.id;
    walker.position = row.avatar.position;
    walker.up = row.up;
    const Vec3d moved = unleaned(row.avatar.position - before, row.up);
    walker.last_move = std::hypot(moved.x, moved.z);
    walker.walked += walker.last_move;
    // A standing avatar keeps the heading of its last move.
    if (walker.last_move > 1e-6) walker.heading = Vec3d{moved.x, 0, moved.z};
  });
  if (!done) return done.error();
  std::vector<CsvWalker> walkers;
  walkers.reserve(order.size());
  for (const uint64_t id : order) walkers.push_back(known[id]);
  return walkers;
}

}  // namespace throng::app
