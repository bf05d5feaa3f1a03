// SPDX-License-Identifier: MIT
// What the helpers of C refuse, beside what those of C++ do.
#pragma once

#include <string>

#include "cairn/cairn_helpers.h"
#include "cairn/contacts.h"
#include "cairn/detail/bad_value.h"

namespace cairn::c {

/// Why a call did nothing.
struct Refusal {
  CairnStatus status = cairnOk;  ///< cairnOk: it was not refused.
  detail::BadValue bad;          ///< None: the status says all there is to say.
};

/// @param status  of what is bad, but is no body
Refusal RefusalOf(const detail::BadValue& bad, CairnStatus status);

/// "points[2].depth is nan, must be finite", in names of C; "" if nothing was refused.
std::string Describe(const Refusal& refusal);

Refusal FindBadSettings(const CairnFrameSettings& settings);
Refusal FindBadStep(const CairnStep& step);

}  // namespace cairn::c
