// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>

#include "import/formats/plan.h"
#include "import/formats/text_cursor.h"

// Reads well-known text, the plans of pedestrian simulators: a POLYGON is walkable ground, its
// holes are obstacles.
namespace throng::importer {
namespace {

constexpr int kDeepestCollection = 16;

class WktReader {
 public:
  WktReader(std::string_view bytes, const std::string& name, double wall_height)
      : bytes_(bytes), cursor_(bytes), name_(name), wall_height_(wall_height) {}

  Result<Plan> read() {
    for (;;) {
      skip_filler();
      if (cursor_.at_end()) break;
      if (!read_geometry(0)) return Error{Errc::kBadFile, message_};
    }
    return std::move(plan_);
  }

 private:
  // Space, separators between geometries, comments, and the SRID that databases put in front.
  void skip_filler() {
    for (;;) {
      cursor_.skip_space();
      if (cursor_.peek() == '#') {
        while (!cursor_.at_end() && cursor_.peek() != '\n') cursor_.skip();
      } else if (cursor_.peek() == ';' || cursor_.peek() == ',') {
        cursor_.skip();
      } else if (upper_rest(5) == "SRID=") {
        while (!cursor_.at_end() && cursor_.peek() != ';') cursor_.skip();
      } else {
        return;
      }
    }
  }

  std::string upper_rest(size_t count) const {
    std::string text(cursor_.rest().substr(0, count));
    for (char& c : text) {
      if (c >= 'a' && c <= 'z') c = static_cast<char>(c - 'a' + 'A');
    }
    return text;
  }

  bool fail(const std::string& why) {
    const size_t at = bytes_.size() - cursor_.rest().size();
    const auto line =
        1 + std::count(bytes_.begin(), bytes_.begin() + static_cast<ptrdiff_t>(at), '\n');
    message_ = fmt::format("{}:{}: {}", name_, line, why);
    return false;
  }

  std::string take_keyword() {
    cursor_.skip_space();
    size_t count = 0;
    const std::string_view rest = cursor_.rest();
    while (count < rest.size() && count < 32 &&
           ((rest[count] >= 'A' && rest[count] <= 'Z') ||
            (rest[count] >= 'a' && rest[count] <= 'z'))) {
      ++count;
    }
    std::string word = upper_rest(count);
    for (size_t i = 0; i < count; ++i) cursor_.skip();
    return word;
  }

  bool take(char wanted) {
    cursor_.skip_space();
    if (cursor_.peek() != wanted) return false;
    cursor_.skip();
    return true;
  }

  bool read_geometry(int depth) {
    if (depth > kDeepestCollection) return fail("collections nest too deep");
    std::string kind = take_keyword();
    if (kind.empty()) return fail("expected a geometry such as POLYGON ((0 0, 9 0, 9 9, 0 0))");
    place_ = fmt::format("{}: {} {}", name_, kind, ++count_);
    std::string next = take_keyword();  // A dimension, EMPTY, or nothing.
    if (next == "Z" || next == "M" || next == "ZM") next = take_keyword();
    if (next == "EMPTY") return true;
    if (!next.empty()) return fail(fmt::format("unexpected word '{}'", next));
    if (kind == "GEOMETRYCOLLECTION") {
      return read_list([&] { return read_geometry(depth + 1); });
    }
    if (kind == "MULTIPOLYGON") return read_list([&] { return read_polygon(); });
    if (kind == "POLYGON") return read_polygon();
    if (kind == "MULTILINESTRING") return read_list([&] { return read_wall(); });
    if (kind == "LINESTRING") return read_wall();
    return fail(
        fmt::format("cannot use a {}; need POLYGON, MULTIPOLYGON, LINESTRING, "
                    "MULTILINESTRING or GEOMETRYCOLLECTION",
                    kind));
  }

  template <class Item>
  bool read_list(Item item) {
    if (!take('(')) return fail("expected (");
    do {
      if (!item()) return false;
    } while (take(','));
    return take(')') || fail("expected , or )");
  }

  bool read_points(Ring& ring) {
    return read_list([&] {
      std::array<double, 2> p{};
      if (!cursor_.take(p[0]) || !cursor_.take(p[1])) return fail("expected two numbers");
      double unused = 0;
      while (cursor_.take(unused)) continue;  // Height and measure: a plan is flat.
      ring.push_back(p);
      return true;
    });
  }

  bool read_polygon() {
    std::vector<Ring> rings;
    const bool good = read_list([&] { return read_points(rings.emplace_back()); });
    if (!good) return false;
    for (Ring& ring : rings) {
      if (ring.size() > 1 && ring.front() == ring.back()) ring.pop_back();
    }
    Plan::Area area{.polygon = {}, .height = wall_height_, .place = place_};
    area.polygon.outer = std::move(rings.front());
    area.polygon.holes.assign(std::make_move_iterator(rings.begin() + 1),
                              std::make_move_iterator(rings.end()));
    plan_.ground.push_back(std::move(area));
    return true;
  }

  bool read_wall() {
    Plan::Wall wall{.line = {}, .height = wall_height_};
    if (!read_points(wall.line)) return false;
    plan_.walls.push_back(std::move(wall));
    return true;
  }

  std::string_view bytes_;
  TextCursor cursor_;
  std::string name_;
  double wall_height_;
  std::string place_;
  std::string message_;
  int count_ = 0;
  Plan plan_;
};

}  // namespace

Result<RawScene> read_wkt(std::string_view bytes, const ReadOptions& options, Context&) {
  const double unit = options.metres_per_unit.value_or(1);
  auto plan = WktReader(bytes, options.name, options.plan_height / unit).read();
  if (!plan) return plan.error();
  SceneWriter writer(options);
  constexpr double kPlate = 0.05;  // [m]
  if (auto done = write_plan(*plan, PlanAxes::kXY, 0, kPlate / unit, writer); !done) {
    return done.error();
  }
  auto scene = writer.finish();
  if (!scene) return scene.error();
  return RawScene{.scene = *std::move(scene), .up = 'z', .metres_per_unit = unit};
}

}  // namespace throng::importer
