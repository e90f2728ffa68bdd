// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <iterator>
#include <numeric>

#include "core/files/part_file.h"
#include "throng/recording.h"

// Recordings as text: CSV for spreadsheets, and the trajectory format of the Juelich experiments.
// them.
namespace throng {
namespace {

// Writes a head, then a line for each avatar of each frame.
template <class Line>
Result<void> write_text(Replay& replay, const std::string& path, const ExportConfig& config,
                        Context& context, const std::string& head, Line line) {
  if (replay.frame_count() == 0) {
    return Error{Errc::kBadFile,
                 path + ": not written, since the recording holds no frame; record the run again"};
  }
  PartFile file(path);
  file.write(head.data(), head.size());
  RecordedFrame frame;
  fmt::memory_buffer text;
  for (uint64_t f = 0; f < replay.frame_count(); ++f) {
    if (context.on_progress) context.on_progress({"export", f, replay.frame_count()});
    if (context.cancel) return Error{Errc::kCancelled, path + ": cancelled"};
    if (auto ok = replay.read(f, frame); !ok) return ok;
    text.clear();
    for (size_t i = 0; i < frame.size(); ++i) {
      const double y = frame.positions[i].y;
      if (y >= config.lowest && y <= config.highest) line(text, frame, i);
    }
    file.write(text.data(), text.size());
  }
  return file.close();
}

}  // namespace

Result<FilmRate> film_rate(Replay& replay) {
  FilmRate film{.first_step = 0, .steps = 0, .rate = 0};
  for (uint64_t f = 0; f < replay.frame_count(); ++f) {
    const Result<FrameInfo> frame = replay.frame_info(f);
    if (!frame) return frame.error();
    if (f == 0) film.first_step = frame->step;
    film.steps = std::gcd(film.steps, frame->step - film.first_step);
  }
  if (film.steps == 0) film.steps = 1;
  film.rate = 1 / (replay.info().dt * static_cast<double>(film.steps));
  return film;
}

Result<void> export_csv(Replay& replay, const std::string& path, const ExportConfig& config,
                        Context& context) {
  const auto& classes = replay.info().classes;
  const std::string head =
      fmt::format("{}{}\n", kCsvColumns, replay.info().leans ? kCsvUpColumns : "");
  return write_text(replay, path, config, context, head,
                    [&](fmt::memory_buffer& text, const RecordedFrame& frame, size_t i) {
                      const Vec3d& p = frame.positions[i];
                      const auto out = std::back_inserter(text);
                      fmt::format_to(out, "{},{},{},{:.4f},{:.4f},{:.4f},{:.4f}", frame.step,
                                     frame.ids[i], classes[frame.classes[i]].name, p.x, p.y, p.z,
                                     frame.radii[i]);
                      if (!frame.up_vectors.empty()) {
                        const Vec3d& up = frame.up_vectors[i];
                        fmt::format_to(out, ",{:.4f},{:.4f},{:.4f}", up.x, up.y, up.z);
                      }
                      text.push_back('\n');
                    });
}

// Readers take the rate from the first line that has "framerate", and metres from "x/m".
Result<void> export_juelich(Replay& replay, const std::string& path, const ExportConfig& config,
                            Context& context) {
  const Result<FilmRate> film = film_rate(replay);
  if (!film) return film.error();
  const std::string head = fmt::format("# framerate: {} fps\n# id frame x/m y/m z/m\n", film->rate);
  return write_text(replay, path, config, context, head,
                    [&](fmt::memory_buffer& text, const RecordedFrame& frame, size_t i) {
                      const Vec3d& p = frame.positions[i];
                      fmt::format_to(std::back_inserter(text), "{} {} {:.3f} {:.3f} {:.3f}\n",
                                     frame.ids[i], film->frame_of(frame.step), p.x, p.z, p.y);
                    });
}

}  // namespace throng
