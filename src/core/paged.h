// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

namespace throng {

/// A long array of which little is touched: its pages are made, of zero-initialised elements, when
/// they are first used. They stay.
template <class T>
class Paged {
 public:
  void resize(size_t count) { pages_.resize((count + kPage - 1) / kPage); }
  T& operator[](size_t i) {
    std::unique_ptr<T[]>& page = pages_[i / kPage];
    if (!page) page = std::make_unique<T[]>(kPage);
    return page[i % kPage];
  }
  /// Forgets all, and gives the pages back.
  void clear() {
    for (auto& page : pages_) page.reset();
  }

 private:
  static constexpr size_t kPage = 1024;
  std::vector<std::unique_ptr<T[]>> pages_;
};

}  // namespace throng
