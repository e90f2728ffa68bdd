// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <atomic>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "throng/path.h"
#include "view/overlays.h"
#include "view/side_task.h"

namespace throng {

/// Overlays that take their time, made beside the window: one thing at a time, the last one asked
/// for.
class OverlayMaker {
 public:
  OverlayMaker(World world, std::optional<Nodes> nodes, Vec3d origin);
  OverlayMaker(const OverlayMaker&) = delete;
  OverlayMaker& operator=(const OverlayMaker&) = delete;
  ~OverlayMaker();  ///< Cancels and waits.

  struct Order {
    Overlay overlay = Overlay::kClearance;
    double height = 0;                                         ///< Of air. [m, world]
    int32_t avatar_class = 0;                                  ///< Of clearance and path.
    Vec3d from, to;                                            ///< Of a path.
    std::shared_ptr<const std::vector<DensityMap>> maps = {};  ///< Of what is painted.
  };
  struct Made {
    Overlay overlay = Overlay::kClearance;
    Marks marks;
    std::string fault;  ///< Why there are none, or empty.
  };
  [[nodiscard]] bool is_busy() const { return busy_; }
  /// Only while it is not busy.
  void start(const Order& order);
  [[nodiscard]] std::optional<Made> take();
  /// Where there are no threads: works for a while.
  void turn() {
    if (task_) task_->turn();
  }

 private:
  Made make(const Order& order);
  Result<std::vector<Vec3d>> way(const Order& order);

  World world_;
  std::optional<Nodes> nodes_;
  Vec3d origin_;
  Context context_;
  std::atomic<bool> busy_ = false;
  std::mutex mutex_;
  std::optional<Made> made_;
  // Made when first needed, of one class.
  std::optional<PathFinder> finder_;
  int32_t finder_class_ = -1;
  std::optional<SideTask> task_;
};

}  // namespace throng
