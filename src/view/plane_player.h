// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <vector>

#include "throng/papers.h"
#include "throng_view/viewer.h"
#include "view/timeline_source.h"

namespace throng::view {

/// Runs the experiment of [CAACD] section V until all avatars stand.
class PlanePlayer final : public TimelinePlayer {
 public:
  /// Fails as caacd::random_space and caacd::Simulation::create do.
  [[nodiscard]] static Result<std::unique_ptr<PlanePlayer>> create(const ExperimentStart& start,
                                                                   Vec3d origin);
  std::shared_ptr<const TimelineFrame> next() override;
  std::shared_ptr<const TimelineFrame> seek(double) override {
    return nullptr;
  }  // Time only goes on.
  std::shared_ptr<const TimelineFrame> again() override;
  void set_curves(std::optional<uint64_t> id, const CurvilinearTuning& tuning) override;

 private:
  PlanePlayer(caacd::Simulation&& simulation, Vec3d origin);
  [[nodiscard]] std::shared_ptr<const CurvedFrame> curved() const;

  caacd::Simulation simulation_;
  Vec3d origin_;
  std::vector<AvatarState> states_;
  std::shared_ptr<const std::vector<Prism>> obstacles_;
  std::shared_ptr<const TimelineFrame> last_;
};

}  // namespace throng::view
