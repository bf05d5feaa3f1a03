// SPDX-License-Identifier: MIT
// The solver without an engine: one contact with friction, solved within a budget.

// [program]
#include <cairn/solver.h>

#include <array>
#include <chrono>
#include <cstdio>

int main() {
  // A ball of 2 kg and radius 0.1 m lands at 3 m/s forwards (x) and 4 m/s down (y).
  cairn::Body ball;
  ball.inv_mass = 1 / 2.0;
  const double turns = 1 / (0.4 * 2.0 * 0.1 * 0.1);
  ball.inv_inertia = cairn::Matrix3::Diagonal(turns, turns, turns);
  ball.velocity.linear = {3, -4, 0};

  // One contact with the ground: a row that only pushes, and a friction row bounded by it.
  // It is 0.1 m below the centre: r = (0, -0.1, 0), and what turns is r x n.
  const cairn::Row normal{.body_a = 0, .linear_a = {0, 1, 0}, .lo = 0};
  const cairn::Row friction{
      .body_a = 0, .linear_a = {1, 0, 0}, .angular_a = {0, 0, 0.1}, .parent = 0, .friction = 0.5};

  const std::array bodies{ball};
  const std::array rows{normal, friction};
  std::array<double, 2> impulses{};  // zeros, or those of the last frame
  std::array<cairn::Velocity, 1> velocities;

  cairn::Solver solver({.budget = cairn::Budget::Time(std::chrono::milliseconds(1))});
  const cairn::Report report = solver.Solve({bodies, rows}, impulses, velocities);
  if (!report.ok()) return 1;

  const cairn::Vector3& v = velocities[0].linear;
  std::printf("impulses %.3f and %.3f N s, rolls at %.3f m/s, residual %.0e m/s\n", impulses[0],
              impulses[1], v.x(), report.residual_max);
}
// [/program]
