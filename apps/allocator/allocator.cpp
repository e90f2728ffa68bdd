// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT

// How jemalloc behaves in our programs; it reads this name before main() begins. What is given back
// stays with the program, large blocks too (oversize_threshold): the next zone asks for the same
// again, and the system would clear it first. Pages of 2 MiB are the system's choice: asked for,
// they cost more than they save where the machine is a guest's.
extern "C" {
[[gnu::visibility("default")]] extern const char* const malloc_conf;
const char* const malloc_conf = "dirty_decay_ms:-1,oversize_threshold:0";
}
