// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "scenario/simulation_state.h"

// Queues before counters, and links: lifts and escalators. Time of a step: linear in the avatars
// that queue or wait.
namespace throng {
namespace {

constexpr double kTailRadius = 1.2;  // [m] An avatar this near to the tail joins the line.
constexpr double kServiceRadius =
    0.45;                     // [m] An avatar this near to its place at a counter is served.
constexpr double kFloor = 1;  // [m] Vertical tolerance between a line's points and the floor.

}  // namespace

Vec3d place_along(const Queue& queue, size_t n) {
  const std::vector<Vec3d>& line = queue.line;
  double offset = static_cast<double>(n) * queue.spacing;
  for (size_t i = 0; i + 1 < line.size(); ++i) {
    const double segment = plan_distance(line[i], line[i + 1]);
    if (offset > segment && i + 2 < line.size()) {
      offset -= segment;
      continue;
    }
    if (segment <= 0) return line[i];
    const double part = offset / segment;
    return {line[i].x + (line[i + 1].x - line[i].x) * part,
            line[i].y + (line[i + 1].y - line[i].y) * std::min(part, 1.0),
            line[i].z + (line[i + 1].z - line[i].z) * part};
  }
  return line.back();
}

// The place of the n-th of a line: no place that an obstacle covers is used. Where there is no
// floor, the last place before that has one.
Place Simulation::State::in_line(size_t line, size_t index, int32_t avatar_class) const {
  const Queue& queue = scenario.queues[line];
  const std::vector<size_t>& covered = lines[line].covered;
  for (const size_t c : covered) index += c <= index ? 1 : 0;
  for (size_t n = index + 1; n-- > 0;) {
    if (std::binary_search(covered.begin(), covered.end(), n)) continue;
    const Place place = world.find_place(avatar_class, place_along(queue, n), kFloor);
    if (place) return place;
  }
  return {};
}

void Simulation::State::move_lines() {
  for (size_t q = 0; q < lines.size(); ++q) {
    WaitingLine& line = lines[q];
    const Queue& queue = scenario.queues[q];
    const auto servers = static_cast<size_t>(queue.servers);
    // Avatars whose service is over leave the line.
    for (size_t i = 0; i < std::min(servers, line.members.size());) {
      ScenarioAvatar* p = find_avatar(line.members[i]);
      if (line.served[i] >= 0 && line.served[i] <= time()) {
        line.members.erase(line.members.begin() + static_cast<std::ptrdiff_t>(i));
        line.served.erase(line.served.begin() + static_cast<std::ptrdiff_t>(i));
        finish_stage(*p);
      } else {
        ++i;
      }
    }
    // The others close up, and an avatar that stands at a counter is served.
    for (size_t i = 0; i < line.members.size(); ++i) {
      ScenarioAvatar& p = *find_avatar(line.members[i]);
      const Place place = in_line(q, i, class_of(p));
      const bool is_current = p.goal.level1 == place.level1 &&
                              plan_distance(p.goal.position, place.position) < queue.spacing / 4;
      if (!is_current || retries(p)) walk_to(p, place, Doing::kInQueue);
      const auto state = crowd.read(p.id);
      if (i < servers && line.served[i] < 0 &&
          plan_distance(state->position, place.position) < kServiceRadius) {
        line.served[i] = time() + draw(queue.service, scenario.seed, p.number, 16 + p.draws++);
      }
    }
    // An avatar that reaches the tail joins; the others head to where it is now.
    size_t kept = 0;
    for (const uint64_t number : line.approaching) {
      ScenarioAvatar* p = find_avatar(number);
      if (p == nullptr || (p->doing != Doing::kToQueue && p->doing != Doing::kGoalUnreachable))
        continue;
      const Place tail = in_line(q, line.members.size(), class_of(*p));
      const auto state = crowd.read(p->id);
      if (tail && plan_distance(state->position, tail.position) < kTailRadius &&
          std::fabs(state->position.y - tail.position.y) < kTailRadius) {
        line.members.push_back(number);
        line.served.push_back(-1);
        walk_to(*p, tail, Doing::kInQueue);
        continue;
      }
      line.approaching[kept++] = number;
      if (plan_distance(p->goal.position, tail.position) > kTailRadius / 2 || retries(*p))
        walk_to(*p, tail, Doing::kToQueue);
    }
    line.approaching.resize(kept);
  }
}

// At each departure, up to `capacity` avatars that wait leave the crowd until their exit is due.
void Simulation::State::run_links() {
  for (size_t n = 0; n < boarding.size(); ++n) {
    const Link& link = scenario.links[n];
    BoardingQueue& boarding_queue = boarding[n];
    for (; boarding_queue.next <= time() + 1e-9; boarding_queue.next += link.interval) {
      for (int32_t k = 0; k < link.capacity && !boarding_queue.members.empty(); ++k) {
        ScenarioAvatar& p = *find_avatar(boarding_queue.members.front());
        boarding_queue.members.pop_front();
        PendingSpawn out;
        out.avatar = p;
        out.link = static_cast<int32_t>(n);
        remove_from_crowd(p);
        out.avatar.id = {};
        out.avatar.area = -1;
        in_transit.push(n, time() + link.seconds, out);
      }
    }
  }
}

}  // namespace throng
