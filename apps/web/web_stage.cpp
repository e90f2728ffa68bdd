// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <cstdio>

#include "command.h"
#include "run/rerun.h"

// The functions that apps/throng/window/view_stage.cpp needs of a program, for a page.
namespace throng::app {

void note(const std::string& sentence) { std::printf("throng: %s\n", sentence.c_str()); }

Result<World> world_of(const RecordingInfo& info, const std::string& folder) {
  if (folder.empty()) {
    return Error{Errc::kBadFile,
                 fmt::format("the recording was walked in {}: open that world's folder along with "
                             "it, or name it with world=",
                             info.world)};
  }
  Result<World> world = World::open(folder);
  if (!world || world->summary().hash == info.world_hash) return world;
  return Error{Errc::kBadFile,
               fmt::format("{}: not the world that was recorded (its hash is {:016x}, recorded "
                           "{:016x}); open the one that was",
                           folder, world->summary().hash, info.world_hash)};
}

}  // namespace throng::app
