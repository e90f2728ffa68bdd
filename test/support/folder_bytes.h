// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <string>

/// The files of a folder and their bytes, to compare one with another.
namespace throng::test {

using FolderBytes = std::map<std::string, std::string>;

inline FolderBytes folder_bytes(const std::string& path) {
  FolderBytes folder;
  for (const auto& entry : std::filesystem::directory_iterator(path)) {
    std::ifstream file(entry.path(), std::ios::binary);
    folder[entry.path().filename().string()] = {std::istreambuf_iterator<char>(file), {}};
  }
  return folder;
}

}  // namespace throng::test
