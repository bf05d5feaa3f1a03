// SPDX-License-Identifier: MIT
#pragma once
#include "cairn/detail/cpp20.h"

#include "cairn/lcp/problem.h"

namespace cairn {

using lcp::BoxedLcp;
using lcp::LcpResidual;
using lcp::MixedLcp;

}  // namespace cairn
