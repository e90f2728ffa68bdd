// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "throng/crowd.h"

// In a browser a page is one process.
namespace throng {

Result<Crowd> crowd_over_ranks(const World& world, const CrowdConfig& config) {
  return Crowd::create(world, config);
}

Result<Crowd> restore_over_ranks(const World& world, const CrowdConfig& config,
                                 std::span<const uint8_t> saved, Context& context) {
  return Crowd::restore(world, config, saved, context);
}

}  // namespace throng
