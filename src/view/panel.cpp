// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "view/panel.h"

#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <limits>

// The windows of the panel in Dear ImGui.
namespace throng::view {
namespace {

constexpr ImGuiWindowFlags kFixed = ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove |
                                    ImGuiWindowFlags_NoSavedSettings |
                                    ImGuiWindowFlags_NoFocusOnAppearing | ImGuiWindowFlags_NoNav;

bool slide(const char* name, double& value, double low, double high, const char* format,
           ImGuiSliderFlags flags = 0) {
  return ImGui::SliderScalar(name, ImGuiDataType_Double, &value, &low, &high, format, flags);
}

void tip(const char* text) {
  if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", text);
}

void draw_transport(PanelState& s) {
  if (ImGui::Button(s.playing ? "Pause" : " Play ")) s.playing = !s.playing;
  tip("Space");
  ImGui::SameLine();
  if (ImGui::Button("Step")) s.step = true;
  tip("Period: one step, and stop");
  ImGui::SameLine();
  ImGui::SetNextItemWidth(-1);
  slide("##speed", s.settings.speed, 0.05, 16, "%.2f x", ImGuiSliderFlags_Logarithmic);
  tip("Speed of time");
}

void draw_crowd(PanelState& s) {
  ImGui::SliderInt("avatars", &s.avatars_wanted, 0, 100000, "%d", ImGuiSliderFlags_Logarithmic);
  if (ImGui::IsItemDeactivatedAfterEdit()) s.set_count = true;
  tip("As many of these as fit; Ctrl-click to type");
  slide("goals within", s.crowd.near, 0, 500, s.crowd.near <= 0 ? "anywhere" : "%.0f m",
        ImGuiSliderFlags_Logarithmic);
  slide("desired speed", s.crowd.speed, 0, 4, s.crowd.speed <= 0 ? "by class" : "%.2f m/s");
  slide("dt", s.crowd.dt, 0.02, 0.5, "%.2f s");
  int seed = static_cast<int>(s.crowd.seed);
  if (ImGui::InputInt("seed", &seed)) s.crowd.seed = static_cast<uint64_t>(std::max(0, seed));
  if (s.class_names.size() > 1 && ImGui::TreeNode("Mix of classes")) {
    s.crowd.mix.resize(s.class_names.size(), 0.0);
    if (std::all_of(s.crowd.mix.begin(), s.crowd.mix.end(), [](double v) { return v <= 0; })) {
      s.crowd.mix[0] = 1;
    }
    for (size_t i = 0; i < s.class_names.size(); ++i) {
      slide(s.class_names[i].c_str(), s.crowd.mix[i], 0, 1, "%.2f");
    }
    ImGui::TreePop();
  }
  if (ImGui::Checkbox("Only what is seen", &s.settings.only_seen)) s.restart = true;
  tip("For an eye in a street: avatars that cannot be seen from there are not simulated, and none\n"
      "appears or disappears in sight. The density is that of the avatars above on all ground");
  if (s.crowd.only_seen && s.status.avatars == 0 && !s.status.loading) {
    ImGui::TextWrapped("No avatars: no ground within %.0f m of the eye. Go nearer.", s.crowd.sight);
  }
  if (ImGui::Checkbox("Far ones coarser", &s.settings.coarse_far)) s.restart = true;
  tip("Avatars more than 300 m away decide and move in longer steps");
  if (ImGui::Button("Start again")) s.restart = true;
  tip("A new crowd with these settings");
}

void draw_tools(PanelState& s) {
  const bool can_paint = s.has_crowd || (s.scenario && !s.scenario->densities.empty());
  if (!can_paint) return;
  ImGui::TextDisabled("A click on the ground");
  const auto tool = [&](const char* name, Tool value) {
    if (!ImGui::RadioButton(name, s.tool == value)) return;
    s.tool = value;
    if (value == Tool::kPaint) s.overlays[static_cast<size_t>(Overlay::kPainted)] = true;
  };
  tool("picks", Tool::kPick);
  if (s.has_crowd) {
    ImGui::SameLine();
    tool("spawns", Tool::kSpawn);
    ImGui::SameLine();
    tool("erases", Tool::kErase);
  }
  tool("paints where people go", Tool::kPaint);
  tool("wipes that away", Tool::kUnpaint);
  if (s.tool == Tool::kPick) return;
  slide("radius", s.brush_radius, 0.5, 30, "%.1f m", ImGuiSliderFlags_Logarithmic);
  if (s.tool == Tool::kSpawn) {
    ImGui::SliderInt("at a time", &s.brush_count, 1, 2000, "%d", ImGuiSliderFlags_Logarithmic);
  }
  if (s.tool == Tool::kPaint) {
    slide("strength", s.brush_weight, 0.05, 1, "%.2f");
    tip("Twice the strength, twice as many");
  }
  if (s.tool != Tool::kPaint && s.tool != Tool::kUnpaint) return;
  if (s.scenario && s.scenario->densities.size() > 1) {
    const auto& names = s.scenario->densities;
    const auto at = static_cast<size_t>(s.scenario->painted);
    if (ImGui::BeginCombo("map", names[at].c_str())) {
      for (size_t i = 0; i < names.size(); ++i) {
        if (ImGui::Selectable(names[i].c_str(), i == at)) {
          s.scenario->painted = static_cast<int32_t>(i);
        }
      }
      ImGui::EndCombo();
    }
  }
  // A scenario's avatars need goals.
  if (s.has_crowd && ImGui::Button("Wipe all away")) s.unpaint_all = true;
}

void draw_scenario(PanelState& s) {
  const SceneFlow& flow = s.flow;
  ImGui::Text("%.1f of %.0f s", s.status.time, s.scenario->seconds);
  ImGui::Text("entered %llu, left %llu", static_cast<unsigned long long>(flow.entered),
              static_cast<unsigned long long>(flow.left));
  const auto show = [](const char* what, uint64_t count) {
    if (count > 0) ImGui::Text("%s %llu", what, static_cast<unsigned long long>(count));
  };
  show("wait outside", flow.outside);
  show("in lifts", flow.in_links);
  show("goal unreachable", flow.goal_unreachable);
  if (ImGui::Button("Start again")) s.restart = true;
  tip("From its beginning, with the painted densities");
}

// Just over the heads of avatars on a storey, under the floor of the next.
double cut_over(const PanelState& s, size_t storey) {
  const double cut = s.storeys[storey] + 2.1;
  return storey + 1 < s.storeys.size() ? std::min(cut, s.storeys[storey + 1] - 0.3) : cut;
}

void draw_levels(PanelState& s) {
  ImGui::Checkbox("Cut away above", &s.is_cut);
  tip("Page Up and Page Down go from storey to storey");
  if (!s.bounds.empty()) {
    ImGui::SetNextItemWidth(-1);
    if (slide("##cut", s.cut, s.bounds.min.y, s.bounds.max.y + 1, "%.2f m")) s.is_cut = true;
  }
  for (size_t k = 0; k < s.storeys.size() && k < 24; ++k) {
    const size_t i = s.storeys.size() - 1 - k;  // The highest first.
    ImGui::PushID(static_cast<int>(i));
    const double top =
        i + 1 < s.storeys.size() ? s.storeys[i + 1] - 0.6 : std::numeric_limits<double>::infinity();
    const bool here = s.is_cut && s.cut > s.storeys[i] && s.cut <= top;
    char label[64];
    std::snprintf(label, sizeof label, "storey %zu, %.2f m", i, s.storeys[i]);
    if (ImGui::Selectable(label, here)) {
      s.is_cut = true;
      s.cut = cut_over(s, i);
    }
    ImGui::PopID();
  }
}

void draw_view(PanelState& s) {
  const auto mode = [&](const char* name, CameraMode value) {
    if (!ImGui::RadioButton(name, s.mode == value)) return;
    if (value == CameraMode::kWalk) {
      s.walk = true;
    } else {
      s.mode = value;
    }
  };
  mode("Orbit", CameraMode::kOrbit);
  ImGui::SameLine();
  mode("Fly", CameraMode::kFly);
  ImGui::SameLine();
  mode("Walk", CameraMode::kWalk);
  if (ImGui::Button("See all")) s.frame_all = true;
  tip("Home");
  slide("view angle", s.settings.view_angle, 10, 120, "%.0f deg");
  slide("fly speed", s.settings.fly_speed, 0.5, 100, "%.1f m/s", ImGuiSliderFlags_Logarithmic);
  slide("edges", s.settings.edges, 0, 1, "%.2f");
  ImGui::Checkbox("Shadows of avatars", &s.settings.shadows);
  ImGui::Checkbox("Smooth", &s.settings.smooth);
  tip("2 x 2 samples a pixel: four times the work");
}

void draw_times(const PanelState& s) {
  const auto row = [](const char* name, double seconds) {
    ImGui::Text("%-22s", name);
    ImGui::SameLine(ImGui::GetWindowWidth() * 0.62F);
    ImGui::Text("%7.2f ms", seconds * 1e3);
  };
  row("frame", s.times.frame);
  row("  between two steps", s.times.blend);
  row("  cull and pack", s.times.pack);
  row("  draw", s.times.draw);
  row("  panel", s.times.panel);
  if (s.has_crowd || s.scenario) {
    ImGui::Separator();
    row("step", s.report.seconds_total);
    row("  paths", s.report.seconds_plan);
    row("  sort", s.report.seconds_sort);
    row("  steer", s.report.seconds_steer);
    row("  commit", s.report.seconds_commit);
    row("  settle", s.report.seconds_settle);
  }
  ImGui::TextDisabled("%s", s.renderer.c_str());
}

void draw_main(PanelState& s, float scale, int32_t height) {
  ImGui::SetNextWindowPos({12 * scale, 12 * scale}, ImGuiCond_FirstUseEver);
  ImGui::SetNextWindowSize({310 * scale, std::min(640 * scale, static_cast<float>(height) - 24)},
                           ImGuiCond_FirstUseEver);
  bool open = true;
  if (!ImGui::Begin("throng", &open)) {
    ImGui::End();
    if (!open) s.settings.panel = false;
    return;
  }
  if (!open) s.settings.panel = false;
  ImGui::PushItemWidth(ImGui::GetWindowWidth() * 0.52F);
  ImGui::TextWrapped("%s", s.status.name.c_str());
  ImGui::TextDisabled("%zu avatars, %zu drawn, %.0f frames/s", s.status.avatars, s.status.drawn,
                      s.times.frame > 0 ? 1 / s.times.frame : 0);
  if (!s.status.error.empty()) {
    ImGui::PushStyleColor(ImGuiCol_Text, ImVec4{1.0F, 0.55F, 0.45F, 1.0F});
    ImGui::TextWrapped("%s", s.status.error.c_str());
    ImGui::PopStyleColor();
  }
  if (s.has_crowd || s.replay || s.scenario || s.experiment) draw_transport(s);
  if (s.has_crowd && ImGui::CollapsingHeader("Crowd", ImGuiTreeNodeFlags_DefaultOpen)) {
    draw_crowd(s);
    draw_tools(s);
  }
  if (s.curves &&
      ImGui::CollapsingHeader(s.experiment ? "[CAACD], section V" : "Curvilinear avoidance",
                              ImGuiTreeNodeFlags_DefaultOpen)) {
    draw_curves(s);
  }
  if (s.scenario && ImGui::CollapsingHeader("Scenario", ImGuiTreeNodeFlags_DefaultOpen)) {
    draw_scenario(s);
    draw_tools(s);
  }
  if (ImGui::CollapsingHeader("Levels", ImGuiTreeNodeFlags_DefaultOpen)) draw_levels(s);
  if (s.has_world && ImGui::CollapsingHeader("Overlays", ImGuiTreeNodeFlags_DefaultOpen)) {
    for (size_t i = 0; i < kOverlays; ++i) {
      if (i % 2 == 1) ImGui::SameLine(ImGui::GetWindowWidth() * 0.5F);
      ImGui::Checkbox(word_for(static_cast<Overlay>(i)), &s.overlays[i]);
      tip(legend_of(static_cast<Overlay>(i)));
    }
  }
  if (ImGui::CollapsingHeader("View")) draw_view(s);
  if (ImGui::CollapsingHeader("Times")) draw_times(s);
  if (ImGui::Button("Keys (F1)")) s.help = !s.help;
  ImGui::PopItemWidth();
  ImGui::End();
}

void draw_progress(const PanelState& s, float scale, int32_t width, int32_t height) {
  if (!s.status.loading) return;
  ImGui::SetNextWindowPos(
      {0.5F * static_cast<float>(width), static_cast<float>(height) - 70 * scale}, ImGuiCond_Always,
      {0.5F, 1});
  ImGui::SetNextWindowSize({std::min(360 * scale, static_cast<float>(width) - 24 * scale), 0});
  ImGui::Begin("##progress", nullptr, kFixed);
  ImGui::Text("%s: %s", s.status.name.c_str(),
              s.progress_stage.empty() ? "open" : s.progress_stage.c_str());
  if (s.progress >= 0) {
    ImGui::ProgressBar(static_cast<float>(s.progress), {-1, 6 * scale}, "");
  } else {
    const auto t = static_cast<float>(std::fmod(ImGui::GetTime() * 0.7, 1.0));
    ImGui::ProgressBar(t, {-1, 6 * scale}, "");
  }
  ImGui::End();
}

void draw_timeline(PanelState& s, float scale, int32_t width, int32_t height) {
  if (!s.replay) return;
  ImGui::SetNextWindowPos(
      {0.5F * static_cast<float>(width), static_cast<float>(height) - 12 * scale}, ImGuiCond_Always,
      {0.5F, 1});
  ImGui::SetNextWindowSize({std::min(760 * scale, static_cast<float>(width) - 24 * scale), 0});
  ImGui::Begin("##timeline", nullptr, kFixed);
  if (ImGui::Button(s.playing ? "Pause" : " Play ")) s.playing = !s.playing;
  ImGui::SameLine();
  ImGui::SetNextItemWidth(-1);
  double time = s.status.time;
  if (slide("##time", time, s.replay->first, s.replay->last, "%.2f s")) s.seek = time;
  ImGui::End();
}

void draw_picked(PanelState& s, float scale, int32_t width) {
  if (s.status.picked < 0) return;
  ImGui::SetNextWindowPos({static_cast<float>(width) - 12 * scale, 12 * scale}, ImGuiCond_Always,
                          {1, 0});
  ImGui::SetNextWindowSize({250 * scale, 0});
  ImGui::Begin("##avatar", nullptr, kFixed);
  ImGui::Text("Avatar %lld", static_cast<long long>(s.status.picked));
  if (s.picked) {
    const AvatarDetail& a = *s.picked;
    const auto index = static_cast<size_t>(a.avatar_class);
    if (index < s.class_names.size()) ImGui::Text("class      %s", s.class_names[index].c_str());
    ImGui::Text("at         %.2f, %.2f, %.2f", a.position.x, a.position.y, a.position.z);
    ImGui::Text("walks      %.2f m/s", s.picked_speed);
    if (a.speed > 0) ImGui::Text("desired    %.2f m/s", a.speed);
    ImGui::Text("has walked %.1f m", s.picked_walked);
    if (a.goal) {
      ImGui::Text("goal       %.1f, %.1f, %.1f", a.goal->x, a.goal->y, a.goal->z);
      ImGui::Text("away       %.1f m", length(*a.goal - a.position));
      ImGui::Text("its goal number %u", a.goals_given);
    }
    if (s.picked_tuning) {
      const CurvilinearTuning& t = *s.picked_tuning;
      ImGui::Text("Mass       %.2f", t.mass);
      ImGui::Text("MaxSpeed   %.2f", t.max_speed);
      ImGui::Text("MaxForce   %.2f", t.max_force);
    }
    if (a.controlled) ImGui::Text("controlled by you");
  }
  ImGui::TextDisabled("F looks at it, Escape lets go");
  ImGui::End();
}

void draw_picked_node(PanelState& s, float scale, int32_t width) {
  if (!s.picked_node || s.status.picked >= 0) return;
  const NodeDetail& d = *s.picked_node;
  ImGui::SetNextWindowPos({static_cast<float>(width) - 12 * scale, 12 * scale}, ImGuiCond_Always,
                          {1, 0});
  ImGui::SetNextWindowSize({290 * scale, 0});
  ImGui::Begin("##node", nullptr, kFixed);
  ImGui::Text("Node %lld", static_cast<long long>(s.status.picked_node));
  ImGui::Text("%s %u, level %d%s", d.info.kind == PatchKind::kBezier ? "patch" : "level tile",
              d.info.source, static_cast<int>(d.info.block_level),
              d.info.cells != 0 ? ", partial" : "");
  ImGui::Text("middle      %.2f, %.2f, %.2f", d.middle.x, d.middle.y, d.middle.z);
  ImGui::Text("inclination at most %.4g deg", d.inclination);
  ImGui::Text("height      %.2f m", d.height);
  ImGui::Text("headroom    %.2f m", d.headroom);
  ImGui::Text("width       %.2f m", d.width);
  ImGui::Text("area        %.2f m2", static_cast<double>(d.info.area));
  for (size_t c = 0; c < s.class_names.size(); ++c) {
    if ((d.info.classes >> c & 1) != 0) ImGui::Text("for         %s", s.class_names[c].c_str());
  }
  ImGui::TextDisabled("Escape lets go");
  ImGui::End();
}

void draw_help(PanelState& s, int32_t width, int32_t height) {
  if (!s.help) return;
  ImGui::SetNextWindowPos({0.5F * static_cast<float>(width), 0.5F * static_cast<float>(height)},
                          ImGuiCond_Appearing, {0.5F, 0.5F});
  if (ImGui::Begin("Keys", &s.help,
                   ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoSavedSettings |
                       ImGuiWindowFlags_NoCollapse) &&
      ImGui::BeginTable("##keys", 2)) {
    const char* const rows[][2] = {
        {"Left drag", "turn around the middle; in Fly and Walk: look around"},
        {"Right or middle drag", "move sideways; with Shift, also the left"},
        {"Wheel", "nearer to what is under the pointer, or away"},
        {"Click",
         "pick an avatar, or a node of the overlay; spawn, erase, paint goals (panel: Crowd)"},
        {"W A S D, arrows", "go; Q down, E up; Shift: faster"},
        {"1, 2, 3", "Orbit, Fly, Walk as an avatar"},
        {"V", "in Walk: through its eyes, or from behind"},
        {"F", "look at the picked avatar"},
        {"T", "paint goals; again: wipe them away; again: pick"},
        {"Home", "see all"},
        {"Page Up, Page Down", "storey by storey; End: all of them"},
        {"Space, period", "pause or play; one step"},
        {"Comma, M", "slower, faster"},
        {"C, L, N, K", "clearance, levels, nodes, links"},
        {"X, H, P, B", "air, density (heat), path and neighbours of the picked avatar"},
        {"O, G", "painted goals; protection fields"},
        {"Y, U", "cylinders of nodes; boxes of the air"},
        {"4 5, 6 7, 8 9", "with [CAACD]: Mass, MaxSpeed, MaxForce of the picked avatar, or of all"},
        {"Tab", "panel"},
        {"F11, F12", "full screen; save a picture"},
        {"Escape", "leave Walk, let go of the avatar, close this"},
        {"Ctrl+Q", "quit"},
    };
    for (const auto& [key, what] : rows) {
      ImGui::TableNextRow();
      ImGui::TableNextColumn();
      ImGui::Text("%s", key);
      ImGui::TableNextColumn();
      ImGui::Text("%s", what);
    }
    ImGui::EndTable();
  }
  ImGui::End();
}

void draw_hint(const PanelState& s, float scale, int32_t width, int32_t height) {
  if (!s.settings.hints || s.help) return;
  ImGui::SetNextWindowPos(
      {static_cast<float>(width) - 12 * scale, static_cast<float>(height) - 12 * scale},
      ImGuiCond_Always, {1, 1});
  ImGui::SetNextWindowBgAlpha(0.45F);
  ImGui::Begin("##hint", nullptr,
               kFixed | ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoInputs);
  const char* text = "F1: keys   Tab: panel";
  if (s.mode == CameraMode::kWalk) text = "W A S D: walk   V: eyes or behind   Escape: leave";
  ImGui::TextUnformatted(text);
  ImGui::End();
}

}  // namespace

void draw_panel(PanelState& s, float scale, int32_t width, int32_t height) {
  if (s.settings.panel) draw_main(s, scale, height);
  draw_picked(s, scale, width);
  draw_picked_node(s, scale, width);
  draw_timeline(s, scale, width, height);
  draw_progress(s, scale, width, height);
  draw_hint(s, scale, width, height);
  draw_help(s, width, height);
}

void step_cut(PanelState& s, int32_t by) {
  if (s.storeys.empty() || (by > 0 && !s.is_cut)) return;
  // The storey on top now; one above all if nothing is cut away.
  const auto all = static_cast<int32_t>(s.storeys.size());
  int32_t top = all;
  if (s.is_cut) {
    top = 0;
    while (top + 1 < all && s.storeys[static_cast<size_t>(top) + 1] < s.cut) ++top;
  }
  // A cut above everything changes nothing: on to the next.
  for (top += by; top >= 0; top += by) {
    if (top >= all) {
      s.is_cut = false;
      return;
    }
    const double cut = cut_over(s, static_cast<size_t>(top));
    if (cut >= s.bounds.max.y) continue;
    s.is_cut = true;
    s.cut = cut;
    return;
  }
}

}  // namespace throng::view
