// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "impostor/view_packer.h"

#include <algorithm>
#include <numeric>
#include <vector>

// Packs views in rows, tallest first: from one elevation, figures have nearly one height, so rows
// waste little, and each view's place follows from the sizes alone.
namespace throng::impostor {
namespace {

struct Row {
  int32_t first = 0, last = 0;  // Into the order.
  int32_t height = 0;
};

}  // namespace

PageSize pack_views(std::span<AtlasView> views) {
  std::vector<uint32_t> order(views.size());
  std::iota(order.begin(), order.end(), 0U);
  std::sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) {
    const AtlasView& l = views[a];
    const AtlasView& r = views[b];
    if (l.height != r.height) return l.height > r.height;
    if (l.width != r.width) return l.width > r.width;
    return a < b;
  });
  std::vector<Row> rows;
  int32_t x = kPageWidth;
  for (size_t i = 0; i < order.size(); ++i) {
    AtlasView& view = views[order[i]];
    if (x + view.width > kPageWidth) {
      rows.push_back({static_cast<int32_t>(i), static_cast<int32_t>(i), view.height});
      x = 0;
    }
    view.x = static_cast<uint16_t>(x);
    x += view.width;
    rows.back().last = static_cast<int32_t>(i) + 1;
  }
  // Rows go to the first page with room; pages are as low as possible without more pages.
  const int32_t total = std::accumulate(
      rows.begin(), rows.end(), 0, [](int32_t sum, const Row& row) { return sum + row.height; });
  const int32_t min_pages = std::max(1, (total + kPageHeight - 1) / kPageHeight);
  std::vector<int32_t> page_of(rows.size()), top_of(rows.size());
  const auto place = [&](int32_t height) {
    std::vector<int32_t> filled;
    for (size_t r = 0; r < rows.size(); ++r) {
      auto page = std::find_if(filled.begin(), filled.end(),
                               [&](int32_t top) { return top + rows[r].height <= height; });
      if (page == filled.end()) page = filled.insert(page, 0);
      page_of[r] = static_cast<int32_t>(page - filled.begin());
      top_of[r] = *page;
      *page += rows[r].height;
    }
    return static_cast<int32_t>(filled.size());
  };
  PageSize size{.width = kPageWidth, .height = kPageHeight, .pages = place(kPageHeight)};
  for (int32_t height = (total / min_pages + 3) / 4 * 4; height < kPageHeight; height += 4) {
    if (rows.empty() || height < rows[0].height || place(height) > size.pages) continue;
    size.height = height;
    break;
  }
  size.pages = place(size.height);
  for (size_t r = 0; r < rows.size(); ++r) {
    for (int32_t i = rows[r].first; i < rows[r].last; ++i) {
      AtlasView& view = views[order[static_cast<size_t>(i)]];
      view.page = static_cast<uint16_t>(page_of[r]);
      view.y = static_cast<uint16_t>(top_of[r]);
    }
  }
  return size;
}

}  // namespace throng::impostor
