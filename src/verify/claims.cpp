// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "verify/claims.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "core/parallel.h"
#include "verify/body_check.h"
#include "verify/check_limits.h"
#include "verify/samples.h"
#include "verify/surface_sampler.h"
#include "verify/triangle_tree.h"

// Three runs over random samples: states, moves, and points of the source's surfaces. Each sample
// is a pure function of (seed, its number) and writes its own record; records are summed in order,
// so the report is the same for any number of workers.
namespace throng::verify {
namespace {

constexpr size_t kBatch = 8192;                ///< Samples between two tests of `cancel`.
constexpr uint64_t kSurfaceSalt = 0x73757266;  ///< Not the stream of the world's places.

/// Share of one body's standable samples that were lost, from counts.
struct Share {
  uint64_t standable = 0;
  uint64_t lost = 0;
  uint64_t isolated = 0;

  void add(Stand stand) {
    standable += stand != Stand::kNo;
    lost += stand == Stand::kLost;
    isolated += stand == Stand::kIsolated;
  }
  [[nodiscard]] double of(uint64_t part) const {
    return standable > 0 ? static_cast<double>(part) / static_cast<double>(standable) : 0;
  }
  [[nodiscard]] double standard_error() const {
    const double p = of(lost);
    return standable > 0 ? std::sqrt(p * (1 - p) / static_cast<double>(standable)) : 0;
  }
};

class Judge {
 public:
  Judge(const Claims& claims, const Scene& scene, const VerifyConfig& config, Context& context)
      : claims_(claims), config_(config), context_(context), tree_(scene, config.workers) {}

  Result<VerifyReport> run() {
    if (!states() || !moves() || !surfaces()) {
      return Error{Errc::kCancelled, "verify: cancelled"};
    }
    return report_;
  }

 private:
  // Makes a check for each piece of a batch with check(), calls it for each sample of the piece in
  // parallel, then consume(record) in order. False if cancelled.
  template <class Record, class Check, class Consume>
  bool for_each_sample(Check check, Consume consume) {
    std::vector<Record> records;
    constexpr size_t kGrain = 64;
    for (uint64_t begin = 0; begin < config_.samples; begin += kBatch) {
      if (context_.cancel) return false;
      if (context_.on_progress) context_.on_progress({"verify", done_, 3 * config_.samples});
      const auto count = static_cast<size_t>(std::min<uint64_t>(kBatch, config_.samples - begin));
      records.assign(count, {});
      parallel_ranges(count, kGrain, config_.workers, [&](size_t first, size_t last) {
        auto check_one = check();
        for (size_t i = first; i < last; ++i) records[i] = check_one(begin + i);
      });
      for (const Record& record : records) consume(record);
      done_ += count;
    }
    return true;
  }

  void fault(const char* what, Vec3d position, uint32_t triangle) {
    const auto same = std::count_if(report_.faults.begin(), report_.faults.end(),
                                    [&](const VerifyFault& f) { return f.what == what; });
    if (static_cast<size_t>(same) < kFaultsOfAKind) {
      report_.faults.push_back({what, position, triangle});
    }
  }

  bool states() {
    const BodyCheck body(tree_, claims_.avatar, claims_.cell);
    std::vector<double> errors;
    const bool finished = for_each_sample<StateRecord>(
        [&] { return [&](uint64_t n) { return check_state(claims_, body, config_.seed, n); }; },
        [&](const StateRecord& r) {
          if (!r.exists) return;
          ++report_.states;
          report_.entered += r.entered;
          report_.unsupported += r.unsupported;
          if (r.entered) fault("entered", r.feet, r.intruder);
          if (r.unsupported) fault("unsupported", r.feet, 0);
          if (r.feet_error) {
            errors.push_back(*r.feet_error);
          } else {
            ++report_.no_surface_under_centre;
          }
        });
    if (!errors.empty()) {
      double sum = 0;
      for (const double e : errors) sum += e;
      report_.feet_error_mean = sum / static_cast<double>(errors.size());
      const auto rank = errors.begin() + static_cast<ptrdiff_t>((errors.size() - 1) * 95 / 100);
      std::nth_element(errors.begin(), rank, errors.end());
      report_.feet_error_p95 = *rank;
    }
    return finished;
  }

  bool moves() {
    const BodyCheck body(tree_, claims_.avatar, claims_.cell);
    return for_each_sample<MoveRecord>(
        [&] {
          return [&](uint64_t n) {
            return check_move(claims_, body, config_.seed, config_.samples + n);
          };
        },
        [&](const MoveRecord& r) {
          if (!r.legal) return;
          ++report_.moves;
          report_.entered += r.segment.entered;
          report_.unsupported += r.segment.unsupported;
          report_.broken += r.segment.broken;
          if (r.segment.entered) fault("entered", r.segment.entered_at, r.segment.intruder);
          if (r.segment.unsupported) fault("unsupported", r.segment.unsupported_at, 0);
          if (r.segment.broken) fault("broken", r.segment.broken_at, 0);
        });
  }

  bool surfaces() {
    const SurfaceSampler sampler(tree_.scene(), levelness_limit(claims_.avatar));
    if (!(sampler.area() > 0)) return true;
    struct SurfaceRecord {
      PointRecord stand;
      SurfaceSampler::Point point;
    };
    Share exact, grown;
    const bool finished = for_each_sample<SurfaceRecord>(
        [&] {
          return [&, check = PointCheck(claims_, tree_)](uint64_t n) mutable {
            const auto point = sampler.point(config_.seed ^ kSurfaceSalt, n);
            return SurfaceRecord{check.check(point.position), point};
          };
        },
        [&](const SurfaceRecord& r) {
          ++report_.surface_points;
          exact.add(r.stand.exact);
          grown.add(r.stand.grown);
          if (r.stand.grown == Stand::kLost) fault("lost", r.point.position, r.point.triangle);
        });
    const double area_of_a_point =
        sampler.area() / static_cast<double>(std::max<uint64_t>(report_.surface_points, 1));
    report_.lost_grown = grown.of(grown.lost);
    report_.lost_grown_error = grown.standard_error();
    report_.isolated_grown = grown.of(grown.isolated);
    report_.standable_area_grown = static_cast<double>(grown.standable) * area_of_a_point;
    report_.lost_exact = exact.of(exact.lost);
    report_.lost_exact_error = exact.standard_error();
    report_.isolated_exact = exact.of(exact.isolated);
    report_.standable_area_exact = static_cast<double>(exact.standable) * area_of_a_point;
    return finished;
  }

  const Claims& claims_;
  const VerifyConfig& config_;
  Context& context_;
  const TriangleTree tree_;
  VerifyReport report_;
  uint64_t done_ = 0;
};

}  // namespace

Result<void> check_source(const Scene& scene, const VerifyConfig& config) {
  if (config.samples == 0 || config.samples > (uint64_t{1} << 40) || config.workers < 0) {
    return Error{Errc::kBadConfig, "verify: need 1 to 2^40 samples and workers >= 0"};
  }
  if (scene.triangles.empty()) {
    return Error{Errc::kBadInput, "verify: the source has no triangles; is it the right file?"};
  }
  if (scene.triangles.size() > std::numeric_limits<uint32_t>::max() / 2) {
    return Error{Errc::kLimit, "verify: the source has over 2^31 triangles; verify it in parts"};
  }
  if (scene.area.size() != scene.triangles.size()) {
    return Error{Errc::kBadInput, "verify: the source has " + std::to_string(scene.area.size()) +
                                      " area kinds for " + std::to_string(scene.triangles.size()) +
                                      " triangles; there must be one each"};
  }
  for (size_t t = 0; t < scene.triangles.size(); ++t) {
    for (const uint32_t p : scene.triangles[t]) {
      constexpr double kMaxCoordinate = 1e9;
      const auto is_sound = [](double v) { return std::fabs(v) <= kMaxCoordinate; };
      if (p < scene.positions.size() && is_sound(scene.positions[p].x) &&
          is_sound(scene.positions[p].y) && is_sound(scene.positions[p].z)) {
        continue;
      }
      return Error{Errc::kBadInput, "verify: triangle " + std::to_string(t) +
                                        " of the source has a corner that is missing, not finite "
                                        "or over 1e9 m away; remove it"};
    }
  }
  return {};
}

Result<VerifyReport> verify_proposals(const Claims& claims, const Scene& source,
                                      const VerifyConfig& config, Context& context) {
  const auto start = std::chrono::steady_clock::now();
  if (auto sound = check_source(source, config); !sound) return sound.error();
  if (!(claims.cell > 0) || !(claims.resolution >= 0)) {
    return Error{Errc::kBadConfig, "verify: the world's cell and resolution are not positive"};
  }
  auto report = Judge(claims, source, config, context).run();
  if (report) {
    report->seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  }
  return report;
}

}  // namespace throng::verify
