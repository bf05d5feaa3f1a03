// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "contestants/contestant.h"

namespace cairn::cli {

enum class Maker { kBullet, kCairn };
/// How a solver is told how much to do.
enum class Control {
  kIterations,  ///< By a number of iterations.
  kClock,       ///< By a budget of time, if there is one.
  kNone,        ///< It ends when it is done.
};

/// A solver that the tool knows. A new one is one class and one line in solver_registry.cc.
struct SolverEntry {
  std::string name, description;
  Maker maker;
  Control control;
  std::unique_ptr<Contestant> (*make)();
  /// Parts that the world takes a time step in, collisions found anew in each. With more than one
  /// there is no error of a substep: nobody else is asked the same.
  int parts = 1;
};

std::span<const SolverEntry> Solvers();

/// How many iterations a solver makes.
struct IterationRule {
  enum class Kind {
    kDefault,  ///< Bullet's default of 10.
    kFixed,
    kFit,  ///< As many as fit the budget, adapted from frame to frame.
  };
  Kind kind = Kind::kDefault;
  int count = 10;

  friend bool operator==(const IterationRule&, const IterationRule&) = default;
};

/// "10" or "fit". @throws Failure (kUsage); `option` is named in the message.
IterationRule ParseIterations(std::string_view option, std::string_view text);

/// A solver of a run: "bullet-si" or, with iterations of its own, "bullet-si@50".
struct SolverChoice {
  const SolverEntry* entry;
  std::optional<IterationRule> own_iterations;
  std::string label;
  int threads = 1;  ///< That it may use, if it has threads.

  std::unique_ptr<Contestant> Make() const {
    std::unique_ptr<Contestant> contestant = entry->make();
    contestant->AllowThreads(threads);
    return contestant;
  }
  /// One that is compared with others on the same states: contacts of any age, and directions of
  /// friction, are what the settings of the world say, so that all are asked the same.
  std::unique_ptr<Contestant> MakeForSameStates() const {
    std::unique_ptr<Contestant> contestant = Make();
    if (contestant->cairn() == nullptr) return contestant;
    bullet::Options& options = contestant->cairn()->options();
    options.resting_slop = options.two_friction_directions = false;
    return contestant;
  }
};

/// Solvers of a list of names with commas. @throws Failure (kUsage)
std::vector<SolverChoice> ParseSolvers(std::string_view list);

}  // namespace cairn::cli
