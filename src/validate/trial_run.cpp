// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "core/stopwatch.h"
#include "throng/scenario.h"
#include "validate/statistics.h"

// Runs the scenario of a trial and measures after every step. Cost of a step: its avatars times the
// measures.
namespace throng {
namespace {

constexpr double kFirstStep = 0.02;  // [m] in one step: a shorter move may be a yield to others.

bool covers(const ScenarioArea& area, const Vec3d& at) {
  return std::ranges::any_of(area.prisms, [&](const Prism& p) { return p.contains(at); });
}

// By the shoelace formula. The parts of an area must not overlap.
double size_of(const ScenarioArea& area) {
  double sum = 0;
  for (const Prism& prism : area.prisms) {
    double twice = 0;
    for (size_t i = 0; i < prism.corners.size(); ++i) {
      const auto &a = prism.corners[i], &b = prism.corners[(i + 1) % prism.corners.size()];
      twice += a[0] * b[1] - a[1] * b[0];
    }
    sum += std::fabs(twice) / 2;
  }
  return sum;
}

bool is_in(const std::vector<int32_t>& list, int32_t index) {
  return list.empty() || std::ranges::find(list, index) != list.end();
}

bool counts(const TrialMeasure& m, const Trip& v) {
  return v.entered >= 0 && is_in(m.sources, v.source) && is_in(m.profiles, v.profile) &&
         is_in(m.journeys, v.journey) &&
         (m.exits.empty() || (v.left >= 0 && is_in(m.exits, v.exit)));
}

// The parameter from a to b of the crossing with a line, 0 to 1; none if there is no crossing.
std::optional<double> crossing(const Vec3d& a, const Vec3d& b,
                               const std::array<std::array<double, 2>, 2>& line) {
  const double lx = line[1][0] - line[0][0], lz = line[1][1] - line[0][1];
  const auto side = [&](const Vec3d& p) {
    return lx * (p.z - line[0][1]) - lz * (p.x - line[0][0]);
  };
  const double before = side(a), after = side(b);
  if ((before < 0) == (after < 0)) return {};
  const double part = before / (before - after);
  const double x = a.x + part * (b.x - a.x), z = a.z + part * (b.z - a.z);
  const double along = (lx * (x - line[0][0]) + lz * (z - line[0][1])) / (lx * lx + lz * lz);
  return along >= 0 && along <= 1 ? std::optional(part) : std::nullopt;
}

// The data collected for one measure during the run.
struct MeasureData {
  std::vector<double> distance, time;  // by person: in the area [m, s]
  std::vector<double> density;         // by step [1/m2]
  std::vector<double> crossed;         // [s]
  std::vector<bool> has_crossed;       // by person
};

class Observer {
 public:
  explicit Observer(const Trial& trial) : trial_(trial), data_(trial.measures.size()) {}

  void observe(const Simulation& simulation, double time) {
    simulation.read(states_);
    const auto trips = simulation.trips();
    const size_t people = trips.size();
    last_position_.resize(people);
    was_here_.resize(people, 0);
    first_step_.resize(people, -1);
    inside_.assign(data_.size(), 0);
    ++observations_;
    for (const AvatarState& state : states_) {
      const size_t n = state.id;
      const Vec3d& now = state.position;
      // An avatar observed the last time has walked since; in a lift it is not observed.
      if (was_here_[n] == observations_ - 1 && was_here_[n] > 0) {
        walked(trips[n], last_position_[n], now, time);
      } else {
        for (size_t k = 0; k < data_.size(); ++k) stands(k, trips[n], now);
      }
      last_position_[n] = now;
      was_here_[n] = observations_;
    }
    for (size_t k = 0; k < data_.size(); ++k) {
      const TrialMeasure& m = trial_.measures[k];
      if (m.of != Observed::kDensity || time < m.from || time > m.until) continue;
      const ScenarioArea& area = trial_.scenario.areas[static_cast<size_t>(m.area)];
      data_[k].density.push_back(inside_[k] / size_of(area));
    }
  }

  [[nodiscard]] std::vector<ValidationMeasure> measures(std::span<const Trip> trips) const {
    std::vector<ValidationMeasure> out;
    for (size_t k = 0; k < data_.size(); ++k) {
      const TrialMeasure& m = trial_.measures[k];
      out.push_back({.name = m.name,
                     .value = value(k, trips, out),
                     .unit = unit(m),
                     .low = m.low,
                     .high = m.high});
      if (m.others.empty() || m.of == Observed::kRatio) continue;
      out.back().unit = out[m.others.front()].unit;
    }
    return out;
  }

 private:
  void stands(size_t k, const Trip& trip, const Vec3d& now) {
    const TrialMeasure& m = trial_.measures[k];
    if (m.of != Observed::kDensity || !counts(m, trip)) return;
    if (covers(trial_.scenario.areas[static_cast<size_t>(m.area)], now)) inside_[k] += 1;
  }

  void walked(const Trip& trip, const Vec3d& before, const Vec3d& now, double time) {
    const double distance = std::hypot(now.x - before.x, now.z - before.z);
    const double dt = trial_.scenario.dt;
    double& first = first_step_[trip.person];
    if (first < 0 && time > trip.started && distance >= kFirstStep) first = time;
    for (size_t k = 0; k < data_.size(); ++k) {
      const TrialMeasure& m = trial_.measures[k];
      stands(k, trip, now);
      if (time < m.from || time > m.until || !counts(m, trip)) continue;
      MeasureData& data = data_[k];
      if (m.of == Observed::kSpeed) {
        const bool here =
            m.area < 0 ? time - dt >= trip.started - 1e-9
                       : covers(trial_.scenario.areas[static_cast<size_t>(m.area)], now) &&
                             covers(trial_.scenario.areas[static_cast<size_t>(m.area)], before);
        if (!here) continue;
        data.distance.resize(last_position_.size());
        data.time.resize(last_position_.size());
        data.distance[trip.person] += distance;
        data.time[trip.person] += dt;
      } else if (m.of == Observed::kFlow || m.of == Observed::kPassed) {
        data.has_crossed.resize(last_position_.size());
        const auto part = crossing(before, now, m.line);
        if (!part || data.has_crossed[trip.person]) continue;
        data.has_crossed[trip.person] = true;
        data.crossed.push_back(time - dt * (1 - *part));
      }
    }
  }

  static std::string unit(const TrialMeasure& m) {
    if (m.statistic == Statistic::kFit) return "p";
    switch (m.of) {
      case Observed::kTime:
      case Observed::kLeft:
      case Observed::kPremovement:
      case Observed::kDelay:
        return "s";
      case Observed::kDesiredSpeed:
      case Observed::kSpeed:
        return "m/s";
      case Observed::kDensity:
        return "1/m2";
      case Observed::kFlow:
        return m.by_width ? "p/(m s)" : "p/s";
      default:
        return "";
    }
  }

  // One number for each person that the measure counts.
  [[nodiscard]] std::vector<double> of_each(size_t k, std::span<const Trip> trips) const {
    const TrialMeasure& m = trial_.measures[k];
    std::vector<double> numbers;
    for (const Trip& v : trips) {
      if (!counts(m, v)) continue;
      if (m.of == Observed::kPremovement) numbers.push_back(v.started - v.entered);
      if (m.of == Observed::kDesiredSpeed) numbers.push_back(v.speed);
      if (m.of == Observed::kDelay && first_step_[v.person] >= 0) {
        numbers.push_back(first_step_[v.person] - v.started);
      }
      if (m.of == Observed::kTime && v.left >= 0) numbers.push_back(v.left - v.started);
      if (m.of == Observed::kLeft && v.left >= 0) numbers.push_back(v.left);
      if (m.of == Observed::kSpeed && v.person < data_[k].time.size() &&
          data_[k].time[v.person] > 0) {
        numbers.push_back(data_[k].distance[v.person] / data_[k].time[v.person]);
      }
    }
    return numbers;
  }

  // The distribution that the scenario states for the numbers: of the first source or profile of
  // the measure.
  [[nodiscard]] const Distribution& distribution_of(const TrialMeasure& m) const {
    const Scenario& s = trial_.scenario;
    if (m.of == Observed::kPremovement) {
      return s.sources[m.sources.empty() ? 0 : static_cast<size_t>(m.sources[0])].premovement;
    }
    return s.profiles[m.profiles.empty() ? 0 : static_cast<size_t>(m.profiles[0])].speed;
  }

  [[nodiscard]] double statistic_of(const TrialMeasure& m,
                                    const std::vector<double>& numbers) const {
    if (numbers.empty()) return std::nan("");
    const auto [min, max] = std::ranges::minmax(numbers);
    double sum = 0;
    for (const double x : numbers) sum += x;
    switch (m.statistic) {
      case Statistic::kMin:
        return min;
      case Statistic::kMax:
        return max;
      case Statistic::kRange:
        return max - min;
      case Statistic::kFit: {
        const auto share = [&](double x) { return validate::share_below(distribution_of(m), x); };
        return validate::ks_likelihood(validate::ks_distance(numbers, share), numbers.size());
      }
      default:
        return sum / static_cast<double>(numbers.size());
    }
  }

  [[nodiscard]] double value(size_t k, std::span<const Trip> trips,
                             const std::vector<ValidationMeasure>& before) const {
    const TrialMeasure& m = trial_.measures[k];
    const auto count = [&](bool has_left) {
      return static_cast<double>(std::ranges::count_if(
          trips, [&](const Trip& v) { return counts(m, v) && (v.left >= 0) == has_left; }));
    };
    switch (m.of) {
      case Observed::kPeople:
        return count(true);
      case Observed::kStayed:
        return count(false);
      case Observed::kPassed:
        return static_cast<double>(data_[k].crossed.size());
      case Observed::kFlow: {
        std::vector<double> times = data_[k].crossed;
        std::sort(times.begin(), times.end());
        const double width = std::hypot(m.line[1][0] - m.line[0][0], m.line[1][1] - m.line[0][1]);
        return validate::flow_rate(times) / (m.by_width ? width : 1);
      }
      case Observed::kDensity:
        return statistic_of(m, data_[k].density);
      case Observed::kRatio:
        return before[m.others[0]].value / before[m.others[1]].value;
      case Observed::kDifference:
        return before[m.others[0]].value - before[m.others[1]].value;
      case Observed::kRise: {
        double smallest = std::numeric_limits<double>::infinity();
        for (size_t i = 1; i < m.others.size(); ++i) {
          const double step = before[m.others[i]].value - before[m.others[i - 1]].value;
          if (std::isnan(step)) return step;
          smallest = std::min(smallest, step);
        }
        return smallest;
      }
      default:
        break;
    }
    if (m.statistic != Statistic::kOverall) return statistic_of(m, of_each(k, trips));
    double distance = 0, time = 0;
    for (const double d : data_[k].distance) distance += d;
    for (const double t : data_[k].time) time += t;
    return distance / time;
  }

  const Trial& trial_;
  std::vector<MeasureData> data_;  // by measure
  std::vector<AvatarState> states_;
  std::vector<Vec3d> last_position_;  // by person
  std::vector<uint64_t> was_here_;    // by person: the last observation that had it
  std::vector<double> first_step_;    // by person [s]
  std::vector<double> inside_;        // by measure: people in its area
  uint64_t observations_ = 0;
};

}  // namespace

Result<ValidationResult> run_trial(const Trial& trial, const ValidationConfig& config,
                                   Context& context) {
  if (!trial.lacks.empty()) {
    return Error{Errc::kBadConfig, trial.about.name + ": cannot be run: " + trial.lacks};
  }
  const auto start = Clock::now();
  Scenario scenario = trial.scenario;
  scenario.seed += config.seed - 1;
  if (config.model != SteeringModel::kSampled) scenario.steering = config.model;
  if (config.pushing) scenario.let_push();
  const auto world = open_world(scenario, context);
  if (!world) return world.error();
  auto simulation = Simulation::create(*world, scenario, config.workers, context);
  if (!simulation) return simulation.error();
  Observer observer(trial);
  observer.observe(*simulation, 0);
  ValidationResult result;
  const auto steps = static_cast<uint64_t>(std::ceil(scenario.seconds / scenario.dt - 1e-9));
  for (uint64_t step = 0; step < steps && !simulation->is_over(); ++step) {
    const auto report = simulation->step();
    if (!report) return report.error();
    observer.observe(*simulation, report->time);
    const CrowdCheck found = simulation->crowd().check();
    result.faults.overlaps += found.overlaps;
    result.faults.wall_entries += found.wall_entries;
    result.faults.obstacle_entries += found.obstacle_entries;
    ++result.checks;
    result.simulated = report->time;
    if (context.cancel) return Error{Errc::kCancelled, "cancelled"};
  }
  result.measures = observer.measures(simulation->trips());
  result.seconds = seconds_since(start);
  return result;
}

}  // namespace throng
