// SPDX-License-Identifier: MIT
#pragma once

namespace cairn::micro {

/// Multiplications and additions per second of one thread, as many of one as of the other and never
/// fused: what our kernels could do at most.
struct Peak {
  double double_flops, float_flops;
};

/// Measured with the best registers of simd::BestTarget(); takes some tenths of a second.
Peak MeasurePeak();

}  // namespace cairn::micro
