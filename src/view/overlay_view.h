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

namespace throng::view {

/// Makes overlays that take long on a task beside the window, one at a time.
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
    std::shared_ptr<const std::vector<DensityMap>> maps = {};  ///< Of painted densities.
  };
  struct Made {
    Overlay overlay = Overlay::kClearance;
    Marks marks;
    std::string fault;                             ///< Why the marks are missing, or empty.
    std::shared_ptr<const DrawnNodes> nodes = {};  ///< With kNodes: what can be picked.
  };
  [[nodiscard]] bool is_busy() const { return busy_; }
  /// Call only while it is not busy.
  void start(const Order& order);
  [[nodiscard]] std::optional<Made> take();
  /// Without threads: works for a share of the frame.
  void run_slice() {
    if (task_) task_->run_slice();
  }

 private:
  Made make(const Order& order);
  void make_of_nodes(Made& made);
  Result<std::vector<Vec3d>> find_path(const Order& order);

  World world_;
  std::optional<Nodes> nodes_;
  Vec3d origin_;
  Context context_;
  std::atomic<bool> busy_ = false;
  std::mutex mutex_;
  std::optional<Made> made_;
  // Made on first use, for one class.
  std::optional<PathFinder> finder_;
  int32_t finder_class_ = -1;
  std::optional<SideTask> task_;
};

}  // namespace throng::view
