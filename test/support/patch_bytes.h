// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "import/raw_scene.h"

/// What the tests of all readers of patches do with bytes.
namespace throng::test {

/// A reader, and the name under which it is given bytes.
struct PatchReader {
  Result<RawScene> (*read_bytes)(std::string_view, const ReadOptions&, Context&);
  const char* name;

  [[nodiscard]] Result<RawScene> read(const std::string& bytes) const;
  /// The sentence with which the bytes are refused; empty, and a failure, if they are not.
  [[nodiscard]] std::string fault_of(const std::string& bytes) const;
  /// Reads every `stride`-th beginning of the bytes, and `count` copies with one byte changed, to
  /// any or to a digit: each is refused with a sentence that begins with `where`, or can be
  /// tessellated. How many are not refused.
  [[nodiscard]] uint64_t survive(const std::string& whole, const std::string& where, size_t stride,
                                 uint64_t seed, uint64_t count) const;
};

}  // namespace throng::test
