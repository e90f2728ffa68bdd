// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "papers/slices/slice_move.h"

#include <cstdlib>

// [ML06] algorithm 1 on slices: a move to the next cell reads two slices. Constant time, after a
// search for the slice.
namespace throng::papers {

size_t find_slice(const SliceSet& slices, int32_t head) {
  return index_above(slices.kept, head, &Slice::height);
}

bool can_move(const SliceSet& slices, size_t slice, size_t from, size_t to, const SliceBody& body) {
  const Slice& read = slices.kept[slice];
  const int32_t feet_from = read.surface[from];
  const int32_t feet_to = read.surface[to];
  if (feet_from == slices.far_plane || feet_to == slices.far_plane) return false;
  if (feet_from + body.height > read.height) return false;
  if (std::abs(feet_from - feet_to) >= body.step) return false;

  // Down, or up below the cut: nothing lies between either floor and the cut.
  const int32_t head = feet_to + body.height;
  if (head <= read.height) return true;

  // Up past the cut: both columns must stay free up to the slice above the raised head.
  const Slice& above = slices.kept[find_slice(slices, head)];
  return head <= above.height && above.surface[from] == feet_from && above.surface[to] == feet_to;
}

}  // namespace throng::papers
