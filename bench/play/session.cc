// SPDX-License-Identifier: MIT
#include "play/session.h"

#include <algorithm>
#include <utility>

namespace cairn::play {
namespace {

constexpr std::chrono::microseconds kLeastMatch{20};

std::chrono::nanoseconds Nanoseconds(double ms) {
  return std::chrono::nanoseconds(static_cast<std::int64_t>(ms * 1e6));
}

}  // namespace

Session::Session(const Controls& controls) : controls_(controls) { Restart(); }

bool Session::Restart() {
  std::vector<std::unique_ptr<Player>> players;
  for (int side = 0; side < controls_.worlds; ++side) {
    players.push_back(std::make_unique<Player>(controls_, controls_.players[side]));
  }
  players_ = std::move(players);
  ++generation_;
  return std::exchange(built_, controls_.scene) != controls_.scene;
}

void Session::Apply() {
  if (controls_.worlds < worlds()) {
    players_.resize(controls_.worlds);
    ++generation_;
  }
  if (controls_.worlds > worlds()) {  // both begin together
    const SceneControls asked = std::exchange(controls_.scene, built_);
    Restart();
    controls_.scene = asked;
  }
  for (int side = 0; side < worlds(); ++side) {
    players_[side]->Apply(controls_, controls_.players[side]);
  }
}

std::optional<std::chrono::nanoseconds> Session::BudgetOf(int side) const {
  const PlayerControls& controls = controls_.players[side];
  if (controls.budget == kFixed) return Nanoseconds(controls.budget_ms);
  if (controls.budget == kRest) return rest_;
  if (controls.budget != kMatch || worlds() < 2) return {};
  const Player& other = *players_[1 - side];
  if (other.history().empty()) return {};
  return std::max<std::chrono::nanoseconds>(kLeastMatch, Nanoseconds(other.MeanSolverTime()));
}

void Session::Step() {
  Apply();
  for (int side = 0; side < worlds(); ++side) players_[side]->Step(BudgetOf(side));
}

void Session::Shoot(const btVector3& from, const btVector3& direction) {
  const btVector3 velocity = direction.normalized() * btScalar(controls_.ball_speed);
  for (const auto& player : players_) player->Shoot(from, velocity, controls_.ball_mass);
}

void Session::Grab(int body, const btVector3& at) {
  for (const auto& player : players_) player->Grab(body, at);
}

void Session::Move(const btVector3& to) {
  for (const auto& player : players_) player->Move(to);
}

void Session::Release() {
  for (const auto& player : players_) player->Release();
}

void Session::Save(const std::string& path) {
  Apply();  // of the solvers that make the next step
  const std::string stem = path.substr(0, path.size() - (path.ends_with(".cairn") ? 6 : 0));
  if (worlds() == 1) return players_[0]->SaveNext(stem + ".cairn");
  players_[0]->SaveNext(stem + "-left.cairn");
  players_[1]->SaveNext(stem + "-right.cairn");
}

}  // namespace cairn::play
