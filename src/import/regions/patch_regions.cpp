// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "import/regions/patch_regions.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "core/corner_box.h"
#include "import/patches/patch_edges.h"
#include "import/patches/patch_scene.h"
#include "import/raw/scene_triangles.h"

// A patch is cut as among all others if those are there that share a corner with it, which decide
// where the corner lies, and the neighbours of these, which decide how their edges are divided:
// tessellate_patches looks no further. Beyond them edges are open, and what is cut there is thrown
// away.
namespace throng::importer {
namespace {

constexpr double kSquare = 64;  // least side of a square of the index [m]
constexpr double kStray = 0.2;  // of triangles beyond the bounds of their patch, at most [m]

template <class Value>
void sort_and_unite(std::vector<Value>& values) {
  std::sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end()), values.end());
}

}  // namespace

PatchRegions::PatchRegions(PatchSet set, const SceneConfig& config) : set_(std::move(set)) {
  config_.rules = config.rules;
  config_.curve_tolerance = config.curve_tolerance;
}

Result<std::unique_ptr<PatchRegions>> PatchRegions::create(PatchSet set, const SceneConfig& config,
                                                           Context& context) {
  if (auto ok = check_patches(set); !ok) return ok.error();
  std::unique_ptr<PatchRegions> made(new PatchRegions(std::move(set), config));
  made->index();
  if (auto ok = made->count(context); !ok) return ok.error();
  return made;
}

void PatchRegions::index() {
  const auto count = static_cast<uint32_t>(set_.size());
  run_of_.resize(count);
  for (uint32_t r = 0; r < set_.runs.size(); ++r) {
    const auto first = run_of_.begin() + set_.runs[r].first_patch;
    std::fill(first, first + set_.runs[r].patch_count, r);
  }
  corner_of_ = weld_corners(set_);
  corner_first_.assign(corner_of_.size() + 1, 0);
  for (const uint32_t corner : corner_of_) ++corner_first_[corner + 1];
  std::inclusive_scan(corner_first_.begin(), corner_first_.end(), corner_first_.begin());
  corner_patches_.resize(corner_of_.size());
  std::vector<uint32_t> next(corner_first_.begin(), corner_first_.end() - 1);
  for (uint32_t i = 0; i < corner_of_.size(); ++i) corner_patches_[next[corner_of_[i]]++] = i / 4;

  Box3d all;
  boxes_.resize(count);
  std::vector<Vec3d> middle(count);
  for (uint32_t p = 0; p < count; ++p) {
    const Box3d box = set_.patches[p].bounds();
    const auto below = [](double v) { return std::nextafter(static_cast<float>(v), -INFINITY); };
    const auto above = [](double v) { return std::nextafter(static_cast<float>(v), INFINITY); };
    boxes_[p] = {below(box.min.x - kStray), below(box.min.z - kStray), above(box.max.x + kStray),
                 above(box.max.z + kStray)};
    middle[p] = (box.min + box.max) * 0.5;
    all.add(middle[p]);
    reach_ = std::max({reach_, box.max.x - middle[p].x, box.max.z - middle[p].z});
  }
  reach_ += 2 * kStray;
  x0_ = all.min.x;
  z0_ = all.min.z;
  // Few patches far apart need few squares.
  const double most = 16 + 4.0 * count;
  const double width = all.max.x - x0_, depth = all.max.z - z0_;
  for (side_ = kSquare; (width / side_ + 1) * (depth / side_ + 1) > most;) side_ *= 2;
  squares_x_ = static_cast<int32_t>(width / side_) + 1;
  squares_z_ = static_cast<int32_t>(depth / side_) + 1;
  const auto square_of = [&](Vec3d at) {
    const auto x = std::min(squares_x_ - 1, static_cast<int32_t>((at.x - x0_) / side_));
    const auto z = std::min(squares_z_ - 1, static_cast<int32_t>((at.z - z0_) / side_));
    return static_cast<size_t>(z) * static_cast<size_t>(squares_x_) + static_cast<size_t>(x);
  };
  square_first_.assign(static_cast<size_t>(squares_x_) * static_cast<size_t>(squares_z_) + 1, 0);
  for (const Vec3d& at : middle) ++square_first_[square_of(at) + 1];
  std::inclusive_scan(square_first_.begin(), square_first_.end(), square_first_.begin());
  square_patches_.resize(count);
  next.assign(square_first_.begin(), square_first_.end() - 1);
  for (uint32_t p = 0; p < count; ++p) square_patches_[next[square_of(middle[p])]++] = p;
}

// Some thousand patches at a time, square after square.
Result<void> PatchRegions::count(Context& context) {
  constexpr size_t kAtOnce = 4096;
  triangles_of_.resize(set_.size());
  std::vector<uint32_t> patches;
  for (size_t done = 0; done < square_patches_.size(); done += kAtOnce) {
    if (context.on_progress) context.on_progress({"read", done, square_patches_.size()});
    const auto first = square_patches_.begin() + static_cast<ptrdiff_t>(done);
    patches.assign(
        first, first + static_cast<ptrdiff_t>(std::min(kAtOnce, square_patches_.size() - done)));
    std::sort(patches.begin(), patches.end());
    const auto made = cut(patches, context);
    if (!made) return made.error();
    for (const uint32_t patch : made->scene.patch_of_triangle) {
      ++triangles_of_[made->number[patch]];
    }
    const Box3d box = corner_box(made->scene.positions, made->scene.triangles, 0);
    if (!box.empty()) {
      bounds_.add(box.min);
      bounds_.add(box.max);
    }
    triangles_ += made->scene.triangles.size();
  }
  return {};
}

std::vector<uint32_t> PatchRegions::find(const Box3d& box) const {
  std::vector<uint32_t> found;
  const auto square = [&](double at, int32_t squares) {
    return static_cast<int32_t>(std::clamp(std::floor(at / side_), 0.0, squares - 1.0));
  };
  const int32_t x0 = square(box.min.x - reach_ - x0_, squares_x_);
  const int32_t x1 = square(box.max.x + reach_ - x0_, squares_x_);
  const int32_t z0 = square(box.min.z - reach_ - z0_, squares_z_);
  const int32_t z1 = square(box.max.z + reach_ - z0_, squares_z_);
  for (int32_t z = z0; z <= z1; ++z) {
    const size_t row = static_cast<size_t>(z) * static_cast<size_t>(squares_x_);
    const uint32_t first = square_first_[row + static_cast<size_t>(x0)];
    const uint32_t last = square_first_[row + static_cast<size_t>(x1) + 1];
    for (uint32_t i = first; i < last; ++i) {
      const FlatBox& flat = boxes_[square_patches_[i]];
      if (flat.x0 <= box.max.x && flat.x1 >= box.min.x && flat.z0 <= box.max.z &&
          flat.z1 >= box.min.z) {
        found.push_back(square_patches_[i]);
      }
    }
  }
  std::sort(found.begin(), found.end());
  return found;
}

uint64_t PatchRegions::estimate(const Box3d& box) const {
  uint64_t sum = 0;
  for (const uint32_t patch : find(box)) sum += triangles_of_[patch];
  return sum;
}

std::vector<uint32_t> PatchRegions::with_neighbours(std::span<const uint32_t> patches) const {
  std::vector<uint32_t> around;
  for (const uint32_t patch : patches) {
    for (uint32_t v = 0; v < 4; ++v) {
      const uint32_t corner = corner_of_[4 * patch + v];
      around.insert(around.end(), corner_patches_.begin() + corner_first_[corner],
                    corner_patches_.begin() + corner_first_[corner + 1]);
    }
  }
  around.insert(around.end(), patches.begin(), patches.end());
  sort_and_unite(around);
  for (int ring = 0; ring < 2; ++ring) {
    for (size_t i = 0, count = around.size(); i < count; ++i) {
      for (const PatchEdge& edge : set_.edges[around[i]]) {
        for (const PatchSide& next : edge.next) {
          if (next.patch != kNoPatch) around.push_back(next.patch);
        }
      }
    }
    sort_and_unite(around);
  }
  return around;
}

PatchSet PatchRegions::subset(std::span<const uint32_t> patches) const {
  PatchSet out;
  out.patches.reserve(patches.size());
  out.edges.reserve(patches.size());
  const auto local = [&](uint32_t patch) {
    const auto at = std::lower_bound(patches.begin(), patches.end(), patch);
    return at != patches.end() && *at == patch ? static_cast<uint32_t>(at - patches.begin())
                                               : kNoPatch;
  };
  for (const uint32_t patch : patches) {
    if (out.runs.empty() || run_of_[patch] != run_of_[patches[out.size() - 1]]) {
      const PatchRun& run = set_.runs[run_of_[patch]];
      out.begin_run(run.file, run.node, run.material, run.kind);
    }
    out.add(set_.patches[patch]);
    out.edges.back() = set_.edges[patch];
  }
  // An edge without one of its neighbours is open, and so is that of the others.
  for (auto& edges : out.edges) {
    for (PatchEdge& edge : edges) {
      for (size_t n = 0; n < neighbour_count(edge.bind); ++n) {
        edge.next[n].patch = local(edge.next[n].patch);
      }
    }
  }
  for (auto& edges : out.edges) {
    for (PatchEdge& edge : edges) {
      const size_t count = neighbour_count(edge.bind);
      const bool is_whole =
          std::all_of(edge.next.begin(), edge.next.begin() + static_cast<ptrdiff_t>(count),
                      [](const PatchSide& next) { return next.patch != kNoPatch; });
      if (is_whole) continue;
      for (size_t n = 0; n < count; ++n) {
        const PatchSide next = edge.next[n];
        if (next.patch != kNoPatch) out.edges[next.patch][next.edge] = {};
      }
      edge = {};
    }
  }
  return out;
}

Result<PatchRegions::Cut> PatchRegions::cut(std::span<const uint32_t> patches,
                                            Context& context) const {
  Cut made;
  made.number = with_neighbours(patches);
  made.scene.patches = subset(made.number);
  if (auto ok = cut_patches(made.scene, config_, context); !ok) return ok.error();
  std::vector<uint8_t> is_wanted(made.number.size(), 0);
  for (size_t i = 0, k = 0; i < patches.size(); ++i) {
    while (made.number[k] != patches[i]) ++k;
    is_wanted[k] = 1;
  }
  size_t kept = 0;
  for (size_t t = 0; t < made.scene.triangles.size(); ++t) {
    if (is_wanted[made.scene.patch_of_triangle[t]] == 0) continue;
    move_triangle(made.scene, t, kept++);
  }
  keep_triangles(made.scene, kept);
  made.scene.parts.clear();
  return made;
}

Result<void> PatchRegions::append(const Box3d& box, uint32_t first_patch, SceneRegion& out,
                                  Context& context) const {
  const std::vector<uint32_t> patches = find(box);
  if (patches.empty()) return {};
  auto made = cut(patches, context);
  if (!made) return made.error();
  for (const uint32_t number : made->number) out.patch_number.push_back(first_patch + number);
  if (out.scene.triangles.empty() && out.scene.patches.empty()) {
    out.scene = std::move(made->scene);
  } else {
    out.scene.append(made->scene);
  }
  return {};
}

}  // namespace throng::importer
