// SPDX-License-Identifier: MIT
#include "cairn/detail/bad_value.h"

#include <array>
#include <charconv>
#include <cmath>

#include "cairn/joints.h"
#include "cairn/strict.h"

namespace cairn::detail {
namespace {

/// Looks at one value after another, and keeps the first that is bad.
class Inspector {
 public:
  /// What the next fields are of.
  void Enter(const char* argument, int index = -1) {
    argument_ = argument;
    index_ = index;
  }
  void Want(bool good, const char* field, double value, const char* rule) {
    if (!good && !bad) bad = {argument_, index_, field, value, rule};
  }
  void WantFinite(const char* field, double value) {
    Want(std::isfinite(value), field, value, "finite");
  }
  void WantFinite(const char* field, std::span<const double> values) {
    for (const double value : values) WantFinite(field, value);
  }
  void WantAtLeast0(const char* field, double value) {
    Want(value >= 0, field, value, "0 or more");
  }
  void WantFiniteAtLeast0(const char* field, double value) {
    Want(value >= 0 && std::isfinite(value), field, value, "finite, 0 or more");
  }
  void WantShare(const char* field, double value) {
    Want(value >= 0 && value <= 1, field, value, "0 to 1");
  }
  /// @param most  bodies that there are
  void WantBody(const char* field, int body, int most) {
    WantAsBody(body >= kWorld && body < most, field, body,
               "-1 for the world, or below the count of bodies");
  }
  void WantOther(const char* field, int body, int other) {
    WantAsBody(body != other, field, body, "another body than the first");
  }

  BadValue bad;

 private:
  void WantAsBody(bool good, const char* field, int body, const char* rule) {
    if (!good && !bad) bad = {argument_, index_, field, static_cast<double>(body), rule, true};
  }

  const char* argument_ = "";
  int index_ = -1;
};

std::span<const double> Numbers(const Vector3& vector) { return {vector.data(), 3}; }

void Inspect(const JointAxis& axis, Inspector* inspector) {
  inspector->Want(axis.lo < kInfinity, "lo", axis.lo, "a number below infinity");
  inspector->Want(axis.hi > -kInfinity, "hi", axis.hi, "a number above -infinity");
  inspector->Want(axis.lo <= axis.hi, "lo", axis.lo, "at most hi");
  inspector->WantFinite("speed", axis.speed);
  inspector->WantAtLeast0("max_motor_force", axis.max_motor_force);
  inspector->WantFinite("rest", axis.rest);
  inspector->WantFiniteAtLeast0("frequency", axis.frequency);
  inspector->WantFiniteAtLeast0("damping_ratio", axis.damping_ratio);
  inspector->Want(axis.max_spring_force > 0, "max_spring_force", axis.max_spring_force, "above 0");
}

void InspectSide(const char* name, const JointSide& side, int bodies, Inspector* inspector) {
  inspector->Enter(name);
  inspector->WantBody("body", side.body, bodies);
  if (side.body != kWorld) inspector->WantFinite("centre", Numbers(side.centre));
  inspector->WantFinite("anchor", Numbers(side.anchor));
  inspector->WantFinite("axes", {side.axes.data(), 9});
}

void InspectSides(const JointSide& a, const JointSide& b, int bodies, Inspector* inspector) {
  InspectSide("a", a, bodies, inspector);
  InspectSide("b", b, bodies, inspector);
  inspector->WantOther("body", b.body, a.body);
}

}  // namespace

std::string Describe(const BadValue& bad) {
  if (!bad) return "";
  std::array<char, 32> text;
  const auto [end, error] = std::to_chars(text.data(), text.data() + text.size(), bad.value);
  const std::string value(text.data(), end);
  if (*bad.argument == '\0') return Describe(Finding{bad.field, -1, "", value, bad.rule});
  return Describe(Finding{bad.argument, bad.index, bad.field, value, bad.rule});
}

BadValue FindBad(const ContactOptions& options, const char* argument) {
  Inspector inspector;
  inspector.Enter(argument);
  inspector.WantAtLeast0("slop", options.slop);
  inspector.WantShare("erp", options.erp);
  inspector.WantAtLeast0("max_push", options.max_push);
  inspector.WantAtLeast0("max_gap", options.max_gap);
  inspector.WantAtLeast0("min_bounce", options.min_bounce);
  inspector.WantFiniteAtLeast0("frequency", options.frequency);
  inspector.WantFiniteAtLeast0("damping_ratio", options.damping_ratio);
  return inspector.bad;
}

BadValue FindBadErp(double erp, const char* field) {
  Inspector inspector;
  inspector.WantShare(field, erp);
  return inspector.bad;
}

BadValue FindBad(const Touch& touch, std::span<const TouchPoint> points, int bodies) {
  Inspector inspector;
  inspector.Enter("touch");
  inspector.WantBody("body_a", touch.body_a, bodies);
  inspector.WantBody("body_b", touch.body_b, bodies);
  inspector.WantOther("body_b", touch.body_b, touch.body_a);
  if (touch.body_a != kWorld) inspector.WantFinite("centre_a", Numbers(touch.centre_a));
  if (touch.body_b != kWorld) inspector.WantFinite("centre_b", Numbers(touch.centre_b));
  inspector.WantFinite("normal", Numbers(touch.normal));
  inspector.WantFiniteAtLeast0("friction", touch.friction);
  inspector.WantFiniteAtLeast0("restitution", touch.restitution);
  for (size_t i = 0; i < points.size(); ++i) {
    inspector.Enter("points", static_cast<int>(i));
    inspector.WantFinite("position", Numbers(points[i].position));
    inspector.WantFinite("depth", points[i].depth);
  }
  return inspector.bad;
}

BadValue FindBad(const JointKind& kind, const JointSide& a, const JointSide& b, int bodies) {
  Inspector inspector;
  for (int i = 0; i < 3; ++i) {
    inspector.Enter("kind.linear", i);
    Inspect(kind.linear[i], &inspector);
  }
  inspector.Enter("kind.twist");
  Inspect(kind.twist, &inspector);
  inspector.Enter("kind");
  inspector.WantAtLeast0("cone", kind.cone);
  InspectSides(a, b, bodies, &inspector);
  return inspector.bad;
}

BadValue FindBad(const JointAxis& length, const JointSide& a, const JointSide& b, int bodies) {
  Inspector inspector;
  inspector.Enter("length");
  Inspect(length, &inspector);
  InspectSides(a, b, bodies, &inspector);
  return inspector.bad;
}

BadValue FindBad(const JointGear& a, const JointGear& b, int bodies) {
  Inspector inspector;
  for (const JointGear* gear : {&a, &b}) {
    inspector.Enter(gear == &a ? "a" : "b");
    inspector.WantFinite("angle", gear->angle);
    inspector.Want(gear->teeth != 0, "teeth", gear->teeth, "another number than 0");
  }
  InspectSide("a.side", a.side, bodies, &inspector);
  InspectSide("b.side", b.side, bodies, &inspector);
  inspector.WantOther("body", b.side.body, a.side.body);
  return inspector.bad;
}

}  // namespace cairn::detail
