// SPDX-License-Identifier: MIT
#pragma once
#include "cairn/detail/cpp20.h"

#include <span>
#include <string>

namespace cairn {

struct ContactOptions;
struct Touch;
struct TouchPoint;
struct JointAxis;
struct JointKind;
struct JointSide;
struct JointGear;

namespace detail {

/// A value that helpers for engines refuse.
struct BadValue {
  const char* argument = "";   ///< Of the function, "points" say; empty: what it was called on.
  int index = -1;              ///< In it; -1: it is no array.
  const char* field = "";      ///< Of it.
  double value = 0;            ///< What it is,
  const char* rule = nullptr;  ///< and what it must be; nullptr: nothing is bad.
  bool names_body = false;     ///< It is the number of a body.

  explicit operator bool() const { return rule != nullptr; }
};

/// "points[2].depth is nan, must be finite"; "" if nothing is bad.
std::string Describe(const BadValue& bad);

/// The first value that is out of its range; ranges are those of contacts.h and joints.h.
BadValue FindBad(const ContactOptions& options, const char* argument);
/// @param field  what it is called: an erp
BadValue FindBadErp(double erp, const char* field);
/// @param bodies  of the step: how many there are
BadValue FindBad(const Touch& touch, std::span<const TouchPoint> points, int bodies);
BadValue FindBad(const JointKind& kind, const JointSide& a, const JointSide& b, int bodies);
BadValue FindBad(const JointAxis& length, const JointSide& a, const JointSide& b, int bodies);
BadValue FindBad(const JointGear& a, const JointGear& b, int bodies);

}  // namespace detail
}  // namespace cairn
