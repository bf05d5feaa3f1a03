// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "cairn/contact_problem.h"
#include "cairn/detail/memory.h"
#include "cairn/report.h"

namespace cairn {

/// Says how fast the bodies of each island are after a step, and for how long they have been quiet.
/// A body at another place than in the last frame, or of another name, starts anew.
class QuietBodies {
 public:
  /// Makes room for so many bodies: Tell() allocates nothing.
  void Reserve(std::size_t bodies);
  /// @param means  that bodies move by, where those are others, which are to be quiet, too; or none
  /// @param speed  Tuning::quiet_speed
  /// @pre room is reserved, the report is that of the problem, solved; velocities are those that it
  /// ends with
  void Tell(const ContactProblem& problem, std::span<const Velocity> velocities,
            std::span<const Velocity> means, double speed, Report* report);
  void Forget() { counts_.clear(); }

 private:
  struct Count {
    std::uint64_t id = 0;
    int solves = 0;
  };

  Array<Count> counts_;  ///< by body
};

}  // namespace cairn
