// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "import/formats/patch_json.h"

#include <fmt/format.h>
#include <simdjson.h>

#include <cmath>

// Reads docs/file_format.md, "Patch files". Linear in the file.
namespace throng::importer {
namespace {

using simdjson::dom::array;
using simdjson::dom::element;
using simdjson::dom::object;

constexpr int64_t kPatchVersion = 1;

class PatchJsonReader {
 public:
  PatchJsonReader(const ReadOptions& options, Context& context)
      : options_(options), context_(context), writer_(options), place_(options.name) {}

  Result<RawScene> read(const element& root) {
    if (!read_root(root)) {
      if (context_.cancel) return Error{Errc::kCancelled, "cancelled while reading"};
      return Error{Errc::kBadFile, message_};
    }
    auto scene = writer_.finish();
    if (!scene) return scene.error();
    return RawScene{.scene = *std::move(scene), .up = 'y', .metres_per_unit = 1};
  }

 private:
  bool fail(const std::string& why) {
    message_ = place_ + ": " + why;
    return false;
  }

  // Else a misspelt key would leave an edge open.
  bool only_keys(const object& node, std::initializer_list<std::string_view> keys) {
    for (const auto& field : node) {
      bool known = false;
      for (const std::string_view key : keys) known = known || field.key == key;
      if (!known) return fail(fmt::format("does not know the key \"{}\"; remove it", field.key));
    }
    return true;
  }

  bool read_root(const element& root) {
    object top;
    std::string_view format;
    int64_t version = 0;
    array groups;
    if (root.get(top) != simdjson::SUCCESS) return fail("must be an object");
    if (top["format"].get(format) != simdjson::SUCCESS || format != "throng-patches") {
      return fail("not a patch file: \"format\" must be \"throng-patches\"");
    }
    if (top["version"].get(version) != simdjson::SUCCESS) return fail("has no whole \"version\"");
    if (version != kPatchVersion) {
      return fail(fmt::format("patch file of version {}; only {} is read", version, kPatchVersion));
    }
    if (!only_keys(top, {"format", "version", "groups"})) return false;
    if (top["groups"].get(groups) != simdjson::SUCCESS) return fail("has no list \"groups\"");
    size_t number = 0;
    for (const element group : groups) {
      place_ = fmt::format("{}: group {}", options_.name, number++);
      if (!read_group(group)) return false;
    }
    place_ = options_.name;
    if (writer_.scene().patches.empty()) return fail("has no patches");
    return true;
  }

  bool read_group(const element& node) {
    object group;
    if (node.get(group) != simdjson::SUCCESS) return fail("must be an object");
    if (!only_keys(group, {"node", "material", "kind", "patches"})) return false;
    std::string_view name;
    std::string_view material;
    int64_t kind = kAreaWalkable;
    const auto text = [&](const char* key, std::string_view& out) {
      const auto failure = group[key].get(out);
      return failure == simdjson::SUCCESS || failure == simdjson::NO_SUCH_FIELD;
    };
    if (!text("node", name)) return fail("\"node\" must be a text");
    if (!text("material", material)) return fail("\"material\" must be a text");
    if (const auto failure = group["kind"].get(kind);
        (failure != simdjson::SUCCESS && failure != simdjson::NO_SUCH_FIELD) || kind < 0 ||
        kind > kAreaLast) {
      return fail(fmt::format("\"kind\" must be a whole number, 0 to {}", kAreaLast));
    }
    array patches;
    if (group["patches"].get(patches) != simdjson::SUCCESS) return fail("has no list \"patches\"");
    writer_.scene().patches.begin_run(options_.name, name, material, static_cast<uint8_t>(kind));
    const std::string group_place = place_;
    size_t number = 0;
    for (const element patch : patches) {
      if (context_.cancel) return false;
      place_ = fmt::format("{}, patch {}", group_place, number++);
      if (!read_patch(patch)) return false;
    }
    return true;
  }

  bool read_patch(const element& node) {
    object patch;
    array points;
    if (node.get(patch) != simdjson::SUCCESS) return fail("must be an object");
    if (!only_keys(patch, {"points", "edges"})) return false;
    if (patch["points"].get(points) != simdjson::SUCCESS || points.size() != 16) {
      return fail("\"points\" must be a list of 16 points");
    }
    BezierPatch surface;
    size_t i = 0;
    for (const element item : points) {
      array numbers;
      Vec3d& p = surface.points[i];
      if (item.get(numbers) != simdjson::SUCCESS || numbers.size() != 3 ||
          numbers.at(0).get(p.x) != simdjson::SUCCESS ||
          numbers.at(1).get(p.y) != simdjson::SUCCESS ||
          numbers.at(2).get(p.z) != simdjson::SUCCESS ||
          !(std::fabs(p.x) < 1e9 && std::fabs(p.y) < 1e9 && std::fabs(p.z) < 1e9)) {
        return fail(fmt::format("point {} must be three numbers below 1e9", i));
      }
      ++i;
    }
    const uint32_t index = writer_.scene().patches.add(surface);
    array edges;
    if (const auto failure = patch["edges"].get(edges); failure == simdjson::NO_SUCH_FIELD) {
      return true;  // All open.
    } else if (failure != simdjson::SUCCESS || edges.size() != 4) {
      return fail("\"edges\" must be a list of 4");
    }
    uint32_t e = 0;
    for (const element edge : edges) {
      if (!read_edge(edge, e, writer_.scene().patches.edges[index][e])) return false;
      ++e;
    }
    return true;
  }

  // null, {"next": [[patch, edge], ...]} or {"part_of": [patch, edge]}.
  bool read_edge(const element& node, uint32_t e, PatchEdge& edge) {
    if (node.is_null()) return true;
    object bind;
    array list;
    if (node.get(bind) != simdjson::SUCCESS || bind.size() != 1) {
      return fail(
          fmt::format("edge {} must be null, {{\"next\": ...}} or {{\"part_of\": ...}}", e));
    }
    if (bind["part_of"].get(list) == simdjson::SUCCESS) {
      edge.bind = EdgeBind::kPart;
      return read_side(list, e, edge.next[0]);
    }
    if (bind["next"].get(list) != simdjson::SUCCESS ||
        (list.size() != 1 && list.size() != 2 && list.size() != 4)) {
      return fail(fmt::format("edge {}: \"next\" must list 1, 2 or 4 neighbours", e));
    }
    edge.bind = static_cast<EdgeBind>(list.size());
    size_t k = 0;
    for (const element item : list) {
      array side;
      if (item.get(side) != simdjson::SUCCESS) return bad_side(e);
      if (!read_side(side, e, edge.next[k++])) return false;
    }
    return true;
  }

  bool bad_side(uint32_t e) {
    return fail(
        fmt::format("edge {}: a neighbour must be [patch, edge], the patch counted through "
                    "the whole file, the edge 0 to 3",
                    e));
  }

  bool read_side(const array& list, uint32_t e, PatchSide& side) {
    uint64_t patch = 0;
    uint64_t edge = 0;
    if (list.size() != 2 || list.at(0).get(patch) != simdjson::SUCCESS ||
        list.at(1).get(edge) != simdjson::SUCCESS || patch >= kNoPatch / 4 || edge > 3) {
      return bad_side(e);
    }
    side = {static_cast<uint32_t>(patch), static_cast<uint32_t>(edge)};
    return true;
  }

  const ReadOptions& options_;
  Context& context_;
  SceneWriter writer_;
  std::string place_;
  std::string message_;
};

}  // namespace

Result<RawScene> read_patch_json(std::string_view bytes, const ReadOptions& options,
                                 Context& context) {
  simdjson::dom::parser parser;
  element root;
  if (const auto failure = parser.parse(simdjson::padded_string(bytes)).get(root);
      failure != simdjson::SUCCESS) {
    return Error{Errc::kBadFile,
                 fmt::format("{}: not JSON: {}", options.name, simdjson::error_message(failure))};
  }
  auto raw = PatchJsonReader(options, context).read(root);
  if (!raw) return raw;
  // Neighbours are tested here, before files are joined, so that a number names a patch of this
  // one.
  if (const auto checked = check_patches(raw->scene.patches); !checked) {
    return Error{Errc::kBadFile, checked.error().message};
  }
  return raw;
}

}  // namespace throng::importer
