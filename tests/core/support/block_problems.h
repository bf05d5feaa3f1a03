// SPDX-License-Identifier: MIT
// Scenes for the block path of the solver, games of many frames, and what the tests of it share.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "plan/pairs.h"
#include "plan/plan.h"
#include "problems.h"
#include "tests/simd/ask_for.h"

namespace cairn::test {

/// Scenes side by side: bodies and rows of each stay in their order.
Scene Together(const std::vector<Scene>& scenes);
/// The same rows as Bullet orders them: first all without a parent, then all friction.
Scene NormalsFirst(const Scene& scene);
/// Bricks of 2 m x 1 m x 1 m in running bond, four contact points in each of their faces.
Scene Wall(int width, int height);
/// Boxes side by side on one plate, four contact points each.
Scene Plate(int boxes);
/// Boxes in contact in all directions. Made of sums, products, quotients and roots alone: the same
/// numbers with every compiler and mathematical library.
Scene Heap(const PileOptions& options, std::uint64_t seed);
/// Gives rows laws of every kind: soft ones, other step lengths, few sweeps, rolling friction that
/// is cut, bounds on both sides.
Scene WithEveryLaw(Scene scene, std::uint64_t seed);

/// What a body would answer along the axes that it is locked along [1/kg]: a row that does push it
/// makes steps of 1 / (d + this).
double DeniedByLocks(const Body& body, const Vector3& linear);

MovableBodies MovableOf(const Scene& scene);
/// @pre the scene is valid
std::vector<RowKind> KindsOf(const Scene& scene, double omega);
/// @pre the scene is valid
void MakePlan(const Scene& scene, double omega, Plan* plan);

/// So many sweeps on blocks, without steps or a look at the residual.
Settings Coloured(int sweeps);
/// The same with steps wherever they may be taken.
Settings ColouredSteps(int sweeps);

/// One frame of a Game.
struct Frame {
  Scene scene;
  std::vector<double> start;  ///< warm start
  std::vector<int> rows;      ///< of the whole scene, for each row
};

/// A scene whose contacts begin and end, with velocities and impulses from frame to frame.
class Game {
 public:
  explicit Game(Scene whole) : whole_(std::move(whole)), impulses_(whole_.rows.size(), 0.0) {}

  Frame Next();
  void Take(const Frame& frame, const Solution& solution);

 private:
  bool Lives(int row) const;

  Scene whole_;
  std::vector<double> impulses_;  ///< last ones, 0 for what has ended
  int frame_ = 0;
};

/// So many frames of the game of that scene.
std::vector<Solution> Play(const Settings& settings, const Scene& whole, int frames);

/// FNV-1a of all impulses and velocities.
std::uint64_t HashOf(std::span<const Solution> solutions);
testing::AssertionResult SameBits(std::span<const Solution> a, std::span<const Solution> b);

}  // namespace cairn::test
