// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <mutex>
#include <vector>

#include "bake/folder/world_bake.h"
#include "bake/folder/world_folder.h"
#include "bake/folder/zone_bake.h"
#include "core/side_by_side.h"
#include "throng/bake.h"
#include "world/zone_data.h"

/// All zones of a bake, by one process.
namespace throng::bake {

/// Bakes zones, several at a time where there are many workers: within one of them more than a few
/// wait for each other. They go into the folder, which may have some of them already, or, if it is
/// null, into memory.
class ZoneBaker {
 public:
  /// All is kept by reference.
  ZoneBaker(const WorldBake& bake, const BakeConfig& config, Context& context, WorldFolder* folder);

  /// Fails with kIo or kCancelled.
  Result<void> run();

  [[nodiscard]] std::vector<ZoneFacts>& facts() { return facts_; }
  /// In memory: in order of z, then x.
  [[nodiscard]] std::vector<std::unique_ptr<world::Zone>> take_zones();

 private:
  Result<void> bake(size_t i, ZoneScratch& scratch);
  Result<void> put(size_t i, flatbuffers::DetachedBuffer bytes);

  const WorldBake& bake_;
  Context& context_;
  WorldFolder* folder_;
  WorkerGroups groups_;
  std::vector<std::unique_ptr<ZoneScratch>> scratch_;  // by group
  std::vector<ZoneFacts> facts_;
  std::vector<std::unique_ptr<world::Zone>> zones_;
  std::mutex mutex_;  // of the folder's journal
};

}  // namespace throng::bake
