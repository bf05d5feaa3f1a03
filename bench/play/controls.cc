// SPDX-License-Identifier: MIT
#include "play/controls.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "contestants/solver_registry.h"
#include "support/command_line.h"
#include "support/failure.h"
#include "support/names.h"

namespace cairn::play {
namespace {

using cli::Failure;
using cli::kUsage;

constexpr int kMostIterations = 10'000;

void AddSide(const std::string& side, PlayerControls* player, std::vector<Field>* fields) {
  std::vector<std::string_view> solvers;
  for (const cli::SolverEntry& entry : cli::Solvers()) solvers.push_back(entry.name);
  fields->insert(fields->end(),
                 {{side + ".solver", &player->solver, 0, 0, solvers},
                  {side + ".iterations", &player->iterations, 1, kMostIterations},
                  {side + ".budget", &player->budget, 0, 0, {kNoBudget, kFixed, kMatch, kRest}},
                  {side + ".budget_ms", &player->budget_ms, 0.01, 1000},
                  {side + ".threads", &player->threads, 1, 64},
                  {side + ".steps", &player->steps},
                  {side + ".acceleration", &player->acceleration}});
}

struct Setter {
  const Field& field;
  std::string_view text;

  void operator()(int* value) const {
    *value = cli::ParseInt(field.name, text, static_cast<long long>(field.least),
                           static_cast<long long>(field.most), "a whole number");
  }
  void operator()(double* value) const {
    *value = cli::ParseNumber(field.name, text, field.least, field.most, "a number");
  }
  void operator()(bool* value) const {
    if (text != "on" && text != "off") {
      throw Failure(kUsage, fmt::format("{} '{}': write on or off", field.name, text));
    }
    *value = text == "on";
  }
  void operator()(std::string* value) const {
    const auto& words = field.words;
    if (!words.empty() && std::find(words.begin(), words.end(), text) == words.end()) {
      throw Failure(kUsage, fmt::format("{} '{}': write one of {}", field.name, text,
                                        fmt::join(words, ", ")));
    }
    *value = text;
  }
};

}  // namespace

std::vector<Field> Fields(Controls* controls) {
  Controls& c = *controls;
  std::vector<Field> fields = {{"scene", &c.scene.scene},
                               {"size", &c.scene.size, 0, 100'000},
                               {"seed", &c.scene.seed, 0, 1'000'000'000},
                               {"worlds", &c.worlds, 1, 2},
                               {"rate", &c.rate, 10, 1000},
                               {"substeps", &c.substeps, 1, 16},
                               {"sleep", &c.sleep},
                               {"paused", &c.paused},
                               {"speed", &c.speed, 0.01, 4},
                               {"measure", &c.measure},
                               {"ball_mass", &c.ball_mass, 0.1, 10'000},
                               {"ball_speed", &c.ball_speed, 0, 200},
                               {"contacts", &c.contacts},
                               {"joints", &c.joints},
                               {"shadows", &c.shadows},
                               {"smooth", &c.smooth},
                               {"panels", &c.panels},
                               {"interpolate", &c.interpolate},
                               {"colours", &c.colours, 0, 0, {"stone", "islands"}}};
  AddSide("left", &c.players[0], &fields);
  AddSide("right", &c.players[1], &fields);
  return fields;
}

void Set(const Field& field, std::string_view text) {
  std::visit(Setter{field, text}, field.value);
}

std::span<const Preset> Presets() {
  static const std::vector<Preset> presets = {
      {"bullet", "Bullet as it comes", {.solver = "bullet-si"}},
      {"cairn", "Cairn as it comes", {}},
      {"match", "Cairn in Bullet's time", {.budget = std::string(kMatch)}},
      {"2ms", "2 ms", {.budget = std::string(kFixed), .budget_ms = 2}}};
  return presets;
}

void UsePreset(std::string_view name, int side, Controls* controls) {
  std::vector<std::string> names;
  for (const Preset& preset : Presets()) names.emplace_back(preset.name);
  const size_t index =
      cli::FindName("preset", name, names, fmt::format("presets are {}", fmt::join(names, ", ")));
  const Preset& preset = Presets()[index];
  controls->players[side] = preset.player;
  if (preset.player.budget != kMatch) return;
  controls->worlds = 2;
  PlayerControls& other = controls->players[1 - side];
  if (!other.solver.starts_with("bullet")) other = Presets()[0].player;
}

}  // namespace cairn::play
