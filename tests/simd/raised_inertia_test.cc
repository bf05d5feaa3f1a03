// SPDX-License-Identifier: MIT
// Raised inertia against its formulas one body at a time, on every target with the same bits.
#include "simd/raised_inertia.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <Eigen/Jacobi>
#include <algorithm>
#include <cstring>
#include <random>
#include <utility>

#include "simd/target.h"

namespace cairn::simd {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr RaiseRules kRules = {
    .time_step = 0.1, .threshold = 2, .hold = 0.9, .same_moment = 1e-3, .on_line = 1e-3};

/// A body whose joints pull.
struct Pulled {
  Matrix3d stiffness, arms, inv_inertia;
  Vector3d held, kept;
};

/// What becomes of it, as principal axes are given.
struct Raised {
  Vector3d held, kept;
  double strain;
  Matrix3d response, carried, inv_inertia;
};

/// The first of axes with equal moments, and how many there are; 1 where there are none.
std::pair<int, int> EqualAxes(const Vector3d& moments) {
  const auto same = [&](int i) {
    return moments[i + 1] - moments[i] <= kRules.same_moment * moments[i + 1];
  };
  return {same(0) ? 0 : 1, 1 + int{same(0)} + int{same(1)}};
}

/// Turns two axes in their plane so that a matrix does not mix them, and the first has less of it.
void Unmix(const Matrix3d& matrix, int p, int q, Matrix3d* axes) {
  Eigen::Matrix2d both;
  for (const int i : {0, 1}) {
    for (const int k : {0, 1}) both(i, k) = axes->col(i ? q : p).dot(matrix * axes->col(k ? q : p));
  }
  const double rounding = 1e-6 * both.trace();
  if (std::abs(both(0, 1)) > rounding) {
    Eigen::JacobiRotation<double> rotation;
    rotation.makeJacobi(both(0, 0), both(0, 1), both(1, 1));
    axes->applyOnTheRight(p, q, rotation);
  }
  const auto own = [&](int i) { return axes->col(i).dot(matrix * axes->col(i)); };
  if (own(p) - own(q) > rounding) axes->col(p).swap(axes->col(q));
}

/// Principal axes; those of equal moments are the ones that do not mix the arms. Where arms are
/// alike across two of them, any are, and these are the kernel's.
Matrix3d AxesOf(const Pulled& body, const Vector3d& moments, Matrix3d axes) {
  const auto [first, count] = EqualAxes(moments);
  for (int round = 0; round < (count == 3 ? 4 : 1); ++round) {
    if (count > 1) Unmix(body.arms, first, first + 1, &axes);
    if (count < 3) continue;
    Unmix(body.arms, 1, 2, &axes);
    Unmix(body.arms, 0, 2, &axes);
  }
  return axes;
}

Raised Raise(const Pulled& body, const Vector3d& moments, const Matrix3d& any_axes) {
  const Matrix3d axes = AxesOf(body, moments, any_axes);
  const Matrix3d about = (axes.transpose() * body.stiffness * axes).cwiseAbs();
  Vector3d k;
  for (int i = 0; i < 3; ++i) {
    const double own = axes.col(i).dot(body.stiffness * axes.col(i));
    const double others = about.row(i).sum() - about(i, i);
    k[i] = std::max({0.0, own + others, kRules.hold * body.held[i]});
  }
  const auto [first, count] = EqualAxes(moments);
  if (count > 1) {
    const auto arms = [&](int i) { return axes.col(i).dot(body.arms * axes.col(i)); };
    const bool on_line = arms(first) < kRules.on_line * arms(first + 1);
    const int begin = first + int{on_line};
    const double most = k.segment(begin, first + count - begin).maxCoeff();
    k.segment(begin, first + count - begin).setConstant(most);
  }
  const Vector3d strain = kRules.time_step * kRules.time_step * k.cwiseProduct(moments);
  const Vector3d kept = (1 + (strain.array() - kRules.threshold).max(0)).inverse();
  const Vector3d carried = kept.cwiseQuotient(body.kept).cwiseMin(1);
  const auto matrix = [&](const Vector3d& of_axes) -> Matrix3d {
    return axes * of_axes.asDiagonal() * axes.transpose();
  };
  return {k,
          kept,
          strain.maxCoeff(),
          matrix(kept),
          matrix(carried),
          matrix(moments.cwiseProduct(kept))};
}

void Put(const Matrix3d& matrix, int lane, double (*to)[kLanes]) {
  for (int column = 0, k = 0; column < 3; ++column) {
    for (int row = column; row < 3; ++row) to[k++][lane] = matrix(row, column);
  }
}
Matrix3d Whole(const double (*from)[kLanes], int lane) {
  Matrix3d whole;
  for (int column = 0, k = 0; column < 3; ++column) {
    for (int row = column; row < 3; ++row)
      whole(row, column) = whole(column, row) = from[k++][lane];
  }
  return whole;
}
Vector3d Three(const double (*from)[kLanes], int lane) {
  return {from[0][lane], from[1][lane], from[2][lane]};
}

/// Moments may be alike, and nothing may pull.
Pulled Draw(std::mt19937_64* random) {
  std::uniform_real_distribution<double> number(-1, 1);
  const auto draw = [&] { return number(*random); };
  Pulled body;
  const Matrix3d any = Matrix3d::NullaryExpr(draw);
  const double pull = number(*random) < -0.8 ? 0 : std::exp(6 * number(*random));
  body.stiffness = pull * (any + any.transpose());
  const auto add_arm = [&] {
    const Vector3d arm = Vector3d::NullaryExpr(draw);
    body.arms += pull * pull * (arm.squaredNorm() * Matrix3d::Identity() - arm * arm.transpose());
  };
  body.arms.setZero();
  add_arm();
  if (number(*random) < 0) add_arm();
  const Eigen::Quaterniond turn(draw(), draw(), draw(), draw());
  Vector3d moments = (2 * Vector3d::NullaryExpr(draw).array()).exp();
  if (number(*random) < 0) moments[1] = moments[0];
  if (number(*random) < 0) moments[2] = moments[1] * (1 + 1e-4);
  const Matrix3d axes = turn.normalized().toRotationMatrix();
  const Matrix3d inertia = axes * moments.asDiagonal() * axes.transpose();
  body.inv_inertia = 0.5 * (inertia + inertia.transpose());
  body.held = 100 * Vector3d::NullaryExpr(draw).cwiseAbs();
  body.kept = Vector3d::NullaryExpr(draw).cwiseAbs();
  return body;
}

void ExpectNear(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  EXPECT_LE((a - b).norm(), 1e-12 * (1 + b.norm()));
}

TEST(RaisedInertia, IsThatOfItsFormulasOnEveryTarget) {
  std::mt19937_64 random(5);
  int raised = 0;
  for (int round = 0; round < 100; ++round) {
    Pulled bodies[kLanes];
    for (Pulled& body : bodies) body = Draw(&random);
    RaisedInertia first;
    for (const Target target : SupportedTargets()) {
      SCOPED_TRACE(TargetName(target));
      PrincipalAxes axes;
      RaisedInertia lanes;
      for (int l = 0; l < kLanes; ++l) {
        Put(bodies[l].inv_inertia, l, axes.matrix);
        Put(bodies[l].stiffness, l, lanes.stiffness);
        Put(bodies[l].arms, l, lanes.arms);
        for (int k = 0; k < 3; ++k) {
          lanes.held[k][l] = bodies[l].held[k];
          lanes.kept[k][l] = bodies[l].kept[k];
        }
      }
      PrincipalAxesKernelFor(target)(&axes);
      RaiseKernelFor(target)(kRules, axes, &lanes);
      for (int l = 0; l < kLanes; ++l) {
        SCOPED_TRACE(l);
        Matrix3d of_body;
        for (int k = 0; k < 9; ++k) of_body(k % 3, k / 3) = axes.axis[k][l];
        const Raised expected = Raise(bodies[l], Three(axes.moment, l), of_body);
        ExpectNear(Three(lanes.held, l), expected.held);
        ExpectNear(Three(lanes.kept, l), expected.kept);
        EXPECT_NEAR(lanes.strain[l], expected.strain, 1e-12 * (1 + expected.strain));
        EXPECT_NEAR(kRules.time_step * kRules.time_step * lanes.held_ratio[l], expected.strain,
                    1e-12 * (1 + expected.strain));
        ExpectNear(Whole(lanes.response, l), expected.response);
        ExpectNear(Whole(lanes.carried, l), expected.carried);
        ExpectNear(Whole(lanes.inv_inertia, l), expected.inv_inertia);
        raised += expected.strain > kRules.threshold ? 1 : 0;
      }
      if (target == SupportedTargets().front()) first = lanes;
      EXPECT_EQ(std::memcmp(&lanes, &first, sizeof(lanes)), 0);
    }
  }
  EXPECT_GT(raised, 100);
}

}  // namespace
}  // namespace cairn::simd
