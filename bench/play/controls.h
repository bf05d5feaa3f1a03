// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace cairn::play {

/// Where the budget of a solver with a clock comes from.
inline constexpr std::string_view kNoBudget = "none";  ///< Iterations decide.
inline constexpr std::string_view kFixed = "fixed";    ///< PlayerControls::budget_ms.
inline constexpr std::string_view kMatch = "match";    ///< What the other world's solver takes.
inline constexpr std::string_view kRest = "rest";      ///< What a picture has left.

/// What one world is solved with. May change at any time.
struct PlayerControls {
  std::string solver = "cairn";  ///< As in `cairn list solvers`.
  int iterations = 10;
  std::string budget{kNoBudget};
  double budget_ms = 2;
  int threads = 1;
  bool steps = true;         ///< Subspace steps, Settings::steps.
  bool acceleration = true;  ///< Acceleration::kNncg.
  friend bool operator==(const PlayerControls&, const PlayerControls&) = default;
};

/// Which world. A change takes effect with a restart.
struct SceneControls {
  /// A scene of `cairn list scenes`, "random" for the random world `seed`, or a file: *.bullet, a
  /// world that Bullet saved, or *.cairn, a recording.
  std::string scene = "castle";
  int size = 0;  ///< 0: the default of the scene.
  int seed = 0;
  friend bool operator==(const SceneControls&, const SceneControls&) = default;
};

/// Everything that a person can set.
struct Controls {
  SceneControls scene;
  int worlds = 2;  ///< 1: the left one only.
  std::array<PlayerControls, 2> players = {PlayerControls{.solver = "bullet-si"}, PlayerControls{}};
  double rate = 60;  ///< Steps a second [Hz]. Random worlds have their own.
  int substeps = 1;  ///< Parts that Bullet takes a step in.
  bool sleep = false;
  bool paused = false;
  double speed = 1;                        ///< 0.1 is slow motion.
  bool measure = true;                     ///< Residuals, which cost about a sweep.
  double ball_mass = 60, ball_speed = 25;  ///< [kg], [m/s]
  bool contacts = false, joints = false, shadows = true, smooth = true, panels = true;
  bool interpolate = true;        ///< Draws between steps.
  std::string colours = "stone";  ///< "stone" or "islands".
};

/// One of the controls by name, "right.budget_ms" say.
struct Field {
  std::string name;
  std::variant<int*, double*, bool*, std::string*> value;
  double least = 0, most = 0;                ///< Of numbers.
  std::vector<std::string_view> words = {};  ///< Of texts: those that are allowed; none: any.
};

/// All of them, in the order of the panels. Pointers are into `controls`.
std::vector<Field> Fields(Controls* controls);

/// @throws cli::Failure (kUsage) that names the field, the value and its range
void Set(const Field& field, std::string_view text);

/// As commands and panels name them.
struct Preset {
  std::string_view name, title;
  PlayerControls player;
};
std::span<const Preset> Presets();

/// Puts a preset into a side, 0 or 1. "Cairn in Bullet's time" needs a Bullet beside it, and gets
/// one. @throws cli::Failure (kUsage) for an unknown name
void UsePreset(std::string_view name, int side, Controls* controls);

}  // namespace cairn::play
