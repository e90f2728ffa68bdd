// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <memory>
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
  explicit StartedTogether(cluster::Ranks& ranks) : ranks_(ranks) {}
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
  cluster::Ranks& ranks_;
  std::vector<Bytes> came_;
};

}  // namespace

Result<Crowd> crowd_over_ranks(const World& world, const CrowdConfig& config) {
  if (rank_info().size <= 1) return Crowd::create(world, config);
  auto joined = cluster::Ranks::join();
  if (!joined) return joined.error();
  static StartedTogether group(**joined);
  CrowdConfig own = config;
  own.workers = cluster::workers_of_rank(config.workers, **joined);
  return crowd::create_shared_crowd(world, own, group);
}

}  // namespace throng
