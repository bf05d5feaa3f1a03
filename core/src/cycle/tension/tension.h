// SPDX-License-Identifier: MIT
#pragma once

#include "cairn/contact_problem.h"
#include "cairn/detail/stiffness.h"
#include "cairn/settings.h"

namespace cairn {

/// Geometric stiffness around the solves of a Solver: what Settings::geometric_stiffness asks for.
class Tension {
 public:
  /// The problem, with the inertia of its bodies raised where their joints pulled too hard before,
  /// and with rows of Joint::errors that ask for less there; as it is where nothing did. It need
  /// not be valid. Valid until the next call.
  ContactProblem Stiffen(const ContactProblem& problem, const Settings& settings);
  /// Remembers what joints pull with in a problem that Stiffen() was asked about, as solved. Where
  /// there is no memory for that, all is forgotten.
  void Learn(const ContactProblem& problem, const Impulses& impulses, const Settings& settings,
             const Report& report);
  void Forget() { stiffness_.Reset(); }

 private:
  /// Into joint_rows_, if any joint is that strained.
  void TakeBackLess(ContactProblem* problem);

  GeometricStiffness stiffness_;
  Array<Body> bodies_;
  Array<JointRow> joint_rows_;
  Array<float> joint_errors_;
  bool acts_ = false;
};

}  // namespace cairn
