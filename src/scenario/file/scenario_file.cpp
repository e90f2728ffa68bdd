// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <span>

#include "core/files/classes_file.h"
#include "core/files/config_file.h"
#include "core/files/read_file.h"
#include "scenario/file/density_image.h"
#include "scenario/file/scenario_reader.h"
#include "throng/scenario.h"

// Reads scenario files, TOML or JSON: one reader a table, in the order in which tables name each
// other; the first error ends it. docs/scenarios.md has every key. Time: linear in the file, and in
// the pixels of density maps times the areas painted on them.
namespace throng {
namespace {

constexpr double kMaxHeight = 1e6;   // [m] as for worlds
constexpr double kMaxSeconds = 1e9;  // [s]
constexpr int kCircleSides = 32;
constexpr double kMaxStages = 10000;  // of a journey

using Kind = ConfigNode::Kind;
using scenario::is_number;
using scenario::Reader;

// All tables of the file, in the order in which they refer to each other.
class File {
 public:
  File(const std::string& name, const ConfigNode& root)
      : name_(name), folder_(std::filesystem::path(name).parent_path().string()), root_(root) {}

  Result<Scenario> read() {
    read_top();
    each("area", [&](Reader& r) { read_area(r); });
    each("density", [&](Reader& r) { read_density(r); });
    each("profile", [&](Reader& r) { read_profile(r); });
    each("queue", [&](Reader& r) { read_queue(r); });
    each("link", [&](Reader& r) { read_link(r); });
    each("journey", [&](Reader& r) { read_journey(r); });
    each("source", [&](Reader& r) { read_source(r); });
    each("obstacle", [&](Reader& r) { read_obstacle(r); });
    each("attractor", [&](Reader& r) { read_attractor(r); });
    if (!error_.message.empty()) return error_;
    return std::move(out_);
  }

 private:
  void each(const char* key, const std::function<void(Reader&)>& visit) {
    if (!error_.message.empty()) return;
    ConfigReader top(name_, root_, "scenario");
    for (const ConfigNode* table : top.tables(key)) {
      Reader reader(name_, *table, title(key, *table));
      if (reader.ok()) visit(reader);
      keep(reader);
    }
    keep(top);
  }
  void keep(const ConfigReader& reader) {
    if (!reader.ok() && error_.message.empty()) error_ = reader.error();
  }
  static std::string title(const std::string& key, const ConfigNode& table) {
    const ConfigNode* name = table.find("name");
    return name != nullptr && name->kind == Kind::kString ? fmt::format("{} '{}'", key, name->text)
                                                          : key;
  }
  [[nodiscard]] std::string path(const std::string& relative) const {
    return (std::filesystem::path(folder_) / relative).string();
  }
  template <class Thing>
  void name_of(Reader& r, const std::vector<Thing>& others, std::string& name) {
    r.require("name");
    r.text("name", name);
    if (!r.ok()) return;
    if (name.empty()) r.fail(*r.find("name"), "the name is empty");
    for (const Thing& other : others) {
      if (other.name == name) r.fail(*r.find("name"), "the name is used twice");
    }
  }

  void read_top();
  void read_plane(const ConfigNode& table);
  bool read_shape(Reader& r, Prism& prism);
  void read_area(Reader& r);
  void read_obstacle(Reader& r);
  void read_attractor(Reader& r);
  void read_density(Reader& r);
  void read_hours(Reader& r, DensityMap& map);
  void read_profile(Reader& r);
  void read_queue(Reader& r);
  void read_link(Reader& r);
  void read_journey(Reader& r);
  void read_stage(Reader& r, Journey& journey);
  void read_source(Reader& r);
  void heights(Reader& r, double& low, double& high);

  std::string name_, folder_;
  const ConfigNode& root_;
  Scenario out_;
  Error error_;
};

void File::read_top() {
  Reader r(name_, root_, "scenario");
  r.only({"world", "part", "model", "builtin", "plane", "cell", "class", "seconds", "dt", "seed",
          "paths", "ways", "search_memory", "steering", "slow_on_slopes", "avoid_jams", "pushing",
          "acceleration", "area", "density", "profile", "queue", "link", "journey", "source",
          "obstacle", "attractor",
          // The expected results of the run, read by load_trial.
          "trial", "measure"});
  r.text("world", out_.world);
  if (!out_.world.empty()) out_.world = path(out_.world);
  if (const ConfigNode* part = r.find("part"); part != nullptr && out_.world.empty()) {
    r.fail(*part, "part is a district of a baked world; name its folder with world");
  } else if (std::array<double, 4> v{}; r.numbers("part", v.data(), v.size())) {
    out_.part.emplace();
    out_.part->add({v[0], 0, v[1]});
    out_.part->add({v[2], 0, v[3]});
  }
  if (const ConfigNode* model = r.find("model"); model != nullptr) {
    std::vector<const ConfigNode*> files = {model};
    if (model->kind == Kind::kArray) {
      files.clear();
      for (const ConfigNode& item : model->items) files.push_back(&item);
    }
    for (const ConfigNode* file : files) {
      if (file->kind != Kind::kString) r.fail(*file, "model must be a file's name in quotes");
      out_.models.push_back(path(file->text));
    }
  }
  r.number("cell", out_.cell, 0.02, 5);
  r.number("seconds", out_.seconds, 0, kMaxSeconds);
  r.number("dt", out_.dt, 1e-3, 1);
  r.count("seed", out_.seed, 0, 9007199254740992.0);
  constexpr double kMebibyte = 1 << 20;
  double search_memory = static_cast<double>(out_.search_bytes) / kMebibyte;
  r.number("search_memory", search_memory, 1, kMebibyte);
  out_.search_bytes = static_cast<uint64_t>(search_memory * kMebibyte);
  std::string paths = "corners";
  const char* paths_key = r.spelling("paths", "ways");
  r.text(paths_key, paths);
  if (const ConfigNode* node = r.find(paths_key);
      node != nullptr && paths != "corners" && paths != "labels" && paths != "zones") {
    r.fail(*node, fmt::format("{} must be \"corners\", \"labels\" or \"zones\"", paths_key));
  }
  if (paths == "labels") out_.paths = PathSpeedup::kLabels;
  if (paths == "zones") out_.paths = PathSpeedup::kZones;
  std::string steering = throng::name_of(out_.steering);
  r.text("steering", steering);
  if (const auto model = find_steering_model(steering)) {
    out_.steering = *model;
  } else if (const ConfigNode* node = r.find("steering"); node != nullptr) {
    r.fail(*node, std::string("steering must be ") + steering_model_names());
  }
  r.flag("slow_on_slopes", out_.slow_on_slopes);
  r.flag("avoid_jams", out_.avoid_jams);
  r.flag("pushing", out_.pushing);
  r.number("acceleration", out_.acceleration, 0, 1000);
  keep(r);
  if (const ConfigNode* table = r.find("builtin"); table != nullptr) {
    Reader b(name_, *table, "builtin");
    BuiltinWorldConfig config;
    double levels = 0;
    b.only({"name", "size", "levels", "seed"});
    b.require("name");
    b.text("name", config.name);
    b.number("size", config.size, 0, 1e6);
    b.number("levels", levels, 0, 1000);
    b.count("seed", config.seed, 0, 9007199254740992.0);
    config.levels = static_cast<int32_t>(levels);
    out_.builtins.push_back(config);
    keep(b);
  }
  if (const ConfigNode* table = r.find("plane"); table != nullptr) read_plane(*table);
  const int world_count = (out_.world.empty() ? 0 : 1) + (out_.models.empty() ? 0 : 1) +
                          (out_.builtins.empty() ? 0 : 1) + (out_.planes.empty() ? 0 : 1);
  if (world_count != 1) {
    r.fail(root_, "give one of: world (a baked folder), model (files), [builtin], [plane]");
    keep(r);
  }
  each("class", [&](Reader& c) {
    AvatarClass avatar;
    name_of(c, out_.classes, avatar.name);
    read_class(c, avatar);
    c.number("speed", avatar.speed, 0.01, 100);  // the range that a crowd accepts
    out_.classes.push_back(avatar);
  });
  if (!out_.classes.empty() && !out_.world.empty()) {
    r.fail(root_, "the classes of a baked world are baked in; drop [[class]], or bake a model");
    keep(r);
  }
}

void File::read_plane(const ConfigNode& table) {
  Reader r(name_, table, "plane");
  PlaneConfig plane;
  r.only({"floor", "holes", "obstacles", "height"});
  r.require("floor");
  r.number("height", plane.obstacle_height, 0.01, 1000);
  if (const ConfigNode* floor = r.find("floor"); floor != nullptr) {
    r.corners(*floor, "floor", plane.ground.outer);
  }
  const auto rings = [&](const char* key, auto add) {
    const ConfigNode* node = r.find(key);
    if (node == nullptr) return;
    if (node->kind != Kind::kArray) return r.fail(*node, fmt::format("{} must be a list", key));
    for (const ConfigNode& item : node->items) {
      Ring ring;
      r.corners(item, key, ring);
      add(ring);
    }
  };
  rings("holes", [&](const Ring& ring) { plane.ground.holes.push_back(ring); });
  rings("obstacles", [&](const Ring& ring) { plane.obstacles.push_back({ring, {}}); });
  out_.planes.push_back(std::move(plane));
  keep(r);
}

void File::heights(Reader& r, double& low, double& high) {
  low = -kMaxHeight;
  high = kMaxHeight;
  double y[2] = {};
  if (!r.numbers("y", y, 2)) return;
  if (!(y[0] < y[1])) return r.fail(*r.find("y"), "y must be [low, high], low below high");
  low = y[0];
  high = y[1];
}

// A box, a polygon or a circle, with its heights.
bool File::read_shape(Reader& r, Prism& prism) {
  heights(r, prism.low, prism.high);
  const auto shapes = (r.find("box") != nullptr ? 1 : 0) + (r.find("polygon") != nullptr ? 1 : 0) +
                      (r.find("circle") != nullptr ? 1 : 0);
  if (!r.ok()) return false;
  if (shapes != 1) {
    r.fail(r.table(), "give it one shape: box, polygon or circle");
    return false;
  }
  double v[4] = {};
  if (const ConfigNode* polygon = r.find("polygon"); polygon != nullptr) {
    r.corners(*polygon, "polygon", prism.corners);
  } else if (r.find("box") != nullptr) {
    r.numbers("box", v, 4);
    prism.corners = {{v[0], v[1]}, {v[2], v[1]}, {v[2], v[3]}, {v[0], v[3]}};
  } else {
    r.numbers("circle", v, 3);
    prism.corners = Prism::circle({v[0], 0, v[1]}, v[2], 1, kCircleSides).corners;
    if (!(v[2] > 0)) r.fail(*r.find("circle"), "circle must be [x, z, radius], radius above 0");
  }
  if (!r.ok()) return false;
  if (auto ok = check_prism(prism); !ok) r.fail(r.table(), ok.error().message);
  return r.ok();
}

// Tables of one name are one area.
void File::read_area(Reader& r) {
  r.only({"name", "box", "polygon", "circle", "y", "speed_factor", "pace"});
  r.require("name");
  std::string name;
  const char* factor_key = r.spelling("speed_factor", "pace");
  double factor = 1;
  r.text("name", name);
  r.number(factor_key, factor, 0.01, 10);
  Prism prism;
  if (!read_shape(r, prism)) return;
  for (ScenarioArea& area : out_.areas) {
    if (area.name != name) continue;
    if (r.find(factor_key) != nullptr) area.speed_factor = factor;
    return area.prisms.push_back(prism);
  }
  out_.areas.push_back({name, {prism}, factor});
}

void File::read_obstacle(Reader& r) {
  ScenarioObstacle obstacle;
  r.only({"name", "box", "polygon", "circle", "y", "begin", "end", "policy", "line", "speed"});
  name_of(r, out_.obstacles, obstacle.name);
  std::string policy = throng::name_of(obstacle.policy);
  r.text("policy", policy);
  if (policy == throng::name_of(ObstaclePolicy::kWait)) {
    obstacle.policy = ObstaclePolicy::kWait;
  } else if (policy != throng::name_of(obstacle.policy)) {
    return r.fail(*r.find("policy"), "policy: write \"shut\" or \"wait\"");
  }
  r.number("begin", obstacle.begin, 0, kMaxSeconds);
  r.number("end", obstacle.end, 0, kMaxSeconds);
  if (!read_shape(r, obstacle.prism)) return;
  if (!(obstacle.begin < obstacle.end)) {
    return r.fail(r.table(), "it must begin before it ends");
  }
  r.number("speed", obstacle.speed, 0.01, 100);
  const ConfigNode* line = r.find("line");
  if (line != nullptr && r.corners(*line, "line", obstacle.line) && obstacle.line.size() < 2) {
    return r.fail(*line, "line: give at least two points [x, z]");
  }
  if (line == nullptr && r.find("speed") != nullptr) {
    return r.fail(*r.find("speed"), "speed goes with a line");
  }
  out_.obstacles.push_back(std::move(obstacle));
}

void File::read_attractor(Reader& r) {
  Attractor attractor;
  r.only({"name", "density", "source", "obstacle", "radius", "weight"});
  name_of(r, out_.attractors, attractor.name);
  r.require("density");
  r.number("radius", attractor.radius, 0.1, 1000);
  double weight = attractor.weight;
  r.number("weight", weight, 1, 255);
  attractor.weight = static_cast<uint8_t>(std::lround(weight));
  if (!r.ok()) return;
  const ConfigNode *source = r.find("source"), *obstacle = r.find("obstacle");
  if ((source == nullptr) == (obstacle == nullptr)) {
    return r.fail(r.table(), "say what it is fixed to: a source's avatars, or an obstacle");
  }
  attractor.density = r.named(*r.find("density"), out_.densities, "density");
  if (source != nullptr) attractor.source = r.named(*source, out_.sources, "source");
  if (obstacle != nullptr) attractor.obstacle = r.named(*obstacle, out_.obstacles, "obstacle");
  out_.attractors.push_back(std::move(attractor));
}

// `images = [{ at, image }, ...]` and `period`.
void File::read_hours(Reader& r, DensityMap& map) {
  r.number("period", map.period, 0, kMaxSeconds);
  for (const ConfigNode* entry : r.tables("images")) {
    Reader hour(name_, *entry, fmt::format("density '{}': images", map.name));
    hour.only({"at", "image"});
    hour.require("at");
    hour.require("image");
    double at = 0;
    std::string file;
    hour.number("at", at, 0, kMaxSeconds);
    hour.text("image", file);
    DensityMap picture;
    if (hour.ok()) {
      const ConfigNode& node = *hour.find("image");
      if (auto ok = scenario::read_density_image(path(file), picture); !ok) {
        hour.fail(node, ok.error().message);
      } else if (!map.hours.empty() && !(at > map.hours.back().at)) {
        hour.fail(*hour.find("at"), "at: give the images in the order of their times");
      } else if (map.period > 0 && !(at < map.period)) {
        hour.fail(*hour.find("at"), "at must be less than the period");
      } else if (!map.hours.empty() &&
                 (picture.width != map.width || picture.height != map.height)) {
        hour.fail(node, fmt::format("{}: it has {} x {} pixels, the first one {} x {}", file,
                                    picture.width, picture.height, map.width, map.height));
      } else if (std::all_of(picture.weights.begin(), picture.weights.end(),
                             [](uint8_t w) { return w == 0; })) {
        hour.fail(node, file + ": its weights are all 0; paint where avatars may be");
      }
    }
    keep(hour);
    if (!hour.ok()) return;
    map.width = picture.width;
    map.height = picture.height;
    map.hours.push_back({at, std::move(picture.weights)});
  }
  if (map.hours.empty()) return r.fail(*r.find("images"), "images: give at least one");
  map.weights = map.hours.front().weights;
}

void File::read_density(Reader& r) {
  DensityMap map;
  r.only({"name", "box", "y", "image", "images", "period", "paint", "pixel"});
  name_of(r, out_.densities, map.name);
  r.require("box");
  heights(r, map.low, map.high);
  double box[4] = {};
  if (!r.numbers("box", box, 4)) return;
  map.x0 = box[0];
  map.z0 = box[1];
  map.x1 = box[2];
  map.z1 = box[3];
  if (!(map.x0 < map.x1 && map.z0 < map.z1)) {
    return r.fail(*r.find("box"), "box must be [x0, z0, x1, z1], low corner first");
  }
  const ConfigNode* image = r.find("image");
  const ConfigNode* images = r.find("images");
  const int given = (image != nullptr ? 1 : 0) + (images != nullptr ? 1 : 0) +
                    (r.find("paint") != nullptr ? 1 : 0);
  if (given != 1) {
    return r.fail(*r.find("box"),
                  "give it one of: an image, a list 'images', or areas in a list 'paint'");
  }
  for (const auto& [key, with] : {std::pair("period", "images"), std::pair("pixel", "paint")}) {
    if (r.find(key) != nullptr && r.find(with) == nullptr) {
      return r.fail(*r.find(key), fmt::format("{} goes with a list '{}'", key, with));
    }
  }
  if (images != nullptr) {
    read_hours(r, map);
    if (!r.ok()) return;
  } else if (image != nullptr) {
    std::string file;
    r.text("image", file);
    if (!r.ok()) return;
    if (auto ok = scenario::read_density_image(path(file), map); !ok) {
      return r.fail(*image, ok.error().message);
    }
  } else {
    double pixel = 0.5;
    r.number("pixel", pixel, 0.01, 1000);
    const double columns = std::ceil((map.x1 - map.x0) / pixel),
                 rows = std::ceil((map.z1 - map.z0) / pixel);
    if (!(columns * rows <= 1 << 26)) {
      return r.fail(*r.find("box"), "it has more than 67 million pixels; give a larger 'pixel'");
    }
    map.width = static_cast<int32_t>(columns);
    map.height = static_cast<int32_t>(rows);
    map.weights.assign(static_cast<size_t>(columns * rows), 0);
    for (const ConfigNode* layer : r.tables("paint")) {
      Reader p(name_, *layer, fmt::format("density '{}': paint", map.name));
      p.only({"area", "weight"});
      p.require("area");
      p.require("weight");
      double weight = 0;
      p.number("weight", weight, 0, 255);
      int32_t area = 0;
      if (p.ok()) area = p.named(*p.find("area"), out_.areas, "area");
      keep(p);
      if (!p.ok()) return;
      scenario::paint_density(map, out_.areas[static_cast<size_t>(area)].prisms,
                              static_cast<uint8_t>(std::lround(weight)));
    }
  }
  if (r.ok() &&
      std::all_of(map.weights.begin(), map.weights.end(), [](uint8_t w) { return w == 0; })) {
    r.fail(*r.find("box"), "its weights are all 0; paint where avatars may be");
  }
  out_.densities.push_back(std::move(map));
}

void File::read_profile(Reader& r) {
  Profile profile;
  r.only({"name", "class", "speed", "radius"});
  name_of(r, out_.profiles, profile.name);
  r.text("class", profile.avatar_class);
  r.distribution("speed", profile.speed, 0.01, 100);
  r.distribution("radius", profile.radius, 0.01, 100);
  out_.profiles.push_back(profile);
}

void File::read_queue(Reader& r) {
  Queue queue;
  r.only({"name", "line", "spacing", "servers", "service"});
  name_of(r, out_.queues, queue.name);
  r.require("line");
  r.require("service");
  r.number("spacing", queue.spacing, 0.1, 100);
  double servers = 1;
  r.number("servers", servers, 1, 1000);
  queue.servers = static_cast<int32_t>(servers);
  r.distribution("service", queue.service, 0, kMaxSeconds);
  if (!r.ok()) return;
  const ConfigNode& line = *r.find("line");
  bool good = line.kind == Kind::kArray && line.items.size() >= 2;
  for (size_t i = 0; good && i < line.items.size(); ++i) {
    const auto& p = line.items[i].items;
    good = p.size() == 3 && std::all_of(p.begin(), p.end(), is_number);
    if (good) queue.line.push_back({p[0].number, p[1].number, p[2].number});
  }
  if (!good) r.fail(line, "line must be a list of at least two [x, y, z], the head first");
  out_.queues.push_back(std::move(queue));
}

void File::read_link(Reader& r) {
  Link link;
  r.only({"name", "from", "to", "interval", "capacity", "seconds"});
  name_of(r, out_.links, link.name);
  for (const char* key : {"from", "to", "seconds"}) r.require(key);
  double capacity = 1;
  r.number("interval", link.interval, 0.01, kMaxSeconds);
  r.number("capacity", capacity, 1, 1e6);
  r.number("seconds", link.seconds, 0, kMaxSeconds);
  link.capacity = static_cast<int32_t>(capacity);
  if (!r.ok()) return;
  link.from = r.named(*r.find("from"), out_.areas, "area");
  link.to = r.named(*r.find("to"), out_.areas, "area");
  out_.links.push_back(link);
}

void File::read_stage(Reader& r, Journey& journey) {
  Stage stage;
  r.only({"go", "random_point", "spot", "density", "wait", "queue", "link", "leave", "by"});
  const char* point_key = r.spelling("random_point", "spot");
  const auto have = [&](const char* key) { return r.find(key) != nullptr; };
  const int kinds = (have("go") ? 1 : 0) + (have(point_key) ? 1 : 0) + (have("wait") ? 1 : 0) +
                    (have("queue") ? 1 : 0) + (have("link") ? 1 : 0) + (have("leave") ? 1 : 0) +
                    (have("density") ? 1 : 0);
  if (!r.ok()) return;
  if (kinds != 1) {
    return r.fail(r.table(),
                  "a stage is one of: go, random_point, density, wait, queue, link, leave");
  }
  if (have("go")) {
    stage.kind = Stage::Kind::kGo;
    r.names(*r.find("go"), out_.areas, "area", stage.areas);
  } else if (have("leave")) {
    stage.kind = Stage::Kind::kLeave;
    r.names(*r.find("leave"), out_.areas, "area", stage.areas);
  } else if (have(point_key)) {
    stage.kind = Stage::Kind::kRandomPoint;
    r.names(*r.find(point_key), out_.areas, "area", stage.areas);
  } else if (have("density")) {
    stage.kind = Stage::Kind::kRandomPoint;
    stage.density = r.named(*r.find("density"), out_.densities, "density");
  } else if (have("wait")) {
    stage.kind = Stage::Kind::kWait;
    r.distribution("wait", stage.seconds, 0, kMaxSeconds);
  } else if (have("queue")) {
    stage.kind = Stage::Kind::kQueue;
    stage.queue = r.named(*r.find("queue"), out_.queues, "queue");
  } else {
    stage.kind = Stage::Kind::kLink;
    stage.link = r.named(*r.find("link"), out_.links, "link");
    stage.areas = {out_.links.empty() ? 0 : out_.links[static_cast<size_t>(stage.link)].from};
  }
  if (const ConfigNode* by = r.find("by"); by != nullptr) {
    std::string how;
    r.text("by", how);
    if (how != "nearest" && how != "quickest")
      r.fail(*by, "by must be \"nearest\" or \"quickest\"");
    if (stage.kind != Stage::Kind::kGo && stage.kind != Stage::Kind::kLeave) {
      r.fail(*by, "only go and leave choose among areas");
    }
    stage.quickest = how == "quickest";
  }
  journey.stages.push_back(std::move(stage));
}

void File::read_journey(Reader& r) {
  Journey journey;
  r.only({"name", "stages", "repeat"});
  name_of(r, out_.journeys, journey.name);
  r.require("stages");
  r.flag("repeat", journey.repeat);
  for (const ConfigNode* table : r.tables("stages")) {
    Reader stage(name_, *table,
                 fmt::format("journey '{}': stage {}", journey.name, journey.stages.size() + 1));
    if (stage.ok()) read_stage(stage, journey);
    keep(stage);
    if (!stage.ok()) return;
  }
  if (!r.ok()) return;
  const ConfigNode& stages = *r.find("stages");
  if (journey.stages.empty() || static_cast<double>(journey.stages.size()) > kMaxStages) {
    return r.fail(stages, "give it 1 to 10000 stages");
  }
  for (size_t i = 0; i + 1 < journey.stages.size(); ++i) {
    if (journey.stages[i].kind == Stage::Kind::kLeave) {
      return r.fail(stages, "nothing can follow the stage 'leave'");
    }
  }
  const auto takes_time = [](const Stage& s) {
    return s.kind != Stage::Kind::kWait || s.seconds.a > 0;
  };
  if (journey.repeat && std::none_of(journey.stages.begin(), journey.stages.end(), takes_time)) {
    return r.fail(stages, "a journey that repeats must take some time");
  }
  out_.journeys.push_back(std::move(journey));
}

void File::read_source(Reader& r) {
  Source source;
  r.only({"name", "area", "density", "profile", "journey", "count", "begin", "end", "rate", "rates",
          "even", "places", "premovement", "group"});
  name_of(r, out_.sources, source.name);
  if (const ConfigNode* area = r.find("area"); area != nullptr) {
    r.names(*area, out_.areas, "area", source.areas);
  }
  if (const ConfigNode* density = r.find("density"); density != nullptr) {
    source.density = r.named(*density, out_.densities, "density");
  }
  r.choices("profile", out_.profiles, source.profiles);
  r.choices("journey", out_.journeys, source.journeys);
  r.count("count", source.count, 0, 1e7);
  r.number("begin", source.begin, 0, kMaxSeconds);
  r.number("end", source.end, 0, kMaxSeconds);
  bool even = false;
  r.flag("even", even);
  if (even) source.pattern = SpawnPattern::kEven;
  r.distribution("premovement", source.premovement, 0, kMaxSeconds);
  source.group = Distribution::fixed(1);
  r.distribution("group", source.group, 1, 20);
  if (!r.ok()) return;
  const ConfigNode& name = *r.find("name");
  if ((r.find("area") != nullptr) == (r.find("density") != nullptr)) {
    return r.fail(name, "say where avatars enter: an area, or a density");
  }
  double rate = 0;
  r.number("rate", rate, 0, 1e6);
  if (r.find("rate") != nullptr) source.rates = {{source.begin, rate}};
  if (const ConfigNode* rates = r.find("rates"); rates != nullptr) {
    std::vector<std::array<double, 2>> list;
    if (r.find("rate") != nullptr) return r.fail(*rates, "give rate or rates, not both");
    if (!r.corners(*rates, "rates", list)) return r.fail(*rates, "rates: pairs of time and rate");
    for (const auto& [from, value] : list) {
      if (!(value >= 0) || (!source.rates.empty() && !(from > source.rates.back().first))) {
        return r.fail(*rates,
                      "rates must be a list of [time, avatars a second], times ascending, "
                      "rates not below 0");
      }
      source.rates.emplace_back(from, value);
    }
  }
  if (source.rates.empty() && source.count == UINT64_MAX) {
    return r.fail(name, "give a count, a rate, or both");
  }
  if (const ConfigNode* node = r.find("places"); node != nullptr) {
    std::string places;
    r.text("places", places);
    if (places != "rows" && places != "chance") {
      return r.fail(*node, "places must be \"chance\" or \"rows\"");
    }
    if (places == "rows") source.pattern = SpawnPattern::kRows;
    if (places == "rows" && (source.areas.size() != 1 || !source.rates.empty())) {
      return r.fail(*node, "rows need one area, a count, and no rate");
    }
  }
  out_.sources.push_back(std::move(source));
}

}  // namespace

Result<Scenario> parse_scenario(const std::string& text, const std::string& name) {
  const auto root = parse_config(text, name);
  if (!root) return root.error();
  return File(name, *root).read();
}

const char* name_of(ObstaclePolicy policy) {
  return policy == ObstaclePolicy::kWait ? "wait" : "shut";
}

Result<Scenario> load_scenario(const std::string& path) {
  const auto text = read_file(path);
  if (!text) return text.error();
  return parse_scenario(*text, path);
}

}  // namespace throng
