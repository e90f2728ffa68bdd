// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "import/formats/ply.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <string>

#include "import/formats/text_cursor.h"

// Reads PLY models, as text or as numbers of either byte order, in one pass over the elements that
// the header lists. Time: linear in the bytes. Source: G. Turk. The PLY polygon file format. 1994.
namespace throng::importer {
namespace {

enum class Type { kInt8, kUint8, kInt16, kUint16, kInt32, kUint32, kFloat, kDouble };

struct Property {
  std::string name;
  Type type = Type::kFloat;
  bool is_list = false;
  Type count_type = Type::kUint8;
};

struct Element {
  std::string name;
  uint64_t count = 0;
  std::vector<Property> properties;
};

bool parse_type(std::string_view word, Type& type) {
  constexpr std::array<std::pair<std::string_view, Type>, 16> kTypes{{{"char", Type::kInt8},
                                                                      {"uchar", Type::kUint8},
                                                                      {"short", Type::kInt16},
                                                                      {"ushort", Type::kUint16},
                                                                      {"int", Type::kInt32},
                                                                      {"uint", Type::kUint32},
                                                                      {"float", Type::kFloat},
                                                                      {"double", Type::kDouble},
                                                                      {"int8", Type::kInt8},
                                                                      {"uint8", Type::kUint8},
                                                                      {"int16", Type::kInt16},
                                                                      {"uint16", Type::kUint16},
                                                                      {"int32", Type::kInt32},
                                                                      {"uint32", Type::kUint32},
                                                                      {"float32", Type::kFloat},
                                                                      {"float64", Type::kDouble}}};
  for (const auto& [name, value] : kTypes) {
    if (name != word) continue;
    type = value;
    return true;
  }
  return false;
}

size_t size_of(Type type) {
  constexpr size_t kSizes[] = {1, 1, 2, 2, 4, 4, 4, 8};
  return kSizes[static_cast<size_t>(type)];
}

template <class T>
double decode(const char* bytes) {
  T value;
  std::memcpy(&value, bytes, sizeof value);
  return static_cast<double>(value);
}

class PlyReader {
 public:
  PlyReader(std::string_view bytes, const ReadOptions& options, Context& context)
      : text_(bytes), name_(options.name), context_(context), writer_(options) {}

  Result<RawScene> read() {
    bool good = read_header();
    for (size_t i = 0; good && i < elements_.size(); ++i) good = read_element(elements_[i]);
    if (context_.cancel) return Error{Errc::kCancelled, "cancelled while reading"};
    if (!good) return Error{Errc::kBadFile, name_ + message_};
    auto scene = writer_.finish();
    if (!scene) return scene.error();
    return RawScene{.scene = *std::move(scene), .up = 'y', .metres_per_unit = 1};
  }

 private:
  bool fail(const std::string& why) {
    message_ = why;
    return false;
  }
  bool fail_line(const std::string& why) { return fail(fmt::format(":{}: {}", line_, why)); }

  bool read_header() {
    for (line_ = 1;; ++line_) {
      const size_t end = text_.find('\n');
      if (end == std::string_view::npos) return fail_line("the header has no end_header");
      TextCursor line(text_.substr(0, end));
      text_.remove_prefix(end + 1);
      const std::string_view word = line.take_word();
      if (line_ == 1) {
        if (word != "ply") return fail_line("not a PLY file: it does not begin with ply");
      } else if (word == "end_header") {
        return true;
      } else if (word == "format") {
        const std::string_view format = line.take_word();
        binary_ = format != "ascii";
        swapped_ = format == "binary_big_endian";
        if (binary_ && !swapped_ && format != "binary_little_endian") {
          return fail_line(fmt::format("unknown format '{}'", format));
        }
      } else if (word == "element") {
        Element element;
        element.name = line.take_word();
        long long count = -1;
        if (!line.take(count) || count < 0) return fail_line("an element needs a name and a count");
        element.count = static_cast<uint64_t>(count);
        elements_.push_back(std::move(element));
      } else if (word == "property") {
        if (!read_property(line)) return false;
      }
    }
  }

  bool read_property(TextCursor& line) {
    if (elements_.empty()) return fail_line("a property stands before any element");
    Property property;
    std::string_view type = line.take_word();
    if (type == "list") {
      property.is_list = true;
      if (!parse_type(line.take_word(), property.count_type))
        return fail_line("unknown type of count");
      type = line.take_word();
    }
    if (!parse_type(type, property.type)) return fail_line(fmt::format("unknown type '{}'", type));
    property.name = line.take_word();
    elements_.back().properties.push_back(std::move(property));
    return true;
  }

  // One number of the body. False at the end of the file.
  bool take(Type type, double& value) {
    if (!binary_) {
      TextCursor cursor(text_);
      if (!cursor.take(value)) return false;
      text_ = cursor.rest();
      return true;
    }
    const size_t size = size_of(type);
    if (text_.size() < size) return false;
    char bytes[8] = {};
    std::memcpy(bytes, text_.data(), size);
    if (swapped_) std::reverse(bytes, bytes + size);
    text_.remove_prefix(size);
    switch (type) {
      case Type::kInt8:
        value = decode<int8_t>(bytes);
        break;
      case Type::kUint8:
        value = decode<uint8_t>(bytes);
        break;
      case Type::kInt16:
        value = decode<int16_t>(bytes);
        break;
      case Type::kUint16:
        value = decode<uint16_t>(bytes);
        break;
      case Type::kInt32:
        value = decode<int32_t>(bytes);
        break;
      case Type::kUint32:
        value = decode<uint32_t>(bytes);
        break;
      case Type::kFloat:
        value = decode<float>(bytes);
        break;
      case Type::kDouble:
        value = decode<double>(bytes);
        break;
    }
    return true;
  }

  bool read_element(const Element& element) {
    const bool vertex = element.name == "vertex";
    const bool face = element.name == "face";
    if (element.properties.empty()) return true;  // Takes no bytes, however many there are.
    if (element.name == "edge" || element.name == "tristrips") {
      writer_.count_points_and_lines(element.count);
    }
    for (uint64_t i = 0; i < element.count; ++i) {
      if ((i & 0xffff) == 0 && context_.cancel) return false;
      const auto truncated = [&] {
        return fail(fmt::format(": ends in {} {} of {}; it is truncated or damaged", element.name,
                                i, element.count));
      };
      Vec3d p{std::nan(""), std::nan(""), std::nan("")};
      for (const Property& property : element.properties) {
        double value = 0;
        if (!take(property.is_list ? property.count_type : property.type, value))
          return truncated();
        if (property.is_list) {
          const bool wanted =
              face && (property.name == "vertex_indices" || property.name == "vertex_index");
          if (!(value >= 0) || !read_list(property.type, value, wanted)) return truncated();
          if (wanted) writer_.add_face(corners_);
        } else if (vertex && property.name.size() == 1) {
          if (property.name[0] == 'x') p.x = value;
          if (property.name[0] == 'y') p.y = value;
          if (property.name[0] == 'z') p.z = value;
        }
      }
      if (vertex) writer_.add_vertex(p);
    }
    return true;
  }

  bool read_list(Type type, double count, bool wanted) {
    corners_.clear();
    for (double i = 0; i < count; ++i) {
      double value = 0;
      if (!take(type, value)) return false;
      const auto vertices = static_cast<double>(writer_.scene().positions.size());
      const bool good = value >= 0 && value < vertices;
      if (wanted) corners_.push_back(good ? static_cast<uint32_t>(value) : kNoVertex);
    }
    return true;
  }

  std::string_view text_;
  std::string name_;
  Context& context_;
  SceneWriter writer_;
  std::string message_;
  int line_ = 0;
  bool binary_ = false;
  bool swapped_ = false;
  std::vector<Element> elements_;
  std::vector<uint32_t> corners_;
};

}  // namespace

Result<RawScene> read_ply(std::string_view bytes, const ReadOptions& options, Context& context) {
  return PlyReader(bytes, options, context).read();
}

}  // namespace throng::importer
