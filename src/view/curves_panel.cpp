// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "view/curves_panel.h"

#include <imgui.h>

#include <algorithm>
#include <array>

#include "view/panel.h"

// The part of the panel for [CAACD], and what its keys do.
namespace throng::view {
namespace {

struct Limits {
  double CurvilinearTuning::*member;
  const char* name;
  double low, high, step;
  const char* format;
  const char* tip;
};
// In the order of CurveValue. The paper's ranges are 1 to 2, 0.4 to 1.2 and 0.02 to 0.20.
constexpr std::array<Limits, 3> kLimits = {
    {{&CurvilinearTuning::mass, "Mass", 0.25, 10, 0.25, "%.2f", "4, 5: heavier avatars turn later"},
     {&CurvilinearTuning::max_speed, "MaxSpeed", 0.1, 4, 0.1, "%.2f",
      "6, 7: an avatar's speed is as many times its own as this is what it began with"},
     {&CurvilinearTuning::max_force, "MaxForce", 0.02, 1, 0.02, "%.2f",
      "8, 9: stronger avatars turn sooner"}}};

void hint(const char* text) {
  if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", text);
}

void draw_states(const CurvedFrame& frame) {
  constexpr std::array<const char*, 4> kNames = {"tolerable", "alert", "critical", "collision"};
  const std::array<ImVec4, 4> colours = {{{0.35F, 0.78F, 0.43F, 1},
                                          {0.96F, 0.82F, 0.24F, 1},
                                          {0.98F, 0.51F, 0.16F, 1},
                                          {0.90F, 0.25F, 0.25F, 1}}};
  const auto counts = frame.count_states();
  for (size_t k = 0; k < counts.size(); ++k) {
    if (k % 2 == 1) ImGui::SameLine(ImGui::GetWindowWidth() * 0.5F);
    ImGui::TextColored(colours[k], "%s %zu", kNames[k], counts[k]);
  }
}

void draw_counts(const caacd::Counts& counts, size_t avatars, bool bad) {
  const auto row = [](const char* name, long long value) {
    ImGui::Text("%s", name);
    ImGui::SameLine(ImGui::GetWindowWidth() * 0.62F);
    ImGui::Text("%lld", value);
  };
  row("frame", counts.frames);
  row("collisions of pairs", counts.collisions);
  const caacd::Reported paper = caacd::reported_collisions(static_cast<int32_t>(avatars));
  row("  in the paper, at most", bad ? paper.bad : paper.others);
  row("collisions with obstacles", counts.obstacle_collisions);
  row("arrived", counts.arrived);
  row("wait for another", counts.waiting);
  ImGui::Text("distance, mean");
  ImGui::SameLine(ImGui::GetWindowWidth() * 0.62F);
  ImGui::Text("%.0f units", counts.walked / static_cast<double>(std::max<size_t>(1, avatars)));
}

bool is_bad(const CurvilinearTuning& t) {
  const std::vector<caacd::ParameterSet> named = caacd::named_sets();
  const caacd::ParameterSet set{t.mass, t.max_speed, t.max_force};
  return set == named[0] || set == named[1];
}

void draw_experiment(PanelState& s, const CurvesPanel& curves) {
  caacd::SpaceConfig& space = s.experiment->space;
  if (s.curved && s.curved->counts) {
    draw_counts(*s.curved->counts, s.curved->avatars.size(), is_bad(curves.all));
  }
  ImGui::SliderInt("avatars##plane", &space.avatars, 5, 100);
  int seed = static_cast<int>(space.seed);
  if (ImGui::InputInt("seed##plane", &seed)) space.seed = static_cast<uint64_t>(std::max(0, seed));
  if (ImGui::Button("Start again")) s.restart = true;
  hint("A new run with these avatars, and with the values that all were given last");
}

}  // namespace

void step_curve(CurvesPanel& curves, CurveValue value, int32_t by) {
  const Limits& limits = kLimits[static_cast<size_t>(value)];
  double& shown = curves.shown.*limits.member;
  shown = std::clamp(shown + by * limits.step, limits.low, limits.high);
  curves.changed = true;
}

void follow_picked(PanelState& s) {
  CurvesPanel& curves = *s.curves;
  if (curves.of != s.status.picked) {
    curves.of = s.status.picked;
    curves.edited = false;
    curves.shown = curves.all;
  }
  // Frames that were made ahead may not have yet what all were given last.
  if (curves.of >= 0 && !curves.edited && s.picked_tuning) curves.shown = *s.picked_tuning;
}

void draw_curves(PanelState& s) {
  CurvesPanel& curves = *s.curves;
  if (curves.of < 0) {
    ImGui::Text("of all avatars");
    hint("Pick an avatar to change its values alone");
  } else {
    ImGui::Text("of avatar %lld", static_cast<long long>(curves.of));
    ImGui::SameLine();
    if (ImGui::SmallButton("Give to all")) curves.to_all = true;
  }
  for (const Limits& limits : kLimits) {
    double& value = curves.shown.*limits.member;
    if (ImGui::SliderScalar(limits.name, ImGuiDataType_Double, &value, &limits.low, &limits.high,
                            limits.format, ImGuiSliderFlags_Logarithmic)) {
      curves.changed = true;
    }
    hint(limits.tip);
  }
  for (const caacd::ParameterSet& set : caacd::named_sets()) {
    if (ImGui::SmallButton(caacd::name_of(set).c_str())) {
      curves.shown.mass = set.mass;
      curves.shown.max_speed = set.max_speed;
      curves.shown.max_force = set.max_force;
      curves.changed = true;
    }
    hint("A set that the paper names");
    ImGui::SameLine();
  }
  ImGui::NewLine();
  if (s.curved) draw_states(*s.curved);
  ImGui::Checkbox("Fields and probes", &s.overlays[static_cast<size_t>(Overlay::kFields)]);
  hint("G: repulsive, precaution and alert fields, and the probe (the paper's repulsive zone)");
  if (s.experiment) draw_experiment(s, curves);
}

}  // namespace throng::view
