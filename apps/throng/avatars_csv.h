// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "throng/picture.h"
#include "throng/result.h"

/// Reads back what `throng run --trajectories` writes.
namespace throng::app {

/// The avatars of the last step in a file with the columns step,id,class,x,y,z,radius. Fails with
/// kBadFile, the line and what to write there.
[[nodiscard]] Result<std::vector<PictureAvatar>> read_avatars(const std::string& path);

}  // namespace throng::app
