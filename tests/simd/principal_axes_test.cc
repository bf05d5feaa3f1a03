// SPDX-License-Identifier: MIT
// Principal axes against Eigen's eigenvalues, on every target with the same bits.
#include "simd/principal_axes.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <Eigen/Eigenvalues>
#include <cmath>
#include <cstring>
#include <limits>
#include <random>
#include <vector>

#include "simd/target.h"

namespace cairn::simd {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kRounding = std::numeric_limits<double>::epsilon();

Matrix3d Turned(const Vector3d& moments, const Eigen::Quaterniond& turn) {
  const Matrix3d axes = turn.normalized().toRotationMatrix();
  const Matrix3d product = axes * moments.asDiagonal() * axes.transpose();
  return 0.5 * (product + product.transpose());
}

void Put(const Matrix3d& matrix, int lane, PrincipalAxes* lanes) {
  for (int column = 0, k = 0; column < 3; ++column) {
    for (int row = column; row < 3; ++row) lanes->matrix[k++][lane] = matrix(row, column);
  }
}

Vector3d Moments(const PrincipalAxes& lanes, int lane) {
  return {lanes.moment[0][lane], lanes.moment[1][lane], lanes.moment[2][lane]};
}

Matrix3d Axes(const PrincipalAxes& lanes, int lane) {
  Matrix3d axes;
  for (int k = 0; k < 9; ++k) axes(k % 3, k / 3) = lanes.axis[k][lane];
  return axes;
}

/// Ascending, unit, at right angles, and the matrix again.
void ExpectAxesOf(const Matrix3d& matrix, const PrincipalAxes& lanes, int lane) {
  const Vector3d moments = Moments(lanes, lane);
  const Matrix3d axes = Axes(lanes, lane);
  const double size = matrix.norm();
  EXPECT_LE(moments[0], moments[1]);
  EXPECT_LE(moments[1], moments[2]);
  EXPECT_LE((axes.transpose() * axes - Matrix3d::Identity()).norm(), 20 * kRounding);
  EXPECT_LE((axes * moments.asDiagonal() * axes.transpose() - matrix).norm(),
            20 * kRounding * size);
  const Eigen::SelfAdjointEigenSolver<Matrix3d> expected(matrix);
  EXPECT_LE((moments - expected.eigenvalues()).norm(), 20 * kRounding * size);
}

void ExpectOnEveryTarget(const std::vector<Matrix3d>& matrices) {
  ASSERT_LE(matrices.size(), static_cast<size_t>(kLanes));
  PrincipalAxes first;
  for (const Target target : SupportedTargets()) {
    SCOPED_TRACE(TargetName(target));
    PrincipalAxes lanes;
    for (size_t l = 0; l < matrices.size(); ++l) Put(matrices[l], static_cast<int>(l), &lanes);
    PrincipalAxesKernelFor(target)(&lanes);
    for (size_t l = 0; l < matrices.size(); ++l) {
      SCOPED_TRACE(l);
      ExpectAxesOf(matrices[l], lanes, static_cast<int>(l));
    }
    if (target == SupportedTargets().front()) first = lanes;
    EXPECT_EQ(std::memcmp(&lanes, &first, sizeof(lanes)), 0);
  }
}

TEST(PrincipalAxes, AreThoseOfEigen) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> number(-1, 1);
  for (int round = 0; round < 200; ++round) {
    std::vector<Matrix3d> matrices;
    for (int l = 0; l < kLanes; ++l) {
      const Vector3d powers(number(random), number(random), number(random));
      const Eigen::Quaterniond turn(number(random), number(random), number(random), number(random));
      matrices.push_back(Turned((4 * powers).array().exp(), turn));
    }
    ExpectOnEveryTarget(matrices);
  }
}

TEST(PrincipalAxes, OfBallsRodsAndWhatIsTurnedAlready) {
  const Eigen::Quaterniond turn(0.4, -0.2, 0.7, 0.1), little(1, 1e-9, -1e-9, 0);
  ExpectOnEveryTarget({Matrix3d::Zero(), Matrix3d::Identity(), Turned({2, 2, 2}, turn),
                       Turned({2, 2, 2 + 1e-15}, turn), Turned({0, 5, 5}, turn),
                       Turned({0, 0, 5}, turn), Vector3d(3, 1, 2).asDiagonal(),
                       Turned({1, 2, 3}, little), 1e20 * Turned({1, 2, 3}, turn),
                       1e-20 * Turned({1, 2, 3}, turn), Turned({1e-9, 1, 1e9}, turn)});
}

TEST(PrincipalAxes, OfALaneDoNotDependOnTheOthers) {
  const Matrix3d matrix = Turned({1, 2, 4}, {0.4, -0.2, 0.7, 0.1});
  for (const Target target : SupportedTargets()) {
    PrincipalAxes alone, beside;
    for (int l = 0; l < kLanes; ++l) {
      const double angle = 0.3 * l;
      Put(Turned({1.0 + l, 2, 4e5}, {1, angle, -angle, 2}), l, &beside);
    }
    Put(Matrix3d::Constant(std::numeric_limits<double>::quiet_NaN()), 6, &beside);
    for (PrincipalAxes* lanes : {&alone, &beside}) {
      Put(matrix, 5, lanes);
      PrincipalAxesKernelFor(target)(lanes);
    }
    EXPECT_EQ(Moments(alone, 5), Moments(beside, 5));
    EXPECT_EQ(Axes(alone, 5), Axes(beside, 5));
    EXPECT_FALSE(Moments(beside, 6).allFinite()) << TargetName(target);
  }
}

// Rounds that other lanes need add zeros to what is done, so that a negative one might or might not
// stay.
TEST(PrincipalAxes, HaveNoNegativeZeros) {
  const double zero = -0.0;
  const Matrix3d locked = (Matrix3d() << zero, 0, 0, 0, 1, zero, 0, zero, 2).finished();
  for (const Target target : SupportedTargets()) {
    PrincipalAxes lanes;
    for (int l = 0; l < kLanes; ++l) Put(locked, l, &lanes);
    PrincipalAxesKernelFor(target)(&lanes);
    EXPECT_EQ(Moments(lanes, 2), Vector3d(0, 1, 2));
    for (const auto& moment : lanes.moment) EXPECT_FALSE(std::signbit(moment[2]));
    for (const auto& axis : lanes.axis) EXPECT_FALSE(std::signbit(axis[2])) << TargetName(target);
  }
}

}  // namespace
}  // namespace cairn::simd
