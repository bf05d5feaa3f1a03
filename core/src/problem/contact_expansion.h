// SPDX-License-Identifier: MIT
#pragma once

#include <span>

#include "cairn/contact_problem.h"
#include "cairn/detail/eigen.h"
#include "cairn/detail/memory.h"

namespace cairn {

/// A problem with the rows of its joints and manifolds written out, in double precision: the
/// specification of simd/rows/joint_rows and simd/rows/contact_rows, and what is solved where those
/// do not do.
class ContactExpansion {
 public:
  /// The bodies of @p problem are referred to.
  /// @pre the problem is valid, but for its rows
  ContactExpansion(const ContactProblem& problem, const Impulses& start);

  ContactProblem problem() const { return {.bodies = bodies_, .rows = rows_, .motions = motions_}; }
  std::span<double> impulses() { return impulses_; }
  /// Writes impulses() to where they belong.
  void Write(const Impulses& impulses) const;

 private:
  struct Point;
  struct Directions {
    Eigen::Vector3d normal, t1;
  };
  void Add(const Joint& joint, const ContactProblem& problem, const Impulses& start);
  void Add(const Manifold& manifold, const ContactProblem& problem, const Impulses& start);
  void AddTwists(const Manifold& manifold, const ContactProblem& problem,
                 std::span<const TwistImpulse> start, int first);
  Point Aim(const Manifold& manifold, const ContactPoint& point,
            const ContactProblem& problem) const;

  std::span<const Body> bodies_;
  std::span<const ContactMotion> motions_;
  Array<Row> rows_;
  Array<double> impulses_;
  size_t given_ = 0;  ///< rows of the problem itself; those that are written out come behind
  Array<Joint> joints_;
  Array<Manifold> manifolds_;
  Array<Directions> directions_;  ///< of their points, one after the other
};

}  // namespace cairn
