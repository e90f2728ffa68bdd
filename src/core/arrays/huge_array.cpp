// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "core/arrays/huge_array.h"

#include <sys/mman.h>

#include <new>

// Zeroed pages from mmap, huge ones on request.
namespace throng {

void UnmapPages::operator()(void* p) const { munmap(p, bytes); }

ZeroedBytes::ZeroedBytes(size_t bytes, Pages pages) {
  if (bytes == 0) return;
  void* data = mmap(nullptr, bytes, PROT_READ | PROT_WRITE,
                    MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  if (data == MAP_FAILED) throw std::bad_alloc();
  data_ = {data, UnmapPages{bytes}};
#ifdef MADV_HUGEPAGE
  // A request only: where the system has no huge pages, the array works as well, only slower.
  if (pages == Pages::kHuge) madvise(data, bytes, MADV_HUGEPAGE);
#else
  static_cast<void>(pages);
#endif
}

void ZeroedBytes::give_back(size_t first, size_t bytes) const {
  constexpr size_t kPage = 4096;
  const size_t begin = (first + kPage - 1) / kPage * kPage, end = (first + bytes) / kPage * kPage;
  if (begin < end) madvise(static_cast<uint8_t*>(data_.get()) + begin, end - begin, MADV_DONTNEED);
}

}  // namespace throng
