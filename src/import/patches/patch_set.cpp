// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "import/patches/patch_edges.h"
#include "throng/scene.h"

// Checks that neighbours along edges name each other and meet. Linear in the edges.
namespace throng {
namespace {

constexpr double kWidestGap = 0.1;  // [m] The real landscapes of [PACS00] are stored to 0.03 m.

bool is_finite(Vec3d p) { return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z); }

class PatchChecker {
 public:
  explicit PatchChecker(const PatchSet& set) : set_(set) {}

  Result<void> check() {
    if (set_.edges.size() != set_.patches.size()) {
      return Error{Errc::kBadInput,
                   fmt::format("patches: {} patches but edges of {}; give four edges to each",
                               set_.patches.size(), set_.edges.size())};
    }
    if (!runs_cover()) {
      return Error{Errc::kBadInput,
                   "patches: the runs leave out patches or overlap; add patches by add()"};
    }
    for (uint32_t p = 0; p < set_.patches.size(); ++p) {
      for (const Vec3d& point : set_.patches[p].points) {
        if (is_finite(point)) continue;
        return Error{Errc::kBadInput,
                     set_.name_of(p) + " has a control point that is not finite; repair the file"};
      }
    }
    for (uint32_t p = 0; p < set_.patches.size(); ++p) {
      for (uint32_t e = 0; e < 4; ++e) {
        if (check_edge({p, e})) continue;
        return Error{Errc::kBadInput, fmt::format("{}, edge {}: {}", set_.name_of(p), e, message_)};
      }
    }
    return {};
  }

 private:
  bool fail(std::string why) {
    message_ = std::move(why);
    return false;
  }

  [[nodiscard]] bool runs_cover() const {
    uint64_t next = 0;
    for (const PatchRun& run : set_.runs) {
      if (run.first_patch != next) return false;
      next += run.patch_count;
    }
    return next == set_.patches.size();
  }

  [[nodiscard]] const PatchEdge& at(PatchSide side) const {
    return set_.edges[side.patch][side.edge];
  }

  bool check_edge(PatchSide side) {
    const PatchEdge& edge = at(side);
    const size_t used = importer::neighbour_count(edge.bind);
    if (used > 4) return fail("has a kind that does not exist; use 0, 1, 2, 4 or part");
    for (size_t k = 0; k < 4; ++k) {
      const PatchSide next = edge.next[k];
      if (k >= used) {
        if (next != PatchSide{}) return fail("names more neighbours than it has; remove them");
        continue;
      }
      if (next.patch >= set_.patches.size() || next.edge > 3) {
        return fail(
            fmt::format("its neighbour is patch {} edge {}, which does not exist; name one "
                        "of {} patches and edge 0 to 3",
                        next.patch, next.edge, set_.patches.size()));
      }
      if (next == side) return fail("is its own neighbour; leave it open");
      for (size_t j = 0; j < k; ++j) {
        if (edge.next[j] == next) return fail("names the same neighbour twice; remove one");
      }
      if (!names_me(next, side, edge.bind)) {
        return fail(fmt::format("{}, edge {}, does not name it in return; bind both",
                                set_.name_of(next.patch), next.edge));
      }
      if (edge.bind != EdgeBind::kPart && !meets(side, next, k, used)) return false;
    }
    return true;
  }

  // Does `other` name `me`, and in the relation that holds between them?
  [[nodiscard]] bool names_me(PatchSide other, PatchSide me, EdgeBind mine) const {
    const PatchEdge& edge = at(other);
    if (mine == EdgeBind::kOne) return edge.bind == EdgeBind::kOne && edge.next[0] == me;
    if (mine == EdgeBind::kPart) {
      return (edge.bind == EdgeBind::kTwo || edge.bind == EdgeBind::kFour) &&
             std::find(edge.next.begin(), edge.next.end(), me) != edge.next.end();
    }
    return edge.bind == EdgeBind::kPart && edge.next[0] == me;
  }

  // Part k of n of the edge against the neighbour's edge, which runs in the opposite direction.
  bool meets(PatchSide side, PatchSide next, size_t k, size_t n) {
    const auto mine = set_.patches[side.patch].edge(static_cast<int32_t>(side.edge));
    const auto theirs = set_.patches[next.patch].edge(static_cast<int32_t>(next.edge));
    for (const double u : {0.0, 0.25, 0.5, 0.75, 1.0}) {
      const Vec3d a = cubic_point(mine, (static_cast<double>(k) + u) / static_cast<double>(n));
      const Vec3d b = cubic_point(theirs, 1 - u);
      const double gap = length(a - b);
      if (gap <= kWidestGap) continue;
      return fail(
          fmt::format("lies {:.3g} m from {}, edge {}, its neighbour; they must meet within "
                      "{} m and run in opposite directions",
                      gap, set_.name_of(next.patch), next.edge, kWidestGap));
    }
    return true;
  }

  const PatchSet& set_;
  std::string message_;
};

}  // namespace

void PatchSet::begin_run(std::string_view file, std::string_view node, std::string_view material,
                         uint8_t kind) {
  if (!runs.empty()) {
    const PatchRun& last = runs.back();
    if (last.file == file && last.node == node && last.material == material && last.kind == kind) {
      return;
    }
    if (last.patch_count == 0) runs.pop_back();
  }
  runs.push_back({.file = std::string(file),
                  .node = std::string(node),
                  .material = std::string(material),
                  .kind = kind,
                  .first_patch = static_cast<uint32_t>(patches.size()),
                  .patch_count = 0});
}

uint32_t PatchSet::add(const BezierPatch& patch) {
  if (runs.empty()) begin_run({}, {}, {});
  ++runs.back().patch_count;
  patches.push_back(patch);
  edges.emplace_back();
  return static_cast<uint32_t>(patches.size() - 1);
}

void PatchSet::bind(PatchSide a, PatchSide b) {
  edges[a.patch][a.edge] = {EdgeBind::kOne, {b}};
  edges[b.patch][b.edge] = {EdgeBind::kOne, {a}};
}

void PatchSet::bind_parts(PatchSide big, std::span<const PatchSide> parts) {
  THRONG_ASSERT(parts.size() == 2 || parts.size() == 4);
  PatchEdge& edge = edges[big.patch][big.edge];
  edge = {static_cast<EdgeBind>(parts.size()), {}};
  std::copy(parts.begin(), parts.end(), edge.next.begin());
  for (const PatchSide part : parts) edges[part.patch][part.edge] = {EdgeBind::kPart, {big}};
}

void PatchSet::append(const PatchSet& other) {
  const auto base = static_cast<uint32_t>(patches.size());
  patches.insert(patches.end(), other.patches.begin(), other.patches.end());
  edges.reserve(edges.size() + other.edges.size());
  for (std::array<PatchEdge, 4> four : other.edges) {
    for (PatchEdge& edge : four) {
      for (PatchSide& next : edge.next) next.patch += next.patch == kNoPatch ? 0 : base;
    }
    edges.push_back(four);
  }
  for (PatchRun run : other.runs) {
    run.first_patch += base;
    runs.push_back(std::move(run));
  }
}

std::string PatchSet::name_of(uint32_t patch) const {
  for (const PatchRun& run : runs) {
    if (patch < run.first_patch || patch - run.first_patch >= run.patch_count) continue;
    return fmt::format("{}: patch {}{}{}", run.file.empty() ? "patches" : run.file,
                       patch - run.first_patch, run.node.empty() ? "" : " of ", run.node);
  }
  return fmt::format("patches: patch {}", patch);
}

Result<void> check_patches(const PatchSet& set) { return PatchChecker(set).check(); }

std::vector<uint32_t> patch_components(const PatchSet& set) {
  std::vector<uint32_t> component(set.size(), kNoPatch);
  std::vector<uint32_t> stack;
  uint32_t count = 0;
  for (uint32_t p = 0; p < set.size(); ++p) {
    if (component[p] != kNoPatch) continue;
    component[p] = count;
    stack.push_back(p);
    while (!stack.empty()) {
      const uint32_t q = stack.back();
      stack.pop_back();
      for (const PatchEdge& edge : set.edges[q]) {
        for (const PatchSide next : edge.next) {
          if (next.patch == kNoPatch || component[next.patch] != kNoPatch) continue;
          component[next.patch] = count;
          stack.push_back(next.patch);
        }
      }
    }
    ++count;
  }
  return component;
}

}  // namespace throng
