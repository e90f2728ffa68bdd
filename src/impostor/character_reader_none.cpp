// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "throng/impostor.h"

// A build without assimp and without child processes: a browser's.
namespace throng {

Result<Character> load_character(const std::string& path, Context&) {
  return Error{Errc::kBadFile, path +
                                   ": this build does not read such files; the program does: "
                                   "throng bake makes a world of it, which opens everywhere"};
}

}  // namespace throng
