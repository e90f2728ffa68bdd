// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "path/edits/solid.h"
#include "path/overlay/node_finder.h"
#include "throng/path.h"
#include "throng/surface.h"

// Paths over the nodes of a baked world, by overlay cells and by a search of all crossings: their
// time by distance, how much longer they are, and whether both agree on what is reachable.
namespace throng::bench {
namespace {

using Json = nlohmann::ordered_json;

struct Options {
  std::string world, avatar_class = "adult";
  std::vector<double> distances{100, 500, 1000, 2000};
  int pairs = 60;
  int judged = 30;  // pairs of each distance that all crossings are searched for, too
  int crates = 60;  // pairs of each distance with a crate put onto their path
  int threads = 2;  // for making the finders
};

[[noreturn]] void stop(const std::string& message) {
  fmt::print(stderr, "bench_node_paths: {}\n", message);
  std::exit(2);
}

double now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

struct Pair {
  NodePlace from, to;
};

// About so far from each other, whether or not a path joins them.
std::vector<Pair> find_pairs(const Nodes& nodes, int32_t avatar_class, double apart, int count) {
  std::vector<Pair> pairs;
  NodePlace from;
  for (uint64_t n = 0; pairs.size() < static_cast<size_t>(count) && n < 400'000; ++n) {
    constexpr uint64_t kEndsPerStart = 512;  // of ends for each beginning
    if (n % kEndsPerStart == 0) from = nodes.random_place(avatar_class, 1, n);
    const NodePlace to = nodes.random_place(avatar_class, 2, n);
    if (!from || !to) stop("the class has no nodes");
    const double far = length(to.feet - from.feet);
    if (far < 0.9 * apart || far > 1.1 * apart) continue;
    pairs.push_back({from, to});
    n |= kEndsPerStart - 1;
  }
  return pairs;
}

double median(std::vector<double> values) {
  if (values.empty()) return 0;
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

Json measure(const Nodes& nodes, int32_t avatar_class, path::NodeFinder& finder,
             path::NodeFinder& search, double apart, const Options& options) {
  const std::vector<Pair> pairs = find_pairs(nodes, avatar_class, apart, options.pairs);
  std::vector<double> reached_ms, other_ms, search_ms, looked, searched;
  double length_sum = 0, ours = 0, best = 0, worst = 0;
  int differ = 0;
  Path path, shortest;
  for (size_t i = 0; i < pairs.size(); ++i) {
    double start = now();
    finder.find(pairs[i].from, pairs[i].to, path);
    const double took = (now() - start) * 1e3;
    const bool reached = path.end == PathEnd::kReached;
    (reached ? reached_ms : other_ms).push_back(took);
    if (reached) {
      length_sum += path.length;
      looked.push_back(static_cast<double>(path.nodes));
    }
    if (i >= static_cast<size_t>(options.judged)) continue;
    start = now();
    search.find(pairs[i].from, pairs[i].to, shortest);
    const double plainly = (now() - start) * 1e3;
    differ += shortest.end != path.end;
    if (!reached || shortest.end != PathEnd::kReached) continue;
    search_ms.push_back(plainly);
    searched.push_back(static_cast<double>(shortest.nodes));
    ours += path.length;
    best += shortest.length;
    worst = std::max(worst, path.length / shortest.length);
  }
  const auto max_of = [](const std::vector<double>& values) {
    return values.empty() ? 0 : *std::max_element(values.begin(), values.end());
  };
  return {{"distance", apart},
          {"pairs", pairs.size()},
          {"reached", reached_ms.size()},
          {"mean_length", length_sum / std::max<double>(1, static_cast<double>(reached_ms.size()))},
          {"median_ms", median(reached_ms)},
          {"max_ms", max_of(reached_ms)},
          {"expanded", median(looked)},
          {"unreachable_median_ms", median(other_ms)},
          {"unreachable_max_ms", max_of(other_ms)},
          {"judged", search_ms.size()},
          {"differ", differ},
          {"search_median_ms", median(search_ms)},
          {"search_max_ms", max_of(search_ms)},
          {"searched", median(searched)},
          {"mean_ratio", best > 0 ? ours / best : 0},
          {"worst_ratio", worst}};
}

// A crate of a metre in the middle of each path: the time until it is avoided, and how much longer
// the path around it is than what a search of all crossings finds.
Json put_crates(const Nodes& nodes, int32_t avatar_class, path::NodeFinder& finder,
                path::NodeFinder& search, double apart, const Options& options) {
  std::vector<double> before_ms, add_ms, find_ms, both_ms, without_ms;
  double ours = 0, best = 0, worst = 0;
  int shut = 0, differ = 0;
  Path path, shortest;
  const auto timed = [](std::vector<double>& list, auto&& call) {
    const double start = now();
    call();
    list.push_back((now() - start) * 1e3);
  };
  for (const auto& [from, to] : find_pairs(nodes, avatar_class, apart, 3 * options.crates)) {
    if (add_ms.size() == static_cast<size_t>(options.crates)) break;
    double start = now();
    finder.find(from, to, path);
    const double before = (now() - start) * 1e3;
    if (path.end != PathEnd::kReached || path.points.size() < 3) continue;
    before_ms.push_back(before);
    const Vec3d at = path.node_places[path.points.size() / 2].feet;
    const Prism crate =
        Prism::box({at.x - 0.5, at.y, at.z - 0.5}, {at.x + 0.5, at.y + 1, at.z + 0.5});
    path::ChangeId id = 0;
    timed(add_ms, [&] { id = finder.add_obstacle({crate}); });
    timed(find_ms, [&] { finder.find(from, to, path); });
    both_ms.push_back(add_ms.back() + find_ms.back());
    const path::ChangeId other = search.add_obstacle({crate});
    search.find(from, to, shortest);
    search.remove(other);
    differ += shortest.end != path.end;
    shut += path.end != PathEnd::kReached;
    if (path.end == PathEnd::kReached && shortest.end == PathEnd::kReached) {
      ours += path.length;
      best += shortest.length;
      worst = std::max(worst, path.length / shortest.length);
    }
    finder.remove(id);
    timed(without_ms, [&] { finder.find(from, to, path); });
  }
  std::sort(both_ms.begin(), both_ms.end());
  return {{"distance", apart},
          {"crates", add_ms.size()},
          {"before_median_ms", median(before_ms)},
          {"add_median_ms", median(add_ms)},
          {"find_median_ms", median(find_ms)},
          {"until_median_ms", median(both_ms)},
          {"until_max_ms", both_ms.empty() ? 0 : both_ms.back()},
          {"without_median_ms", median(without_ms)},
          {"shut", shut},
          {"differ", differ},
          {"mean_ratio", best > 0 ? ours / best : 0},
          {"worst_ratio", worst}};
}

Json run(const Options& options) {
  Context context;
  const Result<Nodes> nodes = Nodes::open(options.world);
  if (!nodes) stop(nodes.error().message);
  const std::vector<AvatarClass> classes = nodes->summary().classes;
  const auto found = std::find_if(classes.begin(), classes.end(), [&](const AvatarClass& avatar) {
    return avatar.name == options.avatar_class;
  });
  if (found == classes.end()) stop("there is no class " + options.avatar_class);
  const auto avatar_class = static_cast<int32_t>(found - classes.begin());
  const auto make = [&](bool overlay) {
    auto made = path::NodeFinder::create(
        *nodes, {.avatar_class = avatar_class, .overlay = overlay, .workers = options.threads},
        context);
    if (!made) stop(made.error().message);
    return *std::move(made);
  };
  path::NodeFinder finder = make(true), search = make(false);
  const PathSummary made = finder.summary(), plain = search.summary();
  Json paths = Json::array(), crates = Json::array();
  for (const double apart : options.distances) {
    paths.push_back(measure(*nodes, avatar_class, finder, search, apart, options));
    if (options.crates == 0) continue;
    crates.push_back(put_crates(*nodes, avatar_class, finder, search, apart, options));
  }
  return {{"world", options.world},
          {"class", options.avatar_class},
          {"crossings", made.crossings},
          {"seconds", made.seconds},
          {"bytes", made.bytes},
          {"search_seconds", plain.seconds},
          {"search_bytes", plain.bytes},
          {"paths", paths},
          {"crates", crates}};
}

}  // namespace
}  // namespace throng::bench

int main(int argc, char** argv) {
  using namespace throng::bench;
  CLI::App parser{"Paths over the nodes of a baked world", "bench_node_paths"};
  Options options;
  parser.add_option("world", options.world, "World folder with nodes")->required();
  parser.add_option("--class", options.avatar_class, "Avatar class")->capture_default_str();
  parser.add_option("--distances", options.distances, "About how far the ends are apart [m]")
      ->delimiter(',');
  parser.add_option("--pairs", options.pairs, "Pairs of each distance")->capture_default_str();
  parser.add_option("--judged", options.judged, "Pairs that are searched for plainly, too")
      ->capture_default_str();
  parser.add_option("--crates", options.crates, "Pairs with a crate on their path")
      ->capture_default_str();
  parser.add_option("--threads", options.threads, "Threads to make the finders")
      ->capture_default_str();
  CLI11_PARSE(parser, argc, argv);
  fmt::print("{}\n", run(options).dump());
  return 0;
}
