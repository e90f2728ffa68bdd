// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "core/parallel.h"
#include "core/random.h"
#include "throng/verify.h"
#include "verify/check_limits.h"
#include "verify/claims.h"
#include "verify/cylinder.h"
#include "verify/triangle_tree.h"
#include "verify/turned_body.h"

// Nodes against the triangles. A body on a node stands along the place's axis: its exact cylinder,
// from where it climbs over things to its top, is turned upright together with the triangles near
// it and tested like any other. What a node promises must hold at every place of it, so also at
// those of the nodes inside it.
namespace throng {
namespace {

using verify::Corners;
using verify::Pose;
using verify::TriangleTree;

constexpr size_t kSampleBatch = 4096;  // samples between two tests of `cancel`
constexpr int kHoleLinkParts = 24;     // poses tested on a link over a hole
constexpr double kAngleMargin = 1e-3;  // of slopes, for planes at exactly a limit [degrees]

struct Sample {
  bool exists = false, entered = false, unsupported = false, steeper = false, lower = false;
  uint32_t arcs = 0, hole_links = 0, one_way = 0;
  Vec3d feet, entered_at;
  uint32_t triangle = 0;
};

class NodeJudge {
 public:
  NodeJudge(const Nodes& nodes, const Scene& scene, const VerifyConfig& config)
      : nodes_(nodes), config_(config), tree_(scene, config.workers), summary_(nodes.summary()) {
    for (const AvatarClass& avatar : summary_.classes) {
      greatest_bottom_ = std::max(greatest_bottom_, bottom_of(avatar));
    }
    avatar_ = summary_.classes[static_cast<size_t>(config.avatar_class)];
  }

  [[nodiscard]] Sample check(uint64_t n) const {
    Sample sample;
    const NodePlace place = nodes_.random_place(config_.avatar_class, config_.seed, n);
    if (!place) return sample;
    sample.exists = true;
    sample.feet = place.feet;
    look({place.feet, place.axis}, sample);
    sample.unsupported = !verify::turned_support(tree_, avatar_, place.feet);
    check_promises(place, sample);
    check_arcs(place.node1 - 1, n, sample);
    return sample;
  }

 private:
  static double bottom_of(const AvatarClass& avatar) {
    return avatar.climb_slope > 0 ? avatar.step_height : body_bottom(avatar);
  }

  void look(const Pose& pose, Sample& sample) const {
    const auto triangle = verify::turned_intruder(tree_, avatar_, pose);
    if (!triangle) return;
    if (!sample.entered) {
      sample.entered_at = pose.feet;
      sample.triangle = *triangle;
    }
    sample.entered = true;
  }

  // Free height from `from` above the feet, up to `max_height`. [m]
  [[nodiscard]] double free_height(const Pose& pose, double from, double max_height) const {
    double lowest = max_height;
    verify::for_each_turned(tree_, pose, 0.01, max_height, [&](uint32_t, const Corners& corners) {
      const auto height = verify::height_at(corners, 0, 0);
      if (height && *height > from && *height < lowest) lowest = *height;
      return false;
    });
    return lowest;
  }

  void check_promises(const NodePlace& place, Sample& sample) const {
    const double slope = std::acos(std::clamp(place.normal.y, -1.0, 1.0)) * 180 / std::numbers::pi;
    const NodeBins& bins = summary_.bins;
    for (uint32_t node1 = place.node1; node1 != 0;) {
      const NodeInfo info = nodes_.node(node1 - 1);
      const double height = bins.height_of(info.height), headroom = bins.height_of(info.headroom);
      if (info.kind == PatchKind::kBezier) {
        sample.steeper |= slope > bins.inclination_of(info.inclination) + kAngleMargin;
        sample.lower |=
            free_height({place.feet, place.normal}, greatest_bottom_, height) < height - 1e-6;
        sample.lower |=
            free_height({place.feet, {0, 1, 0}}, greatest_bottom_, headroom) < headroom - 1e-6;
      } else {
        const double from = body_bottom(avatar_);
        sample.lower |= free_height({place.feet, {0, 1, 0}}, from, headroom) < headroom - 2e-3;
      }
      node1 = info.parent1;
    }
  }

  // One arc of the node, drawn at random, and its hole link if it has one. Off-mesh links are not
  // tested.
  void check_arcs(uint32_t node, uint64_t n, Sample& sample) const {
    std::vector<NodeArc> arcs = nodes_.arcs(node);
    std::erase_if(arcs, [&](const NodeArc& a) {
      return (a.classes >> config_.avatar_class & 1) == 0 || a.kind == LinkKind::kOffMesh;
    });
    if (arcs.empty()) return;
    const NodeArc& arc = arcs[random_below(config_.seed, n, 9, arcs.size())];
    sample.arcs = 1;
    const bool drops = arc.kind == LinkKind::kDrop;
    if (!drops) {
      const std::vector<NodeArc> back = nodes_.arcs(arc.to);
      const bool returns = std::any_of(back.begin(), back.end(), [&](const NodeArc& b) {
        return b.to == node && b.kind == arc.kind && b.classes == arc.classes;
      });
      sample.one_way = returns ? 0 : 1;
    }
    if (!arc.over_hole) return;
    sample.hole_links = 1;
    const int32_t c = config_.avatar_class;
    const NodePlace from = nodes_.place(c, node, arc.from_s, arc.from_t);
    const NodePlace to = nodes_.place(c, arc.to, arc.to_s, arc.to_t);
    if (!from || !to) {
      sample.unsupported = true;
      return;
    }
    const Pose begin{from.feet, from.axis}, end{to.feet, to.axis};
    if (!drops) {
      look_between(begin, end, sample);
      return;
    }
    const Pose over{{end.feet.x, begin.feet.y, end.feet.z}, {0, 1, 0}};
    look_between(begin, over, sample);
    look_between(over, end, sample);
    // What the class needs, and no more.
    const double down = begin.feet.y - end.feet.y;
    if (!(down > 0 && down <= avatar_.max_drop + 1e-9)) sample.one_way = 1;
  }

  void look_between(const Pose& from, const Pose& to, Sample& sample) const {
    for (int k = 0; k <= kHoleLinkParts; ++k) {
      const double t = static_cast<double>(k) / kHoleLinkParts;
      const Vec3d axis = from.axis * (1 - t) + to.axis * t;
      look({from.feet * (1 - t) + to.feet * t, axis * (1 / length(axis))}, sample);
    }
  }

  const Nodes& nodes_;
  const VerifyConfig& config_;
  const TriangleTree tree_;
  NodeSummary summary_;
  AvatarClass avatar_;
  double greatest_bottom_ = 0;
};

}  // namespace

Result<NodeVerifyReport> verify_nodes(const Nodes& nodes, const Scene& source,
                                      const VerifyConfig& config, Context& context) {
  const auto start = std::chrono::steady_clock::now();
  if (auto sound = verify::check_source(source, config); !sound) return sound.error();
  const size_t classes = nodes.summary().classes.size();
  if (config.avatar_class < 0 || static_cast<size_t>(config.avatar_class) >= classes) {
    return Error{Errc::kBadConfig, "verify: the world has no avatar class " +
                                       std::to_string(config.avatar_class) + "; it has " +
                                       std::to_string(classes)};
  }
  const NodeJudge judge(nodes, source, config);
  NodeVerifyReport report;
  std::vector<Sample> samples;
  for (uint64_t begin = 0; begin < config.samples; begin += kSampleBatch) {
    if (context.cancel) return Error{Errc::kCancelled, "verify: cancelled"};
    if (context.on_progress) context.on_progress({"verify", begin, config.samples});
    samples.assign(std::min<uint64_t>(kSampleBatch, config.samples - begin), {});
    parallel_for(samples.size(), config.workers,
                 [&](size_t i) { samples[i] = judge.check(begin + i); });
    for (const Sample& s : samples) {
      const auto count = [&](bool bad, uint64_t& counter, const char* what, Vec3d at) {
        if (!bad) return;
        if (++counter <= verify::kFaultsOfAKind) report.faults.push_back({what, at, s.triangle});
      };
      report.places += s.exists ? 1 : 0;
      report.arcs += s.arcs;
      report.hole_links += s.hole_links;
      count(s.entered, report.entered, "entered", s.entered_at);
      count(s.unsupported, report.unsupported, "unsupported", s.feet);
      count(s.steeper, report.steeper, "steeper", s.feet);
      count(s.lower, report.lower, "lower", s.feet);
      count(s.one_way != 0, report.one_way, "one way", s.feet);
    }
  }
  report.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return report;
}

}  // namespace throng
