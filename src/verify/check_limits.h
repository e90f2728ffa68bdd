// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once
#include <cstddef>

/// What the oracles of paths and of nodes share.
namespace throng::verify {

inline constexpr size_t kFaultsOfAKind = 8;  ///< As many faults of one kind are listed.
inline constexpr size_t kPairBatch = 256;    ///< Pairs between two tests of `cancel`.
inline constexpr double kSameLength = 1e-6;  ///< [m]

}  // namespace throng::verify
