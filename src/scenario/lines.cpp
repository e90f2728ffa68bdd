// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "scenario/simulation_state.h"

// Lines of people before counters, and links: lifts and escalators.
namespace throng {
namespace {

constexpr double kAtTail = 1.2;   // [m] Who is so near its tail joins a line.
constexpr double kAtHead = 0.45;  // [m] Who is so near his place at a counter is served.
constexpr double kFloor = 1;      // [m] Between a line as it is written and the floor.

double distance(const Vec3d& a, const Vec3d& b) {
  const double x = a.x - b.x, z = a.z - b.z;
  return std::sqrt(x * x + z * z);
}

// The point so far behind the head of a line; beyond its end, on along its last leg.
Vec3d along(const std::vector<Vec3d>& line, double way) {
  for (size_t i = 0; i + 1 < line.size(); ++i) {
    const double segment = distance(line[i], line[i + 1]);
    if (way > segment && i + 2 < line.size()) {
      way -= segment;
      continue;
    }
    if (segment <= 0) return line[i];
    const double part = way / segment;
    return {line[i].x + (line[i + 1].x - line[i].x) * part,
            line[i].y + (line[i + 1].y - line[i].y) * std::min(part, 1.0),
            line[i].z + (line[i + 1].z - line[i].z) * part};
  }
  return line.back();
}

}  // namespace

// Where the n-th of a line stands; where the line has no ground, as far back as it has.
Place Simulation::State::in_line(const Queue& queue, size_t index, int32_t avatar_class) const {
  for (size_t n = index + 1; n-- > 0;) {
    const Vec3d at = along(queue.line, static_cast<double>(n) * queue.spacing);
    const Place place = world.find_place(avatar_class, at, kFloor);
    if (place) return place;
  }
  return {};
}

void Simulation::State::move_lines() {
  for (size_t q = 0; q < lines.size(); ++q) {
    WaitingLine& line = lines[q];
    const Queue& queue = scenario.queues[q];
    const auto servers = static_cast<size_t>(queue.servers);
    // Who has been served goes.
    for (size_t i = 0; i < std::min(servers, line.people.size());) {
      Person* p = person(line.people[i]);
      if (line.served[i] >= 0 && line.served[i] <= time()) {
        line.people.erase(line.people.begin() + static_cast<std::ptrdiff_t>(i));
        line.served.erase(line.served.begin() + static_cast<std::ptrdiff_t>(i));
        finish_stage(*p);
      } else {
        ++i;
      }
    }
    // Those behind close up, and whoever stands at a counter is served.
    for (size_t i = 0; i < line.people.size(); ++i) {
      Person& p = *person(line.people[i]);
      const Place place = in_line(queue, i, class_of(p));
      const bool is_his = p.spot.level1 == place.level1 &&
                          distance(p.spot.position, place.position) < queue.spacing / 4;
      if (!is_his) walk_to(p, place, Doing::kInQueue);
      const auto state = crowd.read(p.id);
      if (i < servers && line.served[i] < 0 &&
          distance(state->position, place.position) < kAtHead) {
        line.served[i] = time() + draw(queue.service, scenario.seed, p.number, 16 + p.draws++);
      }
    }
    // Whoever reaches the tail joins; the others go where it is now.
    size_t still = 0;
    for (const uint64_t number : line.coming) {
      Person* p = person(number);
      if (p == nullptr || (p->doing != Doing::kToQueue && p->doing != Doing::kGoalUnreachable))
        continue;
      const Place tail = in_line(queue, line.people.size(), class_of(*p));
      const auto state = crowd.read(p->id);
      if (tail && distance(state->position, tail.position) < kAtTail &&
          std::fabs(state->position.y - tail.position.y) < kAtTail) {
        line.people.push_back(number);
        line.served.push_back(-1);
        walk_to(*p, tail, Doing::kInQueue);
        continue;
      }
      line.coming[still++] = number;
      if (distance(p->spot.position, tail.position) > kAtTail / 2)
        walk_to(*p, tail, Doing::kToQueue);
    }
    line.coming.resize(still);
  }
}

// Who waits at a link when it leaves comes out at its other end later.
void Simulation::State::run_links() {
  for (size_t n = 0; n < landings.size(); ++n) {
    const Link& link = scenario.links[n];
    Landing& landing = landings[n];
    for (; landing.next <= time() + 1e-9; landing.next += link.interval) {
      for (int32_t k = 0; k < link.capacity && !landing.people.empty(); ++k) {
        Person& p = *person(landing.people.front());
        landing.people.pop_front();
        Coming out;
        out.person = p;
        out.due = time() + link.seconds;
        out.link = static_cast<int32_t>(n);
        take_out(p);
        out.person.id = {};
        out.person.area = -1;
        riding.push_back(out);
      }
    }
  }
}

}  // namespace throng
