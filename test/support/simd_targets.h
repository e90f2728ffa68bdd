// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <gtest/gtest.h>
#include <hwy/targets.h>

/// Runs the same test on every set of vector instructions that the program holds.
namespace throng::test {

/// Under the thread sanitizer one set is enough: threads are the same with each, and the results of
/// all sets are compared without it.
#if defined(__has_feature)
#if __has_feature(thread_sanitizer)
#define THRONG_TEST_ONE_SIMD_TARGET 1
#endif
#endif
#ifdef THRONG_TEST_ONE_SIMD_TARGET
inline constexpr bool kOneSimdTarget = true;
#else
inline constexpr bool kOneSimdTarget = false;
#endif

/// Calls body(name) for each target of Highway that this machine supports, with that target chosen;
/// the best one is chosen again at the end, also after a failed ASSERT in the body. Not while other
/// threads bake: the choice is global.
template <class Body>
void for_every_simd_target(Body body) {
  const int64_t all = hwy::SupportedTargets();
  ASSERT_NE(all, 0);
  for (int64_t left = all; left != 0; left &= left - 1) {
    const int64_t target = left & -left;
    hwy::SetSupportedTargetsForTest(target);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
    body(hwy::TargetName(target));
    hwy::SetSupportedTargetsForTest(0);
    if (kOneSimdTarget) break;
  }
  hwy::GetChosenTarget().Update(hwy::SupportedTargets());
}

}  // namespace throng::test
