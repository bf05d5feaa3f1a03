// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <cstdint>
#include <limits>
#include <span>

namespace cairn::test {

/// Bytes read as decisions. When they are used up every decision is 0, so that the beginning of an
/// input means the same whatever follows it.
class Choices {
 public:
  explicit Choices(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}

  bool empty() const { return at_ == bytes_.size(); }
  int Byte() { return at_ < bytes_.size() ? bytes_[at_++] : 0; }
  /// In [0, count), count <= 256.
  int Below(int count) { return Byte() % count; }
  /// True once in so many times, and never when nothing is left.
  bool OneIn(int times) { return Byte() % times == times - 1; }
  /// In [-1, 1], often a round number.
  double Unit() {
    const int byte = Byte();
    if (byte < 16) return byte < 8 ? 0 : byte < 12 ? 1 : -1;
    return (byte - 128 + Byte() / 256.0) / 128;
  }

 private:
  std::span<const std::uint8_t> bytes_;
  std::size_t at_ = 0;
};

/// Numbers over some decades, and what is no number at all.
class Numbers {
 public:
  /// @p choices must outlive it.
  explicit Numbers(Choices* choices) : choices_(*choices) {
    constexpr int kDecades[] = {0, 0, 0, 1, 3, 6, 12, 25, 50, 160, 307};
    decades_ = kDecades[choices_.Below(11)];
    has_bad_ = choices_.OneIn(8);
  }
  int decades() const { return decades_; }

  double Real() {
    if (has_bad_ && choices_.OneIn(32)) return Bad();
    const double unit = choices_.Unit();
    if (decades_ == 0 || choices_.Below(2) == 0) return unit;
    return unit * std::pow(10.0, decades_ * choices_.Unit());
  }
  double Positive() { return std::abs(Real()); }
  float Float() { return static_cast<float>(Real()); }
  float PositiveFloat() { return static_cast<float>(Positive()); }

 private:
  double Bad() {
    constexpr double kEndless = std::numeric_limits<double>::infinity();
    const double bad[] = {std::numeric_limits<double>::quiet_NaN(), kEndless, -kEndless, -1,
                          std::numeric_limits<double>::max(),       5e-324,   -0.0};
    return bad[choices_.Below(7)];
  }

  Choices& choices_;
  int decades_;
  bool has_bad_;
};

}  // namespace cairn::test
