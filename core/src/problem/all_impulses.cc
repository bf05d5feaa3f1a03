// SPDX-License-Identifier: MIT
#include "cairn/contact_problem.h"

namespace cairn {

std::size_t AllRows(const ContactProblem& problem) {
  std::size_t rows = problem.rows.size();
  for (const Joint& joint : problem.joints) rows += joint.rows;
  for (const Manifold& manifold : problem.manifolds) rows += manifold.rows();
  return rows;
}

std::vector<double> AllImpulses(const ContactProblem& problem, const Impulses& impulses) {
  std::vector<double> all(impulses.rows.begin(), impulses.rows.end());
  all.reserve(AllRows(problem));
  for (const Joint& joint : problem.joints) {
    const auto rows = impulses.joint_rows.subspan(joint.first_row, joint.rows);
    all.insert(all.end(), rows.begin(), rows.end());
  }
  for (const Manifold& manifold : problem.manifolds) {
    const auto points = impulses.points.subspan(manifold.first_point, manifold.points);
    for (const ContactImpulse& point : points) all.push_back(point.normal);
    for (const ContactImpulse& point : points) {
      all.insert(all.end(), point.tangential, point.tangential + manifold.tangents);
    }
    if (!manifold.twists) continue;
    for (const TwistImpulse& twist :
         impulses.twists.subspan(manifold.first_point, manifold.points)) {
      all.insert(all.end(), {twist.spinning, twist.rolling[0], twist.rolling[1]});
    }
  }
  return all;
}

}  // namespace cairn
