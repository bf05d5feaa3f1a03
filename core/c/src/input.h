// SPDX-License-Identifier: MIT
// What the helpers of C refuse: ranges are those of cairn_helpers.h.
#pragma once

#include <span>
#include <string>

#include "cairn/cairn_helpers.h"

namespace cairn::c {

/// The first value that is out of its range, if any.
struct BadInput {
  CairnStatus status = cairnOk;  ///< cairnOk: none is.
  const char* argument = "";     ///< "points", say; empty: a field of the only one.
  int index = -1;                ///< in it; -1: it is no array
  const char* field = "";        ///< Empty: the status says all there is to say.
  double value = 0;
  const char* rule = "";
};

/// "points[2].depth is nan, must be finite"; "" if there is none.
std::string Describe(const BadInput& bad);

BadInput FindBadOptions(const CairnContactOptions& options);
BadInput FindBadSettings(const CairnFrameSettings& settings);
BadInput FindBadStep(const CairnStep& step);

/// @param bodies  of the step: how many there are
BadInput FindBadTouch(const CairnTouch& touch, std::span<const CairnTouchPoint> points, int bodies);
BadInput FindBadJoint(const CairnJointKind& kind, const CairnJointSide& a, const CairnJointSide& b,
                      int bodies);
BadInput FindBadDistance(const CairnJointAxis& length, const CairnJointSide& a,
                         const CairnJointSide& b, int bodies);
BadInput FindBadGear(const CairnJointGear& a, const CairnJointGear& b, int bodies);

}  // namespace cairn::c
