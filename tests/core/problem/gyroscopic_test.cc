// SPDX-License-Identifier: MIT
// Gyroscopic terms against matrices of Eigen, and against what is known of tops.
#include "cairn/detail/gyroscopic.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <cstring>
#include <limits>
#include <vector>

#include "simd/gyroscopic.h"
#include "tests/core/support/problems.h"

namespace cairn {
namespace {

using Eigen::Matrix3d;
using Eigen::Quaterniond;
using Eigen::Vector3d;
using simd::GyroscopicKernel;
using simd::GyroscopicKernels;
using simd::Target;
using test::Random;

constexpr int kLanes = simd::kLanes;

template <class Scalar>
void Run(const GyroscopicKernels& kernels, Scalar time_step, Gyroscopes<Scalar>* bodies) {
  const auto run = [&](GyroscopicKernel<Scalar> kernel) {
    kernel(time_step, bodies->inv_moment, bodies->turn, bodies->spin, bodies->change);
  };
  if constexpr (sizeof(Scalar) == sizeof(float)) {
    run(kernels.of_floats);
  } else {
    run(kernels.of_doubles);
  }
}

struct Top {
  Vector3d inv_moment, spin;
  Quaterniond turn;
};

Top RandomTop(Random* random) {
  Top top;
  for (double& inverse : top.inv_moment) inverse = random->Uniform(0.5, 4);
  top.spin = random->Vector(8);
  top.turn = Quaterniond(random->Rotation());
  return top;
}

template <class Scalar>
void Put(const Top& top, int lane, Gyroscopes<Scalar>* bodies) {
  for (int k = 0; k < 3; ++k) {
    bodies->inv_moment[k][lane] = static_cast<Scalar>(top.inv_moment[k]);
    bodies->spin[k][lane] = static_cast<Scalar>(top.spin[k]);
  }
  for (int k = 0; k < 4; ++k) {
    bodies->turn[k][lane] = static_cast<Scalar>(top.turn.coeffs()[k]);
  }
}

template <class Scalar>
Vector3d ChangeOf(const Gyroscopes<Scalar>& bodies, int lane) {
  return {bodies.change[0][lane], bodies.change[1][lane], bodies.change[2][lane]};
}

Matrix3d CrossMatrix(const Vector3d& v) {
  return (Matrix3d() << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0).finished();
}

/// The step of Newton's method, with whole matrices.
Vector3d Expected(const Top& top, double time_step) {
  const Vector3d w = top.turn.conjugate() * top.spin;
  const Matrix3d inertia = top.inv_moment.cwiseInverse().asDiagonal();
  const Vector3d momentum = inertia * w;
  const Matrix3d jacobian =
      inertia + time_step * (CrossMatrix(w) * inertia - CrossMatrix(momentum));
  const Vector3d after = w - jacobian.inverse() * (time_step * w.cross(momentum));
  return top.turn * after - top.spin;
}

template <class Scalar>
class Gyroscopic : public testing::Test {};
using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(Gyroscopic, Scalars);

TYPED_TEST(Gyroscopic, IsTheStepOfNewtonOnEveryTarget) {
  constexpr double kStep = 1 / 60.0;
  const double tolerance = 50 * std::numeric_limits<TypeParam>::epsilon();
  Random random(7);
  for (int round = 0; round < 50; ++round) {
    Gyroscopes<TypeParam> bodies;
    std::vector<Top> tops;
    for (int l = 0; l < kLanes; ++l) {
      tops.push_back(RandomTop(&random));
      Put(tops.back(), l, &bodies);
    }
    Gyroscopes<TypeParam> first;
    for (const Target target : simd::SupportedTargets()) {
      Run(simd::GyroscopicKernelsFor(target), static_cast<TypeParam>(kStep), &bodies);
      for (int l = 0; l < kLanes; ++l) {
        const Vector3d error = ChangeOf(bodies, l) - Expected(tops[l], kStep);
        EXPECT_LE(error.norm(), tolerance * tops[l].spin.norm())
            << simd::TargetName(target) << " lane " << l;
      }
      if (target == simd::SupportedTargets().front()) first = bodies;
      EXPECT_EQ(std::memcmp(bodies.change, first.change, sizeof(first.change)), 0)
          << simd::TargetName(target);
    }
  }
}

// A top that turns about a principal axis turns on, and so does one that is a ball.
TYPED_TEST(Gyroscopic, LeavesWhatTurnsSteadilyAlone) {
  Gyroscopes<TypeParam> bodies;
  Put({{1, 2, 3}, {0, 0, 9}, Quaterniond::Identity()}, 0, &bodies);
  Put({{2, 2, 2}, {3, -4, 5}, Quaterniond::Identity()}, 1, &bodies);
  FindGyroscopicTerms(TypeParam(0.02), &bodies);
  EXPECT_EQ(ChangeOf(bodies, 0), Vector3d(0, 0, 0));
  EXPECT_LT(ChangeOf(bodies, 1).norm(), 20 * std::numeric_limits<TypeParam>::epsilon());
}

// The explicit step makes a spinning rod faster and faster.
TYPED_TEST(Gyroscopic, GainsNoEnergyInAThousandSteps) {
  const Vector3d moment(1, 1, 0.05);
  Top top{moment.cwiseInverse(), {0.3, 0.2, 20}, Quaterniond::Identity()};
  const auto energy = [&] {
    const Vector3d w = top.turn.conjugate() * top.spin;
    return w.dot(moment.cwiseProduct(w)) / 2;
  };
  const double before = energy();
  for (int step = 0; step < 1000; ++step) {
    Gyroscopes<TypeParam> bodies;
    Put(top, 0, &bodies);
    FindGyroscopicTerms(TypeParam(1 / 60.0), &bodies);
    top.spin += ChangeOf(bodies, 0);
    const double angle = top.spin.norm() / 60;
    top.turn = Quaterniond(Eigen::AngleAxisd(angle, top.spin.normalized())) * top.turn;
    top.turn.normalize();
  }
  EXPECT_LE(energy(), before * 1.0001);
  EXPECT_GT(energy(), before * 0.2);
}

TYPED_TEST(Gyroscopic, TakesAxesThatCannotTurn) {
  Gyroscopes<TypeParam> bodies;
  Put({{0, 0, 0}, {3, -4, 5}, Quaterniond::Identity()}, 0, &bodies);
  Put({{0, 2, 3}, {3, -4, 5}, Quaterniond::Identity()}, kLanes - 1, &bodies);
  FindGyroscopicTerms(TypeParam(0.02), &bodies);
  EXPECT_EQ(ChangeOf(bodies, 0), Vector3d(0, 0, 0));
  EXPECT_TRUE(ChangeOf(bodies, kLanes - 1).allFinite());
}

}  // namespace
}  // namespace cairn
