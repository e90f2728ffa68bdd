// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "core/rank_group.h"
#include "throng/crowd.h"

/// Crowds that ranks share.
namespace throng::crowd {

/// Makes a crowd, which each rank has made or restored alike, one of all ranks of a group, which
/// stays as long as the crowd. Fails, alike on all ranks, as `crowd` did, and with kBadConfig if
/// avatars fly or go over nodes or if its edits have off-mesh links.
Result<Crowd> share_crowd(Result<Crowd> crowd, RankGroup& group);
/// Avatars that this rank moves.
std::vector<AvatarState> own_avatars(const Crowd& crowd);

}  // namespace throng::crowd
