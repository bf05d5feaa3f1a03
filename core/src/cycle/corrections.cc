// SPDX-License-Identifier: MIT
#include "cycle/corrections.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "cairn/detail/eigen.h"
#include "cycle/end_velocity.h"

namespace cairn {
namespace {

using Eigen::Vector3d;

Vector3d FromFloats(const float* from) { return {from[0], from[1], from[2]}; }

/// How fast bodies of a problem move, and points of them.
class Motion {
 public:
  Motion(const ContactProblem& problem, std::span<const Velocity> velocities)
      : problem_(problem), velocities_(velocities) {}

  /// What a row does with the velocity of one body.
  double Along(int body, const Vector3d& linear, const Vector3d& angular) const {
    if (body == kWorld) return 0;
    const Velocity end = EndOf(problem_, velocities_, body);
    return linear.dot(View(end.linear)) + angular.dot(View(end.angular));
  }

  double Along(const Manifold& manifold, const ContactPoint& point) const {
    const Vector3d normal = FromFloats(point.normal);
    return Along(manifold.body_a, normal, FromFloats(point.arm_a).cross(normal)) -
           Along(manifold.body_b, normal, FromFloats(point.arm_b).cross(normal));
  }

  double Along(const Joint& joint, const JointRow& row) const {
    const Vector3d linear_a = FromFloats(row.linear_a);
    const Vector3d linear_b = joint.opposite ? Vector3d(-linear_a) : FromFloats(row.linear_b);
    return Along(joint.body_a, linear_a, FromFloats(row.angular_a)) +
           Along(joint.body_b, linear_b, FromFloats(row.angular_b));
  }

 private:
  const ContactProblem& problem_;
  std::span<const Velocity> velocities_;
};

/// What a row does of what it was asked for: @p moves is its velocity.
Correction CorrectionOf(double target, double moves) {
  const double asked = std::abs(target);
  return {.asked = asked, .done = std::clamp(target < 0 ? -moves : moves, 0.0, asked)};
}

Correction OfContacts(const ContactProblem& problem, const Motion& motion) {
  const Manifold* worst = nullptr;
  const ContactPoint* deepest = nullptr;
  float most = 0;
  for (const Manifold& manifold : problem.manifolds) {
    for (int i = 0; i < manifold.points; ++i) {
      const ContactPoint& point = problem.points[manifold.first_point + i];
      if (!(point.bias > most) || (manifold.speeds >> i & 1) != 0) continue;
      most = point.bias;
      worst = &manifold;
      deepest = &point;
    }
  }
  return worst == nullptr ? Correction() : CorrectionOf(most, motion.Along(*worst, *deepest));
}

/// Of rows that only turn, or of the others.
Correction OfJoints(const ContactProblem& problem, const Motion& motion, bool turns) {
  const Joint* worst = nullptr;
  const JointRow* furthest = nullptr;
  float most = 0;
  for (const Joint& joint : problem.joints) {
    const std::uint32_t wanted = joint.errors & (turns ? joint.angular : ~joint.angular);
    for (int i = 0; wanted != 0 && i < joint.rows; ++i) {
      const JointRow& row = problem.joint_rows[joint.first_row + i];
      if ((wanted >> i & 1) == 0 || !(std::abs(row.target) > most)) continue;
      most = std::abs(row.target);
      worst = &joint;
      furthest = &row;
    }
  }
  return worst == nullptr ? Correction()
                          : CorrectionOf(furthest->target, motion.Along(*worst, *furthest));
}

}  // namespace

void TellCorrections(const ContactProblem& problem, std::span<const Velocity> velocities,
                     Report* report) {
  const Motion motion(problem, velocities);
  report->depth = OfContacts(problem, motion);
  report->gap = OfJoints(problem, motion, false);
  report->angle = OfJoints(problem, motion, true);
}

}  // namespace cairn
