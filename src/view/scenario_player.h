// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "throng/scenario.h"
#include "view/timeline_source.h"

namespace throng::view {

/// Runs a scenario until its time is over or all avatars have left.
class ScenarioPlayer final : public TimelinePlayer {
 public:
  /// Fails as Simulation::create does.
  [[nodiscard]] static Result<std::unique_ptr<ScenarioPlayer>> create(const World& world,
                                                                      const Scenario& scenario,
                                                                      int32_t workers, Vec3d origin,
                                                                      Context& context);
  std::shared_ptr<const TimelineFrame> next() override;
  std::shared_ptr<const TimelineFrame> seek(double) override {
    return nullptr;
  }  // Time only goes on.
  std::shared_ptr<const TimelineFrame> again() override;
  /// As Simulation::set_density.
  [[nodiscard]] Result<void> set_density(const std::string& name,
                                         std::span<const uint8_t> weights) {
    return simulation_.set_density(name, weights);
  }

 private:
  ScenarioPlayer(Simulation&& simulation, double seconds, Vec3d origin);

  Simulation simulation_;
  double seconds_;
  Vec3d origin_;
  std::vector<AvatarState> states_;
  std::shared_ptr<const std::vector<Prism>> obstacles_;
  SimulationReport report_;
  std::string fault_;
  std::shared_ptr<const TimelineFrame> last_;
};

}  // namespace throng::view
