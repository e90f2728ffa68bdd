// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cassert>

/// Macros for exports and assertions. Symbols without THRONG_API are hidden.
#if defined(_WIN32) && defined(THRONG_SHARED)
#ifdef THRONG_BUILDING
#define THRONG_API __declspec(dllexport)
#else
#define THRONG_API __declspec(dllimport)
#endif
#elif defined(__GNUC__)
#define THRONG_API __attribute__((visibility("default")))
#else
#define THRONG_API
#endif

/// Asserts against misuse by the calling code (bad data gives a Result). Checked in debug builds
/// only.
#define THRONG_ASSERT(condition) assert(condition)
