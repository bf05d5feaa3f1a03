// SPDX-License-Identifier: MIT
#include "tests/bullet_adapter/row_oracle.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <vector>

#include "bullet_adapter/src/conversions.h"
#include "cairn/detail/eigen.h"
#include "cairn/detail/threads.h"
#include "measure/instrumented_solver.h"
#include "problem/contact_expansion.h"

namespace cairn::test {
namespace {

using bench::Substep;

/// 1e-6 with floats: eight roundings, as either side makes several.
constexpr double kTolerance = sizeof(btScalar) == sizeof(float) ? 1e-6 : 1e-12;

/// Numbers that have no full precision any more are zero [m/s].
constexpr double kNothing = 1e-30;

/// Bullet's solver, stopped between its set-up and its sweeps.
class Oracle : public btSequentialImpulseConstraintSolver {
 public:
  void SetUp(Substep::Group* group, btContactSolverInfo* info) {
    solveGroupCacheFriendlySetup(group->bodies.data(), static_cast<int>(group->bodies.size()),
                                 group->manifolds.data(), static_cast<int>(group->manifolds.size()),
                                 group->joints.data(), static_cast<int>(group->joints.size()),
                                 *info, nullptr);
  }
  /// Gives the companion ids back; what it writes besides has to be restored.
  void Finish(Substep::Group* group, btContactSolverInfo* info) {
    solveGroupCacheFriendlyFinish(group->bodies.data(), static_cast<int>(group->bodies.size()),
                                  *info);
  }

  const btConstraintArray& joints() const { return m_tmpSolverNonContactConstraintPool; }
  const btConstraintArray& contacts() const { return m_tmpSolverContactConstraintPool; }
  const btConstraintArray& frictions() const { return m_tmpSolverContactFrictionConstraintPool; }
  const btConstraintArray& twists() const {
    return m_tmpSolverContactRollingFrictionConstraintPool;
  }
  const btSolverBody& body(int id) const { return m_tmpSolverBodyPool[id]; }
};

/// sum |J_k| |v_k|: what J v is rounded against.
double SpeedScale(const btSolverBody& body, const btVector3& linear, const btVector3& angular) {
  const btVector3 velocity =
      body.m_linearVelocity.absolute() + body.m_externalForceImpulse.absolute();
  const btVector3 spin =
      body.m_angularVelocity.absolute() + body.m_externalTorqueImpulse.absolute();
  return linear.absolute().dot(velocity) + angular.absolute().dot(spin);
}

void ExpectNear(double actual, double expected, double scale, const char* what) {
  if (actual == expected) return;  // infinities, too
  EXPECT_NEAR(actual, expected, kTolerance * (std::abs(expected) + scale) + kNothing) << what;
}

void ExpectAxis(const Eigen::Vector3d& actual, const btVector3& expected, const char* what) {
  const double scale = expected.length();
  for (int k = 0; k < 3; ++k) ExpectNear(actual[k], expected[k], scale, what);
}

/// A row that turns a body about an axis which it is locked about, but for less than a thousandth.
bool IsLocked(const btSolverBody& body, const btSolverConstraint& source, const btVector3& axis) {
  const btRigidBody* const rigid = body.m_originalBody;
  if (rigid == nullptr || !source.m_contactNormal1.isZero() || !source.m_contactNormal2.isZero()) {
    return false;
  }
  const auto answer = [rigid](const btVector3& a) {
    return (rigid->getInvInertiaTensorWorld() * a).dot(a);
  };
  return answer(axis * rigid->getAngularFactor()) < btScalar(1e-3) * answer(axis);
}

enum class Halves { kBoth, kOfBodies };

class RowComparison {
 public:
  RowComparison(const Oracle& oracle, const bullet::FastGroup& ours)
      : oracle_(oracle), rows_(ours.problem().rows) {}

  /// What all kinds of rows share.
  const Row& Compare(int index, const btSolverConstraint& source, Halves halves) const {
    const Row& row = rows_[index];
    const btSolverBody& a = oracle_.body(source.m_solverBodyIdA);
    const btSolverBody& b = oracle_.body(source.m_solverBodyIdB);
    const bool both = halves == Halves::kBoth;
    const btVector3 &turns_a = source.m_relpos1CrossNormal, &turns_b = source.m_relpos2CrossNormal;
    const bool locked_a = both && IsLocked(a, source, turns_a);
    const bool locked_b = both && IsLocked(b, source, turns_b);
    const btVector3 none(0, 0, 0);
    if (both || a.m_originalBody != nullptr) {
      ExpectAxis(row.linear_a, source.m_contactNormal1, "linear a");
      ExpectAxis(row.angular_a, locked_a ? none : turns_a, "angular a");
    }
    if (both || b.m_originalBody != nullptr) {
      ExpectAxis(row.linear_b, source.m_contactNormal2, "linear b");
      ExpectAxis(row.angular_b, locked_b ? none : turns_b, "angular b");
    }
    const double step = source.m_jacDiagABInv;
    const double speed = SpeedScale(a, source.m_contactNormal1, source.m_relpos1CrossNormal) +
                         SpeedScale(b, source.m_contactNormal2, source.m_relpos2CrossNormal);
    // Bullet's way to switch a row off that nothing can move for
    const double inverse_step = step != 0 ? 1 / step : 0;
    ExpectNear(row.target,
               std::clamp(source.m_rhs * inverse_step, -bullet::kMostTarget, bullet::kMostTarget),
               2 * speed, "target");
    // softness is a share of the diagonal, here of what is left of it
    if (!locked_a && !locked_b) {
      ExpectNear(row.compliance, source.m_cfm * inverse_step, 0, "compliance");
    }
    return row;
  }

 private:
  const Oracle& oracle_;
  std::span<const Row> rows_;
};

void CompareJoints(const Oracle& oracle, const bullet::FastGroup& ours, RowCounts* counts) {
  const RowComparison comparison(oracle, ours);
  int next = 0;
  for (const bullet::JointRows& joint : ours.group().joints) {
    for (int i = 0; i < joint.rows; ++i, ++next) {
      ASSERT_LT(next, oracle.joints().size());
      const btSolverConstraint& source = oracle.joints()[next];
      const Row& row = comparison.Compare(joint.first_row + i, source, Halves::kBoth);
      EXPECT_EQ(row.lo, bullet::Bound(source.m_lowerLimit));
      EXPECT_EQ(row.hi, bullet::Bound(source.m_upperLimit));
      EXPECT_EQ(row.host.max_sweeps, source.m_overrideNumSolverIterations);
      EXPECT_EQ(joint.joint, source.m_originalContactPoint);
    }
  }
  EXPECT_EQ(next, oracle.joints().size());
  counts->joints += next;
}

void CompareContacts(const Oracle& oracle, const bullet::FastGroup& ours, RowCounts* counts) {
  const RowComparison comparison(oracle, ours);
  const auto& points = ours.group().points;
  const std::span<const double> impulses = ours.group().impulses;
  int friction = 0, twist = 0;
  ASSERT_EQ(static_cast<int>(points.size()), oracle.contacts().size());
  for (int i = 0; i < oracle.contacts().size(); ++i) {
    const btSolverConstraint& normal = oracle.contacts()[i];
    EXPECT_EQ(points[i].point, normal.m_originalContactPoint);
    comparison.Compare(points[i].normal_row, normal, Halves::kBoth);
    ExpectNear(impulses[points[i].normal_row], normal.m_appliedImpulse, 0, "start");
    for (int k = 0; k < points[i].frictions; ++k) {
      ASSERT_LT(friction, oracle.frictions().size());
      const btSolverConstraint& source = oracle.frictions()[friction++];
      const Row& row = comparison.Compare(points[i].friction_row + k, source, Halves::kBoth);
      EXPECT_EQ(source.m_frictionIndex, i);
      EXPECT_EQ(row.friction, source.m_friction);
    }
    for (int k = 0; k < points[i].twists; ++k) {
      ASSERT_LT(twist, oracle.twists().size());
      const btSolverConstraint& source = oracle.twists()[twist++];
      const Row& row = comparison.Compare(points[i].twist_row + k, source, Halves::kOfBodies);
      EXPECT_EQ(source.m_frictionIndex, i);
      EXPECT_EQ(row.friction, source.m_friction);
      EXPECT_EQ(row.hi, source.m_friction);
    }
  }
  EXPECT_EQ(friction, oracle.frictions().size());
  EXPECT_EQ(twist, oracle.twists().size());
  counts->normals += static_cast<int>(points.size());
  counts->frictions += friction;
  counts->twists += twist;
}

bool SameBits(const Row& a, const Row& b) {
  return a.linear_a == b.linear_a && a.angular_a == b.angular_a && a.linear_b == b.linear_b &&
         a.angular_b == b.angular_b && a.target == b.target && a.compliance == b.compliance &&
         a.lo == b.lo && a.hi == b.hi && a.friction == b.friction && a.parent == b.parent;
}

void ReadOurs(const Substep& substep, const Substep::Group& group, const ChangeState& change,
              const btContactSolverInfo& info, bullet::ContactForm form, bullet::FastGroup* ours) {
  substep.Restore();
  change(substep);
  static detail::Threads alone;  // outlives what reads with it
  ours->Read({group.bodies, group.manifolds, group.joints}, info, bullet::SweepLimits::kBullet,
             {.contacts = form, .two_friction_directions = false}, 1, &alone);
}

/// Sums of some ten products of numbers of up to ten, in floats.
constexpr double kFloats = 5e-5;
/// Directions of slower slides are decided by rounding [m/s].
constexpr double kSlides = 0.05;

void ExpectClose(const Row& actual, const Row& expected, double sign) {
  const auto close = [sign](const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
    EXPECT_LE((a - sign * b).norm(), kFloats * (1 + b.norm()));
  };
  // the half of what has no number is left out of rows
  if (expected.body_a != kWorld) {
    close(actual.linear_a, expected.linear_a);
    close(actual.angular_a, expected.angular_a);
  }
  if (expected.body_b != kWorld) {
    close(actual.linear_b, expected.linear_b);
    close(actual.angular_b, expected.angular_b);
  }
  EXPECT_NEAR(actual.target, sign * expected.target, kFloats * (1 + std::abs(expected.target)));
}

/// One point of a manifold, its rows as they were written out, and those that it should have.
class PointComparison {
 public:
  struct Rows {
    const Row *normal, *frictions, *twists;  ///< twists: or none
  };
  PointComparison(const Rows& actual, const bullet::FastGroup& rows, const bullet::PointRows& point)
      : normal_(*actual.normal),
        frictions_(actual.frictions),
        twists_(actual.twists),
        rows_(rows.problem().rows),
        point_(point) {}

  void Compare() const {
    const Row& normal = rows_[point_.normal_row];
    ExpectClose(normal_, normal, 1);
    EXPECT_NEAR(normal_.compliance, normal.compliance, 1e-6 * normal.compliance);
    EXPECT_EQ(normal_.host.max_sweeps, normal.host.max_sweeps);
    for (int k = 0; k < point_.frictions; ++k) {
      const Row &actual = frictions_[k], &expected = rows_[point_.friction_row + k];
      EXPECT_FLOAT_EQ(static_cast<float>(actual.friction), static_cast<float>(expected.friction));
      EXPECT_NEAR(View(actual.linear_a).norm(), 1, kFloats);
      EXPECT_NEAR(View(actual.linear_a).dot(View(normal_.linear_a)), 0, kFloats);
      if (std::abs(rows_[point_.friction_row].target) < kSlides) continue;
      const double along = View(actual.linear_a).dot(View(expected.linear_a)) +
                           View(actual.linear_b).dot(View(expected.linear_b));
      ExpectClose(actual, expected, along < 0 ? -1 : 1);
    }
    CompareTwists();
  }

 private:
  void CompareTwists() const {
    for (int k = 0; k < point_.twists; ++k) {
      ASSERT_NE(twists_, nullptr);
      const Row &actual = twists_[k], &expected = rows_[point_.twist_row + k];
      ExpectClose(actual, expected, -1);  // Bullet turns the second body
      EXPECT_FLOAT_EQ(static_cast<float>(actual.friction), static_cast<float>(expected.friction));
      EXPECT_FLOAT_EQ(static_cast<float>(actual.hi), static_cast<float>(expected.hi));
    }
    // where other points of the manifold roll
    for (int k = 0; twists_ != nullptr && point_.twists == 0 && k < Manifold::kTwistRows; ++k) {
      EXPECT_EQ(twists_[k].friction, 0);
    }
  }

  const Row& normal_;
  const Row *frictions_, *twists_;
  std::span<const Row> rows_;
  const bullet::PointRows& point_;
};

bool HasAngularFactor(const btTypedConstraint& joint) {
  const btVector3 none(1, 1, 1);
  return joint.getRigidBodyA().getAngularFactor() != none ||
         joint.getRigidBodyB().getAngularFactor() != none;
}

/// Joints that go to the core as such, with their rows as they were written out from @p next on.
/// Returns what comes behind those.
const Row* CompareJoints(const bullet::FastGroup& rows, const bullet::FastGroup& points,
                         const Row* next, RowCounts* counts) {
  const auto &expected = rows.group().joints, &actual = points.group().joints;
  EXPECT_EQ(actual.size(), expected.size());
  for (size_t i = 0; i < std::min(actual.size(), expected.size()); ++i) {
    EXPECT_EQ(actual[i].joint, expected[i].joint);
    EXPECT_EQ(actual[i].rows, expected[i].rows);
    if (actual[i].written_out) {
      if (HasAngularFactor(*actual[i].joint)) counts->locked += actual[i].rows;
      continue;
    }
    for (int k = 0; k < actual[i].rows; ++k, ++next) {
      const Row& row = rows.problem().rows[expected[i].first_row + k];
      ExpectClose(*next, row, 1);
      EXPECT_FLOAT_EQ(static_cast<float>(next->lo), static_cast<float>(row.lo));
      EXPECT_FLOAT_EQ(static_cast<float>(next->hi), static_cast<float>(row.hi));
      EXPECT_EQ(row.compliance, 0);
      EXPECT_EQ(next->host.max_sweeps, row.host.max_sweeps);
      ++counts->compact;
    }
  }
  return next;
}

void CompareManifolds(const bullet::FastGroup& rows, bullet::FastGroup* points, RowCounts* counts) {
  std::map<const btManifoldPoint*, const bullet::PointRows*> rows_of;
  for (const bullet::PointRows& point : rows.group().points) rows_of[point.point] = &point;
  const ContactProblem problem = points->problem();
  const ContactExpansion expansion(problem, points->impulses());
  const Row* next = expansion.problem().rows.data() + problem.rows.size();
  next = CompareJoints(rows, *points, next, counts);
  for (const Manifold& manifold : problem.manifolds) {
    for (int p = 0; p < manifold.points; ++p) {
      const auto of = rows_of.find(points->contacts().sources()[manifold.first_point + p]);
      ASSERT_NE(of, rows_of.end());
      ASSERT_EQ(of->second->frictions, manifold.tangents);
      const Row* const frictions = next + manifold.points + p * manifold.tangents;
      const Row* const twists =
          next + manifold.points * (1 + manifold.tangents) + p * Manifold::kTwistRows;
      const PointComparison::Rows actual{next + p, frictions, manifold.twists ? twists : nullptr};
      PointComparison(actual, rows, *of->second).Compare();
      rows_of.erase(of);
      ++counts->points;
    }
    next += manifold.rows();
  }
  // the others are rows
  EXPECT_EQ(rows_of.size(), points->group().points.size());
}

}  // namespace

RowCounts ExpectBulletsRows(const Substep& substep, const btContactSolverInfo& info,
                            const ChangeState& change) {
  RowCounts counts;
  btContactSolverInfo own_info = info;
  for (Substep::Group group : substep.groups()) {
    bullet::FastGroup ours, again;
    constexpr auto kRows = bullet::ContactForm::kRows;
    ReadOurs(substep, group, change, info, kRows, &ours);
    substep.Restore();
    change(substep);
    Oracle oracle;
    oracle.SetUp(&group, &own_info);
    CompareJoints(oracle, ours, &counts);
    CompareContacts(oracle, ours, &counts);
    oracle.Finish(&group, &own_info);

    ReadOurs(substep, group, change, info, kRows, &again);
    const auto first = ours.problem().rows, second = again.problem().rows;
    EXPECT_TRUE(std::ranges::equal(first, second, SameBits));

    bullet::FastGroup points;
    ReadOurs(substep, group, change, info, bullet::ContactForm::kManifolds, &points);
    CompareManifolds(ours, &points, &counts);
  }
  substep.Restore();
  return counts;
}

RowCounts ExpectBulletsRowsInWorld(const std::function<void(bench::World*)>& build,
                                   const ChangeState& change, int frames, int stride) {
  btSequentialImpulseConstraintSolver driver;
  bench::InstrumentedSolver instrumented(&driver);
  bench::World world(&instrumented);
  build(&world);
  RowCounts counts;
  for (int frame = 0; frame < frames; ++frame) {
    if (frame % stride == stride - 1) {
      instrumented.ProbeNext([&](Substep* substep, const btContactSolverInfo& info) {
        const RowCounts more = ExpectBulletsRows(*substep, info, change);
        counts.joints += more.joints;
        counts.normals += more.normals;
        counts.frictions += more.frictions;
        counts.twists += more.twists;
        counts.points += more.points;
        counts.compact += more.compact;
        counts.locked += more.locked;
      });
    }
    world.Step();
    if (testing::Test::HasFailure()) {
      ADD_FAILURE() << "in frame " << frame;
      break;
    }
  }
  return counts;
}

}  // namespace cairn::test
