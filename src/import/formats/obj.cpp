// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "import/formats/obj.h"

#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "import/formats/mtl.h"
#include "import/formats/text_cursor.h"

// Reads Wavefront OBJ in one pass over the lines.
namespace throng::importer {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

class ObjReader {
 public:
  explicit ObjReader(const ReadOptions& options)
      : writer_(options),
        has_materials_(options.materials == SceneMaterials::kRead),
        library_(options.name) {}

  Result<RawScene> read(std::string_view bytes, Context& context) {
    size_t lines = 0;
    while (!bytes.empty()) {
      read_line(next_line(bytes));
      if ((++lines & 0xffff) == 0 && context.cancel) return Error{Errc::kCancelled, "cancelled"};
    }
    auto scene = writer_.finish();
    if (!scene) return scene.error();
    RawScene raw{.scene = *std::move(scene), .up = 'y', .metres_per_unit = 1};
    library_.hand_over(raw);
    return raw;
  }

 private:
  // The next line, with lines that end in a backslash joined to it.
  std::string_view next_line(std::string_view& bytes) {
    joined_.clear();
    for (;;) {
      const size_t end = bytes.find('\n');
      std::string_view line = bytes.substr(0, end);
      bytes = end == std::string_view::npos ? std::string_view() : bytes.substr(end + 1);
      while (!line.empty() && TextCursor::is_space(line.back())) line.remove_suffix(1);
      const bool goes_on = !line.empty() && line.back() == '\\' && !bytes.empty();
      if (!goes_on && joined_.empty()) return line;
      joined_ += goes_on ? line.substr(0, line.size() - 1) : line;
      if (!goes_on) return joined_;
      joined_ += ' ';
    }
  }

  void read_line(std::string_view line) {
    TextCursor cursor(line);
    const std::string_view word = cursor.take_word();
    if (word == "v") {
      Vec3d p{kNan, kNan, kNan};  // A broken vertex still takes its number; its triangles drop out.
      if (!(cursor.take(p.x) && cursor.take(p.y) && cursor.take(p.z))) p = {kNan, kNan, kNan};
      writer_.add_vertex(p);
    } else if (word == "f" || word == "fo") {
      read_face(cursor);
    } else if (word == "o") {
      object_ = name(cursor);
      group_.clear();
      changed_ = true;
    } else if (word == "g") {
      group_ = name(cursor);
      changed_ = true;
    } else if (word == "usemtl") {
      material_ = name(cursor);
      changed_ = true;
    } else if (has_materials_ && word == "vt") {
      std::array<double, 2> place{};
      if (!(cursor.take(place[0]) && cursor.take(place[1]))) place = {};
      // Files count upwards from the lower edge.
      places_.push_back({static_cast<float>(place[0]), static_cast<float>(1 - place[1])});
    } else if (has_materials_ && word == "mtllib") {
      library_.read(name(cursor));
    } else if (word == "l" || word == "p" || word == "curv") {
      writer_.count_points_and_lines(1);
    }
  }

  static std::string name(TextCursor& cursor) { return std::string(cursor.take_rest()); }

  void read_face(TextCursor& cursor) {
    corners_.clear();
    face_places_.clear();
    bool good = !writer_.full();
    while (good) {
      long long index = 0;
      const std::string_view word = cursor.take_word();
      if (word.empty()) break;
      TextCursor corner(word);
      good = corner.take(index) && (corner.at_end() || corner.peek() == '/');
      const auto count = static_cast<long long>(writer_.scene().positions.size());
      if (index < 0) index += count + 1;  // Negative ones count back from the last vertex.
      good = good && index >= 1 && index <= count;
      if (good) corners_.push_back(static_cast<uint32_t>(index - 1));
      if (good && has_materials_) read_place(corner);
    }
    if (!good || corners_.size() < 3) {
      writer_.count_bad(corners_.size() > 3 ? corners_.size() - 2 : 1);
      return;
    }
    if (changed_) {
      std::string node = object_;
      if (!node.empty() && !group_.empty()) node += '/';
      writer_.begin_part(node + group_, material_, library_.material1(material_));
      changed_ = false;
    }
    writer_.add_face(corners_, face_places_);
  }

  // What follows a corner's vertex: "/7" or "/7/3". A corner without leaves the face without.
  void read_place(TextCursor& corner) {
    long long index = 0;
    if (corner.at_end()) return;
    TextCursor place(corner.rest().substr(1));
    if (!place.take(index)) return;
    const auto count = static_cast<long long>(places_.size());
    if (index < 0) index += count + 1;
    if (index >= 1 && index <= count)
      face_places_.push_back(places_[static_cast<size_t>(index - 1)]);
  }

  SceneWriter writer_;
  std::string joined_;
  std::string object_, group_, material_;
  bool changed_ = true;
  std::vector<uint32_t> corners_;
  bool has_materials_;
  MaterialLibrary library_;
  std::vector<std::array<float, 2>> places_, face_places_;
};

}  // namespace

Result<RawScene> read_obj(std::string_view bytes, const ReadOptions& options, Context& context) {
  return ObjReader(options).read(bytes, context);
}

}  // namespace throng::importer
