// SPDX-License-Identifier: MIT
// A game loop without a window or a clock of its own: to be copied. `cairn play` runs by it.
#pragma once

#include <algorithm>
#include <chrono>

namespace cairn::examples {

/// When to step and what a step may cost: fixed steps, pictures in between, and for the solvers
/// what a picture has left.
///
///     const FixedSteps::Plan plan = loop.Advance(passed, {.step = 1.0 / 60});
///     for (int i = 0; i < plan.steps; ++i) session.Step();
///     Draw(plan.share);
///     loop.Learn(time_without_solvers);
class FixedSteps {
 public:
  struct Pace {
    double step = 1.0 / 60;     ///< [s]
    double speed = 1;           ///< Simulated time per time.
    double picture = 1.0 / 60;  ///< A picture is to take [s].
  };
  struct Plan {
    int steps = 0;
    double share = 1;  ///< Draw this share of a step after the last but one.
    /// For the solver of each step and world.
    std::chrono::nanoseconds budget{0};
  };

  /// @param passed  since the last picture [s]; after a hitch the game slows down instead
  /// @param worlds  that share the time
  Plan Advance(double passed, const Pace& pace, int worlds) {
    unspent_ = std::min(unspent_ + passed * pace.speed, kMostSteps * pace.step);
    Plan plan;
    // a hair less than a step is one: rounding must not make pictures wait
    plan.steps = static_cast<int>(unspent_ / pace.step + 1e-9);
    unspent_ = std::max(0.0, unspent_ - plan.steps * pace.step);
    plan.share = unspent_ / pace.step;
    const double left = std::max(kLeast, kSafety * (pace.picture - rest_));
    plan.budget = std::chrono::nanoseconds(
        static_cast<std::int64_t>(1e9 * left / (std::max(1, plan.steps) * worlds)));
    return plan;
  }

  /// What the last picture took but for its solvers [s]: a mean that follows slowly.
  void Learn(double rest) { rest_ += kFollow * (rest - rest_); }

  static constexpr int kMostSteps = 4;

 private:
  static constexpr double kLeast = 0.0005;  // [s]
  static constexpr double kSafety = 0.9, kFollow = 0.1;

  double unspent_ = 0, rest_ = 0.004;
};

}  // namespace cairn::examples
