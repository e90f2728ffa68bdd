// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "view/ui.h"

#include <imgui.h>
#include <imgui_internal.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <utility>

// Events become ImGui's input; its draw lists become one list of vertices, indices and runs.
namespace throng::view {
namespace {

constexpr float kLetters = 15;  // [px at a pixel ratio of 1]

void set_style(float scale) {
  ImGui::StyleColorsDark();
  ImGuiStyle& style = ImGui::GetStyle();
  style.WindowRounding = 6;
  style.FrameRounding = 4;
  style.GrabRounding = 4;
  style.ScrollbarRounding = 4;
  style.WindowBorderSize = 0;
  style.WindowPadding = {10, 10};
  style.ItemSpacing = {8, 5};
  style.Colors[ImGuiCol_WindowBg] = {0.09F, 0.10F, 0.12F, 0.88F};
  style.Colors[ImGuiCol_TitleBg] = {0.09F, 0.10F, 0.12F, 0.95F};
  style.Colors[ImGuiCol_TitleBgActive] = {0.13F, 0.16F, 0.20F, 0.95F};
  style.Colors[ImGuiCol_Header] = {0.20F, 0.25F, 0.32F, 0.75F};
  style.Colors[ImGuiCol_FrameBg] = {0.20F, 0.23F, 0.28F, 0.80F};
  style.Colors[ImGuiCol_Button] = {0.20F, 0.38F, 0.58F, 0.75F};
  style.Colors[ImGuiCol_CheckMark] = {1.00F, 0.72F, 0.30F, 1.00F};
  style.Colors[ImGuiCol_SliderGrab] = {1.00F, 0.72F, 0.30F, 0.85F};
  style.Colors[ImGuiCol_SliderGrabActive] = {1.00F, 0.80F, 0.45F, 1.00F};
  style.ScaleAllSizes(scale);
}

void map_keys(ImGuiIO& io) {
  const auto map = [&](ImGuiKey theirs, Key ours) { io.KeyMap[theirs] = static_cast<int>(ours); };
  map(ImGuiKey_Tab, Key::kTab);
  map(ImGuiKey_LeftArrow, Key::kLeft);
  map(ImGuiKey_RightArrow, Key::kRight);
  map(ImGuiKey_UpArrow, Key::kUp);
  map(ImGuiKey_DownArrow, Key::kDown);
  map(ImGuiKey_PageUp, Key::kPageUp);
  map(ImGuiKey_PageDown, Key::kPageDown);
  map(ImGuiKey_Home, Key::kHome);
  map(ImGuiKey_End, Key::kEnd);
  map(ImGuiKey_Delete, Key::kDelete);
  map(ImGuiKey_Backspace, Key::kBackspace);
  map(ImGuiKey_Enter, Key::kEnter);
  map(ImGuiKey_Escape, Key::kEscape);
  map(ImGuiKey_Space, Key::kSpace);
  for (const auto& [theirs, letter] : {std::pair{ImGuiKey_A, 'A'},
                                       {ImGuiKey_C, 'C'},
                                       {ImGuiKey_V, 'V'},
                                       {ImGuiKey_X, 'X'},
                                       {ImGuiKey_Y, 'Y'},
                                       {ImGuiKey_Z, 'Z'}}) {
    map(theirs, key_of(letter));
  }
}

}  // namespace

Ui::Ui(const std::string& font, double pixel_ratio)
    : context_(ImGui::CreateContext()), scale_(static_cast<float>(pixel_ratio)) {
  ImGui::SetCurrentContext(context_);
  ImGuiIO& io = ImGui::GetIO();
  io.IniFilename = nullptr;
  io.LogFilename = nullptr;
  io.BackendFlags |= ImGuiBackendFlags_RendererHasVtxOffset;
  io.ConfigWindowsMoveFromTitleBarOnly = true;
  set_style(scale_);
  map_keys(io);
  const float size = std::round(kLetters * scale_);
  std::error_code none;
  if (font.empty() || !std::filesystem::exists(font, none) ||
      io.Fonts->AddFontFromFileTTF(font.c_str(), size) == nullptr) {
    ImFontConfig config;
    config.SizePixels = std::max(13.0F, 13 * std::round(scale_));
    io.Fonts->AddFontDefault(&config);
  }
  io.Fonts->Build();
}

Ui::~Ui() { ImGui::DestroyContext(context_); }

Result<void> Ui::set_texture(Drawing& drawing) const {
  ImGui::SetCurrentContext(context_);
  unsigned char* alpha = nullptr;
  int width = 0, height = 0;
  ImGui::GetIO().Fonts->GetTexDataAsAlpha8(&alpha, &width, &height);
  const auto size = static_cast<size_t>(width) * static_cast<size_t>(height);
  return drawing.set_panel_texture(width, height, {alpha, size});
}

bool Ui::handle(const ViewEvent& event) {
  ImGui::SetCurrentContext(context_);
  ImGuiIO& io = ImGui::GetIO();
  const auto hold = [&](bool down) {
    io.KeysDown[static_cast<size_t>(event.key)] = down;
    if (event.key == Key::kShift) io.KeyShift = down;
    if (event.key == Key::kControl) io.KeyCtrl = down;
    if (event.key == Key::kAlt) io.KeyAlt = down;
  };
  const auto move = [&] {
    io.MousePos = {static_cast<float>(event.x), static_cast<float>(event.y)};
  };
  switch (event.kind) {
    case ViewEventKind::kKeyDown:
      hold(true);
      return io.WantTextInput;
    case ViewEventKind::kKeyUp:
      hold(false);
      return false;  // What saw the key go down must see it come up.
    case ViewEventKind::kText:
      io.AddInputCharacter(event.text);
      return io.WantTextInput;
    case ViewEventKind::kMouseMove:
      move();
      return io.WantCaptureMouse;
    case ViewEventKind::kMouseDown:
      move();
      down_[static_cast<size_t>(event.button)] = true;
      pressed_[static_cast<size_t>(event.button)] = true;
      // Since the last frame the pointer may have come onto the panel, or left it.
      ImGui::UpdateHoveredWindowAndCaptureFlags();
      return io.WantCaptureMouse;
    case ViewEventKind::kMouseUp:
      move();
      down_[static_cast<size_t>(event.button)] = false;
      return false;
    case ViewEventKind::kWheel:
      io.MouseWheel += static_cast<float>(event.y);
      return io.WantCaptureMouse;
    case ViewEventKind::kLeave:
      std::fill(std::begin(io.KeysDown), std::end(io.KeysDown), false);
      down_.fill(false);
      io.KeyShift = io.KeyCtrl = io.KeyAlt = false;
      return false;
    case ViewEventKind::kDrop:
      return false;
  }
  return false;
}

void Ui::begin(double seconds, int32_t width, int32_t height) {
  ImGui::SetCurrentContext(context_);
  ImGuiIO& io = ImGui::GetIO();
  io.DisplaySize = {static_cast<float>(width), static_cast<float>(height)};
  io.DeltaTime = static_cast<float>(std::clamp(seconds, 1e-4, 1.0));
  for (size_t b = 0; b < down_.size(); ++b) {
    io.MouseDown[b] = down_[b] || std::exchange(pressed_[b], false);
  }
  ImGui::NewFrame();
}

PanelView Ui::end() {
  ImGui::Render();
  vertices_.clear();
  indices_.clear();
  runs_.clear();
  const ImDrawData* data = ImGui::GetDrawData();
  for (int list = 0; list < data->CmdListsCount; ++list) {
    const ImDrawList& commands = *data->CmdLists[list];
    const auto first_vertex = static_cast<uint32_t>(vertices_.size());
    const auto first_index = static_cast<uint32_t>(indices_.size());
    for (const ImDrawVert& v : commands.VtxBuffer) {
      vertices_.push_back({v.pos.x, v.pos.y, v.uv.x, v.uv.y, v.col});
    }
    for (const ImDrawIdx index : commands.IdxBuffer) indices_.push_back(first_vertex + index);
    for (const ImDrawCmd& command : commands.CmdBuffer) {
      if (command.ElemCount == 0) continue;
      for (uint32_t i = 0; i < command.ElemCount; ++i) {
        indices_[first_index + command.IdxOffset + i] += command.VtxOffset;
      }
      runs_.push_back({.first = first_index + command.IdxOffset,
                       .count = command.ElemCount,
                       .left = static_cast<int32_t>(command.ClipRect.x),
                       .top = static_cast<int32_t>(command.ClipRect.y),
                       .right = static_cast<int32_t>(command.ClipRect.z),
                       .bottom = static_cast<int32_t>(command.ClipRect.w)});
    }
  }
  return {.vertices = vertices_, .indices = indices_, .runs = runs_};
}

std::string Ui::layout() const {
  ImGui::SetCurrentContext(context_);
  return ImGui::SaveIniSettingsToMemory();
}

void Ui::set_layout(const std::string& layout) {
  ImGui::SetCurrentContext(context_);
  ImGui::LoadIniSettingsFromMemory(layout.c_str(), layout.size());
}

}  // namespace throng::view
