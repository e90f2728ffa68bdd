// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <string>
#include <vector>

#include "throng/result.h"
#include "throng_draw/draw.h"
#include "throng_view/view_event.h"

struct ImGuiContext;

/// Dear ImGui between events and a PanelView: it knows neither windows nor graphics libraries here.
namespace throng {

class Ui {
 public:
  /// `font` is a TrueType file, or empty. `pixel_ratio` scales all.
  Ui(const std::string& font, double pixel_ratio);
  Ui(const Ui&) = delete;
  Ui& operator=(const Ui&) = delete;
  ~Ui();

  /// Gives the letters to a drawing.
  [[nodiscard]] Result<void> set_texture(Drawing& drawing) const;
  /// Tells of an event; true if the panel is what it was meant for.
  bool handle(const ViewEvent& event);
  /// Between these two, ImGui calls are for this frame.
  void begin(double seconds, int32_t width, int32_t height);
  /// Valid until the next begin().
  [[nodiscard]] PanelView end();
  [[nodiscard]] float scale() const { return scale_; }
  [[nodiscard]] std::string layout() const;  ///< Where windows are, to keep.
  void set_layout(const std::string& layout);

 private:
  ImGuiContext* context_ = nullptr;
  float scale_ = 1;
  // What is down, and what went down since the last frame, even if it came up again: ImGui sees
  // only what is down when a frame begins.
  std::array<bool, 3> down_{}, pressed_{};
  std::vector<PanelVertex> vertices_;
  std::vector<uint32_t> indices_;
  std::vector<PanelRun> runs_;
};

}  // namespace throng
