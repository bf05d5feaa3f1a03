// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <vector>

namespace cairn::cli {

/// Times a chain of `length` dependent multiplications and additions: nothing but the clock of the
/// CPU, and who else wants it, decides how long that takes [ms].
double TimeChain(int length);

/// The same small piece of work, over and over, beside what is measured: if it takes longer, so
/// does everything. Takes about 0.1 ms and the same number of instructions in every process.
class Metronome {
 public:
  Metronome();

  /// Does the work. Time it took [ms].
  double Beat();

 private:
  std::vector<float> values_;  ///< What a solver has of a small scene, in size.
  std::vector<int> order_;
};

}  // namespace cairn::cli
