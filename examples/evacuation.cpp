// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
//
// An evacuation: read a scenario, run it until all avatars have left, and print its egress curve
// and the flow through each exit. Every step is checked for overlaps and for avatars in walls.
//   build/release/examples/evacuation [SCENARIO.toml]
// Expected output (examples/evacuation.toml: eight offices, two exits; run in the root folder):
//     10 s    5 #
//     20 s   40 ##########
//     30 s   88 ######################
//     40 s  135 #################################
//     50 s  184 ##############################################
//     60 s  223 #######################################################
//   west exit, 1.2 m wide: 120 avatars from 6.5 s to 57.6 s, 2.33 per second
//   east exit, 1.0 m wide: 120 avatars from 7.9 s to 69.4 s, 1.93 per second
//   240 entered, 240 left, 0 faults
#include <throng/scenario.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

using namespace throng;

template <class T>
T need(Result<T> result) {  // The value, or the end of the program with the error's sentence.
  if (!result) std::printf("evacuation: %s\n", result.error().message.c_str()), std::exit(1);
  return *std::move(result);
}

int main(int argc, char** argv) {
  Context context;  // Progress and cancel, for long calls.
  const Scenario scenario = need(load_scenario(argc > 1 ? argv[1] : "examples/evacuation.toml"));
  const World world = need(open_world(scenario, context));
  Simulation simulation = need(Simulation::create(world, scenario, /*workers=*/0, context));

  // The egress curve: how many have left, every 10 s.
  SimulationReport now;
  uint64_t faults = 0;
  for (int step = 1; !simulation.is_over() && now.time < scenario.seconds; ++step) {
    now = need(simulation.step());
    const CrowdCheck check = simulation.crowd().check();
    faults += check.overlaps + check.wall_entries;
    if (step % std::lround(10 / scenario.dt) != 0) continue;
    const int left = static_cast<int>(now.left);
    std::printf("%4.0f s %4d %s\n", now.time, left, std::string(left / 4, '#').c_str());
  }

  // The flow through each exit, between its first and its last avatar.
  for (size_t exit = 0; exit < scenario.areas.size(); ++exit) {
    std::vector<double> times;
    for (const Trip& trip : simulation.trips()) {
      if (trip.left >= 0 && trip.exit == static_cast<int32_t>(exit)) times.push_back(trip.left);
    }
    if (times.size() < 2) continue;
    const auto [first, last] = std::minmax_element(times.begin(), times.end());
    std::printf("%s: %zu avatars from %.1f s to %.1f s, %.2f per second\n",
                scenario.areas[exit].name.c_str(), times.size(), *first, *last,
                static_cast<double>(times.size() - 1) / (*last - *first));
  }
  std::printf("%d entered, %d left, %d faults\n", static_cast<int>(now.entered),
              static_cast<int>(now.left), static_cast<int>(faults));
  return now.left == now.entered && now.outside == 0 && faults == 0 ? 0 : 1;
}
