// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cassert>

/// Export and assertion macros. Everything not marked THRONG_API is hidden.
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

/// Misuse by the caller's code (never bad data: that is a Result). Checked in debug builds only.
#define THRONG_ASSERT(condition) assert(condition)
