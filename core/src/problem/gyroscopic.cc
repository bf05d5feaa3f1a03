// SPDX-License-Identifier: MIT
#include "cairn/detail/gyroscopic.h"

#include "simd/gyroscopic.h"

namespace cairn {
namespace {

template <class Scalar>
void Find(simd::GyroscopicKernel<Scalar> kernel, Scalar time_step, Gyroscopes<Scalar>* bodies) {
  static_assert(Gyroscopes<Scalar>::kMost == simd::kLanes);
  kernel(time_step, bodies->inv_moment, bodies->turn, bodies->spin, bodies->change);
}

/// Chosen once for all: bits do not depend on it.
const simd::GyroscopicKernels& Kernels() {
  static const simd::GyroscopicKernels& kKernels = simd::GyroscopicKernelsFor(simd::ChosenTarget());
  return kKernels;
}

}  // namespace

void FindGyroscopicTerms(float time_step, Gyroscopes<float>* bodies) {
  Find(Kernels().of_floats, time_step, bodies);
}

void FindGyroscopicTerms(double time_step, Gyroscopes<double>* bodies) {
  Find(Kernels().of_doubles, time_step, bodies);
}

}  // namespace cairn
