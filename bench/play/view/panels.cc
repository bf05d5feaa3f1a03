// SPDX-License-Identifier: MIT
#include "play/view/panels.h"

#include <fmt/format.h>
#include <imgui.h>
#include <imgui_stdlib.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "scenes/facts.h"

namespace cairn::play {
namespace {

constexpr int kSide = 292, kStrip = 158;  // [pixels] of the panels on the left and below
constexpr const char* kFont = "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf";
constexpr ImU32 kSideColours[] = {IM_COL32(255, 166, 77, 255), IM_COL32(90, 200, 250, 255)};
constexpr const char* kSides[] = {"left", "right"};
constexpr ImGuiWindowFlags kFixedWindow = ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoResize |
                                          ImGuiWindowFlags_NoTitleBar |
                                          ImGuiWindowFlags_NoSavedSettings;

/// A curve over time of each world.
struct Plot {
  const char* title;
  double (*value)(const Sample&);
};
constexpr Plot kPlots[] = {{"solver, ms", [](const Sample& s) { return s.solver_ms; }},
                           {"other parts, ms", [](const Sample& s) { return s.world_ms; }},
                           {"residual, m/s", [](const Sample& s) { return s.residual; }},
                           {"energy, kJ", [](const Sample& s) { return s.energy / 1000; }},
                           {"sweeps", [](const Sample& s) { return double(s.sweeps); }},
                           {"deepest, mm", [](const Sample& s) { return 1000 * s.penetration; }},
                           {"joint gap, mm", [](const Sample& s) { return 1000 * s.joint_gap; }},
                           {"steps kept", [](const Sample& s) { return double(s.steps_kept); }},
                           {"undone", [](const Sample& s) { return double(s.steps_undone); }},
                           {"guarded", [](const Sample& s) { return double(s.guarded); }}};
constexpr size_t kColumns = std::size(kPlots) / 2;

/// A number for a narrow place; "-" where it is not known.
std::string Short(double value) {
  if (std::isnan(value)) return "-";
  return fmt::format(fmt::runtime(std::abs(value) >= 1 ? "{:.4g}" : "{:.2g}"), value);
}

void DrawPlot(const Session& session, const Plot& plot, const ImVec2& size) {
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const ImVec2 at = ImGui::GetCursorScreenPos();
  list.AddRectFilled(at, {at.x + size.x, at.y + size.y}, IM_COL32(255, 255, 255, 12), 4);
  double low = 0, high = 0;
  for (int side = 0; side < session.worlds(); ++side) {
    for (const Sample& sample : session.player(side).history()) {
      low = std::min(low, plot.value(sample));
      high = std::max(high, plot.value(sample));
    }
  }
  if (!(high > low)) high = low + 1;
  list.PushClipRect(at, {at.x + size.x, at.y + size.y});
  float right = at.x + size.x - 6;
  const float row = size.x < 190 ? 15 : 0;  // of numbers: below the title where it is narrow
  for (int side = session.worlds() - 1; side >= 0; --side) {
    const auto& history = session.player(side).history();
    std::vector<ImVec2> points;
    for (size_t i = 0; i < history.size(); ++i) {
      const double share = (plot.value(history[i]) - low) / (high - low);
      if (std::isnan(share)) continue;
      points.push_back({at.x + size.x * static_cast<float>(i) / Player::kMostHistory,
                        at.y + size.y - 3 - (size.y - 22 - row) * static_cast<float>(share)});
    }
    list.AddPolyline(points.data(), static_cast<int>(points.size()), kSideColours[side], 0, 1.6f);
    if (history.empty()) continue;
    const std::string text = Short(plot.value(history.back()));
    right -= ImGui::CalcTextSize(text.c_str()).x;
    list.AddText({right, at.y + 3 + row}, kSideColours[side], text.c_str());
    right -= 8;
  }
  list.AddText({at.x + 6, at.y + 3}, IM_COL32(200, 204, 210, 255), plot.title);
  list.PopClipRect();
  ImGui::Dummy(size);
}

std::string TitleOf(Player& player, const PlayerControls& controls) {
  if (controls.budget != kNoBudget && player.cairn() != nullptr) {
    if (controls.budget == kFixed)
      return fmt::format("{}, {:.3g} ms", controls.solver, controls.budget_ms);
    return controls.solver +
           (controls.budget == kMatch ? ", in the other's time" : ", what is left");
  }
  if (player.solver().control == cli::Control::kNone) return controls.solver;
  return fmt::format("{}, {} iterations", controls.solver, controls.iterations);
}

/// The island of a body.
std::string DescribeIsland(Player* player, int body) {
  const bench::IslandFacts facts = bench::FactsOfIsland(player->world(), body);
  std::string text = fmt::format(
      "body {}, island of {} bodies, {:.4g} kg{}\n{} contacts, {} joints, speed {:.2g} m/s", body,
      facts.bodies, facts.mass, facts.asleep ? ", asleep" : "", facts.contacts, facts.joints,
      facts.speed);
  if (player->played().recorded() == nullptr) {
    text += fmt::format("\ndeepest {:.2f} mm, joint gap {:.2f} mm", 1000 * facts.penetration,
                        1000 * facts.joint_gap);
  }
  const std::optional<IslandReport> found = player->ReportOf(body);
  if (!found) return text;
  const IslandReport& report = *found;
  return text + fmt::format(
                    "\n{} rows, {} sweeps, residual {:.1e} from {:.1e} m/s\nsteps {} kept, "
                    "{} undone; {}\nended: {}",
                    report.rows, report.sweeps, report.residual.max, report.residual_before.max,
                    report.steps_accepted, report.steps_restored, cairn::Describe(report.no_step),
                    cairn::Describe(report.stop));
}

/// Worlds and recordings in the folder of a file, else in the one where the program was started.
std::vector<std::string> FilesBeside(const std::string& scene) {
  namespace fs = std::filesystem;
  const fs::path folder = fs::path(scene).parent_path();
  std::vector<std::string> files;
  std::error_code none;  // of a folder that cannot be read
  for (const auto& entry : fs::directory_iterator(folder.empty() ? "." : folder, none)) {
    const fs::path& path = entry.path();
    if (path.extension() != ".cairn" && path.extension() != ".bullet") continue;
    files.push_back((folder / path.filename()).string());
  }
  std::sort(files.begin(), files.end());
  return files;
}

/// Whether there is room for panels beside worlds.
bool ArePanelsShown(const Controls& controls, int width, int height) {
  return controls.panels && width >= 640 && height >= 360;
}

}  // namespace

Panels::Panels() {
  ImGui::GetIO().IniFilename = nullptr;
  ImGui::StyleColorsDark();
  ImGuiStyle& style = ImGui::GetStyle();
  style.FrameRounding = style.GrabRounding = 4;
  style.WindowRounding = style.WindowBorderSize = 0;
  style.ItemSpacing = {6, 4};
  style.Colors[ImGuiCol_WindowBg] = {0.09f, 0.10f, 0.12f, 1};
  ImFontAtlas& fonts = *ImGui::GetIO().Fonts;
  for (const float size : {13.0f, 20.0f}) {
    const bool there = std::filesystem::exists(kFont);
    large_ = there ? fonts.AddFontFromFileTTF(kFont, size) : fonts.AddFontDefault();
  }
}

std::vector<Area> Panels::Areas(const Controls& controls, int width, int height) {
  const bool panels = ArePanelsShown(controls, width, height);
  const int left = panels ? kSide : 0, below = panels ? kStrip : 0;
  const int each = std::max(1, (width - left) / controls.worlds);
  std::vector<Area> areas;
  for (int i = 0; i < controls.worlds; ++i) {
    areas.push_back({left + i * each + i, below, std::max(1, each - controls.worlds + 1),
                     std::max(1, height - below)});
  }
  return areas;
}

void Panels::Mark(const std::string& name) {
  if (!ImGui::IsItemVisible()) return;  // scrolled away
  const ImVec2 low = ImGui::GetItemRectMin(), high = ImGui::GetItemRectMax();
  // a box with a label is clicked in the box
  widgets_[name] = {std::min((low.x + high.x) / 2, low.x + 10), (low.y + high.y) / 2};
}

bool Panels::Button(const char* title, const std::string& name, float width) {
  const bool pressed = ImGui::Button(fmt::format("{}##{}", title, name).c_str(), {width, 0});
  Mark(name);
  return pressed;
}

void Panels::Control(const std::string& name, const char* unit) {
  const Field& field = fields_.at(name);
  const std::string label = unit == nullptr ? "" : name.substr(name.find('.') + 1) + unit,
                    id = label + "##" + name;
  const auto log = ImGuiSliderFlags_Logarithmic | ImGuiSliderFlags_AlwaysClamp;
  if (bool* const* on = std::get_if<bool*>(&field.value)) {
    ImGui::Checkbox(id.c_str(), *on);
  } else if (int* const* count = std::get_if<int*>(&field.value)) {
    const int most = static_cast<int>(std::min(field.most, 1000.0));
    ImGui::SliderInt(id.c_str(), *count, static_cast<int>(field.least), most, "%d",
                     most > 20 ? log : 0);
  } else if (double* const* number = std::get_if<double*>(&field.value)) {
    ImGui::SliderScalar(id.c_str(), ImGuiDataType_Double, *number, &field.least, &field.most,
                        "%.3g", log);
  } else {
    std::string* const word = std::get<std::string*>(field.value);
    if (field.words.empty()) ImGui::InputText(id.c_str(), word);
    if (!field.words.empty() && ImGui::BeginCombo(id.c_str(), word->c_str())) {
      for (const std::string_view choice : field.words) {
        if (ImGui::Selectable(std::string(choice).c_str(), *word == choice)) *word = choice;
        Mark(fmt::format("{}.{}", name, choice));
      }
      ImGui::EndCombo();
    }
  }
  Mark(name);
}

void Panels::DrawScene(Controls* controls) {
  ImGui::PushItemWidth(150);
  if (ImGui::BeginCombo("scenes, files", "choose", ImGuiComboFlags_HeightLarge)) {
    std::vector<std::string> names = FilesBeside(controls->scene.scene);
    names.push_back("random");
    for (const bench::SceneInfo& scene : bench::Scenes()) names.emplace_back(scene.name);
    for (const std::string& name : names) {
      const bool chosen = ImGui::Selectable(name.c_str(), controls->scene.scene == name);
      Mark("scenes." + name);
      if (!chosen) continue;
      controls->scene = {.scene = name, .size = 0, .seed = controls->scene.seed};
      requests_ = {"restart"};
    }
    ImGui::EndCombo();
  }
  Mark("scenes");
  Control("scene");
  for (const auto& [label, value] :
       {std::pair{"size", &controls->scene.size}, {"seed", &controls->scene.seed}}) {
    ImGui::InputInt(label, value);
    *value = std::max(0, *value);
    Mark(label);
  }
  ImGui::PopItemWidth();
}

void Panels::DrawSide(int side, Controls* controls) {
  const std::string prefix = kSides[side];
  ImGui::AlignTextToFramePadding();
  ImGui::TextColored(ImGui::ColorConvertU32ToFloat4(kSideColours[side]), "%s", prefix.c_str());
  ImGui::PushItemWidth(-1);
  for (const Preset& preset : Presets()) {
    const std::string name = fmt::format("{}.preset.{}", prefix, preset.name);
    if (Button(std::string(preset.title).c_str(), name, -1)) {
      UsePreset(preset.name, side, controls);
    }
  }
  Control(prefix + ".solver", nullptr);
  ImGui::PopItemWidth();
  ImGui::PushItemWidth(60);
  for (const char* const name : {".iterations", ".budget", ".budget_ms", ".threads"}) {
    Control(prefix + name);
  }
  ImGui::PopItemWidth();
  Control(prefix + ".steps");
  Control(prefix + ".acceleration");
}

void Panels::DrawSidebar(Session* session, const Facts& facts, int height) {
  Controls& controls = session->controls();
  ImGui::SetNextWindowPos({0, 0});
  ImGui::SetNextWindowSize({kSide, static_cast<float>(height)});
  ImGui::Begin("controls", nullptr, kFixedWindow);
  DrawScene(&controls);
  const float width = (ImGui::GetContentRegionAvail().x - 4 * 6) / 5;
  for (const Request& request : kRequests) {
    if (Button(request.title, request.name, width)) requests_.insert(request.name);
    ImGui::SameLine();
  }
  ImGui::NewLine();
  controls.paused |= requests_.contains("step");
  ImGui::PushItemWidth(110);
  for (const auto& [name, unit] : {std::pair{"worlds", ""},
                                   {"rate", " (steps a second)"},
                                   {"substeps", ""},
                                   {"speed", " (of time)"},
                                   {"ball_mass", " (kg)"},
                                   {"ball_speed", " (m/s)"},
                                   {"colours", ""}}) {
    Control(name, unit);
  }
  ImGui::PopItemWidth();
  const char* const checks[] = {"paused",  "sleep",  "measure",     "contacts", "joints",
                                "shadows", "smooth", "interpolate", "panels"};
  for (int i = 0; i < 9; ++i) {
    if (i % 3 != 0) ImGui::SameLine(static_cast<float>(8 + 92 * (i % 3)));
    Control(checks[i]);
  }
  ImGui::Separator();
  if (ImGui::BeginTable("sides", 2)) {
    for (int side = 0; side < controls.worlds; ++side) {
      ImGui::TableNextColumn();
      DrawSide(side, &controls);
    }
    ImGui::EndTable();
  }
  ImGui::Separator();
  ImGui::Text("%.0f pictures a second, drawing %.1f ms", 1000 / std::max(0.01, facts.picture_ms),
              facts.draw_ms);
  ImGui::TextWrapped("%s", facts.message.c_str());
  ImGui::End();
}

void Panels::DrawPlots(const Session& session, int width, int height) {
  const float space = static_cast<float>(width - kSide);
  ImGui::SetNextWindowPos({kSide, static_cast<float>(height - kStrip)});
  ImGui::SetNextWindowSize({space, kStrip});
  ImGui::Begin("plots", nullptr, kFixedWindow | ImGuiWindowFlags_NoScrollbar);
  const ImVec2 size((space - 16) / kColumns - 6, (kStrip - 16 - 6) / 2);
  for (size_t i = 0; i < std::size(kPlots); ++i) {
    if (i % kColumns != 0) ImGui::SameLine();
    DrawPlot(session, kPlots[i], size);
  }
  ImGui::End();
}

void Panels::DrawLabel(Session* session, int side, const Facts& facts, const Area& area,
                       int height) {
  Player& player = session->player(side);
  const float top = static_cast<float>(height - area.y - area.height);
  ImGui::SetNextWindowPos({static_cast<float>(area.x) + 10, top + 10});
  ImGui::SetNextWindowBgAlpha(0.72f);
  const float width = std::min(330.0f, static_cast<float>(area.width) - 20);
  ImGui::SetNextWindowSizeConstraints({width, 0}, {width, 1000});
  ImGui::Begin(kSides[side], nullptr,
               kFixedWindow | ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoInputs);
  ImGui::PushTextWrapPos(width - 8);
  ImGui::PushFont(large_);
  ImGui::TextColored(ImGui::ColorConvertU32ToFloat4(kSideColours[side]), "%s",
                     TitleOf(player, session->controls().players[side]).c_str());
  ImGui::PopFont();
  if (!player.history().empty()) {
    const Sample& last = player.history().back();
    const std::string deepest = fmt::format(", deepest {:.1f} mm", 1000 * last.penetration);
    ImGui::Text("residual %.2g m/s%s", last.residual,
                player.played().recorded() ? "" : deepest.c_str());
    const std::string parts =
        fmt::format(", last {:.2f} + {:.2f} + {:.2f}", last.build_ms, last.solve_ms, last.write_ms);
    const bool split = player.cairn() && !player.played().recorded() && width > 300;
    ImGui::Text("solver %.2f ms%s", player.MeanSolverTime(), split ? parts.c_str() : "");
  }
  if (const cli::FrameWorld* const recorded = player.played().recorded()) {
    const Recording& frame = recorded->problem().frame;
    ImGui::Text("frame %lld, %zu rows\nof %s", static_cast<long long>(frame.frame),
                recorded->problem().rows.rows.size(), frame.source.c_str());
  }
  if (!player.failure().empty()) ImGui::Text("stopped: %s", player.failure().c_str());
  if (facts.side == side) {
    ImGui::Separator();
    ImGui::TextUnformatted(DescribeIsland(&player, facts.body).c_str());
  }
  ImGui::PopTextWrapPos();
  ImGui::End();
}

Requests Panels::Draw(Session* session, const Facts& facts, int width, int height) {
  requests_ = {};
  widgets_.clear();
  fields_.clear();
  for (Field& field : Fields(&session->controls())) fields_.emplace(field.name, field);
  const std::vector<Area> areas = Areas(session->controls(), width, height);
  for (int side = 0; side < std::min(session->worlds(), session->controls().worlds); ++side) {
    DrawLabel(session, side, facts, areas[side], height);
  }
  if (!ArePanelsShown(session->controls(), width, height)) return requests_;
  DrawPlots(*session, width, height);
  DrawSidebar(session, facts, height);
  return requests_;
}

}  // namespace cairn::play
