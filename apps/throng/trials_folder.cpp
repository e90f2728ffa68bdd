// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "trials_folder.h"

#include <filesystem>

// Finds the folder of trials beside the program or in the source tree.
namespace throng::app {

std::string trials_folder() {
  namespace fs = std::filesystem;
  std::error_code failed;
  const fs::path program = fs::read_symlink("/proc/self/exe", failed);
  if (!failed) {
    const fs::path installed = program.parent_path().parent_path() / THRONG_DATA_FOLDER / "trials";
    if (fs::is_directory(installed, failed)) return installed.string();
  }
  return THRONG_TRIALS_SOURCE;
}

}  // namespace throng::app
