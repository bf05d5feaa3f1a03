// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "cairn/contact_problem.h"
#include "cairn/detail/memory.h"
#include "cairn/detail/threads.h"
#include "cairn/report.h"

namespace cairn {

/// Says how fast the bodies of each island are after a step, and for how long they have been quiet.
/// A body that was not in the last frame starts anew: by its id, or where it has none its place.
class QuietBodies {
 public:
  /// What is quiet is slower.
  struct Speeds {
    double linear, angular;
  };
  /// Makes room for so many bodies: Tell() allocates nothing.
  void Reserve(std::size_t bodies);
  /// @param means  that bodies move by, where those are others, which are to be quiet, too; or none
  /// @param threads  that help, if they are here
  /// @pre room is reserved, the report is that of the problem, solved; velocities are those that it
  /// ends with
  void Tell(const ContactProblem& problem, std::span<const Velocity> velocities,
            std::span<const Velocity> means, const Speeds& speeds, detail::Threads* threads,
            Report* report);
  void Forget() {
    counts_.clear();
    known_ = 0;
  }

 private:
  struct Count {
    std::uint64_t id = 0;
    double inv_mass = 0;  ///< tells bodies apart that have no names
    int solves = 0;
  };

  /// Bodies of an island that follow each other.
  struct Run {
    int island;
    double linear2, angular2;  ///< of the fastest
    int solves;                ///< of the least quiet
  };
  /// Bodies with names are where others were in the last frame.
  bool AnyMoved(const ContactProblem& problem, detail::Threads* threads);
  /// Puts what is known of bodies with names where they are now.
  void Follow(std::span<const Body> bodies);
  /// Those of a part of the bodies into runs_, from the number of its first body on. Returns how
  /// many.
  int LookAt(const ContactProblem& problem, std::span<const Velocity> velocities,
             std::span<const Velocity> means, const Speeds& speeds, std::span<const int> island_of,
             int first, int count);

  Array<Count> counts_;    ///< by body, and room for more
  std::size_t known_ = 0;  ///< so many were in the last frame
  Array<Count> by_id_;     ///< of the last frame, while bodies move
  Array<Run> runs_;
  Array<int> runs_of_;  ///< a part: so many
};

}  // namespace cairn
