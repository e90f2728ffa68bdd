// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <CLI/CLI.hpp>
#include <vector>

#include "throng/base.h"

namespace throng::app {

/// Adds --block: box-shaped obstacles, six numbers each.
void add_blocks(CLI::App* command, std::vector<double>& blocks);

/// The boxes of --block. Fails with kBadInput and a sentence.
Result<std::vector<Prism>> boxes_of(const std::vector<double>& blocks);

}  // namespace throng::app
