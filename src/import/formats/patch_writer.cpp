// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "core/files/part_file.h"
#include "import/patches/patch_edges.h"
#include "throng/scene.h"

// Writes docs/file_format.md, "Patch files": a patch a line. fmt prints the shortest decimal that
// reads back as the same double.
namespace throng {
namespace {

void append_side(std::string& out, PatchSide side) {
  fmt::format_to(std::back_inserter(out), "[{},{}]", side.patch, side.edge);
}

void append_edge(std::string& out, const PatchEdge& edge) {
  const size_t count = importer::neighbour_count(edge.bind);
  if (count == 0) {
    out += "null";
  } else if (edge.bind == EdgeBind::kPart) {
    out += "{\"part_of\":";
    append_side(out, edge.next[0]);
    out += '}';
  } else {
    out += "{\"next\":[";
    for (size_t k = 0; k < count; ++k) {
      if (k > 0) out += ',';
      append_side(out, edge.next[k]);
    }
    out += "]}";
  }
}

void append_patch(std::string& out, const BezierPatch& patch,
                  const std::array<PatchEdge, 4>& edges) {
  out += "{\"points\":[";
  for (size_t i = 0; i < patch.points.size(); ++i) {
    const Vec3d& p = patch.points[i];
    fmt::format_to(std::back_inserter(out), "{}[{},{},{}]", i > 0 ? "," : "", p.x, p.y, p.z);
  }
  out += "],\"edges\":[";
  for (size_t e = 0; e < 4; ++e) {
    if (e > 0) out += ',';
    append_edge(out, edges[e]);
  }
  out += "]}";
}

std::string quoted(const std::string& text) {
  return nlohmann::json(text).dump(-1, ' ', true, nlohmann::json::error_handler_t::replace);
}

}  // namespace

Result<void> write_patches(const PatchSet& set, const std::string& path) {
  if (set.empty()) return Error{Errc::kBadInput, path + ": there are no patches to write"};
  if (const auto checked = check_patches(set); !checked) return checked;
  PartFile file(path);
  std::string text;
  const auto flush = [&] {
    file.write(text.data(), text.size());
    text.clear();
  };
  text = "{\"format\":\"throng-patches\",\"version\":1,\"groups\":[";
  for (size_t r = 0; r < set.runs.size(); ++r) {
    const PatchRun& run = set.runs[r];
    fmt::format_to(std::back_inserter(text),
                   "{}\n{{\"node\":{},\"material\":{},\"kind\":{},\"patches\":[", r > 0 ? "," : "",
                   quoted(run.node), quoted(run.material), run.kind);
    for (uint32_t p = run.first_patch; p < run.first_patch + run.patch_count; ++p) {
      text += p > run.first_patch ? ",\n" : "\n";
      append_patch(text, set.patches[p], set.edges[p]);
      if (text.size() > (1u << 20)) flush();
    }
    text += "]}";
  }
  text += "]}\n";
  flush();
  return file.close();
}

}  // namespace throng
