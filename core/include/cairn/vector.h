// SPDX-License-Identifier: MIT
#pragma once
#include "cairn/detail/cpp20.h"

#include "cairn/detail/numbers.h"

namespace cairn {

/// Three doubles and nothing else, x y z: memory may be copied. Vectors of other libraries become
/// one and come from one by themselves: those with v[0] to v[2], made by V(x, y, z), as Eigen's
/// are. Where that loses digits it has to be asked for: btVector3(v).
struct Vector3 : detail::Numbers3 {
  constexpr Vector3() = default;
  constexpr Vector3(double x, double y, double z) : Numbers3{{x, y, z}} {}
  constexpr Vector3(const detail::ReadableVector auto& v) { detail::ReadThree(v, data()); }
  template <detail::MadeOfThree V>
  constexpr explicit(detail::kLosesDigits<V>) operator V() const {
    return V(x(), y(), z());
  }
  friend bool operator==(const Vector3&, const Vector3&) = default;
};

/// Nine doubles and nothing else, column by column. Likewise: those with m(row, column).
struct Matrix3 {
  constexpr Matrix3() = default;
  constexpr Matrix3(const detail::ReadableMatrix auto& m) { detail::ReadNine(m, columns); }
  template <detail::MadeOfNine M>
  constexpr explicit(detail::kLosesDigits<M>) operator M() const {
    return detail::MakeNine<M>(columns);
  }
  static constexpr Matrix3 Diagonal(double x, double y, double z) {
    return Matrix3(detail::DiagonalOf{x, y, z});
  }
  constexpr double& operator()(int row, int column) { return columns[3 * column + row]; }
  constexpr double operator()(int row, int column) const { return columns[3 * column + row]; }
  constexpr double* data() { return columns; }
  constexpr const double* data() const { return columns; }
  friend bool operator==(const Matrix3&, const Matrix3&) = default;
  double columns[9] = {};
};

}  // namespace cairn
