// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace throng::app {

/// Where the trials of the standards lie: installed beside the program (share/throng/trials), else
/// in the source tree that it was built from.
std::string trials_folder();

}  // namespace throng::app
