// SPDX-License-Identifier: MIT
// How vectors and matrices of other libraries become ours, and ours theirs, without their headers.
#pragma once
#include "cairn/detail/cpp20.h"

#include <concepts>
#include <type_traits>
#include <utility>

namespace cairn::detail {

/// What an expression stands for, found once (Eigen's eval() and toDenseMatrix()); else itself.
template <class T>
constexpr decltype(auto) Value(const T& t) {
  if constexpr (requires { t.toDenseMatrix(); }) {
    return t.toDenseMatrix();
  } else if constexpr (requires { t.eval(); }) {
    return t.eval();
  } else {
    return (t);
  }
}

/// What a vector of three is, but for where it comes from.
struct Numbers3 {
  double xyz[3] = {};

  constexpr double& operator[](int i) { return xyz[i]; }
  constexpr double operator[](int i) const { return xyz[i]; }
  constexpr double& x() { return xyz[0]; }
  constexpr double& y() { return xyz[1]; }
  constexpr double& z() { return xyz[2]; }
  constexpr double x() const { return xyz[0]; }
  constexpr double y() const { return xyz[1]; }
  constexpr double z() const { return xyz[2]; }
  constexpr double* data() { return xyz; }
  constexpr const double* data() const { return xyz; }
  friend bool operator==(const Numbers3&, const Numbers3&) = default;
  /// Eigen's  six << a, b;  would leave out b without a word.
  template <class T>
  requires requires(T& t) { t.finished(); }
  friend void operator,(T&&, const Numbers3&) = delete;
};

/// How many numbers an array has, or a class says to have; -1: it does not say.
template <class T>
constexpr int Count() {
  if constexpr (requires { T::SizeAtCompileTime; }) {
    return T::SizeAtCompileTime;
  } else {
    return std::is_array_v<T> ? static_cast<int>(std::extent_v<T>) : -1;
  }
}

template <class T, int n>
concept MayHold = (std::is_class_v<T> || std::is_array_v<T>)&&(Count<T>() == n || Count<T>() == -1);

/// Has v[0], v[1] and v[2].
template <class T>
concept ReadableVector = MayHold<T, 3> && requires(const T& t) {
  requires std::floating_point<std::remove_cvref_t<decltype(t[0])>>;
};

/// Is made of three numbers, and has room for them, or for four with one of padding.
template <class T>
concept MadeOfThree = ReadableVector<T> && requires(const T& t) {
  T(1.0, 2.0, 3.0);
  requires sizeof(T) == 3 * sizeof(t[0]) || sizeof(T) == 4 * sizeof(t[0]);
};

/// Has m(row, column), or stands for something that has.
template <class T>
concept ReadableMatrix = MayHold<T, 9> && requires(const T& t) {
  requires std::floating_point<std::remove_cvref_t<decltype(Value(t)(0, 0))>>;
};

/// Has room for nine numbers, which m(row, column) can write.
template <class T>
concept MadeOfNine = MayHold<T, 9> && std::default_initializable<T> && requires(T& t) {
  t(0, 0) = 1.0;
  requires sizeof(T) == 9 * sizeof(t(0, 0));
};

/// Of a vector or matrix: its numbers are smaller than a double.
template <class T>
inline constexpr bool kLosesDigits = true;
template <MadeOfThree T>
inline constexpr bool kLosesDigits<T> = sizeof(std::declval<const T&>()[0]) < sizeof(double);
template <MadeOfNine T>
inline constexpr bool kLosesDigits<T> = sizeof(std::declval<T&>()(0, 0)) < sizeof(double);

constexpr void ReadThree(const ReadableVector auto& v, double* to) {
  const auto& from = Value(v);
  for (int i = 0; i < 3; ++i) to[i] = from[i];
}

constexpr void ReadNine(const ReadableMatrix auto& m, double* columns) {
  const auto& from = Value(m);
  for (int i = 0; i < 9; ++i) columns[i] = from(i % 3, i / 3);
}

template <MadeOfNine M>
constexpr M MakeNine(const double* columns) {
  M m;
  for (int i = 0; i < 9; ++i) m(i % 3, i / 3) = columns[i];
  return m;
}

/// A matrix that is read.
struct DiagonalOf {
  double entries[3];
  constexpr double operator()(int row, int column) const {
    return row == column ? entries[row] : 0;
  }
};

}  // namespace cairn::detail
