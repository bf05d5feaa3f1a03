// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace cairn::cli {

/// Times a chain of `length` dependent multiplications and additions: nothing but the clock of the
/// CPU, and who else wants it, decides how long that takes [ms].
double TimeChain(int length);

/// The same two small pieces of work, over and over, beside what is measured: if they take longer,
/// so does everything. The same number of instructions in every process.
class Metronome {
 public:
  Metronome();

  struct Beat {
    double arithmetic = 0;  ///< A chain in registers: the clock of the core [ms].
    double memory = 0;      ///< Reads beyond the caches of the core: who else uses them [ms].
  };
  /// Does the work; takes about 0.03 ms.
  Beat Strike();

 private:
  std::vector<float> values_;
  std::uint32_t state_ = 1;
};

}  // namespace cairn::cli
