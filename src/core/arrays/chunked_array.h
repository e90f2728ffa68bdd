// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

namespace throng {

/// An array that grows in chunks: nothing is copied when it grows, and it holds at most one chunk
/// more than it needs. Cleared, it keeps its chunks until they are given back.
template <class T>
class ChunkedArray {
 public:
  [[nodiscard]] size_t size() const { return size_; }
  T& operator[](size_t i) { return chunks_[i / kChunk][i % kChunk]; }
  const T& operator[](size_t i) const { return chunks_[i / kChunk][i % kChunk]; }
  void push_back(const T& value) {
    if (size_ == chunks_.size() * kChunk) chunks_.push_back(std::make_unique<T[]>(kChunk));
    (*this)[size_++] = value;
  }
  void clear() { size_ = 0; }
  /// Gives back the unused chunks beyond so many elements.
  void shrink(size_t keep) {
    const size_t used = (size_ + kChunk - 1) / kChunk, kept = (keep + kChunk - 1) / kChunk;
    const size_t chunks = used > kept ? used : kept;
    if (chunks < chunks_.size()) chunks_.resize(chunks);
  }
  [[nodiscard]] size_t allocated_bytes() const { return chunks_.size() * kChunk * sizeof(T); }

 private:
  static constexpr size_t kChunk = 1024;
  size_t size_ = 0;
  std::vector<std::unique_ptr<T[]>> chunks_;
};

}  // namespace throng
