// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "paths/path_output.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

// How `throng path` prints a path: one writer for all finders, since they give one type.
namespace throng::app {
namespace {

const char* path_word(SpentBudget spent) {
  switch (spent) {
    case SpentBudget::kNone:
      return "";
    case SpentBudget::kNodes:
      return "nodes";
    case SpentBudget::kMemory:
      return "memory";
    case SpentBudget::kCancelled:
      return "cancelled";
  }
  return "";
}

const char* path_word(PathEnd end) {
  switch (end) {
    case PathEnd::kReached:
      return "reached";
    case PathEnd::kUnreachable:
      return "unreachable";
    case PathEnd::kNoPlace:
      return "no place";
    case PathEnd::kBudgetExhausted:
      return "budget exhausted";
  }
  return "";
}

const char* path_word(SegmentKind kind) {
  switch (kind) {
    case SegmentKind::kWalk:
      return "walk";
    case SegmentKind::kCross:
      return "cross";
    case SegmentKind::kOffMesh:
      return "off-mesh link";
    case SegmentKind::kTakeOff:
      return "take off";
    case SegmentKind::kFly:
      return "fly";
    case SegmentKind::kLand:
      return "land";
  }
  return "";
}

bool is_flown(SegmentKind kind) {
  return kind == SegmentKind::kTakeOff || kind == SegmentKind::kFly || kind == SegmentKind::kLand;
}

// Points that are printed at each end of a path over nodes, which has one each --spacing on curved
// ground; between them only those over edges and at links.
constexpr size_t kPrintedEnds = 8;

// "1.200 m from there in the plane and 2.900 m below".
std::string how_near(const Vec3d& nearest, const Vec3d& goal) {
  const double below = goal.y - nearest.y;
  std::string text = fmt::format("{:.3f} m from there in the plane",
                                 std::hypot(nearest.x - goal.x, nearest.z - goal.z));
  if (std::fabs(below) < 0.0005) return text;
  return text + fmt::format(" and {:.3f} m {}", std::fabs(below), below > 0 ? "below" : "above");
}

// With the option that made it.
std::string blocker_text(Blocker blocker) {
  std::string text = word_for(blocker);
  if (blocker == Blocker::kObstacle) text += " (--block)";
  if (blocker == Blocker::kClosed) text += " (--area-cost)";
  return text;
}

std::string point_text(const Path& path, size_t i) {
  std::string text = "  " + where(path.points[i].position);
  if (!path.node_places.empty()) {
    const NodePlace& place = path.node_places[i];
    const double slope = std::acos(std::clamp(place.normal.y, -1.0, 1.0)) * 180 / std::numbers::pi;
    text += fmt::format("  {:3.0f} deg", slope);
    if (!place) text += "  over the edge";
  }
  for (const PathLink& link : path.links) {
    if (link.point != i || link.kind == LinkKind::kWalk) continue;
    const bool is_wide = link.over_hole && link.kind != LinkKind::kDrop;
    text += fmt::format("  {}{}", word_for(link.kind), is_wide ? " over a hole" : "");
  }
  if (i > 0 && is_flown(path.segments[i - 1])) {
    text += fmt::format("  {}", path_word(path.segments[i - 1]));
  }
  return text + '\n';
}

// Is it only one more point of a surface: not over an edge, and not at a link?
bool is_plain(const Path& path, size_t i) {
  if (path.node_places.empty() || !path.node_places[i]) return false;
  return std::none_of(path.links.begin(), path.links.end(), [i](const PathLink& link) {
    return link.point == i && link.kind != LinkKind::kWalk;
  });
}

std::string point_lines(const Path& path) {
  const size_t count = path.points.size();
  std::string text;
  size_t left_out = 0;
  const auto end_gap = [&] {
    if (left_out > 0) {
      text += fmt::format("  ... {}: --json has all\n", counted(left_out, "more point"));
    }
    left_out = 0;
  };
  for (size_t i = 0; i < count; ++i) {
    const bool is_end = i < kPrintedEnds || i + kPrintedEnds >= count;
    if (!is_end && is_plain(path, i)) {
      ++left_out;
      continue;
    }
    end_gap();
    text += point_text(path, i);
  }
  return text;
}

}  // namespace

Json path_json(const PathRun& run, const Path& path) {
  Json points = Json::array(), segments = Json::array(), links = Json::array();
  for (const Place& p : path.points) points.push_back(numbers(p.position));
  for (const SegmentKind kind : path.segments) segments.push_back(path_word(kind));
  for (const PathLink& link : path.links) {
    links.push_back(
        {{"point", link.point}, {"kind", word_for(link.kind)}, {"over_hole", link.over_hole}});
  }
  Json json = {{"world", run.world},         {"class", run.avatar_class},
               {"end", path_word(path.end)}, {"length", path.length},
               {"cost", path.cost},          {"points", points},
               {"segments", segments},       {"links", links},
               {"nodes", path.nodes},        {"seconds", run.seconds}};
  if (!path.node_places.empty()) {
    Json normals = Json::array();
    for (const NodePlace& place : path.node_places) normals.push_back(numbers(place.normal));
    json["normals"] = normals;
    json["corridor"] = path.corridor;
  }
  if (path.spent != SpentBudget::kNone) json["spent"] = path_word(path.spent);
  if (path.end == PathEnd::kUnreachable && !path.points.empty()) {
    const Vec3d& nearest = path.points.back().position;
    json["nearest"] = {{"place", numbers(nearest)},
                       {"distance", length(run.goal - nearest)},
                       {"below", run.goal.y - nearest.y},
                       {"blocked_by", word_for(path.blocked_by)}};
  }
  return json;
}

std::string path_text(const PathRun& run, const Path& path) {
  std::string text;
  if (path.end == PathEnd::kReached) {
    const std::string over =
        path.corridor.empty() ? "" : fmt::format(" over {}", counted(path.corridor.size(), "node"));
    const bool flies = std::any_of(path.segments.begin(), path.segments.end(), is_flown);
    const char* seen = path.node_places.empty() && !flies ? " as seen from above" : "";
    text = fmt::format("{:.3f} m{} for {}{}, {}, found in {:.3f} ms\n", path.length, seen,
                       run.avatar_class, over, counted(path.segments.size(), "segment"),
                       run.seconds * 1e3);
    if (std::fabs(path.cost - path.length) > 0.0005) {
      text += fmt::format("  costs {:.3f}\n", path.cost);
    }
  } else {
    text = fmt::format("no path for {}: {}\n", run.avatar_class, path_word(path.end));
    if (path.spent == SpentBudget::kMemory) {
      text += fmt::format("  the search needs more than {} MiB of memory; raise {}\n",
                          run.search_bytes >> 20, run.memory_option);
    }
    if (path.end != PathEnd::kUnreachable || path.points.empty()) return text;
    const Vec3d& nearest = path.points.back().position;
    text += fmt::format("  gets to ({}), {}; blocked by: {}\n", where(nearest),
                        how_near(nearest, run.goal), blocker_text(path.blocked_by));
  }
  return text + point_lines(path);
}

}  // namespace throng::app
