// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "core/rank_group.h"
#include "throng/crowd.h"

/// Crowds that ranks share.
namespace throng::crowd {

/// An empty crowd of all ranks of a group, which stays as long as the crowd. Fails as
/// Crowd::create, alike on all ranks, and with kBadConfig if its edits have off-mesh links.
Result<Crowd> create_shared_crowd(const World& world, const CrowdConfig& config, RankGroup& group);
/// Avatars that this rank moves.
std::vector<AvatarState> own_avatars(const Crowd& crowd);

}  // namespace throng::crowd
