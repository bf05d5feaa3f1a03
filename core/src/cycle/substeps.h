// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Geometry>
#include <span>

#include "cairn/contact_problem.h"
#include "cairn/detail/memory.h"

namespace cairn {

/// A time step in parts: the problem of each, made of that of the whole and of what its bodies did
/// in the parts before.
///
///     for (substeps.Begin(problem, start, n); !substeps.done(); substeps.Advance()) {
///       solve substeps.problem() into substeps.impulses() and substeps.velocities()
///       if asked and substeps.HasErrors(): substeps.Relax(), and solve again
///     }
///     substeps.Write(impulses, velocities);
///
/// External impulses, bounds of impulses and compliances are those of an nth of the step. A row
/// asks for a velocity, which moves its bodies some distance in the whole step. What they are
/// behind or ahead of that after some parts is carried to the target of the next, to first order.
/// Three rows of a joint that hold a point do better: their arms turn with the bodies, and what
/// they are behind is measured. A gap is shared out to nobody: it is closed when it is used up, and
/// bounces where it is.
class Substeps {
 public:
  /// @pre the problem is valid, and outlives the parts; parts >= 1
  void Begin(const ContactProblem& problem, const Impulses& start, int parts);
  bool done() const { return part_ == parts_; }
  /// Of parts that are not done, this one included.
  int left() const { return parts_ - part_; }
  /// The problem of the part, its start and where it ends.
  ContactProblem problem() const;
  Impulses impulses() { return {rows_x_, points_x_, twists_x_, joints_x_}; }
  std::span<Velocity> velocities() { return velocities_; }
  /// Some row of the part takes back an error of position, faster than @p least [m/s] or [rad/s].
  bool HasErrors(double least) const;
  /// Of a part that is solved: bodies move as that says. From here on its problem asks for nothing
  /// that takes back errors, and starts from what came of it.
  void Relax();
  /// Takes up what came of the part, and goes on to the next.
  void Advance();
  /// The sum of all impulses, and velocities in the end.
  void Write(const Impulses& impulses, std::span<Velocity> velocities) const;
  /// By body: what velocities were on average.
  std::span<const Velocity> means() const { return means_; }

 private:
  /// How a body moved so far, in velocities: displacements over the length of the step.
  struct Travel {
    Velocity start;   ///< of the step, as rows of joints and contacts see it
    Velocity pushed;  ///< by external impulses over the step
    Velocity now;     ///< when the part begins
    Velocity total;   ///< displacement since the step began
    Eigen::Quaterniond turn = Eigen::Quaterniond::Identity();  ///< since the step began
    Eigen::Matrix3d turned = Eigen::Matrix3d::Identity();      ///< the same
  };
  /// Three rows of a joint that hold a point, with its arms.
  struct Held {
    int joint, row;
    Eigen::Vector3d arm_a, arm_b;
  };

  void Start(const Impulses& start);
  /// Its bias takes back depth.
  bool IsDepth(const Manifold& manifold, int point) const;
  void FindHeld();
  void MoveBodies();
  void MoveMotions();
  void Turn(const Eigen::Vector3d& spin, Travel* travel) const;
  /// What turns a body at once as the parts of the step did.
  Eigen::Vector3d MeanSpin(const Travel& travel) const;
  void Add();
  void AimRows();
  void AimJoints();
  void AimHeld(const Held& held);
  void AimPoints();
  /// Targets of the part, of a row with a target of the whole step that has travelled so far.
  double AimBoth(double target, double travelled) const;
  double AimOne(double target, double travelled) const;
  template <class AnyRow>
  double Along(const AnyRow& row, int body_a, int body_b, Velocity Travel::*what) const;
  double share() const { return 1.0 / parts_; }

  ContactProblem whole_;
  int parts_ = 1, part_ = 1;
  Array<Body> bodies_;
  Array<Row> rows_;
  Array<ContactPoint> points_;
  Array<ContactMotion> motions_;
  Array<ContactTwist> twists_;
  Array<JointRow> joint_rows_;
  Array<float> joint_errors_;
  Array<double> rows_x_, rows_sum_;
  Array<ContactImpulse> points_x_, points_sum_;  ///< of sums: direction is a push [N s]
  Array<TwistImpulse> twists_x_, twists_sum_;
  Array<float> joints_x_, joints_sum_;
  Array<Velocity> velocities_, means_;
  Array<Velocity> moves_;  ///< of the part, if it was relaxed
  bool relaxed_ = false;
  Array<Travel> travels_;
  Array<Held> held_;
  Array<char> is_held_;  ///< by row of a joint
};

}  // namespace cairn
