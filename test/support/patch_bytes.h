// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "import/raw/raw_scene.h"

/// Tests of damaged bytes for all readers of patches.
namespace throng::test {

/// A reader, and the file name that it gets.
struct PatchReader {
  Result<importer::RawScene> (*read_bytes)(std::string_view, const importer::ReadOptions&,
                                           Context&);
  const char* name;

  [[nodiscard]] Result<importer::RawScene> read(const std::string& bytes) const;
  /// The message with which the bytes are refused; empty, and a failed test, if they are not.
  [[nodiscard]] std::string fault_of(const std::string& bytes) const;
  /// Reads every `stride`-th prefix of the bytes, and `count` copies with one byte changed, to any
  /// byte or to a digit. Expects that each is refused with a message that begins with `where`, or
  /// can be tessellated. Returns how many are not refused.
  [[nodiscard]] uint64_t survive(const std::string& whole, const std::string& where, size_t stride,
                                 uint64_t seed, uint64_t count) const;
};

}  // namespace throng::test
