// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

namespace throng {

/// A long array of which little is touched: its pages are made, of zero-initialised elements, when
/// they are first used. They stay until they are cleared.
template <class T>
class Paged {
 public:
  void resize(size_t count) {
    const size_t pages = (count + kPage - 1) / kPage;
    for (size_t p = pages; p < pages_.size(); ++p) made_ -= pages_[p] ? 1 : 0;
    pages_.resize(pages);
  }
  T& operator[](size_t i) {
    std::unique_ptr<T[]>& page = pages_[i / kPage];
    if (!page) {
      page = std::make_unique<T[]>(kPage);
      ++made_;
    }
    return page[i % kPage];
  }
  /// Forgets all, and gives the pages back.
  void clear() {
    for (auto& page : pages_) page.reset();
    made_ = 0;
  }
  /// Of the pages that were made.
  [[nodiscard]] size_t allocated_bytes() const { return made_ * kPage * sizeof(T); }

 private:
  static constexpr size_t kPage = 1024;
  size_t made_ = 0;
  std::vector<std::unique_ptr<T[]>> pages_;
};

}  // namespace throng
