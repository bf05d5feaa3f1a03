// SPDX-License-Identifier: MIT
#include "problem/bad_field.h"

#include <cmath>
#include <span>

#include "problem/joint_errors.h"

namespace cairn {
namespace {

/// The first field that is looked at and is not as it must be.
class FieldSearch {
 public:
  explicit FieldSearch(Status status) : status_(status) {}

  void Finite(const char* name, double value) {
    if (status_ == Status::kNotFinite) Holds(std::isfinite(value), name, value, "finite");
  }
  template <class Numbers>
  void AllFinite(const char* name, const Numbers& numbers) {
    for (const double value : numbers) Finite(name, value);
  }
  void AllFinite(const char* name, const Vector3& vector) {
    for (int k = 0; k < 3; ++k) Finite(name, vector[k]);
  }
  void IsNumber(const char* name, double value) {
    if (status_ == Status::kNotFinite) Holds(!std::isnan(value), name, value, "a number");
  }
  void AtLeastZero(Status status, const char* name, double value) {
    if (status_ == status) Holds(value >= 0, name, value, "0 or more");
  }
  void Bounds(double lo, double hi) {
    if (status_ != Status::kBadBounds) return;
    Holds(lo < kInfinity, "lo", lo, "below infinity");
    Holds(hi > -kInfinity, "hi", hi, "above -infinity");
    Holds(lo <= hi, "lo", lo, "at most hi");
  }
  void Bodies(const ContactProblem& problem, int a, int b) {
    if (status_ != Status::kNoSuchBody) return;
    const int bodies = static_cast<int>(problem.bodies.size());
    const char* const range = "kWorld or below problem.bodies.size()";
    Holds(a >= kWorld && a < bodies, "body_a", a, range);
    Holds(b >= kWorld && b < bodies, "body_b", b, range);
    Holds(a != b, "body_b", b, "another than body_a");
  }
  void Holds(bool holds, const char* name, double value, const char* range) {
    if (bad_.name == nullptr && !holds) bad_ = {name, value, range};
  }
  Status status() const { return status_; }
  const BadSetting& found() const { return bad_; }

 private:
  Status status_;
  BadSetting bad_;
};

}  // namespace

BadSetting FindBadFieldOfBody(const ContactProblem& problem, int body, Status status) {
  FieldSearch search(status);
  const Body& of = problem.bodies[body];
  search.Finite("inv_mass", of.inv_mass);
  for (int k = 0; k < 9; ++k) search.Finite("inv_inertia", of.inv_inertia(k / 3, k % 3));
  search.AllFinite("linear_factor", of.linear_factor);
  search.AllFinite("velocity.linear", of.velocity.linear);
  search.AllFinite("velocity.angular", of.velocity.angular);
  search.AllFinite("impulse", of.impulse);
  search.AllFinite("angular_impulse", of.angular_impulse);
  if (!problem.motions.empty()) {
    const ContactMotion& motion = problem.motions[body];
    search.AllFinite("motions.free_velocity", motion.free_velocity);
    search.AllFinite("motions.free_spin", motion.free_spin);
    search.AllFinite("motions.start_velocity", motion.start_velocity);
    search.AllFinite("motions.start_spin", motion.start_spin);
  }
  search.AtLeastZero(Status::kBadMass, "inv_mass", of.inv_mass);
  for (int k = 0; k < 3; ++k) {
    search.AtLeastZero(Status::kBadMass, "linear_factor", of.linear_factor[k]);
  }
  for (int k = 0; k < 3; ++k) {
    search.AtLeastZero(Status::kBadMass, "the diagonal of inv_inertia", of.inv_inertia(k, k));
  }
  return search.found();
}

BadSetting FindBadFieldOfRow(const ContactProblem& problem, const Impulses& start, int row,
                             Status status) {
  FieldSearch search(status);
  const Row& of = problem.rows[row];
  search.Finite("its impulse at the start", start.rows[row]);
  search.AllFinite("linear_a", of.linear_a);
  search.AllFinite("angular_a", of.angular_a);
  search.AllFinite("linear_b", of.linear_b);
  search.AllFinite("angular_b", of.angular_b);
  search.Finite("target", of.target);
  search.Finite("compliance", of.compliance);
  search.Finite("friction", of.friction);
  search.Finite("relaxation", of.relaxation);
  search.IsNumber("lo", of.lo);
  search.IsNumber("hi", of.hi);
  search.Bodies(problem, of.body_a, of.body_b);
  search.Bounds(of.lo, of.hi);
  if (status == Status::kBadBounds) {
    search.Holds(of.lo <= 0, "lo of friction", of.lo, "0 or less");
    search.Holds(of.hi >= 0, "hi of friction", of.hi, "0 or more");
  }
  search.AtLeastZero(Status::kBadCompliance, "compliance", of.compliance);
  if (status == Status::kBadCompliance) {
    search.Holds(of.relaxation > 0 && of.relaxation < 2, "relaxation", of.relaxation,
                 "above 0 and below 2");
  }
  search.AtLeastZero(Status::kBadFriction, "friction", of.friction);
  if (status == Status::kBadParent) {
    search.Holds(false, "parent", of.parent,
                 "kNoRow or an earlier row of the same two bodies, which has none");
  }
  return search.found();
}

BadSetting FindBadFieldOfJoint(const ContactProblem& problem, const Impulses& start, int joint,
                               Status status) {
  FieldSearch search(status);
  const Joint& of = problem.joints[joint];
  search.Bodies(problem, of.body_a, of.body_b);
  search.Finite("damping", of.damping);
  for (int i = 0; i < of.rows && status != Status::kNoSuchBody; ++i) {
    const JointRow& row = problem.joint_rows[of.first_row + i];
    search.Finite("the impulse of a row at the start", start.joint_rows[of.first_row + i]);
    search.AllFinite("linear_a of a row", row.linear_a);
    search.AllFinite("angular_a of a row", row.angular_a);
    if (!of.opposite) search.AllFinite("linear_b of a row", row.linear_b);
    search.AllFinite("angular_b of a row", row.angular_b);
    search.Finite("target of a row", row.target);
    search.Finite("joint_errors of a row", ErrorOf(problem, of, i));
    if (of.soft) search.Finite("compliance of a row", row.compliance);
    if (of.soft) search.AtLeastZero(Status::kBadCompliance, "compliance of a row", row.compliance);
    if (!of.is_bounded(i)) continue;
    search.IsNumber("lo of a row", row.lo);
    search.IsNumber("hi of a row", row.hi);
    search.Bounds(row.lo, row.hi);
  }
  return search.found();
}

BadSetting FindBadFieldOfManifold(const ContactProblem& problem, const Impulses& start,
                                  int manifold, Status status) {
  FieldSearch search(status);
  const Manifold& of = problem.manifolds[manifold];
  search.Bodies(problem, of.body_a, of.body_b);
  for (int i = 0; i < of.points && status != Status::kNoSuchBody; ++i) {
    const int at = of.first_point + i;
    const ContactPoint& point = problem.points[at];
    search.AllFinite("arm_a of a point", point.arm_a);
    search.AllFinite("arm_b of a point", point.arm_b);
    search.AllFinite("normal of a point", point.normal);
    search.AllFinite("tangent of a point", point.tangent);
    search.Finite("bias of a point", point.bias);
    search.Finite("restitution of a point", point.restitution);
    search.Finite("friction of a point", point.friction);
    if (of.soft) search.Finite("compliance of a point", point.compliance);
    search.Finite("the impulse of a point at the start", start.points[at].normal);
    search.AllFinite("the friction of a point at the start", start.points[at].tangential);
    search.AtLeastZero(Status::kBadFriction, "friction of a point", point.friction);
    search.AtLeastZero(Status::kBadFriction, "restitution of a point", point.restitution);
    if (of.soft) {
      search.AtLeastZero(Status::kBadCompliance, "compliance of a point", point.compliance);
    }
    if (!of.twists) continue;
    const ContactTwist& twist = problem.twists[at];
    search.Finite("spinning of a point", twist.spinning);
    search.Finite("rolling of a point", twist.rolling);
    search.IsNumber("most_spinning of a point", twist.most_spinning);
    search.IsNumber("most_rolling of a point", twist.most_rolling);
    search.Finite("the twist of a point at the start", start.twists[at].spinning);
    search.AllFinite("the twist of a point at the start", start.twists[at].rolling);
    search.AtLeastZero(Status::kBadFriction, "spinning of a point", twist.spinning);
    search.AtLeastZero(Status::kBadFriction, "rolling of a point", twist.rolling);
    search.AtLeastZero(Status::kBadFriction, "most_spinning of a point", twist.most_spinning);
    search.AtLeastZero(Status::kBadFriction, "most_rolling of a point", twist.most_rolling);
  }
  return search.found();
}

}  // namespace cairn
