// SPDX-License-Identifier: MIT
#include "cairn/vector.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cstring>
#include <string>
#include <type_traits>

#include "cairn/contact_problem.h"
#include "cairn/detail/eigen.h"

namespace cairn {
namespace {

/// A vector as engines have it: floats, one of padding, operators that are no templates.
struct EngineVector {
  EngineVector(float x, float y, float z) : m{x, y, z, 0} {}
  float operator[](int i) const { return m[i]; }
  friend EngineVector operator-(const EngineVector& a, const EngineVector& b) {
    return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
  }
  float m[4];
};

template <class A, class B>
concept CanBeSubtracted = requires(const A& a, const B& b) {
  a - b;
};

template <class Type, int numbers>
constexpr bool IsPlain = sizeof(Type) == numbers * sizeof(double) &&
                         std::is_trivially_copyable_v<Type>&& std::is_standard_layout_v<Type>;
static_assert(IsPlain<Vector3, 3> && IsPlain<Matrix3, 9> && IsPlain<Velocity, 6>);

// What has another number of numbers, or does not say how many, is refused when it is compiled.
static_assert(!std::is_convertible_v<Eigen::Vector4d, Vector3>);
static_assert(!std::is_convertible_v<Eigen::Matrix3d, Vector3>);
static_assert(!std::is_convertible_v<Eigen::Vector3d, Matrix3>);
static_assert(!std::is_convertible_v<Vector3, Eigen::VectorXd>);
static_assert(!std::is_convertible_v<Vector3, Eigen::Matrix3d>);
static_assert(!std::is_convertible_v<Matrix3, Eigen::MatrixXd>);
static_assert(!std::is_convertible_v<double[2], Vector3>);
static_assert(!std::is_convertible_v<const float*, Vector3>);
static_assert(!std::is_convertible_v<std::string, Vector3>);
static_assert(!std::is_convertible_v<double, Vector3>);

// Nothing is computed in floats because of a conversion that nobody asked for.
static_assert(std::is_convertible_v<EngineVector, Vector3>);
static_assert(std::is_constructible_v<EngineVector, Vector3>);
static_assert(!std::is_convertible_v<Vector3, EngineVector>);
static_assert(!CanBeSubtracted<Vector3, Vector3>);

template <class V>
concept CanBeListed = requires(Eigen::Matrix<double, 6, 1>& six, const V& v) {
  six << v, v;
};
static_assert(CanBeListed<Eigen::Vector3d> && !CanBeListed<Vector3>);
template <class V>
concept CanBeListedLast = requires(Eigen::Matrix<double, 6, 1>& six, const V& v) {
  six << View(v), v;
};
static_assert(!CanBeListedLast<Vector3>);

TEST(Vector, IsThreeDoublesInMemory) {
  const double from[3] = {1, 2, 3};
  Vector3 v;
  EXPECT_EQ(v, Vector3(0, 0, 0));
  std::memcpy(&v, from, sizeof v);
  EXPECT_EQ(v, Vector3(1, 2, 3));
  v.y() = 7;
  v[2] = 8;
  EXPECT_EQ(v.x(), 1);
  EXPECT_EQ(v.data()[1], 7);
  EXPECT_EQ(v.z(), 8);
}

TEST(Vector, BecomesAndComesFromThoseOfEigen) {
  const Eigen::Vector3d e(1, 2, 3);
  const Eigen::Matrix3d m{{0, 1, 0}, {0, 0, 1}, {2, 0, 0}};
  Body body;
  body.velocity.linear = e;
  const Eigen::Vector3d back = body.velocity.linear;
  EXPECT_EQ(back, e);
  const Eigen::Vector3d constructed(body.velocity.linear);
  EXPECT_EQ(constructed, e);
  body.velocity = {.linear = m * e, .angular = e.cross(Eigen::Vector3d::UnitX())};
  EXPECT_EQ(body.velocity.linear, Vector3(2, 3, 2));
  EXPECT_EQ(body.velocity.angular, Vector3(0, 3, -2));
  body.impulse = m.row(2);
  EXPECT_EQ(body.impulse, Vector3(2, 0, 0));
  body.impulse = Eigen::VectorXd::LinSpaced(5, 0, 4).segment(1, 3);
  EXPECT_EQ(body.impulse, e);
}

TEST(Vector, ComesFromWhatEnginesHave) {
  const float floats[3] = {1, 2, 3};
  Vector3 v = floats;
  EXPECT_EQ(v, Vector3(1, 2, 3));
  v = EngineVector(4, 5, 6);
  EXPECT_EQ(v, Vector3(4, 5, 6));
  EXPECT_EQ((EngineVector(v) - EngineVector(1, 2, 2))[2], 4);
}

TEST(Matrix, IsNineDoublesColumnByColumn) {
  const double from[9] = {1, 2, 3, 4, 5, 6, 7, 8, 9};
  Matrix3 m;
  std::memcpy(&m, from, sizeof m);
  EXPECT_EQ(m(1, 0), 2);
  EXPECT_EQ(m(0, 2), 7);
  m(2, 1) = 0;
  EXPECT_EQ(m.data()[5], 0);
  const Matrix3 diagonal = Matrix3::Diagonal(1, 2, 3);
  EXPECT_EQ(diagonal(1, 1), 2);
  EXPECT_EQ(diagonal(1, 2), 0);
}

TEST(Matrix, BecomesAndComesFromThoseOfEigen) {
  const Eigen::Matrix3d e{{1, 2, 3}, {4, 5, 6}, {7, 8, 9}};
  Matrix3 m = e;
  EXPECT_EQ(m(0, 2), 3);
  const Eigen::Matrix3d back = m;
  EXPECT_EQ(back, e);
  m = e * e;
  EXPECT_EQ(m(0, 0), 30);
  m = Eigen::Vector3d(1, 2, 3).asDiagonal();
  EXPECT_EQ(m, Matrix3::Diagonal(1, 2, 3));
  m = Eigen::Matrix3d::Identity() / 2;
  EXPECT_EQ(m, Matrix3::Diagonal(0.5, 0.5, 0.5));
  const Eigen::Matrix<double, 3, 3, Eigen::RowMajor> rows = e;
  m = rows;
  EXPECT_EQ(m, Matrix3(e));
}

TEST(Vector, IsSeenByEigenWhereItIs) {
  Vector3 v(1, 2, 3);
  View(v) *= 2;
  EXPECT_EQ(v, Vector3(2, 4, 6));
  const Matrix3 m = Matrix3::Diagonal(1, 2, 3);
  EXPECT_EQ(Vector3(View(m) * View(v)), Vector3(2, 8, 18));
}

}  // namespace
}  // namespace cairn
