// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "import/formats/bpt.h"

#include <fmt/format.h>

#include <cmath>

#include "import/formats/text_cursor.h"
#include "import/patches/patch_edges.h"

// Format, as in the files that use it: the number of patches; then for each patch its two degrees
// and the control points, one a line, those of the second direction next to each other. Lines that
// begin with # are comments. Z is up.
namespace throng::importer {
namespace {

class BptReader {
 public:
  BptReader(std::string_view bytes, const ReadOptions& options, Context& context)
      : text_(bytes), options_(options), context_(context), writer_(options) {}

  Result<RawScene> read() {
    if (!read_patches()) {
      if (context_.cancel) return Error{Errc::kCancelled, "cancelled while reading"};
      return Error{Errc::kBadFile, fmt::format("{}:{}: {}", options_.name, line_, message_)};
    }
    auto scene = writer_.finish();
    if (!scene) return scene.error();
    bind_equal_edges(scene->patches, 0);
    return RawScene{.scene = *std::move(scene), .up = 'z', .metres_per_unit = 1};
  }

 private:
  bool fail(std::string why) {
    message_ = std::move(why);
    return false;
  }

  // The next line that is neither blank nor a comment.
  bool next_line(TextCursor& line) {
    while (!text_.empty()) {
      const size_t end = text_.find('\n');
      line = TextCursor(text_.substr(0, end));
      text_.remove_prefix(end == std::string_view::npos ? text_.size() : end + 1);
      ++line_;
      line.skip_space();
      if (!line.at_end() && line.peek() != '#') return true;
    }
    return false;
  }

  static bool ends(TextCursor& line) {
    line.skip_space();
    return line.at_end();
  }

  bool read_patches() {
    TextCursor line{""};
    long long count = 0;
    if (!next_line(line) || !line.take(count) || !ends(line) || count < 1) {
      return fail("does not begin with the number of patches; write it on a line of its own");
    }
    writer_.scene().patches.begin_run(options_.name, "patches", "");
    for (long long p = 0; p < count; ++p) {
      if (context_.cancel) return false;
      if (!read_patch(p, count)) return false;
    }
    if (next_line(line)) {
      return fail(
          fmt::format("more follows after the last of {} patches; correct the number", count));
    }
    return true;
  }

  bool read_patch(long long p, long long count) {
    const auto truncated = [&](const char* what) {
      return fail(
          fmt::format("ends before the {} of patch {} of {}; the file is truncated, or the "
                      "number of patches is wrong",
                      what, p + 1, count));
    };
    TextCursor line{""};
    long long outer = 0;
    long long inner = 0;
    if (!next_line(line)) return truncated("degrees");
    if (!line.take(outer) || !line.take(inner) || !ends(line) || outer < 1 || outer > 3 ||
        inner < 1 || inner > 3) {
      return fail(fmt::format("patch {} needs its two degrees here, each 1 to 3", p + 1));
    }
    std::array<Vec3d, 16> points;
    const auto rows = static_cast<size_t>(inner) + 1;
    const auto columns = static_cast<size_t>(outer) + 1;
    for (size_t i = 0; i < columns; ++i) {
      for (size_t j = 0; j < rows; ++j) {
        Vec3d& point = points[j * columns + i];
        if (!next_line(line)) return truncated("control points");
        if (!line.take(point.x) || !line.take(point.y) || !line.take(point.z) || !ends(line) ||
            !(std::fabs(point.x) < 1e9 && std::fabs(point.y) < 1e9 && std::fabs(point.z) < 1e9)) {
          return fail(fmt::format("control point {} of patch {} needs three numbers below 1e9 here",
                                  i * rows + j + 1, p + 1));
        }
      }
    }
    writer_.scene().patches.add(raise_degree(
        static_cast<int32_t>(outer), static_cast<int32_t>(inner), {points.data(), columns * rows}));
    return true;
  }

  std::string_view text_;
  const ReadOptions& options_;
  Context& context_;
  SceneWriter writer_;
  std::string message_;
  int line_ = 0;
};

}  // namespace

Result<RawScene> read_bpt(std::string_view bytes, const ReadOptions& options, Context& context) {
  return BptReader(bytes, options, context).read();
}

}  // namespace throng::importer
