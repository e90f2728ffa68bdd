// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT

// How jemalloc behaves in our programs; it reads this name before main() begins. The heap lies on
// pages of 2 MiB where the system has them: a bake touches a gigabyte, and each small page costs
// more than what is written on it. What is given back stays with the program, large blocks too
// (oversize_threshold): the next zone asks for the same again, and the system would clear it first.
extern "C" {
[[gnu::visibility("default")]] extern const char* const malloc_conf;
const char* const malloc_conf = "thp:always,dirty_decay_ms:-1,oversize_threshold:0";
}
