// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "view/overlay_view.h"

#include <cmath>
#include <utility>

#include "view/viewer_state.h"

// Orders overlays as the panel switches them on, and shows them when they are made.
namespace throng::view {

OverlayMaker::OverlayMaker(World world, std::optional<Nodes> nodes, Vec3d origin)
    : world_(std::move(world)), nodes_(std::move(nodes)), origin_(origin) {
  context_.on_progress = [](const Progress&) { SideTask::pause_if_due(); };
}

OverlayMaker::~OverlayMaker() {
  context_.cancel = true;
  task_.reset();
}

void OverlayMaker::start(const Order& order) {
  task_.reset();
  busy_ = true;
  task_.emplace([this, order] {
    Made made = make(order);
    {
      const std::lock_guard lock(mutex_);
      made_ = std::move(made);
    }
    busy_ = false;
  });
}

std::optional<OverlayMaker::Made> OverlayMaker::take() {
  const std::lock_guard lock(mutex_);
  return std::exchange(made_, std::nullopt);
}

Result<std::vector<Vec3d>> OverlayMaker::find_path(const Order& order) {
  if (!finder_ || finder_class_ != order.avatar_class) {
    PathConfig config{.avatar_class = order.avatar_class};
    Result<PathFinder> finder = PathFinder::create(world_, config, context_);
    if (!finder && finder.error().code != Errc::kCancelled) {
      config.space = PathSpace::kGround;  // The world has no air or no nodes.
      finder = PathFinder::create(world_, config, context_);
    }
    if (!finder) return finder.error();
    finder_.emplace(*std::move(finder));
    finder_class_ = order.avatar_class;
  }
  std::vector<Vec3d> points;
  Path path;
  finder_->find({.from = order.from, .to = order.to, .nearest = false}, path);
  if (path.end != PathEnd::kReached) return points;
  for (const Place& place : path.points) points.push_back(place.position);
  return points;
}

void OverlayMaker::make_of_nodes(Made& made) {
  if (!nodes_) {
    made.fault = "nodes: this world has none; bake it with --nodes";
  } else if (made.overlay == Overlay::kLinks) {
    made.marks = link_marks(*nodes_, origin_, context_);
  } else if (made.overlay == Overlay::kCylinders) {
    made.marks = cylinder_marks(*nodes_, origin_, context_);
  } else {
    const auto drawn = std::make_shared<DrawnNodes>(nodes_->summary().bins);
    made.marks = node_marks(*nodes_, origin_, *drawn, context_);
    made.nodes = drawn;
  }
}

OverlayMaker::Made OverlayMaker::make(const Order& order) {
  Made made{.overlay = order.overlay, .marks = {}, .fault = {}};
  switch (order.overlay) {
    case Overlay::kClearance:
      made.marks = clearance_marks(world_, order.avatar_class, origin_, context_);
      break;
    case Overlay::kLevels:
      made.marks = level_marks(world_, origin_, context_);
      break;
    case Overlay::kNodes:
    case Overlay::kLinks:
    case Overlay::kCylinders:
      make_of_nodes(made);
      break;
    case Overlay::kAir:
      if (auto marks = air_marks(world_, order.height, origin_, context_)) {
        made.marks = *std::move(marks);
      } else {
        made.fault = marks.error().message;
      }
      break;
    case Overlay::kBoxes:
      if (auto marks = box_marks(world_, origin_)) {
        made.marks = *std::move(marks);
      } else {
        made.fault = "boxes: " + marks.error().message + "; bake it with --fly";
      }
      break;
    case Overlay::kPath:
      if (auto points = find_path(order)) {
        made.marks = path_marks(*points, origin_);
      } else {
        made.fault = points.error().message;
      }
      break;
    case Overlay::kPainted:
      if (order.maps) made.marks = painted_marks(world_, *order.maps, origin_, context_);
      break;
    case Overlay::kDensity:
    case Overlay::kNeighbours:
    case Overlay::kFields:
      break;  // Made in each frame.
  }
  return made;
}

}  // namespace throng::view

namespace throng {

// The node that was picked, as long as the overlay of nodes is on.
void Viewer::State::show_picked_node() {
  if (!drawn_nodes) panel.status.picked_node = -1;
  const int64_t picked = panel.status.picked_node;
  if (picked == shown_node) return;
  shown_node = picked;
  panel.picked_node.reset();
  Marks marks;
  if (picked >= 0 && nodes) {
    panel.picked_node = view::detail_of(*nodes, drawn_nodes->bins, static_cast<uint32_t>(picked));
    marks = view::picked_node_marks(*nodes, static_cast<uint32_t>(picked), origin);
  }
  keep_error(drawing.set_marks(kPickedNodeSlot, marks));
}

// Orders the overlays that are on and not made, and shows those that have been made.
void Viewer::State::show_overlays() {
  const auto slot = [](view::Overlay overlay) { return static_cast<size_t>(overlay); };
  const auto set = [&](view::Overlay overlay, const Marks& marks) {
    if (auto ok = drawing.set_marks(slot(overlay), marks); !ok) {
      panel.status.error = ok.error().message;
    }
    shown[slot(overlay)] = !marks.triangles.empty() || !marks.lines.empty();
  };
  const size_t picked = panel.status.picked < 0
                            ? crowd.now().size()
                            : crowd.now().find(static_cast<uint64_t>(panel.status.picked));
  const bool has_picked = picked < crowd.now().size();
  if (overlay_maker) {
    overlay_maker->run_slice();
    if (auto made = overlay_maker->take()) {
      if (!made->fault.empty()) {
        panel.status.error = made->fault;
        panel.overlays[slot(made->overlay)] = false;
      } else if (panel.overlays[slot(made->overlay)]) {
        set(made->overlay, made->marks);
        if (made->nodes) drawn_nodes = made->nodes;
      }
    }
  }
  for (size_t i = 0; i < view::kOverlays; ++i) {
    const auto overlay = static_cast<view::Overlay>(i);
    if (!panel.overlays[i]) {
      if (shown[i]) set(overlay, {});
      ordered[i] = false;
      if (overlay == view::Overlay::kNodes) drawn_nodes.reset();
      continue;
    }
    if (overlay == view::Overlay::kDensity) {
      set(overlay, view::density_marks(crowd.now()));
    } else if (overlay == view::Overlay::kFields) {
      set(overlay, view::field_marks(crowd.now(), picked, rig.target, panel.class_radii));
    } else if (overlay == view::Overlay::kNeighbours) {
      set(overlay, has_picked ? view::neighbour_marks(crowd.now(), picked, 5) : Marks{});
    } else if (overlay_maker && !overlay_maker->is_busy()) {
      view::OverlayMaker::Order order{
          .overlay = overlay, .height = 0, .avatar_class = 0, .from = {}, .to = {}, .maps = {}};
      if (overlay == view::Overlay::kAir) {
        order.height = (panel.is_cut ? panel.cut : panel.bounds.max.y) - 0.05;
        if (ordered[i] && order.height == air_height) continue;
        air_height = order.height;
      } else if (overlay == view::Overlay::kPath) {
        if (!has_picked || !panel.picked || !panel.picked->goal) {
          if (shown[i]) set(overlay, {});
          ordered[i] = false;
          continue;
        }
        if (ordered[i] && path_ordered_at && *last_now - *path_ordered_at < 0.5) continue;
        path_ordered_at = last_now;
        order.avatar_class = panel.picked->avatar_class;
        order.from = panel.picked->position;
        order.to = *panel.picked->goal;
      } else if (ordered[i]) {
        continue;
      }
      if (overlay == view::Overlay::kPainted) {
        order.maps = std::make_shared<const std::vector<DensityMap>>(painted);
      }
      ordered[i] = true;
      overlay_maker->start(order);
    }
  }
  show_picked_node();
}

}  // namespace throng
