// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "steer_bench.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numbers>
#include <optional>
#include <pugixml.hpp>
#include <utility>

#include "core/files/read_file.h"
#include "core/random.h"

// Elements are read in the order of the file into a draft. Then what is left to chance is placed:
// obstacles, starts, targets. The first fault ends it; all later ones follow from it.
namespace throng::test {
namespace {

constexpr double kWall = 2;         // [m] high
constexpr double kMargin = 0.25;    // [m] of random places from walls, beyond the radius
constexpr double kApart = 0.02;     // [m] between bodies at random starts
constexpr uint64_t kTries = 10000;  // for each random place
constexpr double kMaxCount = 100000;
constexpr int kCircleCorners = 32;
enum Stream : uint64_t { kObstacleStream = 1, kStartStream, kTargetStream };

struct Bounds {
  double x0 = 0, z0 = 0, x1 = 0, z1 = 0;
};

// A point, or any in a region.
struct PointOrRegion {
  Vec3d at;
  std::optional<Bounds> anywhere_in;
};

struct Agent {
  pugi::xml_node node;
  PointOrRegion from, to;
  double radius = 0, speed = 0;
};

struct ObstacleRegion {
  pugi::xml_node node;
  Bounds bounds;
  uint64_t count = 0;
  double size = 0;
};

Ring ring_of(const Bounds& b) { return {{b.x0, b.z0}, {b.x1, b.z0}, {b.x1, b.z1}, {b.x0, b.z1}}; }

// Distance of a point from a polygon; 0 inside.
double distance_to(const Ring& ring, const Vec3d& p) {
  bool inside = false;
  double nearest = INFINITY;
  for (size_t i = 0; i < ring.size(); ++i) {
    const auto [ax, az] = ring[i];
    const auto [bx, bz] = ring[(i + 1) % ring.size()];
    const double dx = bx - ax, dz = bz - az;
    if ((az > p.z) != (bz > p.z) && p.x < ax + dx * (p.z - az) / dz) inside = !inside;
    const double length2 = dx * dx + dz * dz;
    const double along = length2 > 0 ? ((p.x - ax) * dx + (p.z - az) * dz) / length2 : 0;
    const double t = std::clamp(along, 0.0, 1.0);
    nearest = std::min(nearest, std::hypot(p.x - ax - t * dx, p.z - az - t * dz));
  }
  return inside ? 0 : nearest;
}

class CaseReader {
 public:
  CaseReader(std::string_view text, const std::string& name, uint64_t seed)
      : text_(text), name_(name), seed_(seed) {}

  Result<Play> read() {
    pugi::xml_document document;
    const pugi::xml_parse_result parsed = document.load_buffer(text_.data(), text_.size());
    if (!parsed) return Error{Errc::kBadFile, place_of(parsed.offset) + parsed.description()};
    const pugi::xml_node root = document.child("SteerBenchTestCase");
    if (!root) return Error{Errc::kBadFile, name_ + ": holds no SteerBenchTestCase"};
    const pugi::xml_node header = child(root, "header");
    play_.name = header.child("name").text().as_string();
    world_ = bounds(child(header, "worldBounds"));
    for (const pugi::xml_node& node : root.children()) read_element(node);
    if (agents_.empty()) refuse(root, "has no agents");
    for (const Agent& agent : agents_) radius_ = std::max(radius_, agent.radius);
    for (const ObstacleRegion& region : regions_) place_obstacles(region);
    place_starts();
    place_targets();
    if (!fault_.empty()) return Error{Errc::kBadFile, fault_};
    return finish();
  }

 private:
  // "NAME:LINE: ".
  [[nodiscard]] std::string place_of(std::ptrdiff_t offset) const {
    const auto end = std::clamp<std::ptrdiff_t>(offset, 0, std::ssize(text_));
    const auto line = 1 + std::count(text_.begin(), text_.begin() + end, '\n');
    return name_ + ":" + std::to_string(line) + ": ";
  }

  void refuse(const pugi::xml_node& node, const std::string& what) {
    if (fault_.empty()) fault_ = place_of(node.offset_debug()) + node.name() + " " + what;
  }

  pugi::xml_node child(const pugi::xml_node& node, const char* name) {
    const pugi::xml_node found = node.child(name);
    if (!found) refuse(node, std::string("without ") + name);
    return found;
  }

  // What stands between the tags, without blanks around it.
  static std::string_view words(const pugi::xml_node& node) {
    constexpr const char* kBlanks = " \t\r\n";
    const std::string_view all = node.child_value();
    const size_t begin = all.find_first_not_of(kBlanks);
    if (begin == std::string_view::npos) return {};
    return all.substr(begin, all.find_last_not_of(kBlanks) + 1 - begin);
  }

  double number(const pugi::xml_node& node, const char* name) {
    const pugi::xml_node found = child(node, name);
    std::string_view digits = words(found);
    if (digits.starts_with('+')) digits.remove_prefix(1);
    double value = 0;
    const auto [end, failed] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    const bool is_read = failed == std::errc{} && end == digits.data() + digits.size();
    if (found && !(is_read && std::fabs(value) <= 1e6)) refuse(found, "is no number up to 1e6");
    return value;
  }

  double positive(const pugi::xml_node& node, const char* name) {
    const double value = number(node, name);
    if (!(value > 0)) refuse(node, std::string("needs ") + name + " above 0");
    return value;
  }

  uint64_t count(const pugi::xml_node& node, const char* name) {
    const double value = positive(node, name);
    if (value > kMaxCount || value != std::floor(value)) {
      refuse(node, std::string("needs a whole number of at most 100000 as ") + name);
      return 0;
    }
    return static_cast<uint64_t>(value);
  }

  Bounds bounds(const pugi::xml_node& node) {
    const Bounds b{number(node, "xmin"), number(node, "zmin"), number(node, "xmax"),
                   number(node, "zmax")};
    if (!(b.x0 <= b.x1 && b.z0 <= b.z1)) refuse(node, "has a minimum above its maximum");
    return b;
  }

  Vec3d point(const pugi::xml_node& node) { return {number(node, "x"), 0, number(node, "z")}; }

  // A point, or `random`, in the node's own regionBounds or else in `everywhere`.
  PointOrRegion spot(const pugi::xml_node& node, const Bounds& everywhere) {
    if (words(node.child("random")) != "true") return {point(node), {}};
    const pugi::xml_node region = node.child("regionBounds");
    return {{}, region ? bounds(region) : everywhere};
  }

  // Refuses children that have none of some names.
  void allow(const pugi::xml_node& node, std::initializer_list<std::string_view> names) {
    for (const pugi::xml_node& each : node.children()) {
      if (each.type() != pugi::node_element) continue;
      if (std::ranges::find(names, std::string_view(each.name())) == names.end()) {
        refuse(each, std::string("of ") + node.name() + " is not read");
      }
    }
  }

  void read_element(const pugi::xml_node& node) {
    const std::string_view name = node.name();
    if (node.type() != pugi::node_element || name == "header" || name == "suggestedCameraView") {
      return;
    }
    if (name == "agent") return read_agent(node);
    if (name == "agentRegion") return read_agents(node);
    if (name == "obstacle") return obstacles_.push_back(ring_of(bounds(node)));
    if (name == "obstacleRegion") return read_obstacles(node);
    if (name == "circleObstacle") return read_circle(node);
    if (name == "orientedObstacle" || name == "orientedBoxObstacle") return read_oriented(node);
    if (name == "polygonObstacle") return read_polygon(node);
    refuse(node, "is not read");
  }

  // An agent whose start is `from` unless it says where.
  Agent agent(const pugi::xml_node& node, const std::optional<Bounds>& from) {
    Agent agent{.node = node, .from = {}, .to = {}};
    const pugi::xml_node start = child(node, "initialConditions");
    allow(start, {"name", "radius", "position", "direction", "speed"});
    agent.radius = positive(start, "radius");
    agent.from.anywhere_in = from;
    if (!from || start.child("position")) agent.from = spot(child(start, "position"), world_);
    const pugi::xml_node goals = child(node, "goalSequence");
    allow(goals, {"seekStaticTarget"});
    const pugi::xml_node target = child(goals, "seekStaticTarget");
    if (const pugi::xml_node second = target.next_sibling("seekStaticTarget")) {
      refuse(second, "after another is not read");
    }
    allow(target, {"targetLocation", "desiredSpeed", "timeDuration"});
    agent.to = spot(child(target, "targetLocation"), world_);
    agent.speed = positive(target, "desiredSpeed");
    return agent;
  }

  void read_agent(const pugi::xml_node& node) {
    allow(node, {"name", "initialConditions", "goalSequence"});
    agents_.push_back(agent(node, {}));
  }

  void read_agents(const pugi::xml_node& node) {
    allow(node, {"name", "numAgents", "regionBounds", "initialConditions", "goalSequence"});
    const uint64_t all = count(node, "numAgents");
    const Agent like = agent(node, bounds(child(node, "regionBounds")));
    if (fault_.empty()) agents_.insert(agents_.end(), all, like);
  }

  void read_obstacles(const pugi::xml_node& node) {
    allow(node, {"numObstacles", "obstacleSize", "obstacleHeight", "regionBounds"});
    regions_.push_back({node, bounds(child(node, "regionBounds")), count(node, "numObstacles"),
                        positive(node, "obstacleSize")});
  }

  // A polygon around the circle, not in it.
  void read_circle(const pugi::xml_node& node) {
    allow(node, {"position", "radius", "height"});
    const Vec3d middle = point(child(node, "position"));
    const double radius = positive(node, "radius") / std::cos(std::numbers::pi / kCircleCorners);
    Ring ring;
    for (int k = 0; k < kCircleCorners; ++k) {
      const double angle = 2 * std::numbers::pi * k / kCircleCorners;
      ring.push_back({middle.x + radius * std::cos(angle), middle.z + radius * std::sin(angle)});
    }
    obstacles_.push_back(std::move(ring));
  }

  // Turned about Y by thetaY, from z to x.
  void read_oriented(const pugi::xml_node& node) {
    allow(node, {"position", "size", "thetaY"});
    const Vec3d middle = point(child(node, "position"));
    const pugi::xml_node size = child(node, "size");
    const double x = positive(size, "x") / 2, z = positive(size, "z") / 2;
    const double angle = number(node, "thetaY") * std::numbers::pi / 180;
    const double cosine = std::cos(angle), sine = std::sin(angle);
    Ring ring = ring_of({-x, -z, x, z});
    for (auto& [cx, cz] : ring) {
      const double turned = middle.x + cosine * cx + sine * cz;
      cz = middle.z - sine * cx + cosine * cz;
      cx = turned;
    }
    obstacles_.push_back(std::move(ring));
  }

  void read_polygon(const pugi::xml_node& node) {
    allow(node, {"vertices", "vertex", "point", "height"});
    const pugi::xml_node vertices = node.child("vertices") ? node.child("vertices") : node;
    Ring ring;
    for (const pugi::xml_node& vertex : vertices.children()) {
      const std::string_view name = vertex.name();
      if (name != "vertex" && name != "point") continue;
      const Vec3d at = point(vertex);
      ring.push_back({at.x, at.z});
    }
    if (ring.size() < 3) refuse(node, "has fewer than three vertices");
    obstacles_.push_back(std::move(ring));
  }

  [[nodiscard]] Vec3d random_point(const Bounds& b, uint64_t stream) {
    const uint64_t n = drawn_++;
    return {b.x0 + (b.x1 - b.x0) * random_unit(seed_, stream, 2 * n), 0,
            b.z0 + (b.z1 - b.z0) * random_unit(seed_, stream, 2 * n + 1)};
  }

  // Can a body stand there, as far as obstacles and the world's end are concerned?
  [[nodiscard]] bool is_clear(const Vec3d& p) const {
    const double room = radius_ + kMargin;
    if (p.x < world_.x0 + room || p.x > world_.x1 - room || p.z < world_.z0 + room ||
        p.z > world_.z1 - room) {
      return false;
    }
    return std::ranges::all_of(obstacles_,
                               [&](const Ring& ring) { return distance_to(ring, p) >= room; });
  }

  // Draws points until one is right. Refuses the node if none is.
  template <class IsRight>
  Vec3d place(const pugi::xml_node& node, const Bounds& in, uint64_t stream, const char* what,
              IsRight is_right) {
    for (uint64_t n = 0; n < kTries && fault_.empty(); ++n) {
      const Vec3d p = random_point(in, stream);
      if (is_right(p)) return p;
    }
    refuse(node, std::string("has no room for ") + what);
    return {};
  }

  // Boxes with all of themselves in the region, off the starts and targets that the case gives.
  void place_obstacles(const ObstacleRegion& region) {
    const double half = region.size / 2;
    Bounds middles{region.bounds.x0 + half, region.bounds.z0 + half, region.bounds.x1 - half,
                   region.bounds.z1 - half};
    if (middles.x0 > middles.x1 || middles.z0 > middles.z1) {
      return refuse(region.node, "has no room for an obstacle");
    }
    const auto box = [&](const Vec3d& p) {
      return ring_of({p.x - half, p.z - half, p.x + half, p.z + half});
    };
    const auto is_off = [&](const PointOrRegion& spot, const Ring& ring) {
      return spot.anywhere_in || distance_to(ring, spot.at) >= radius_ + kMargin;
    };
    for (uint64_t k = 0; k < region.count && fault_.empty(); ++k) {
      const Vec3d at =
          place(region.node, middles, kObstacleStream, "an obstacle", [&](const Vec3d& p) {
            return std::ranges::all_of(agents_, [&](const Agent& agent) {
              return is_off(agent.from, box(p)) && is_off(agent.to, box(p));
            });
          });
      obstacles_.push_back(box(at));
    }
  }

  void place_starts() {
    std::vector<Vec3d> starts;
    for (const Agent& agent : agents_) {
      if (!agent.from.anywhere_in) starts.push_back(agent.from.at);
    }
    for (Agent& agent : agents_) {
      if (!agent.from.anywhere_in) continue;
      agent.from.at =
          place(agent.node, *agent.from.anywhere_in, kStartStream, "an agent", [&](const Vec3d& p) {
            return is_clear(p) && std::ranges::all_of(starts, [&](const Vec3d& s) {
                     return std::hypot(s.x - p.x, s.z - p.z) >= 2 * radius_ + kApart;
                   });
          });
      starts.push_back(agent.from.at);
    }
  }

  void place_targets() {
    for (Agent& agent : agents_) {
      if (!agent.to.anywhere_in) continue;
      agent.to.at = place(agent.node, *agent.to.anywhere_in, kTargetStream, "a target",
                          [&](const Vec3d& p) { return is_clear(p); });
    }
  }

  Result<Play> finish() {
    PlaneConfig plane;
    plane.ground.outer = ring_of(world_);
    for (Ring& ring : obstacles_) plane.obstacles.push_back({std::move(ring), {}});
    plane.obstacle_height = kWall;
    auto scene = create_plane_scene(plane);
    if (!scene) return Error{Errc::kBadFile, name_ + ": " + scene.error().message};
    play_.scene = *std::move(scene);
    for (const Agent& agent : agents_) {
      play_.walkers.push_back({agent.from.at, agent.to.at, agent.speed});
    }
    play_.avatar.name = "agent";
    play_.avatar.radius = radius_;
    return std::move(play_);
  }

  std::string_view text_;
  const std::string& name_;
  uint64_t seed_;
  uint64_t drawn_ = 0;
  std::string fault_;
  Play play_;
  Bounds world_;
  double radius_ = 0;
  std::vector<Agent> agents_;
  std::vector<Ring> obstacles_;
  std::vector<ObstacleRegion> regions_;
};

}  // namespace

Result<Play> read_steer_bench(std::string_view text, const std::string& name, uint64_t seed) {
  return CaseReader(text, name, seed).read();
}

Result<Play> load_steer_bench(const std::string& path, uint64_t seed) {
  const auto text = read_file(path);
  if (!text) return text.error();
  return read_steer_bench(*text, path, seed);
}

}  // namespace throng::test
