// SPDX-License-Identifier: MIT
#include "input.h"

#include <array>
#include <charconv>
#include <cmath>

#include "cairn/contact_problem.h"
#include "cairn/strict.h"

namespace cairn::c {
namespace {

/// Looks at one value after another, and keeps the first that is bad.
class Inspector {
 public:
  explicit Inspector(CairnStatus refusal = cairnBadInput) : refusal_(refusal) {}

  /// What the next fields are of.
  void Enter(const char* argument, int index = -1) {
    argument_ = argument;
    index_ = index;
  }
  void Want(bool good, const char* field, double value, const char* rule) {
    if (!good) Refuse(refusal_, field, value, rule);
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
  void WantBody(const char* field, int body, int bodies) {
    if (body < kWorld || body >= bodies) {
      Refuse(cairnNoSuchBody, field, body, "CAIRN_WORLD, or below bodyCount");
    }
  }
  void WantOther(const char* field, int body, int other) {
    if (body == other) Refuse(cairnNoSuchBody, field, body, "another body than the first");
  }

  BadInput bad;

 private:
  void Refuse(CairnStatus status, const char* field, double value, const char* rule) {
    if (bad.status == cairnOk) bad = {status, argument_, index_, field, value, rule};
  }

  const CairnStatus refusal_;
  const char* argument_ = "";
  int index_ = -1;
};

void Inspect(const CairnContactOptions& options, Inspector* inspector) {
  inspector->WantAtLeast0("slop", options.slop);
  inspector->WantShare("erp", options.erp);
  inspector->WantAtLeast0("maxPush", options.maxPush);
  inspector->WantAtLeast0("maxGap", options.maxGap);
  inspector->WantAtLeast0("minBounce", options.minBounce);
  inspector->WantFiniteAtLeast0("frequency", options.frequency);
  inspector->WantFiniteAtLeast0("dampingRatio", options.dampingRatio);
}

void Inspect(const CairnJointAxis& axis, Inspector* inspector) {
  inspector->Want(axis.lo < kInfinity, "lo", axis.lo, "a number below infinity");
  inspector->Want(axis.hi > -kInfinity, "hi", axis.hi, "a number above -infinity");
  inspector->Want(axis.lo <= axis.hi, "lo", axis.lo, "at most hi");
  inspector->WantFinite("speed", axis.speed);
  inspector->WantAtLeast0("maxMotorForce", axis.maxMotorForce);
  inspector->WantFinite("rest", axis.rest);
  inspector->WantFiniteAtLeast0("frequency", axis.frequency);
  inspector->WantFiniteAtLeast0("dampingRatio", axis.dampingRatio);
  inspector->Want(axis.maxSpringForce > 0, "maxSpringForce", axis.maxSpringForce, "above 0");
}

void InspectSide(const char* name, const CairnJointSide& side, int bodies, Inspector* inspector) {
  inspector->Enter(name);
  inspector->WantBody("body", side.body, bodies);
  if (side.body != kWorld) inspector->WantFinite("centre", side.centre);
  inspector->WantFinite("anchor", side.anchor);
  for (const auto& axis : side.axes) inspector->WantFinite("axes", axis);
}

void InspectSides(const CairnJointSide& a, const CairnJointSide& b, int bodies,
                  Inspector* inspector) {
  InspectSide("a", a, bodies, inspector);
  InspectSide("b", b, bodies, inspector);
  inspector->WantOther("body", b.body, a.body);
}

}  // namespace

std::string Describe(const BadInput& bad) {
  if (bad.status == cairnOk) return "";
  if (*bad.field == '\0') return cairnDescribe(bad.status);
  std::array<char, 32> text;
  const auto [end, error] = std::to_chars(text.data(), text.data() + text.size(), bad.value);
  const std::string value(text.data(), end);
  const std::string field(bad.field);
  if (*bad.argument == '\0') return Describe(Finding{field, -1, "", value, bad.rule});
  return Describe(Finding{bad.argument, bad.index, field, value, bad.rule});
}

BadInput FindBadOptions(const CairnContactOptions& options) {
  Inspector inspector(cairnBadSettings);
  Inspect(options, &inspector);
  return inspector.bad;
}

BadInput FindBadSettings(const CairnFrameSettings& settings) {
  Inspector inspector(cairnBadSettings);
  inspector.WantShare("jointErp", settings.jointErp);
  inspector.Enter("contacts");
  Inspect(settings.contacts, &inspector);
  return inspector.bad;
}

BadInput FindBadStep(const CairnStep& step) {
  Inspector inspector;
  inspector.Enter("step");
  inspector.Want(step.timeStep > 0 && std::isfinite(step.timeStep), "timeStep", step.timeStep,
                 "finite, above 0");
  inspector.Want(step.substeps >= 1 && step.substeps <= 64, "substeps", step.substeps, "1 to 64");
  return inspector.bad;
}

BadInput FindBadTouch(const CairnTouch& touch, std::span<const CairnTouchPoint> points,
                      int bodies) {
  Inspector inspector;
  inspector.Enter("touch");
  inspector.WantBody("bodyA", touch.bodyA, bodies);
  inspector.WantBody("bodyB", touch.bodyB, bodies);
  inspector.WantOther("bodyB", touch.bodyB, touch.bodyA);
  if (touch.bodyA != kWorld) inspector.WantFinite("centreA", touch.centreA);
  if (touch.bodyB != kWorld) inspector.WantFinite("centreB", touch.centreB);
  inspector.WantFinite("normal", touch.normal);
  inspector.WantFiniteAtLeast0("friction", touch.friction);
  inspector.WantFiniteAtLeast0("restitution", touch.restitution);
  for (size_t i = 0; i < points.size(); ++i) {
    inspector.Enter("points", static_cast<int>(i));
    inspector.WantFinite("position", points[i].position);
    inspector.WantFinite("depth", points[i].depth);
  }
  return inspector.bad;
}

BadInput FindBadJoint(const CairnJointKind& kind, const CairnJointSide& a, const CairnJointSide& b,
                      int bodies) {
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

BadInput FindBadDistance(const CairnJointAxis& length, const CairnJointSide& a,
                         const CairnJointSide& b, int bodies) {
  Inspector inspector;
  inspector.Enter("length");
  Inspect(length, &inspector);
  InspectSides(a, b, bodies, &inspector);
  return inspector.bad;
}

BadInput FindBadGear(const CairnJointGear& a, const CairnJointGear& b, int bodies) {
  Inspector inspector;
  for (const CairnJointGear* gear : {&a, &b}) {
    inspector.Enter(gear == &a ? "a" : "b");
    inspector.WantFinite("angle", gear->angle);
    inspector.Want(gear->teeth != 0, "teeth", gear->teeth, "another number than 0");
  }
  InspectSide("a.side", a.side, bodies, &inspector);
  InspectSide("b.side", b.side, bodies, &inspector);
  inspector.WantOther("body", b.side.body, a.side.body);
  return inspector.bad;
}

}  // namespace cairn::c
