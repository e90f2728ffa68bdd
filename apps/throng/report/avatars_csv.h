// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "throng/base.h"
#include "throng/picture.h"

/// Reads back what `throng run --trajectories` writes.
namespace throng::app {

/// The avatars of the last step in a file with the columns step,id,class,x,y,z,radius, and up_x,
/// up_y,up_z if some lean. Fails with kBadFile, the line and what to write there.
[[nodiscard]] Result<std::vector<PictureAvatar>> read_avatars(const std::string& path);

/// An avatar of the last step, and what the steps before add.
struct CsvWalker {
  uint64_t id = 0;
  Vec3d position;        ///< Feet. [m]
  Vec3d up{0, 1, 0};     ///< Along the body. [unit length]
  Vec3d heading;         ///< Along its last move, before it leans; 0 if it never moved.
  double last_move = 0;  ///< Over what it stands on, since the step before in the file. [m]
  double walked = 0;     ///< Likewise, since its first line. [m]
};

/// As read_avatars.
[[nodiscard]] Result<std::vector<CsvWalker>> read_walkers(const std::string& path);

}  // namespace throng::app
