// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "import/raw/clean.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <mutex>
#include <utility>

#include "core/corner_box.h"
#include "core/function_ref.h"
#include "core/hash.h"
#include "core/parallel.h"
#include "import/raw/raw_scene.h"
#include "import/raw/scene_triangles.h"

// Removes what a bake cannot use and counts what is suspicious. Each test is one pass over the
// triangles; only the search for duplicates sorts.
namespace throng::importer {
namespace {

constexpr double kMaxCoordinate = 1e9;  // [m] Beyond it a double keeps less than a micrometre.
constexpr double kLargestWorld = 1e6;   // [m] 1000 km.
constexpr double kSpikeLength = 1000;   // [m] Shorter ones are harmless.

// Calls look(begin, end, share) for ranges of all triangles in parallel, and add(share) for each
// share, one at a time and in no fixed order: add must not depend on the order.
template <class Share, class Look>
void share_out(size_t triangles, Look look, FunctionRef<void(Share&)> add) {
  constexpr size_t kGrain = 1 << 16;
  std::mutex mutex;
  parallel_ranges(triangles, kGrain, 0, [&](size_t begin, size_t end) {
    Share share{};
    look(begin, end, share);
    const std::scoped_lock lock(mutex);
    add(share);
  });
}

template <class IsCounted>
uint64_t count_triangles(const Scene& scene, IsCounted is_counted) {
  uint64_t sum = 0;
  share_out<uint64_t>(
      scene.triangles.size(),
      [&](size_t begin, size_t end, uint64_t& share) {
        for (size_t t = begin; t < end; ++t) share += is_counted(t) ? 1 : 0;
      },
      [&](uint64_t& share) { sum += share; });
  return sum;
}

bool is_finite(Vec3d p) { return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z); }

double largest_side(const Box3d& box) {
  if (box.empty()) return 0;
  const Vec3d size = box.max - box.min;
  return std::max({size.x, size.y, size.z});
}

// Keeps the triangles for which keep(t) is true and adapts the ranges of the parts.
template <class Keep>
void filter_triangles(Scene& scene, Keep keep) {
  size_t kept = 0;
  size_t done = 0;
  const auto move_range = [&](size_t end) {
    for (; done < end; ++done) {
      if (!keep(done)) continue;
      move_triangle(scene, done, kept);
      ++kept;
    }
  };
  std::vector<ScenePart> parts;
  for (ScenePart& part : scene.parts) {
    move_range(part.first_triangle);
    const auto first = static_cast<uint32_t>(kept);
    move_range(size_t{part.first_triangle} + part.triangle_count);
    part.first_triangle = first;
    part.triangle_count = static_cast<uint32_t>(kept) - first;
    if (part.triangle_count > 0) parts.push_back(std::move(part));
  }
  move_range(scene.triangles.size());
  scene.parts = std::move(parts);
  keep_triangles(scene, kept);
}

void drop_broken(Scene& scene) {
  const size_t vertices = scene.positions.size();
  const uint64_t broken = count_triangles(scene, [&](size_t t) {
    for (const uint32_t corner : scene.triangles[t]) {
      if (corner >= vertices || !is_finite(scene.positions[corner])) return true;
    }
    return false;
  });
  if (broken == 0) {
    std::erase_if(scene.parts, [](const ScenePart& part) { return part.triangle_count == 0; });
    return;
  }
  filter_triangles(scene, [&](size_t t) {
    const auto& corners = scene.triangles[t];
    for (const uint32_t corner : corners) {
      if (corner < vertices) continue;
      ++scene.report.bad_index;
      return false;
    }
    for (const uint32_t corner : corners) {
      if (is_finite(scene.positions[corner])) continue;
      ++scene.report.non_finite;
      return false;
    }
    return true;
  });
}

bool uses_all_vertices(const Scene& scene) {
  std::vector<uint8_t> used(scene.positions.size(), 0);
  parallel_ranges(scene.triangles.size(), size_t{1} << 16, 0, [&](size_t begin, size_t end) {
    for (size_t t = begin; t < end; ++t) {
      // Many threads write the same.
      for (const uint32_t corner : scene.triangles[t]) {
        __atomic_store_n(&used[corner], uint8_t{1}, __ATOMIC_RELAXED);
      }
    }
  });
  return std::find(used.begin(), used.end(), 0) == used.end();
}

void drop_unused_vertices(Scene& scene) {
  if (uses_all_vertices(scene)) return;
  std::vector<uint32_t> renamed(scene.positions.size(), kNoVertex);
  for (const auto& corners : scene.triangles) {
    for (const uint32_t corner : corners) renamed[corner] = 0;
  }
  uint32_t kept = 0;
  for (size_t i = 0; i < renamed.size(); ++i) {
    if (renamed[i] == kNoVertex) continue;
    scene.positions[kept] = scene.positions[i];
    renamed[i] = kept++;
  }
  scene.positions.resize(kept);
  for (auto& corners : scene.triangles) {
    for (uint32_t& corner : corners) corner = renamed[corner];
  }
}

// Triangles without area. They stay: a wire is solid.
uint64_t count_degenerate(const Scene& scene) {
  return count_triangles(scene, [&](size_t t) {
    const auto& [ia, ib, ic] = scene.triangles[t];
    const Vec3d a = scene.positions[ia];
    const Vec3d ab = scene.positions[ib] - a;
    const Vec3d ac = scene.positions[ic] - a;
    const Vec3d normal = cross(ab, ac);
    const double longest = std::max(dot(ab, ab), dot(ac, ac));
    return !(dot(normal, normal) > 1e-20 * longest * longest);
  });
}

// Counts triangles whose three corners, in any order, are those of an earlier one: one 64-bit hash
// a triangle, sorted. Among ten million triangles two different ones share a hash with probability
// 3e-6. Triangles of patches are left out: a patch is cut once, and comparing them took three
// quarters of the time in which a landscape is read.
uint64_t count_duplicates(const Scene& scene) {
  std::vector<uint64_t> hashes;
  if (scene.patches.empty()) hashes.reserve(scene.triangles.size());
  for (size_t t = 0; t < scene.triangles.size(); ++t) {
    if (!scene.patch_of_triangle.empty() && scene.patch_of_triangle[t] != kNoPatch) continue;
    const auto& corners = scene.triangles[t];
    std::array<std::array<uint64_t, 3>, 3> bits;
    for (int k = 0; k < 3; ++k) {
      const Vec3d p = scene.positions[corners[k]];
      // Adding zero makes -0 and 0 the same bits.
      bits[k] = {std::bit_cast<uint64_t>(p.x + 0.0), std::bit_cast<uint64_t>(p.y + 0.0),
                 std::bit_cast<uint64_t>(p.z + 0.0)};
    }
    std::sort(bits.begin(), bits.end());
    hashes.push_back(hash_bytes(bits.data(), sizeof bits));
  }
  std::sort(hashes.begin(), hashes.end());
  uint64_t count = 0;
  for (size_t i = 1; i < hashes.size(); ++i) count += hashes[i] == hashes[i - 1] ? 1 : 0;
  return count;
}

// A spike is a thin triangle over 1 km long and ten times longer than the box of all others: one of
// its corners is wrong. The box grows by the shorter candidates first, so a model that really is
// kilometres large has no spikes.
Box3d count_spikes(Scene& scene) {
  using Candidates = std::vector<std::pair<double, uint32_t>>;
  struct Share {
    Box3d box;
    Candidates candidates;
  };
  Box3d box;
  Candidates candidates;
  const auto look = [&](size_t t, Share& share) {
    const auto& [ia, ib, ic] = scene.triangles[t];
    const Vec3d a = scene.positions[ia];
    const Vec3d b = scene.positions[ib];
    const Vec3d c = scene.positions[ic];
    const std::array<double, 3> sides{dot(b - a, b - a), dot(c - b, c - b), dot(a - c, a - c)};
    const double longest = *std::max_element(sides.begin(), sides.end());
    const double shortest = *std::min_element(sides.begin(), sides.end());
    if (longest > kSpikeLength * kSpikeLength && shortest < 0.01 * longest) {
      share.candidates.emplace_back(std::sqrt(longest), static_cast<uint32_t>(t));
      return;
    }
    for (const Vec3d& p : {a, b, c}) share.box.add(p);
  };
  share_out<Share>(
      scene.triangles.size(),
      [&](size_t begin, size_t end, Share& share) {
        for (size_t t = begin; t < end; ++t) look(t, share);
      },
      [&](Share& share) {
        if (!share.box.empty()) {
          box.add(share.box.min);
          box.add(share.box.max);
        }
        candidates.insert(candidates.end(), share.candidates.begin(), share.candidates.end());
      });
  std::sort(candidates.begin(), candidates.end());
  for (const auto& [length_of, t] : candidates) {
    if (!box.empty() && length_of > 10 * length(box.max - box.min)) {
      ++scene.report.spikes;
      continue;
    }
    for (const uint32_t corner : scene.triangles[t]) box.add(scene.positions[corner]);
  }
  return box;
}

// The box that holds the middle 98 of 100 vertices on each axis, by at most a million samples.
Box3d bulk_box(const Scene& scene) {
  const size_t stride = scene.positions.size() / 1'000'000 + 1;
  struct Axis {
    double Vec3d::*of;
    double low = 0, high = 0;
  };
  std::array<Axis, 3> axes{{{&Vec3d::x}, {&Vec3d::y}, {&Vec3d::z}}};
  parallel_for(axes.size(), 0, [&](size_t a) {
    Axis& axis = axes[a];
    std::vector<double> values;
    values.reserve(scene.positions.size() / stride + 1);
    for (size_t i = 0; i < scene.positions.size(); i += stride) {
      values.push_back(scene.positions[i].*axis.of);
    }
    const size_t tail = values.size() / 100;
    std::nth_element(values.begin(), values.begin() + static_cast<ptrdiff_t>(tail), values.end());
    axis.low = values[tail];
    const size_t top = values.size() - 1 - tail;
    std::nth_element(values.begin(), values.begin() + static_cast<ptrdiff_t>(top), values.end());
    axis.high = values[top];
  });
  return {{axes[0].low, axes[1].low, axes[2].low}, {axes[0].high, axes[1].high, axes[2].high}};
}

uint64_t count_outside(const Scene& scene, const Box3d& bulk, double margin) {
  return count_triangles(scene, [&](size_t t) {
    for (const uint32_t corner : scene.triangles[t]) {
      const Vec3d p = scene.positions[corner];
      const double away = std::max({bulk.min.x - p.x, p.x - bulk.max.x, bulk.min.y - p.y,
                                    p.y - bulk.max.y, bulk.min.z - p.z, p.z - bulk.max.z});
      if (away > margin) return true;
    }
    return false;
  });
}

void warn_of_dropped(Scene& scene, const std::string& name) {
  const SceneReport& report = scene.report;
  const uint64_t dropped = report.non_finite + report.bad_index;
  if (dropped == 0) return;
  scene.report.warnings.push_back(fmt::format(
      "{}: {} of {} triangles are left out: {} with corners that are not finite, {} with "
      "bad indices",
      name, dropped, report.triangles_read, report.non_finite, report.bad_index));
}

// `side`: of the model without its spikes. Not called for an empty scene. [m]
Result<void> clean(Scene& scene, const std::string& name, Context& context, double& side) {
  const SceneReport& report = scene.report;
  warn_of_dropped(scene, name);
  drop_unused_vertices(scene);
  if (context.cancel) return Error{Errc::kCancelled, "cancelled while cleaning"};
  const Box3d all = corner_box(scene.positions, scene.triangles, 0);
  for (const double value : {all.min.x, all.min.y, all.min.z, all.max.x, all.max.y, all.max.z}) {
    if (std::fabs(value) <= kMaxCoordinate) continue;
    return Error{Errc::kBadInput,
                 fmt::format("{}: a vertex lies {:.3g} km from the origin; remove it, or give the "
                             "scale if the unit is not the metre",
                             name, std::fabs(value) / 1000)};
  }
  scene.report.degenerate += count_degenerate(scene);
  scene.report.duplicate += count_duplicates(scene);
  if (context.cancel) return Error{Errc::kCancelled, "cancelled while cleaning"};

  const uint64_t spikes_before = report.spikes;
  const Box3d box = count_spikes(scene);
  const uint64_t spikes = report.spikes - spikes_before;
  const Box3d bulk = bulk_box(scene);
  const double bulk_side = std::max(largest_side(bulk), 1.0);
  const double margin = std::max(10 * bulk_side, kSpikeLength);
  const uint64_t outside = count_outside(scene, bulk, margin);
  if (largest_side(all) > kLargestWorld && outside + spikes > 0) {
    return Error{Errc::kBadInput,
                 fmt::format("{}: {} triangles reach {:.4g} km while the rest is {:.4g} km across; "
                             "remove them",
                             name, std::max(outside, spikes), largest_side(all) / 1000,
                             (spikes > 0 ? largest_side(box) : bulk_side) / 1000)};
  }
  if (spikes > 0) {
    scene.report.warnings.push_back(fmt::format(
        "{}: {} spikes, triangles up to {:.4g} km long beside a model of {:.4g} m; they are kept",
        name, spikes, largest_side(all) / 1000, largest_side(box)));
  } else if (outside > 0) {
    scene.report.warnings.push_back(
        fmt::format("{}: {} triangles lie more than {:.4g} km away from the rest; they are kept",
                    name, outside, margin / 1000));
  }
  side = spikes > 0 ? largest_side(box) : largest_side(all);
  return {};
}

}  // namespace

Error nothing_left(const SceneReport& report, const std::string& name) {
  return {Errc::kBadInput,
          fmt::format("{}: no triangle is left of {} ({} ignored, {} not finite, {} with bad "
                      "indices); check the file and the rules",
                      name, report.triangles_read, report.ignored, report.non_finite,
                      report.bad_index)};
}

void warn_of_size(SceneReport& report, const std::string& name, double side) {
  std::string what;
  if (side < 0.5) what = fmt::format("only {:.3g} m across", side);
  if (side > 200'000) what = fmt::format("{:.4g} km across", side / 1000);
  if (what.empty()) return;
  report.warnings.push_back(
      fmt::format("{}: the model is {}; if its unit is not the metre, give its scale", name, what));
}

Result<void> clean_scene(Scene& scene, const std::string& name, Context& context) {
  drop_broken(scene);
  if (scene.triangles.empty()) return nothing_left(scene.report, name);
  double side = 0;
  if (auto ok = clean(scene, name, context, side); !ok) return ok;
  warn_of_size(scene.report, name, side);
  return {};
}

Result<void> clean_part(Scene& scene, const std::string& name, Context& context) {
  drop_broken(scene);
  if (scene.triangles.empty()) {
    warn_of_dropped(scene, name);
    return {};
  }
  double side = 0;
  return clean(scene, name, context, side);
}

}  // namespace throng::importer
