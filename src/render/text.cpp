// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "render/text.h"

#include <algorithm>
#include <array>
#include <string>
#include <utility>
#include <vector>

// The font: a glyph is a few strokes on a grid: baseline at 4, small letters up to 12, capitals up
// to 16, descenders down to 0. A stroke is a list of corners, each two characters (0-9, then a = 10
// ...), and strokes are separated by blanks. A stroke that begins with '~' is rounded by cutting
// its corners (Chaikin, 1974), three times; a corner on a straight run limits how far the rounding
// reaches.
namespace throng::render {
namespace {

constexpr double kCapital = 12;  // Grid units from the baseline to the top of a capital.
constexpr double kBaseline = 4;
constexpr double kGap = 3.4;  // Between glyphs.

struct Glyph {
  int width;
  const char* strokes;
};

constexpr std::array<Glyph, 95> kGlyphs = {{
    {5, ""},                                   // space
    {2, "1g19 1415"},                          // !
    {4, "0g0c 4g4c"},                          // "
    {9, "142g 747g 0b9b 0898"},                // #
    {8, "~8d8f0f0a8a850507 4h43"},             // $
    {11, "04bg ~2g5g5b0b0g2g ~99b9b4646999"},  // %
    {9, "~942d2g6g6c08046488"},                // &
    {2, "1g1c"},                               // '
    {4, "~4h0e0642"},                          // (
    {4, "~0h4e4602"},                          // )
    {8, "4g48 0e8a 8e0a"},                     // *
    {8, "0a8a 464e"},                          // +
    {2, "151402"},                             // ,
    {6, "0a6a"},                               // -
    {2, "1415"},                               // .
    {6, "026h"},                               // /
    {7, "~3g7g74040g3g"},                      // 0
    {7, "1d4g44 1474"},                        // 1
    {7, "~0d0g7g7b0604 0474"},                 // 2
    {7, "~0e0g7g7a3a ~3a7a740406"},            // 3
    {7, "545g0777"},                           // 4
    {7, "7g0g0a ~0a3b7b740406"},               // 5
    {7, "~7e7g0g0a0474797b0b08"},              // 6
    {7, "0g7g24"},                             // 7
    {7, "~4g7g7a0a0g4g ~4a7a74040a4a"},        // 8
    {7, "~0604747a7g0g0b09797c"},              // 9
    {2, "1415 1a1b"},                          // :
    {2, "151402 1a1b"},                        // ;
    {8, "8f0a85"},                             // <
    {8, "0c8c 0888"},                          // =
    {8, "0f8a05"},                             // >
    {7, "~0d0g7g7b4a48 4445"},                 // ?
    {11, "~8b8c4c48888c ~88b8bg0g04b4"},       // @
    {8, "044g84 1878"},                        // A
    {8, "040g ~0g5g8g8a5a0a ~0a5a8a845404"},   // B
    {8, "~8d8g0g048487"},                      // C
    {8, "040g ~0g3g8g843404"},                 // D
    {7, "7g0g0474 0a6a"},                      // E
    {7, "7g0g04 0a6a"},                        // F
    {8, "~8d8g0g04848a 8a5a"},                 // G
    {8, "040g 848g 0a8a"},                     // H
    {2, "141g"},                               // I
    {6, "~6g6a640407"},                        // J
    {8, "040g 8g09 3b84"},                     // K
    {7, "0g0474"},                             // L
    {10, "040g57aga4"},                        // M
    {8, "040g848g"},                           // N
    {8, "~4g8g84040g4g"},                      // O
    {8, "040g ~0g5g8g894909"},                 // P
    {9, "~4g8g84040g4g 5793"},                 // Q
    {8, "040g ~0g5g8g894909 4984"},            // R
    {8, "~8d8g0g0a8a840407"},                  // S
    {8, "0g8g 4g44"},                          // T
    {8, "~0g0a04848a8g"},                      // U
    {8, "0g448g"},                             // V
    {12, "0g346c94cg"},                        // W
    {8, "048g 0g84"},                          // X
    {8, "0g4a8g 4a44"},                        // Y
    {8, "0g8g0484"},                           // Z
    {3, "3h0h0232"},                           // [
    {6, "0h62"},                               // backslash
    {3, "0h3h3202"},                           // ]
    {8, "0c4g8c"},                             // ^
    {8, "0282"},                               // _
    {3, "0g3d"},                               // `
    {6, "6c64 ~6a6c0c046466"},                 // a
    {6, "0g04 ~0a0c6c640406"},                 // b
    {6, "~6a6c0c046466"},                      // c
    {6, "6g64 ~6a6c0c046466"},                 // d
    {6, "0868 ~686c0c046465"},                 // e
    {5, "~5g2g2d24 0c5c"},                     // f
    {6, "~6c64600001 ~6a6c0c046466"},          // g
    {6, "0g04 ~0a0c6c6964"},                   // h
    {2, "1c14 1f1g"},                          // i
    {3, "~3c343000 3f3g"},                     // j
    {6, "0g04 6c07 2964"},                     // k
    {2, "1g14"},                               // l
    {10, "0c04 ~0a0c5c5954 ~5a5caca9a4"},      // m
    {6, "0c04 ~0a0c6c6964"},                   // n
    {6, "~3c6c64040c3c"},                      // o
    {6, "0c00 ~0a0c6c640406"},                 // p
    {6, "6c60 ~6a6c0c046466"},                 // q
    {4, "0c04 ~080c4c"},                       // r
    {6, "~6a6c0c0868640406"},                  // s
    {5, "~2g272454 0c5c"},                     // t
    {6, "6c64 ~0c07046466"},                   // u
    {6, "0c346c"},                             // v
    {10, "0c245b84ac"},                        // w
    {6, "046c 0c64"},                          // x
    {6, "0c34 6c2010"},                        // y
    {6, "0c6c0464"},                           // z
    {4, "~4h2h2b0a ~0a292242"},                // {
    {2, "1h12"},                               // |
    {4, "~0h2h2b4a ~4a292202"},                // }
    {8, "~090b4b48888b"},                      // ~
}};
constexpr Glyph kUnknown = {6, "04640g6g 0g04 6g64"};

int digit(char c) { return c <= '9' ? c - '0' : c - 'a' + 10; }

const Glyph& glyph_of(char c) {
  const auto code = static_cast<unsigned char>(c);
  return code >= 32 && code < 127 ? kGlyphs[code - 32u] : kUnknown;
}

void round_off(std::vector<Point>& path) {
  std::vector<Point> cut = {path.front()};
  for (size_t i = 0; i + 1 < path.size(); ++i) {
    const Point a = path[i], b = path[i + 1];
    if (i > 0) cut.push_back({a.x * 0.75 + b.x * 0.25, a.y * 0.75 + b.y * 0.25});
    if (i + 2 < path.size()) cut.push_back({a.x * 0.25 + b.x * 0.75, a.y * 0.25 + b.y * 0.75});
  }
  cut.push_back(path.back());
  path = std::move(cut);
}

void draw_stroke(Canvas& canvas, std::string_view stroke, Point origin, double scale, double line,
                 Rgb colour) {
  const bool is_round = stroke.front() == '~';
  std::vector<Point> path;
  for (size_t i = is_round ? 1 : 0; i + 1 < stroke.size(); i += 2) {
    path.push_back(
        {static_cast<double>(digit(stroke[i])), static_cast<double>(digit(stroke[i + 1]))});
  }
  for (int i = 0; is_round && i < 3; ++i) round_off(path);
  for (Point& p : path) p = {origin.x + p.x * scale, origin.y - (p.y - kBaseline) * scale};
  canvas.path(path, line, colour);
}

}  // namespace

double text_width(std::string_view text, const TextStyle& style) {
  double units = 0;
  for (const char c : text) units += glyph_of(c).width + kGap;
  return std::max(0.0, units - kGap) * style.size / kCapital;
}

void draw_text(Canvas& canvas, Point at, std::string_view text, const TextStyle& style) {
  const double scale = style.size / kCapital;
  const double line = std::max(style.bold ? 1.4 : 1.0, style.size * (style.bold ? 0.19 : 0.125));
  if (style.align == Align::kCentre) at.x -= text_width(text, style) / 2;
  if (style.align == Align::kRight) at.x -= text_width(text, style);
  for (const char c : text) {
    const Glyph& glyph = glyph_of(c);
    std::string_view rest = glyph.strokes;
    while (!rest.empty()) {
      const size_t blank = rest.find(' ');
      draw_stroke(canvas, rest.substr(0, blank), at, scale, line, style.colour);
      rest = blank == std::string_view::npos ? std::string_view() : rest.substr(blank + 1);
    }
    at.x += (glyph.width + kGap) * scale;
  }
}

std::string fit_text(std::string_view text, double width, const TextStyle& style) {
  if (text_width(text, style) <= width) return std::string(text);
  while (!text.empty() && text_width(std::string(text) + "..", style) > width)
    text.remove_suffix(1);
  return text.empty() ? std::string() : std::string(text) + "..";
}

}  // namespace throng::render
