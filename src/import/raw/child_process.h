// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "throng/base.h"

/// Runs code that may corrupt memory in a child process, which sends its results through a pipe.
namespace throng::importer {

/// How much a child may use before the system ends it.
struct ChildLimits {
  uint64_t bytes = 0;    ///< Memory beyond what the parent has. [> 0]
  uint64_t seconds = 0;  ///< Time on a processor. [> 0]
};

/// The child's end of the pipe. A write ends the child if the parent has ended.
class PipeWriter {
 public:
  explicit PipeWriter(int file) : file_(file) {}
  void write(const void* data, size_t size) const;

 private:
  int file_;
};

/// The parent's end.
class PipeReader {
 public:
  PipeReader(int file, Context& context) : file_(file), context_(context) {}
  /// False at the end of the pipe or when the context cancels; then `data` is not complete.
  bool read(void* data, size_t size);

 private:
  int file_;
  Context& context_;
};

/// In a child: allows it that much more processor time from now on, within its limits.
void allow_this_child(uint64_t seconds);

/// Forks. The child calls `child` and ends; the parent calls `parent`, which returns true once it
/// has received everything. What `child` throws ends the child. Fails with kBadFile and a clause
/// that says how the child ended, with kCancelled, or with kIo. Needs a POSIX system.
[[nodiscard]] Result<void> run_in_child(const ChildLimits& limits, Context& context,
                                        const std::function<void(const PipeWriter&)>& child,
                                        const std::function<bool(PipeReader&)>& parent);

}  // namespace throng::importer
