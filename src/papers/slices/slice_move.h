// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>

#include "throng/papers.h"

/// [ML06] algorithm 1 in its conservative form, on the slices themselves. The crowd walks on level
/// tiles instead; this is the seed's own method, and what the level tiles are held against.
namespace throng::papers {

/// A body on slices. [mm]
struct SliceBody {
  int32_t height = 1750;
  int32_t step = 400;  ///< Moves must climb or drop less than this, as printed. [<= height]
};

/// The lowest of slices, highest first, at or above `head`; the first slice if none is (a head
/// above it is above everything). `height` gets the height of an element. [mm]
template <class Slices, class Height = std::identity>
[[nodiscard]] size_t index_above(const Slices& slices, int32_t head, Height height = {}) {
  const auto is_above = [&](const auto& slice) { return std::invoke(height, slice) >= head; };
  const auto below = std::partition_point(std::begin(slices), std::end(slices), is_above);
  const auto above = static_cast<size_t>(below - std::begin(slices));
  return above == 0 ? 0 : above - 1;
}

/// The slice that a head at `head` reads: see index_above. [mm]
[[nodiscard]] size_t find_slice(const SliceSet& slices, int32_t head);

/// May a body that stands in cell `from` of slice `slice` move to the neighbouring cell `to`? It
/// then stands at that slice's surface in `to`.
///
/// Three differences from the printed algorithm, all towards refusing:
/// - The printed rule, on a climb past the slice, compares only cell A with the higher slice. That
///   admits a head into a ceiling over B between the two slices; here B is compared as well.
/// - Its search `sliceHeight[++j]` runs downwards, slices being numbered from the top; ours runs
/// up.
/// - The far plane is no surface, and a body must fit where it stands.
/// Where it says yes, both columns are free from the higher floor to the
/// head.
[[nodiscard]] bool can_move(const SliceSet& slices, size_t slice, size_t from, size_t to,
                            const SliceBody& body);

}  // namespace throng::papers
