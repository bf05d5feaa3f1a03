// SPDX-License-Identifier: MIT
#pragma once
#include "cairn/detail/cpp20.h"

#include <cstddef>
#include <memory>
#include <span>

#include "cairn/contact_problem.h"
#include "cairn/memory.h"
#include "cairn/report.h"
#include "cairn/settings.h"

namespace cairn {

/// Projected Gauss-Seidel with subspace minimisation, after [1] (contact_problem.h);
/// docs/solver.md has our differences from the paper. Different solvers may run at the same time,
/// one may not. It keeps what it learnt about an island from frame to frame (see Body::id), never
/// the problem.
class Solver {
 public:
  /// @param memory  where all of it lies that is its own; nullptr: operator new
  explicit Solver(const Settings& settings = {}, Memory* memory = nullptr);
  ~Solver();
  Solver(Solver&&) noexcept;
  Solver& operator=(Solver&&) noexcept;

  Settings& settings();
  const Settings& settings() const;

  /// Solves one time step.
  /// @param[in,out] impulses  one per row, row of a joint, point and twist: the start (or zeros;
  ///                          brought inside the bounds first) and the result.
  /// @param[out] velocities   one per body: velocities at the end of the step.
  /// Bad input: the report says what and where (see Describe()), nothing is written.
  [[nodiscard]] Report Solve(const ContactProblem& problem, const Impulses& impulses,
                             std::span<Velocity> velocities);
  /// The same into a report of an earlier call, whose memory is used again. After a problem on
  /// Path::kFast one that is no larger is solved without allocating, but for a step on a new graph.
  void Solve(const ContactProblem& problem, const Impulses& impulses,
             std::span<Velocity> velocities, Report* report);
  /// A problem without joints and manifolds.
  [[nodiscard]] Report Solve(const ContactProblem& problem, std::span<double> impulses,
                             std::span<Velocity> velocities);
  void Solve(const ContactProblem& problem, std::span<double> impulses,
             std::span<Velocity> velocities, Report* report);

  std::span<const Velocity> mean_velocities() const;  ///< Move bodies, with substeps or relax.
  /// Forgets everything learnt in earlier frames: the next Solve() is that of a new solver.
  void Reset();
  /// Saves and loads: @p other knows of bodies and islands what this one does, and both find the
  /// order of their rows anew, so that from here on they give the same bits.
  void CopyStateTo(Solver* other);
  std::size_t bytes() const;       ///< Of the memory that it holds now; docs/engine.md, Memory.
  std::size_t most_bytes() const;  ///< Most that it ever held.
  detail::Threads& threads();  ///< For hosts that read and write their objects on the same ones.

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace cairn
