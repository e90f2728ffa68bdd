// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <string>

#include "throng/scenario.h"

/// The families of tests, one file each.
namespace throng::validate {

struct Test {
  ValidationTest about;
  Result<ValidationResult> (*run)(const ValidationConfig& config, Context& context);
};

std::span<const Test> density_tests();      // fundamental diagrams
std::span<const Test> bottleneck_tests();   // flow through doors
std::span<const Test> stream_tests();       // lanes, crossings, arches
std::span<const Test> motion_tests();       // before a door, in haste
std::span<const Test> rest_tests();         // people that wait
std::span<const Test> passage_tests();      // opposite directions in narrow corridors
std::span<const Test> crossing_tests();     // four streams that meet
std::span<const Test> counterflow_tests();  // a door, a long corridor, a corridor that is fed
std::span<const Test> maze_tests();         // corridors one body wide
std::span<const Test> jam_tests();          // a building in which all go to and fro

/// Recorded people beside predictions of their positions, for a folder of scenes.
Result<ValidationResult> walkers(const std::string& folder, const ValidationConfig& config,
                                 Context& context);

/// Experiments of the laboratory of Juelich, for a folder of their files.
Result<ValidationResult> laboratory(const std::string& folder, const ValidationConfig& config,
                                    Context& context);

}  // namespace throng::validate
