// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT

// How jemalloc behaves in our programs; it reads this name before main() begins.
//
// dirty_decay_ms: pages that are freed stay with the program for about 10 s [ms], large blocks too
// (oversize_threshold): the next zone or frame asks for the same again, and the system would clear
// them first. It must be finite, or a program keeps for ever the most that it ever needed.
//
// lg_extent_max_active_fit: any free range may be cut up. By default none serves a request of less
// than 1/64 of its size. Mesa's software OpenGL puts the triangles of a frame into thousands of
// blocks of 64 KiB; freed, they merge into ranges that the blocks of the next frame may then not
// use, so each frame took new pages, 200 MB of them in a city.
//
// Pages of 2 MiB are the system's choice: asked for, they cost more than they save where the
// machine is a guest's.
extern "C" {
[[gnu::visibility("default")]] extern const char* const malloc_conf;
const char* const malloc_conf =
    "dirty_decay_ms:10000,lg_extent_max_active_fit:63,oversize_threshold:0";
}
