// SPDX-License-Identifier: MIT
// Raised inertia against its formulas one body at a time, on every target with the same bits.
#include "simd/raised_inertia.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cstring>
#include <random>

#include "simd/target.h"

namespace cairn::simd {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr RaiseRules kRules = {.time_step = 0.1, .threshold = 2, .hold = 0.9, .same_moment = 1e-3};

/// A body whose joints pull.
struct Pulled {
  Matrix3d stiffness, inv_inertia;
  Vector3d held, kept;
};

/// What becomes of it, as principal axes are given.
struct Raised {
  Vector3d held, kept;
  double strain;
  Matrix3d response, carried, inv_inertia;
};

Raised Raise(const Pulled& body, const Vector3d& moments, const Matrix3d& axes) {
  const Matrix3d about = (axes.transpose() * body.stiffness * axes).cwiseAbs();
  Vector3d k;
  for (int i = 0; i < 3; ++i) {
    const double own = axes.col(i).dot(body.stiffness * axes.col(i));
    const double others = about.row(i).sum() - about(i, i);
    k[i] = std::max({0.0, own + others, kRules.hold * body.held[i]});
  }
  const auto same = [&](int i) {
    return moments[i + 1] - moments[i] <= kRules.same_moment * moments[i + 1];
  };
  if (same(0)) k[0] = k[1] = std::max(k[0], k[1]);
  if (same(1)) k[1] = k[2] = std::max(k[1], k[2]);
  if (same(0)) k[0] = k[1];
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
