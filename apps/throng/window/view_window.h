// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <functional>
#include <string>

#include "throng/base.h"
#include "throng_view/viewer.h"

/// The viewer's window: the only file that names GLFW.
namespace throng::app {

struct WindowConfig {
  int32_t width = 1280, height = 720;                      ///< [units of the desktop]
  bool remember = true;                                    ///< Read and keep the settings.
  std::string pictures = ".";                              ///< Folder for F12.
  std::function<LoadStage(const std::string& path)> open;  ///< For files that are dropped.
  const std::atomic<bool>* cancel = nullptr;               ///< Close when it is set: Ctrl-C.
  double seconds = 0;                                      ///< Close after so long, 0: never. [s]
};

/// Opens a window, shows what `load` loads, returns when it is closed. Fails with kNotFound: no
/// display, or no driver.
[[nodiscard]] Result<void> run_window(const std::string& name, const LoadStage& load,
                                      const ViewerConfig& config, const WindowConfig& window);

/// A TrueType file of this machine for the panel, or empty.
[[nodiscard]] std::string panel_font();

}  // namespace throng::app
