// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <span>
#include <utility>
#include <vector>

#include "cluster/job_assignment.h"
#include "cluster/ranks.h"
#include "crowd/shared_crowd.h"
#include "throng/bake.h"
#include "throng/crowd.h"

// A crowd of all ranks that were started together.
namespace throng {
namespace {

class StartedTogether final : public RankGroup {
 public:
  static Result<StartedTogether*> join() {
    auto joined = cluster::Ranks::join();
    if (!joined) return joined.error();
    static StartedTogether group(**joined);
    return &group;
  }
  /// A rank's settings.
  [[nodiscard]] CrowdConfig own(CrowdConfig config) const {
    config.workers = cluster::workers_of_rank(config.workers, ranks_);
    return config;
  }
  [[nodiscard]] int32_t rank() const override { return ranks_.rank(); }
  [[nodiscard]] int32_t size() const override { return ranks_.size(); }
  std::span<const Bytes> gather(std::span<const uint8_t> mine) override {
    came_ = ranks_.gather(mine);
    return came_;
  }
  std::span<const Bytes> exchange(std::span<const int32_t> ranks,
                                  std::span<const Bytes> to) override {
    came_ = ranks_.exchange(ranks, to);
    return came_;
  }
  std::vector<int32_t> divide(std::span<const Weight> points) override {
    return ranks_.divide(points);
  }

 private:
  explicit StartedTogether(cluster::Ranks& ranks) : ranks_(ranks) {}

  cluster::Ranks& ranks_;
  std::vector<Bytes> came_;
};

}  // namespace

Result<Crowd> crowd_over_ranks(const World& world, const CrowdConfig& config) {
  if (rank_info().size <= 1) return Crowd::create(world, config);
  auto group = StartedTogether::join();
  if (!group) return group.error();
  return crowd::share_crowd(Crowd::create(world, (*group)->own(config)), **group);
}

Result<Crowd> restore_over_ranks(const World& world, const CrowdConfig& config,
                                 std::span<const uint8_t> saved, Context& context) {
  if (rank_info().size <= 1) return Crowd::restore(world, config, saved, context);
  auto group = StartedTogether::join();
  if (!group) return group.error();
  auto crowd = Crowd::restore(world, (*group)->own(config), saved, context);
  if (auto ok = agree_over_ranks(crowd ? Result<void>() : crowd.error()); !ok) return ok.error();
  return crowd::share_crowd(std::move(crowd), **group);
}

}  // namespace throng
