// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "import/formats/movingai.h"

#include "core/files/read_file.h"
#include "import/formats/text_cursor.h"

// Reads the maps of movingai.com as text, line by line. Source: [Stu12], [BS18].
namespace throng {
namespace {

constexpr long long kMaxCells = 16000;  // along a side
constexpr long long kMaxVoxels = 4096;  // along a side

Error bad_map(const std::string& name, const std::string& what) {
  return {Errc::kBadFile, name + ": " + what};
}

// "NAME N": one line of the head.
bool take_size(importer::TextCursor& at, std::string_view name, int32_t& size) {
  long long value = 0;
  if (at.take_word() != name || !at.take(value) || value < 1 || value > kMaxCells) return false;
  size = static_cast<int32_t>(value);
  return true;
}

}  // namespace

Result<FlatCells> importer::read_grid_map(std::string_view text, const std::string& name) {
  importer::TextCursor at(text);
  FlatCells cells;
  if (at.take_word() != "type" || at.take_word() != "octile") {
    return bad_map(name, "not a grid map; its first line must be `type octile`");
  }
  if (!take_size(at, "height", cells.depth) || !take_size(at, "width", cells.width)) {
    return bad_map(name, "lines 2 and 3 must be `height N` and `width N`, N from 1 to 16000");
  }
  if (at.take_word() != "map") return bad_map(name, "line 4 must be `map`");

  for (int32_t z = 0; z < cells.depth; ++z) {
    const std::string_view row = at.take_word();
    if (row.size() != static_cast<size_t>(cells.width)) {
      return bad_map(name, "line " + std::to_string(z + 5) + " has " + std::to_string(row.size()) +
                               " cells, `width` says " + std::to_string(cells.width));
    }
    for (const char c : row) cells.passable.push_back(c == '.' || c == 'G' || c == 'S' ? 1 : 0);
  }
  return cells;
}

Result<FlatCells> load_grid_map(const std::string& path) {
  const auto text = read_file(path);
  if (!text) return text.error();
  return importer::read_grid_map(*text, path);
}

Result<VoxelCells> importer::read_voxel_map(std::string_view text, const std::string& name) {
  importer::TextCursor at(text);
  long long size[3];
  if (at.take_word() != "voxel") {
    return bad_map(name, "not a voxel map; its first line must be `voxel X Y Z`");
  }
  for (long long& side : size) {
    if (!at.take(side) || side < 1 || side > kMaxVoxels) {
      return bad_map(name, "line 1 must be `voxel X Y Z`, each from 1 to 4096");
    }
  }
  VoxelCells cells{.width = static_cast<int32_t>(size[0]),
                   .height = static_cast<int32_t>(size[1]),
                   .depth = static_cast<int32_t>(size[2]),
                   .filled = {}};
  for (size_t line = 2;; ++line) {
    at.skip_space();
    if (at.at_end()) return cells;
    long long voxel[3];
    for (size_t i = 0; i < 3; ++i) {
      if (!at.take(voxel[i]) || voxel[i] < 0 || voxel[i] >= size[i]) {
        return bad_map(name, "line " + std::to_string(line) +
                                 " must be a voxel of the map, three whole numbers from 0");
      }
    }
    cells.filled.push_back({static_cast<int32_t>(voxel[0]), static_cast<int32_t>(voxel[1]),
                            static_cast<int32_t>(voxel[2])});
  }
}

Result<VoxelCells> load_voxel_map(const std::string& path) {
  const auto text = read_file(path);
  if (!text) return text.error();
  return importer::read_voxel_map(*text, path);
}

}  // namespace throng
