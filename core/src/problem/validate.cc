// SPDX-License-Identifier: MIT
#include "problem/validate.h"

#include <algorithm>
#include <cmath>

#include "cairn/detail/bad_input.h"
#include "cairn/detail/eigen.h"
#include "problem/bad_field.h"
#include "problem/joint_errors.h"

namespace cairn {
namespace {

bool Finite(const auto& of) { return View(of).allFinite(); }

Status CheckBody(const Body& body) {
  const bool finite = std::isfinite(body.inv_mass) && Finite(body.inv_inertia) &&
                      Finite(body.linear_factor) && Finite(body.velocity.linear) &&
                      Finite(body.velocity.angular) && Finite(body.impulse) &&
                      Finite(body.angular_impulse);
  if (!finite) return Status::kNotFinite;

  Eigen::Matrix3d factor;
  const bool mass = body.inv_mass >= 0 && View(body.linear_factor).minCoeff() >= 0;
  if (!mass || !FactorInertia(body.inv_inertia, &factor)) return Status::kBadMass;
  return Status::kOk;
}

bool SamePair(const Row& row, const Row& other) {
  return std::minmax(row.body_a, row.body_b) == std::minmax(other.body_a, other.body_b);
}

Status CheckParent(std::span<const Row> rows, int index) {
  const Row& row = rows[index];
  if (row.parent == kNoRow) return Status::kOk;
  if (row.parent < 0 || row.parent >= index) return Status::kBadParent;
  const Row& parent = rows[row.parent];
  if (parent.parent != kNoRow || !SamePair(row, parent)) return Status::kBadParent;
  return row.lo <= 0 && row.hi >= 0 ? Status::kOk : Status::kBadBounds;
}

Status CheckRow(const ContactProblem& problem, int index) {
  const Row& row = problem.rows[index];
  // zero times what is not finite is not zero
  double zero = 0 * row.target + 0 * row.compliance + 0 * row.friction + 0 * row.relaxation;
  for (int k = 0; k < 3; ++k) {
    zero += 0 * row.linear_a[k] + 0 * row.angular_a[k] + 0 * row.linear_b[k] + 0 * row.angular_b[k];
  }
  if (zero != 0 || std::isnan(row.lo) || std::isnan(row.hi)) return Status::kNotFinite;

  const int bodies = static_cast<int>(problem.bodies.size());
  const auto known = [bodies](int body) { return body >= kWorld && body < bodies; };
  if (!known(row.body_a) || !known(row.body_b)) return Status::kNoSuchBody;
  if (row.body_a == row.body_b && row.body_a != kWorld) return Status::kNoSuchBody;

  if (row.lo > row.hi || row.lo == kInfinity || row.hi == -kInfinity) return Status::kBadBounds;
  if (row.compliance < 0) return Status::kBadCompliance;
  if (!(row.relaxation > 0 && row.relaxation < 2)) return Status::kBadCompliance;
  if (row.friction < 0) return Status::kBadFriction;
  return CheckParent(problem.rows, index);
}

bool Finite(const ContactMotion& motion) {
  float zero = 0;
  for (int k = 0; k < 3; ++k) {
    zero += 0 * motion.free_velocity[k] + 0 * motion.free_spin[k];
    zero += 0 * motion.start_velocity[k] + 0 * motion.start_spin[k];
  }
  return zero == 0;
}

/// What resists turning at a point, and where it starts.
Status CheckTwist(const ContactTwist& twist, const TwistImpulse& start) {
  const float zero = 0 * twist.spinning + 0 * twist.rolling + 0 * start.spinning +
                     0 * start.rolling[0] + 0 * start.rolling[1];
  const bool numbers = !std::isnan(twist.most_spinning) && !std::isnan(twist.most_rolling);
  if (zero != 0 || !numbers) return Status::kNotFinite;
  const bool bounds = twist.spinning >= 0 && twist.rolling >= 0 && twist.most_spinning >= 0 &&
                      twist.most_rolling >= 0;
  return bounds ? Status::kOk : Status::kBadFriction;
}

/// Its points, and where they start.
Status CheckPoints(const ContactProblem& problem, const Manifold& manifold, const Impulses& start) {
  for (int p = manifold.first_point; p < manifold.first_point + manifold.points; ++p) {
    const ContactPoint& point = problem.points[p];
    const ContactImpulse& impulse = start.points[p];
    float zero = 0 * point.bias + 0 * point.restitution + 0 * point.friction;
    zero += 0 * impulse.normal + 0 * impulse.tangential[0] + 0 * impulse.tangential[1];
    if (manifold.soft) zero += 0 * point.compliance;
    for (int k = 0; k < 3; ++k) {
      zero += 0 * point.arm_a[k] + 0 * point.arm_b[k] + 0 * point.normal[k] + 0 * point.tangent[k];
    }
    if (zero != 0) return Status::kNotFinite;
    if (point.friction < 0 || point.restitution < 0) return Status::kBadFriction;
    if (manifold.soft && point.compliance < 0) return Status::kBadCompliance;
    if (!manifold.twists) continue;
    const Status status = CheckTwist(problem.twists[p], start.twists[p]);
    if (status != Status::kOk) return status;
  }
  return Status::kOk;
}

/// The rows of a joint, and where they start.
Status CheckJointRows(const ContactProblem& problem, const Joint& joint, const Impulses& start) {
  for (int i = 0; i < joint.rows; ++i) {
    const JointRow& row = problem.joint_rows[joint.first_row + i];
    float zero = 0 * row.target + 0 * start.joint_rows[joint.first_row + i];
    zero += 0 * ErrorOf(problem, joint, i);
    if (joint.soft) zero += 0 * row.compliance;
    for (int k = 0; k < 3; ++k) {
      zero += 0 * row.linear_a[k] + 0 * row.angular_a[k];
      zero += 0 * row.angular_b[k] + (joint.opposite ? 0 : 0 * row.linear_b[k]);
    }
    if (zero != 0) return Status::kNotFinite;
    if (joint.soft && row.compliance < 0) return Status::kBadCompliance;
    if (!joint.is_bounded(i)) continue;
    if (std::isnan(row.lo) || std::isnan(row.hi)) return Status::kNotFinite;
    const bool bounds = row.lo <= row.hi && row.lo < kInfinity && row.hi > -kInfinity;
    if (!bounds) return Status::kBadBounds;
  }
  return Status::kOk;
}

bool Inside(double value, double lo, double hi) { return value >= lo && value <= hi; }

/// They are bodies of the problem, and not the same.
bool JoinsTwo(const ContactProblem& problem, int a, int b) {
  const int bodies = static_cast<int>(problem.bodies.size());
  return a != b && Inside(a, kWorld, bodies - 1) && Inside(b, kWorld, bodies - 1);
}

}  // namespace

namespace {

constexpr double kFloatRounding = 1e-5;

/// Plain Cholesky, where no pivot is small and the halves differ by rounding at most, as those of
/// a turned body do.
bool FactorDefinite(const Eigen::Matrix3d& m, Eigen::Matrix3d* factor) {
  constexpr double kLeastPivot = 1e-4;
  const double most = kFloatRounding * std::max({m(0, 0), m(1, 1), m(2, 2)});
  const auto alike = [&m, most](int i, int j) { return std::abs(m(i, j) - m(j, i)) <= most; };
  if (!(m(0, 0) > 0 && alike(1, 0) && alike(2, 0) && alike(2, 1))) return false;
  const auto mean = [&m](int i, int j) { return 0.5 * (m(i, j) + m(j, i)); };
  const double l00 = std::sqrt(m(0, 0)), l10 = mean(1, 0) / l00, l20 = mean(2, 0) / l00;
  const double pivot1 = m(1, 1) - l10 * l10;
  if (!(pivot1 > kLeastPivot * m(1, 1))) return false;
  const double l11 = std::sqrt(pivot1), l21 = (mean(2, 1) - l20 * l10) / l11;
  const double pivot2 = m(2, 2) - l20 * l20 - l21 * l21;
  if (!(pivot2 > kLeastPivot * m(2, 2))) return false;
  *factor << l00, 0, 0, l10, l11, 0, l20, l21, std::sqrt(pivot2);
  return true;
}

}  // namespace

bool FactorInertia(const Eigen::Matrix3d& inv_inertia, Eigen::Matrix3d* factor) {
  if (FactorDefinite(inv_inertia, factor)) return true;
  const double scale = inv_inertia.cwiseAbs().maxCoeff();
  const double tolerance = kFloatRounding * scale;
  if ((inv_inertia - inv_inertia.transpose()).cwiseAbs().maxCoeff() > tolerance) return false;

  // Cholesky with the largest pivot first. What is left of a semidefinite matrix has its largest
  // entry on the diagonal: when it has not, only rounding is left, or the matrix was indefinite.
  Eigen::Matrix3d rest = 0.5 * (inv_inertia + inv_inertia.transpose());
  factor->setZero();
  for (int k = 0; k < 3; ++k) {
    int largest;
    const double pivot = rest.diagonal().maxCoeff(&largest);
    const double most = rest.cwiseAbs().maxCoeff();
    if (pivot <= 1e-12 * scale || pivot * (1 + kFloatRounding) < most) break;
    factor->col(k) = rest.col(largest) / std::sqrt(pivot);
    rest -= (factor->col(k) * factor->col(k).transpose()).eval();
    rest.row(largest).setZero();
    rest.col(largest).setZero();
  }
  return rest.cwiseAbs().maxCoeff() <= tolerance;
}

Status ValidateRow(const ContactProblem& problem, int row, double impulse) {
  return std::isfinite(impulse) ? CheckRow(problem, row) : Status::kNotFinite;
}

BadSetting FindBadSize(const ContactProblem& problem, const Impulses& impulses) {
  BadSetting bad;
  const auto check = [&bad](const char* name, size_t size, const char* range, size_t wanted) {
    if (bad.name == nullptr && size != wanted) bad = {name, static_cast<double>(size), range};
  };
  const auto check_or_none = [&check](const char* name, size_t size, const char* range,
                                      size_t wanted) {
    if (size != 0) check(name, size, range, wanted);
  };
  const bool joints = !problem.joints.empty(), manifolds = !problem.manifolds.empty();
  check("impulses.rows.size()", impulses.rows.size(), "problem.rows.size()", problem.rows.size());
  if (joints) {
    check("impulses.joint_rows.size()", impulses.joint_rows.size(), "problem.joint_rows.size()",
          problem.joint_rows.size());
    check_or_none("problem.joint_errors.size()", problem.joint_errors.size(),
                  "0 or problem.joint_rows.size()", problem.joint_rows.size());
  }
  check_or_none("problem.motions.size()", problem.motions.size(), "0 or problem.bodies.size()",
                problem.bodies.size());
  if (manifolds) {
    check("impulses.points.size()", impulses.points.size(), "problem.points.size()",
          problem.points.size());
    check_or_none("problem.twists.size()", problem.twists.size(), "0 or problem.points.size()",
                  problem.points.size());
    check("impulses.twists.size()", impulses.twists.size(), "problem.twists.size()",
          problem.twists.size());
  }
  return bad;
}

namespace {

/// The field that says how many of an array it has, or where, and is wrong; if any.
BadSetting FindBadField(const ContactProblem& problem, const Joint& joint) {
  static_assert(Joint::kMostRows == 32);
  if (!Inside(joint.rows, 1, Joint::kMostRows)) {
    return {"rows", static_cast<double>(joint.rows), "1 to 32"};
  }
  const auto last = static_cast<std::int64_t>(problem.joint_rows.size()) - joint.rows;
  if (joint.first_row >= 0 && joint.first_row <= last) return {};
  return {"first_row", static_cast<double>(joint.first_row),
          "0 to problem.joint_rows.size() - rows"};
}

BadSetting FindBadField(const ContactProblem& problem, const Manifold& manifold) {
  static_assert(Manifold::kMostPoints == 4);
  if (!Inside(manifold.points, 1, Manifold::kMostPoints)) {
    return {"points", static_cast<double>(manifold.points), "1 to 4"};
  }
  if (!Inside(manifold.tangents, 0, 2)) {
    return {"tangents", static_cast<double>(manifold.tangents), "0 to 2"};
  }
  if (manifold.twists && problem.twists.empty()) {
    return {"twists", 1, "0 without problem.twists"};
  }
  const auto last = static_cast<std::int64_t>(problem.points.size()) - manifold.points;
  if (manifold.first_point >= 0 && manifold.first_point <= last) return {};
  return {"first_point", static_cast<double>(manifold.first_point),
          "0 to problem.points.size() - points"};
}

}  // namespace

Status ValidateJoint(const ContactProblem& problem, int index) {
  const Joint& joint = problem.joints[index];
  if (!JoinsTwo(problem, joint.body_a, joint.body_b)) return Status::kNoSuchBody;
  if (FindBadField(problem, joint).name != nullptr) return Status::kWrongSize;
  return std::isfinite(joint.damping) ? Status::kOk : Status::kNotFinite;
}

Status ValidateManifold(const ContactProblem& problem, int index) {
  const Manifold& manifold = problem.manifolds[index];
  if (!JoinsTwo(problem, manifold.body_a, manifold.body_b)) return Status::kNoSuchBody;
  return FindBadField(problem, manifold).name == nullptr ? Status::kOk : Status::kWrongSize;
}

namespace {

/// What is to be said of one thing of a problem, whose spans have the right sizes.
class Judge {
 public:
  Judge(const ContactProblem& problem, const Impulses& impulses)
      : problem_(problem), impulses_(impulses) {}

  Status OfBody(int i) const {
    // nobody else looks at motions
    const bool finite = problem_.motions.empty() || Finite(problem_.motions[i]);
    return finite ? CheckBody(problem_.bodies[i]) : Status::kNotFinite;
  }
  Status OfRow(int i) const { return ValidateRow(problem_, i, impulses_.rows[i]); }
  Status OfJoint(int i) const {
    const Status status = ValidateJoint(problem_, i);
    return status == Status::kOk ? CheckJointRows(problem_, problem_.joints[i], impulses_) : status;
  }
  Status OfManifold(int i) const {
    const Status status = ValidateManifold(problem_, i);
    return status == Status::kOk ? CheckPoints(problem_, problem_.manifolds[i], impulses_) : status;
  }

 private:
  const ContactProblem& problem_;
  const Impulses& impulses_;
};

}  // namespace

BadInput FindBadInput(const ContactProblem& problem, const Impulses& impulses) {
  const Judge judge(problem, impulses);
  const auto all_bad = [](size_t count, const auto& status_of) {
    std::vector<int> bad;
    for (int i = 0; i < static_cast<int>(count); ++i) {
      if (status_of(i) != Status::kOk) bad.push_back(i);
    }
    return bad;
  };
  return {
      .bodies = all_bad(problem.bodies.size(), [&](int i) { return judge.OfBody(i); }),
      .rows = all_bad(problem.rows.size(), [&](int i) { return judge.OfRow(i); }),
      .joints = all_bad(problem.joints.size(), [&](int i) { return judge.OfJoint(i); }),
      .manifolds = all_bad(problem.manifolds.size(), [&](int i) { return judge.OfManifold(i); })};
}

Report Validate(const ContactProblem& problem, const Impulses& impulses) {
  Report report;
  // the first of many that is refused
  const auto refused = [&report](size_t count, const auto& status_of, int* bad) {
    for (int i = 0; i < static_cast<int>(count); ++i) {
      report.status = status_of(i);
      if (report.ok()) continue;
      *bad = i;
      return true;
    }
    return false;
  };
  if (problem.bodies.empty()) report.status = Status::kEmptyProblem;
  if (!report.ok()) return report;
  report.bad_setting = FindBadSize(problem, impulses);
  if (report.bad_setting.name != nullptr) report.status = Status::kWrongSize;
  if (!report.ok()) return report;

  const Judge judge(problem, impulses);
  const auto body = [&](int i) { return judge.OfBody(i); };
  const auto row = [&](int i) { return judge.OfRow(i); };
  const auto joint = [&](int i) { return judge.OfJoint(i); };
  const auto manifold = [&](int i) { return judge.OfManifold(i); };
  if (refused(problem.bodies.size(), body, &report.bad_body)) {
    report.bad_setting = FindBadFieldOfBody(problem, report.bad_body, report.status);
    return report;
  }
  if (refused(problem.rows.size(), row, &report.bad_row)) {
    report.bad_setting = FindBadFieldOfRow(problem, impulses, report.bad_row, report.status);
    return report;
  }
  if (refused(problem.joints.size(), joint, &report.bad_joint)) {
    const int bad = report.bad_joint;
    report.bad_setting = report.status == Status::kWrongSize
                             ? FindBadField(problem, problem.joints[bad])
                             : FindBadFieldOfJoint(problem, impulses, bad, report.status);
    return report;
  }
  const float bounce = problem.contact_law.bounce_speed;
  if (!(bounce >= 0)) {
    report.status = Status::kNotFinite;
    report.bad_setting = {"problem.contact_law.bounce_speed", bounce, "0 or more"};
  }
  if (report.ok() && refused(problem.manifolds.size(), manifold, &report.bad_manifold)) {
    const int bad = report.bad_manifold;
    report.bad_setting = report.status == Status::kWrongSize
                             ? FindBadField(problem, problem.manifolds[bad])
                             : FindBadFieldOfManifold(problem, impulses, bad, report.status);
  }
  return report;
}

}  // namespace cairn
