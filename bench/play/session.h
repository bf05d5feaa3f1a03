// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "play/player.h"

namespace cairn::play {

/// One world or two in step, with controls that may change at any time: what the window shows,
/// without the window.
/// Where nothing is dragged or shot and no clock decides, a world has the bits of `cairn run`.
class Session {
 public:
  /// @throws cli::Failure for a scene, size or file that is not there
  explicit Session(const Controls& controls);

  /// Changes count from the next Step() on, those of the scene from the next Restart() on.
  Controls& controls() { return controls_; }
  const Controls& controls() const { return controls_; }

  /// One step of each world, paused or not.
  void Step();
  /// Builds the worlds anew. @return whether those of another scene
  /// @throws cli::Failure as above; then all stays as it was
  bool Restart();
  /// Hands over the controls without a step.
  void Apply();

  /// A ball into each world.
  void Shoot(const btVector3& from, const btVector3& direction);
  /// The same body in each world; see Player::Grab().
  void Grab(int body, const btVector3& at);
  void Move(const btVector3& to);
  void Release();
  /// FILE of each world: "NAME-left.cairn" and "NAME-right.cairn" where there are two.
  void Save(const std::string& path);

  int worlds() const { return static_cast<int>(players_.size()); }
  Player& player(int side) { return *players_[side]; }
  const Player& player(int side) const { return *players_[side]; }
  /// Changes when worlds have gone or come.
  int built() const { return generation_; }
  int frame() const { return players_.front()->frame(); }
  /// What a picture has left for the solver of each step: the budget of kRest.
  void SetRest(std::chrono::nanoseconds rest) { rest_ = rest; }

 private:
  std::optional<std::chrono::nanoseconds> BudgetOf(int side) const;

  Controls controls_;
  SceneControls built_;
  int generation_ = 0;
  std::vector<std::unique_ptr<Player>> players_;
  std::chrono::nanoseconds rest_ = std::chrono::milliseconds(8);
};

}  // namespace cairn::play
