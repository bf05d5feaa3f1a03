// SPDX-License-Identifier: MIT
#include "cairn/contact_problem.h"
#include "problem/contact_expansion.h"

namespace cairn {

std::size_t AllRows(const ContactProblem& problem) {
  std::size_t rows = problem.rows.size();
  for (const Joint& joint : problem.joints) rows += joint.rows;
  for (const Manifold& manifold : problem.manifolds) rows += manifold.rows();
  return rows;
}

std::vector<double> AllImpulses(const ContactProblem& problem, const Impulses& impulses) {
  // A point that hardly slides may slide another way in floats than in doubles: impulses are along
  // the directions that those are measured along, whatever directions they were found along.
  ContactExpansion expansion(problem, impulses);
  return {expansion.impulses().begin(), expansion.impulses().end()};
}

}  // namespace cairn
