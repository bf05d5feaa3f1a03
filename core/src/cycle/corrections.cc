// SPDX-License-Identifier: MIT
#include "cycle/corrections.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

#include "cairn/detail/eigen.h"
#include "cycle/end_velocity.h"
#include "problem/joint_errors.h"

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
    return SumOf(joint, row, [this](int body, const Vector3d& linear, const Vector3d& angular) {
      return Along(body, linear, angular);
    });
  }

  /// What of the free motion of the bodies a row of a joint does not work against.
  double Left(const Joint& joint, const JointRow& row) const {
    if (joint.damping == 1 || problem_.motions.empty()) return 0;
    const double free =
        SumOf(joint, row, [this](int body, const Vector3d& linear, const Vector3d& angular) {
          if (body == kWorld) return 0.0;
          const ContactMotion& motion = problem_.motions[body];
          return linear.dot(FromFloats(motion.free_velocity)) +
                 angular.dot(FromFloats(motion.free_spin));
        });
    return (1 - static_cast<double>(joint.damping)) * free;
  }

 private:
  template <class Function>
  static double SumOf(const Joint& joint, const JointRow& row, const Function& of_body) {
    const Vector3d linear_a = FromFloats(row.linear_a);
    const Vector3d linear_b = joint.opposite ? Vector3d(-linear_a) : FromFloats(row.linear_b);
    return of_body(joint.body_a, linear_a, FromFloats(row.angular_a)) +
           of_body(joint.body_b, linear_b, FromFloats(row.angular_b));
  }

  const ContactProblem& problem_;
  std::span<const Velocity> velocities_;
};

/// What a row does of what it was asked for: @p moves is its velocity.
Correction CorrectionOf(double target, double moves) {
  const double asked = std::abs(target);
  return {.asked = asked, .done = std::clamp(target < 0 ? -moves : moves, 0.0, asked)};
}

/// A point that is asked for more than others.
struct Deepest {
  float bias = 0;
  const Manifold* manifold = nullptr;
  const ContactPoint* point = nullptr;

  /// Of equals the first stays.
  void See(const Deepest& other) {
    if (other.bias > bias) *this = other;
  }
};

Deepest DeepestOf(const ContactProblem& problem, int first, int count) {
  Deepest deepest;
  for (const Manifold& manifold : problem.manifolds.subspan(first, count)) {
    for (int i = 0; i < manifold.points; ++i) {
      const ContactPoint& point = problem.points[manifold.first_point + i];
      if ((manifold.speeds >> i & 1) == 0) deepest.See({point.bias, &manifold, &point});
    }
  }
  return deepest;
}

Correction OfContacts(const ContactProblem& problem, const Motion& motion,
                      detail::Threads* threads) {
  constexpr int kManifoldsOfPart = 512, kMostParts = 64;
  const int manifolds = static_cast<int>(problem.manifolds.size());
  const int of_part = std::max(kManifoldsOfPart, (manifolds + kMostParts - 1) / kMostParts);
  std::array<Deepest, kMostParts> parts;
  threads->For(
      manifolds, of_part,
      [&](int first, int count) { parts[first / of_part] = DeepestOf(problem, first, count); },
      {SpanKind::kResults});
  Deepest deepest;
  for (const Deepest& part : parts) deepest.See(part);
  if (deepest.point == nullptr) return {};
  return CorrectionOf(deepest.bias, motion.Along(*deepest.manifold, *deepest.point));
}

/// Of rows that only turn, or of the others.
Correction OfJoints(const ContactProblem& problem, const Motion& motion, bool turns) {
  const Joint* worst = nullptr;
  const JointRow* furthest = nullptr;
  float error = 0;
  for (const Joint& joint : problem.joints) {
    for (int i = 0; i < joint.rows; ++i) {
      const float of_row = ErrorOf(problem, joint, i);
      if (joint.is_angular(i) != turns || !(std::abs(of_row) > std::abs(error))) continue;
      error = of_row;
      worst = &joint;
      furthest = &problem.joint_rows[joint.first_row + i];
    }
  }
  if (worst == nullptr) return {};
  // the rest of its target is no error
  const double other =
      static_cast<double>(furthest->target - error) + motion.Left(*worst, *furthest);
  return CorrectionOf(error, motion.Along(*worst, *furthest) - other);
}

}  // namespace

void TellCorrections(const ContactProblem& problem, std::span<const Velocity> velocities,
                     detail::Threads* threads, Report* report) {
  const Motion motion(problem, velocities);
  report->depth = OfContacts(problem, motion, threads);
  report->gap = OfJoints(problem, motion, false);
  report->angle = OfJoints(problem, motion, true);
}

}  // namespace cairn
