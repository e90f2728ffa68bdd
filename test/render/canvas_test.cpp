// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "render/canvas.h"

#include <gtest/gtest.h>

#include <array>

#include "render/marks.h"
#include "render/text.h"

namespace throng {
namespace {

constexpr render::Rgb kBlack{0, 0, 0};

// The amount of ink on the canvas, in pixels.
double ink(const render::Canvas& canvas) {
  double sum = 0;
  for (int32_t y = 0; y < canvas.height(); ++y) {
    for (int32_t x = 0; x < canvas.width(); ++x) sum += 1 - canvas.at(x, y).g / 255.0;
  }
  return sum;
}

TEST(Canvas, ShapesCoverTheirAreaWhereverTheyLie) {
  for (const double shift : {0.0, 0.25, 0.5, 0.8}) {
    render::Canvas disc(40, 40, render::kPaper), line(60, 40, render::kPaper),
        box(40, 40, render::kPaper);
    disc.disc({20 + shift, 20 - shift}, 9, kBlack);
    EXPECT_NEAR(ink(disc), 3.14159 * 81, 3);
    line.line({10 + shift, 10}, {50, 20 + shift}, 3, kBlack);
    EXPECT_NEAR(ink(line), 3 * std::hypot(40 - shift, 10 + shift) + 3.14159 * 1.5 * 1.5, 3);
    box.fill({3.5 + shift, 7.25, 11, 5.5}, kBlack);
    EXPECT_NEAR(ink(box), 60.5, 0.3);
  }
}

TEST(Canvas, WhatLiesOutsideIsLeftOut) {
  render::Canvas canvas(10, 8, render::kPaper);
  canvas.disc({-30, 4}, 5, kBlack);
  canvas.fill({12, -5, 9, 40}, kBlack);
  canvas.line({-20, -20}, {30, -3}, 2, kBlack);
  canvas.set(-1, 0, kBlack);
  canvas.set(0, 8, kBlack);
  canvas.fill_convex(std::array<render::Point, 3>{{{-9, -9}, {-3, -9}, {-5, -2}}}, kBlack);
  render::draw_text(canvas, {200, 4}, "out", {.size = 5});
  EXPECT_EQ(ink(canvas), 0);
  canvas.fill({-5, -5, 100, 100}, kBlack);
  EXPECT_EQ(ink(canvas), 80);
}

TEST(Canvas, ConvexPolygonsThatShareAnEdgeNeitherOverlapNorLeaveAGap) {
  render::Canvas canvas(30, 30, render::kPaper);
  const std::array<render::Point, 4> corners = {
      {{3.2, 4.7}, {25.1, 7.3}, {22.4, 26.2}, {5.9, 21.1}}};
  canvas.fill_convex(std::array<render::Point, 3>{corners[0], corners[1], corners[2]}, kBlack);
  const double first = ink(canvas);
  canvas.fill_convex(std::array<render::Point, 3>{corners[0], corners[2], corners[3]}, kBlack);
  render::Canvas second(30, 30, render::kPaper), whole(30, 30, render::kPaper);
  second.fill_convex(std::array<render::Point, 3>{corners[0], corners[2], corners[3]}, kBlack);
  whole.fill_convex(corners, kBlack);
  EXPECT_EQ(ink(canvas), first + ink(second));
  EXPECT_EQ(ink(canvas), ink(whole));
}

TEST(Canvas, ReducingAverages) {
  render::Canvas large(6, 3, render::kPaper), small(4, 2, render::kPaper);
  for (int32_t i = 0; i < 3; ++i) large.set(i, i, kBlack);
  small.draw_reduced(large, 3, 1, 1);
  EXPECT_EQ(small.at(1, 1), (render::Rgb{170, 170, 170}));
  EXPECT_EQ(small.at(2, 1), render::kPaper);
  EXPECT_EQ(small.at(0, 0), render::kPaper);
}

TEST(Text, EveryPrintableCharacterDrawsInsideItsBox) {
  for (char c = 33; c < 127; ++c) {
    render::Canvas canvas(80, 80, render::kPaper);
    const render::TextStyle style{.size = 24};
    const std::string text(1, c);
    render::draw_text(canvas, {20, 50}, text, style);
    EXPECT_GT(ink(canvas), 3) << c;
    render::Canvas cover = canvas;
    cover.fill({17, 20, render::text_width(text, style) + 6, 42}, render::kPaper);
    EXPECT_LT(ink(cover), 0.5) << c << " sticks out";
  }
}

TEST(Text, AlignmentMovesTheSameInk) {
  const std::string text = "12.5 m";
  render::TextStyle style{.size = 12};
  render::Canvas left(200, 40, render::kPaper), right(200, 40, render::kPaper),
      centre(200, 40, render::kPaper);
  const double width = render::text_width(text, style);
  render::draw_text(left, {50, 30}, text, style);
  style.align = render::Align::kRight;
  render::draw_text(right, {50 + width, 30}, text, style);
  style.align = render::Align::kCentre;
  render::draw_text(centre, {50 + width / 2, 30}, text, style);
  EXPECT_NEAR(ink(left), ink(right), 1e-6);
  EXPECT_NEAR(ink(left), ink(centre), 1e-6);
}

TEST(Text, LongLinesAreCutToFit) {
  const render::TextStyle style{.size = 10};
  EXPECT_EQ(render::fit_text("short", 1000, style), "short");
  const std::string cut = render::fit_text("a sentence that is far too long", 80, style);
  EXPECT_LE(render::text_width(cut, style), 80);
  EXPECT_EQ(cut.substr(cut.size() - 2), "..");
  EXPECT_EQ(render::fit_text("abc", 0, style), "");
}

TEST(Marks, LengthsAreRoundNumbersWithUnits) {
  EXPECT_EQ(render::round_below(3.7), 2);
  EXPECT_EQ(render::round_below(0.5), 0.5);
  EXPECT_EQ(render::round_below(99), 50);
  EXPECT_EQ(render::round_below(100), 100);
  EXPECT_NEAR(render::round_below(0.0031), 0.002, 1e-12);
  EXPECT_EQ(render::round_below(0), 0);
  EXPECT_EQ(render::length_text(2000), "2 km");
  EXPECT_EQ(render::length_text(50), "50 m");
  EXPECT_EQ(render::length_text(0.2), "20 cm");
  EXPECT_EQ(render::length_text(0.005), "5 mm");
}

TEST(HeightRamp, GetsLighterInEvenSteps) {
  const auto lightness = [](double t) {
    const render::Rgb c = render::height_colour(t);
    const double y = 0.2126 * std::pow(c.r / 255.0, 2.2) + 0.7152 * std::pow(c.g / 255.0, 2.2) +
                     0.0722 * std::pow(c.b / 255.0, 2.2);
    return std::cbrt(y);
  };
  const double step = (lightness(1) - lightness(0)) / 10;
  EXPECT_GT(step, 0.03);
  for (int i = 0; i < 10; ++i) {
    EXPECT_NEAR(lightness((i + 1) / 10.0) - lightness(i / 10.0), step, step * 0.5) << i;
  }
}

}  // namespace
}  // namespace throng
