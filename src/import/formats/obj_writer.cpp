// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <cmath>
#include <iterator>
#include <string>

#include "import/raw/scene_output.h"
#include "throng/scene.h"

// Writes Wavefront OBJ as read_obj reads it: corners once, then faces under the names of their
// parts. No material file: names suffice for rules, and for programs that have their own
// colours.
namespace throng {
namespace {

// Names end with the line; blanks inside are kept by most readers, ours too.
std::string one_line(std::string name) {
  for (char& c : name) {
    if (c == '\n' || c == '\r') c = ' ';
  }
  return name;
}

// Significant digits of a coordinate: ten, and far from the origin as many as keep the micrometre.
int digits(double metres) {
  int count = 10;
  for (double size = std::fabs(metres); size >= 1e4 && count < 17; size /= 10) ++count;
  return count;
}

}  // namespace

Result<void> write_obj(const Scene& scene, const std::string& path) {
  if (const auto fine = importer::check_scene(scene, path); !fine) return fine;
  importer::SceneOutput out(path);
  fmt::memory_buffer line;
  const auto put = [&] {
    out.put_bytes(line.data(), line.size());
    line.clear();
  };
  const auto to = std::back_inserter(line);
  for (const Vec3d& p : scene.positions) {
    fmt::format_to(to, "v {:.{}g} {:.{}g} {:.{}g}\n", p.x, digits(p.x), p.y, digits(p.y), p.z,
                   digits(p.z));
    put();
  }
  size_t part = 0;
  for (size_t t = 0; t < scene.triangles.size(); ++t) {
    while (part < scene.parts.size() && scene.parts[part].first_triangle == t) {
      fmt::format_to(to, "o {}\nusemtl {}\n", one_line(scene.parts[part].node),
                     one_line(scene.parts[part].material));
      ++part;
    }
    const auto& corner = scene.triangles[t];
    fmt::format_to(to, "f {} {} {}\n", corner[0] + 1, corner[1] + 1, corner[2] + 1);
    put();
  }
  return out.close();
}

}  // namespace throng
