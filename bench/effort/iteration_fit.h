// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>

namespace cairn::cli {

/// Finds, frame by frame, how many iterations of a solver without a clock fit into a budget: what
/// users do by hand, at its best.
class IterationFit {
 public:
  explicit IterationFit(std::chrono::nanoseconds budget) : budget_(budget) {}

  int iterations() const { return iterations_; }
  /// Learns what a frame with iterations() iterations took.
  void Learn(std::chrono::nanoseconds time);

 private:
  std::chrono::nanoseconds budget_;
  int iterations_ = 10;
};

}  // namespace cairn::cli
