// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <string>
#include <vector>

#include "throng/base.h"
#include "throng_draw/draw.h"
#include "throng_view/viewer.h"

struct ImGuiContext;

/// Dear ImGui between events and a PanelView, without windows and graphics libraries.
namespace throng::view {

class Ui {
 public:
  /// `font` is a TrueType file, or empty. `pixel_ratio` scales all.
  Ui(const std::string& font, double pixel_ratio);
  Ui(const Ui&) = delete;
  Ui& operator=(const Ui&) = delete;
  ~Ui();

  /// Passes the font's texture to a drawing.
  [[nodiscard]] Result<void> set_texture(Drawing& drawing) const;
  /// Passes an event on; true if it was meant for the panel.
  bool handle(const ViewEvent& event);
  /// Between these two, ImGui calls are for this frame.
  void begin(double seconds, int32_t width, int32_t height);
  /// Valid until the next begin().
  [[nodiscard]] PanelView end();
  [[nodiscard]] float scale() const { return scale_; }
  [[nodiscard]] std::string layout() const;  ///< Places of the windows, to save.
  void set_layout(const std::string& layout);

 private:
  ImGuiContext* context_ = nullptr;
  float scale_ = 1;
  // Buttons that are down, and those that went down since the last frame even if they came up
  // again: ImGui sees only buttons that are down when a frame begins.
  std::array<bool, 3> down_{}, pressed_{};
  std::vector<PanelVertex> vertices_;
  std::vector<uint32_t> indices_;
  std::vector<PanelRun> runs_;
};

}  // namespace throng::view
