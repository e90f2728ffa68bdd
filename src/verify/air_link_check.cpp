// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>
#include <optional>
#include <vector>

#include "core/parallel.h"
#include "core/random.h"
#include "throng/path.h"
#include "throng/verify.h"
#include "verify/claims.h"
#include "verify/cylinder.h"
#include "verify/triangle_tree.h"

// The oracle of links between the air and the ground: the exact body on its whole rise from the
// node into the leaf, which is its landing, too; both directions of a link; and from random places
// on nodes, whether the leaf above leads back to the ground.
namespace throng {
namespace {

constexpr uint64_t kMaxFaults = 8;
constexpr uint64_t kBatch = 4096;
constexpr uint64_t kPlacesSalt = 0x6c656176;

struct LinkSample {
  bool link = false, place = false;
  const char* fault = nullptr;
  Vec3d at;
  uint32_t triangle = 0;
};

class AirLinkJudge {
 public:
  AirLinkJudge(const AirLinks& links, const Nodes& nodes, const verify::TriangleTree& tree,
               int32_t avatar_class)
      : links_(links),
        nodes_(nodes),
        tree_(tree),
        class_(avatar_class),
        avatar_(nodes.world().summary().classes[static_cast<size_t>(avatar_class)]) {}

  void judge_link(const AirLink& link, PathFinder& finder, LinkSample& sample) const {
    if (!is_for_class(link)) return;
    sample.link = true;
    sample.at = link.feet;
    const NodePlace place = nodes_.place(class_, link.node, link.s, link.t);
    const std::optional<Vec3d> up = place ? take_off(finder, place) : std::nullopt;
    if (!up || up->y > place.feet.y + avatar_.height + 1e-9) {
      sample.fault = "no take-off";
      return;
    }
    const verify::Cylinder body{.x = up->x,
                                .z = up->z,
                                .low = std::min(place.feet.y + body_bottom(avatar_), up->y),
                                .high = up->y + avatar_.height,
                                .radius = avatar_.radius};
    const bool entered =
        tree_.find(body.bounds(), [&](uint32_t triangle, const verify::Corners& corners) {
          if (!verify::meets(body, corners)) return false;
          sample.triangle = triangle;
          return true;
        });
    if (entered) {
      sample.fault = "entered";
      return;
    }
    // From the leaf to the node, and from the node to the leaf.
    if (!has(links_.of_leaf(*up), link) || !has(links_.of_node(link.node), link)) {
      sample.fault = "one way";
    }
  }

  // The middle of the cell that holds a random place.
  void judge_place(uint64_t seed, uint64_t n, PathFinder& finder, LinkSample& sample) const {
    const NodePlace random = nodes_.random_place(class_, seed, n);
    if (!random) return;
    const double side = 1 << nodes_.node(random.node1 - 1).depth;
    const auto middle = [&](double at) {
      return (std::min(std::floor(at * side), side - 1) + 0.5) / side;
    };
    const NodePlace place =
        nodes_.place(class_, random.node1 - 1, middle(random.s), middle(random.t));
    if (!place) return;
    const auto up = take_off(finder, place);
    if (!up) return;
    sample.place = true;
    sample.at = place.feet;
    const std::vector<AirLink> found = links_.of_leaf(*up);
    const auto count = std::count_if(found.begin(), found.end(),
                                     [&](const AirLink& link) { return is_for_class(link); });
    if (count != 1) sample.fault = "sink";
  }

 private:
  [[nodiscard]] bool is_for_class(const AirLink& link) const {
    return (link.classes >> class_ & 1) != 0;
  }
  // Straight up from the feet, whatever the ground is made of.
  [[nodiscard]] static std::optional<Vec3d> take_off(PathFinder& finder, const NodePlace& place) {
    return finder.take_off(Place{.position = place.feet, .level1 = 1});
  }
  static bool has(const std::vector<AirLink>& links, const AirLink& link) {
    return std::any_of(links.begin(), links.end(), [&](const AirLink& other) {
      return other.leaf_id == link.leaf_id && other.node == link.node &&
             other.classes == link.classes && other.s == link.s && other.t == link.t;
    });
  }

  const AirLinks& links_;
  const Nodes& nodes_;
  const verify::TriangleTree& tree_;
  int32_t class_;
  AvatarClass avatar_;
};

void add(const LinkSample& sample, AirLinkReport& report) {
  report.links += sample.link ? 1 : 0;
  report.places += sample.place ? 1 : 0;
  if (sample.fault == nullptr) return;
  const std::string what = sample.fault;
  report.blocked += what == "no take-off" ? 1 : 0;
  report.entered += what == "entered" ? 1 : 0;
  report.one_way += what == "one way" ? 1 : 0;
  report.sinks += what == "sink" ? 1 : 0;
  if (report.faults.size() < kMaxFaults)
    report.faults.push_back({what, sample.at, sample.triangle});
}

}  // namespace

Result<AirLinkReport> verify_air_links(const AirLinks& links, const Nodes& nodes,
                                       const Scene& source, const VerifyConfig& config,
                                       Context& context) {
  const auto start = std::chrono::steady_clock::now();
  if (auto sound = verify::check_source(source, config); !sound) return sound.error();
  auto finder = PathFinder::create(
      nodes.world(),
      {.avatar_class = config.avatar_class, .workers = config.workers, .space = PathSpace::kAir},
      context);
  if (!finder) return finder.error();
  const verify::TriangleTree tree(source, config.workers);
  const AirLinkJudge judge(links, nodes, tree, config.avatar_class);
  const uint64_t count = links.summary().links;
  std::vector<std::unique_ptr<PathFinder>> finders;
  for (int32_t i = 0; i < worker_count(config.workers); ++i) {
    finders.push_back(std::make_unique<PathFinder>(*finder));
  }
  AirLinkReport report;
  std::vector<LinkSample> samples;
  for (uint64_t begin = 0; begin < config.samples; begin += kBatch) {
    if (context.cancel) return Error{Errc::kCancelled, "verify: cancelled"};
    if (context.on_progress) context.on_progress({"verify", begin, config.samples});
    samples.assign(std::min(kBatch, config.samples - begin), {});
    parallel_for_worker(samples.size(), config.workers, [&](size_t i, int32_t w) {
      PathFinder& own = *finders[static_cast<size_t>(w)];
      const uint64_t n = begin + i;
      if (n % 2 != 0) return judge.judge_place(config.seed ^ kPlacesSalt, n, own, samples[i]);
      if (count == 0) return;
      const auto link = links.link(random_below(config.seed, n, 0, count));
      if (link) judge.judge_link(*link, own, samples[i]);
    });
    for (const LinkSample& sample : samples) add(sample, report);
  }
  report.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return report;
}

}  // namespace throng
