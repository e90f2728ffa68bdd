// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "validate/tracks.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>

#include "core/files/read_file.h"

// Readers of text tables of positions, one row a person and frame. Linear in the text.
namespace throng::validate {
namespace {

// The numbers of a line; false if the line holds anything else.
bool numbers_of(const std::string& line, std::vector<double>& out) {
  out.clear();
  const char* at = line.c_str();
  while (true) {
    while (*at == ' ' || *at == '\t' || *at == '\r') ++at;
    if (*at == 0) return true;
    char* end = nullptr;
    const double value = std::strtod(at, &end);
    if (end == at || !std::isfinite(value) || std::fabs(value) > 1e9) return false;
    out.push_back(value);
    at = end;
  }
}

constexpr int64_t kMaxFrames = 1000000;  // 17 hours at 16 a second
constexpr double kMaxFps = 1000;

struct Columns {
  size_t person, frame, x, z, min_count;
};

// A comment may state the frames a second and the unit.
void read_comment(const std::string& line, double& fps, double& unit) {
  if (const size_t at = line.find("framerate:"); at != std::string::npos) {
    const double value = std::strtod(line.c_str() + at + 10, nullptr);
    fps = value;
  }
  if (line.find("x/m") != std::string::npos) unit = 1;
  if (line.find("x/cm") != std::string::npos) unit = 0.01;
}

Result<Tracks> load(const std::string& path, const Columns& columns, double unit) {
  const auto text = read_file(path);
  if (!text) return text.error();
  Tracks tracks;
  std::map<int64_t, std::vector<TrackPoint>> people;
  std::vector<double> row;
  size_t begin = 0;
  for (int64_t number = 1; begin < text->size(); ++number) {
    const size_t end = std::min(text->find('\n', begin), text->size());
    const std::string line = text->substr(begin, end - begin);
    begin = end + 1;
    const auto bad = [&](const std::string& why) {
      return Error{Errc::kBadFile, path + ":" + std::to_string(number) + ": " + why};
    };
    if (line.starts_with('#')) {
      read_comment(line, tracks.fps, unit);
      if (!(tracks.fps >= 1 && tracks.fps <= kMaxFps)) {
        return bad("the frames a second must be within 1 to 1000");
      }
      continue;
    }
    if (!numbers_of(line, row)) return bad("numbers are expected here, nothing else");
    if (row.empty()) continue;
    if (row.size() < columns.min_count) {
      return bad("it has " + std::to_string(row.size()) + " numbers, " +
                 std::to_string(columns.min_count) + " are expected");
    }
    auto& points = people[std::llround(row[columns.person])];
    const TrackPoint point{std::llround(row[columns.frame]), row[columns.x] * unit,
                           row[columns.z] * unit};
    if (point.frame < 0 || point.frame > kMaxFrames) {
      return bad("a frame must be within 0 to " + std::to_string(kMaxFrames));
    }
    if (!points.empty() && points.back().frame >= point.frame) {
      return bad("frames of a person must ascend");
    }
    points.push_back(point);
  }
  if (people.empty()) return Error{Errc::kBadFile, path + ": it has no positions"};
  for (auto& [person, points] : people) tracks.people.push_back({person, std::move(points)});
  return tracks;
}

}  // namespace

Result<Tracks> load_juelich(const std::string& path) {
  return load(path, {.person = 0, .frame = 1, .x = 2, .z = 3, .min_count = 5}, 0.01);
}

Result<Tracks> load_obsmat(const std::string& path) {
  return load(path, {.person = 1, .frame = 0, .x = 2, .z = 4, .min_count = 8}, 1);
}

}  // namespace throng::validate
