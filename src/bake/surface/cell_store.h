// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <unordered_map>
#include <vector>

#include "bake/surface/node_scene.h"
#include "bake/surface/patch_cells.h"
#include "core/files/scratch_file.h"
#include "throng/base.h"

/// Judged cells of patches that several batches need, in a temporary file: judging takes most of
/// the time of a batch, and zones near it are of other batches, too.
namespace throng::bake {

class CellStore {
 public:
  /// Fails with kIo.
  static Result<std::unique_ptr<CellStore>> create(const std::string& folder);

  // From several threads, of different patches.

  /// Keeps the cells of a patch of a region. If that cannot be done they are judged again.
  void keep(const NodeRegion& region, uint32_t patch, const BezierCells& cells);
  /// False if they are not here.
  [[nodiscard]] bool read(const NodeRegion& region, uint32_t patch, BezierCells& out) const;

  /// Gives the place of a patch free, by its number in the whole scene.
  void drop(uint32_t number);

 private:
  struct Entry {
    uint64_t offset = 0;
    uint32_t bytes = 0;
  };

  explicit CellStore(ScratchFile file) : file_(std::move(file)) {}

  ScratchFile file_;
  mutable std::mutex mutex_;  // of what follows
  std::unordered_map<uint32_t, Entry> entries_;
  std::map<uint32_t, std::vector<uint64_t>> free_;  // places by their size
  uint64_t end_ = 0;
};

}  // namespace throng::bake
