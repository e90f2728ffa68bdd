// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <CLI/CLI.hpp>
#include <span>
#include <vector>

#include "throng/base.h"

namespace throng::app {

/// Adds --block: box-shaped obstacles, six numbers each.
void add_blocks(CLI::App* command, std::vector<double>& blocks);

/// The box with two opposite corners that an option gives. Fails with kBadInput and
/// a sentence that names the option.
Result<Prism> box_of(std::span<const double, 6> corners, const char* option);

/// The boxes of --block. Fails with kBadInput and a sentence.
Result<std::vector<Prism>> boxes_of(const std::vector<double>& blocks);

/// Puts the boxes of --block up as obstacles of a finder.
template <class Finder>
Result<void> add_boxes(const std::vector<double>& blocks, Finder& finder) {
  const auto boxes = boxes_of(blocks);
  if (!boxes) return boxes.error();
  for (const Prism& box : *boxes) {
    if (auto added = finder.add_obstacle(box); !added) return added.error();
  }
  return {};
}

}  // namespace throng::app
