// SPDX-License-Identifier: MIT
#include "cairn/strict.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <initializer_list>
#include <string_view>

#include "cairn/detail/eigen.h"
#include "problem/islands.h"
#include "problem/validate.h"

namespace cairn {
namespace {

using Eigen::Vector3f;

/// Lengths and angles of unit vectors may be off by so much.
constexpr float kUnitError = 1e-3f;

/// The shortest text that means this number, in any locale.
template <class Number>
std::string Text(Number number) {
  std::array<char, 32> text;
  const auto [end, error] = std::to_chars(text.begin(), text.end(), number);
  return {text.begin(), end};
}

std::string Join(std::initializer_list<std::string_view> parts) {
  std::string text;
  for (const std::string_view part : parts) text.append(part);
  return text;
}

template <class Vector>
std::string TextOf(const Vector& v) {
  return Join({"(", Text(v[0]), ", ", Text(v[1]), ", ", Text(v[2]), ")"});
}

Vector3f ToVector(const float* from) { return {from[0], from[1], from[2]}; }

bool Finite(const Vector3f& v) { return (0 * v).isZero(0); }
bool Finite(const auto& of) { return (0 * View(of)).isZero(0); }

/// Looks at a problem whose spans fit one another.
class Inspector {
 public:
  Inspector(const ContactProblem& problem, const Impulses& impulses, int most)
      : problem_(problem), impulses_(impulses), most_(most) {}

  void Inspect() {
    Each("bodies", problem_.bodies, [this](const Body& body) { InspectBody(body); });
    InspectNames();
    Each("rows", problem_.rows, [this](const Row& row) { InspectRow(row); });
    InspectJoints();
    InspectManifolds();
  }

  std::vector<Finding> findings;

 private:
  template <class Item, class Function>
  void Each(const char* array, std::span<const Item> items, const Function& function) {
    for (size_t i = 0; i < items.size() && !full(); ++i) {
      Enter(array, static_cast<int>(i));
      function(items[i]);
    }
  }

  void Enter(const char* array, int index) {
    array_ = array;
    index_ = index;
  }
  bool full() const { return static_cast<int>(findings.size()) >= most_; }
  void Add(std::string_view field, std::string value, std::string_view rule) {
    if (full()) return;
    findings.push_back({array_, index_, std::string(field), std::move(value), std::string(rule)});
  }
  void Expect(bool good, std::string_view field, double value, std::string_view rule) {
    if (!good) Add(field, Text(value), rule);
  }
  template <class Number>
  void ExpectFinite(std::string_view field, Number value) {
    if (!(0 * value == 0)) Add(field, Text(value), "finite");
  }
  template <class Vector>
  void ExpectFiniteVector(std::string_view field, const Vector& v) {
    if (!Finite(v)) Add(field, TextOf(v), "finite");
  }
  template <class Number>
  void ExpectNotNegative(std::string_view field, Number value) {
    if (!(value >= 0 && 0 * value == 0)) Add(field, Text(value), "0 or more");
  }

  void InspectBody(const Body& body);
  void InspectNames();
  void InspectRow(const Row& row);
  void InspectJoints();
  void InspectJointRow(const Joint& joint, int place);
  void InspectManifolds();
  void InspectPoint(const Manifold& manifold, int index);
  void InspectDirections(const ContactPoint& point);
  void InspectTwist(int index);
  bool InspectPair(int a, int b);
  bool InspectRange(std::string_view first_field, int first, int count, size_t size,
                    std::vector<char>* taken);

  bool moves(int body) const { return body != kWorld && CanMove(problem_.bodies[body]); }

  const ContactProblem& problem_;
  const Impulses& impulses_;
  int most_;
  const char* array_ = "";
  int index_ = -1;
};

void Inspector::InspectBody(const Body& body) {
  ExpectNotNegative("inv_mass", body.inv_mass);
  ExpectFiniteVector("velocity.linear", body.velocity.linear);
  ExpectFiniteVector("velocity.angular", body.velocity.angular);
  ExpectFiniteVector("impulse", body.impulse);
  ExpectFiniteVector("angular_impulse", body.angular_impulse);
  if (!Finite(body.linear_factor) || View(body.linear_factor).minCoeff() < 0) {
    Add("linear_factor", TextOf(body.linear_factor), "three numbers of 0 or more");
  }
  Eigen::Matrix3d factor;
  if (!Finite(body.inv_inertia) || !FactorInertia(body.inv_inertia, &factor)) {
    std::string rows = TextOf(View(body.inv_inertia).row(0));
    for (int i = 1; i < 3; ++i) rows.append(", ").append(TextOf(View(body.inv_inertia).row(i)));
    Add("inv_inertia", rows, "symmetric positive semidefinite");
  }
}

void Inspector::InspectNames() {
  std::vector<std::pair<std::uint64_t, int>> names;
  for (size_t i = 0; i < problem_.bodies.size(); ++i) {
    const std::uint64_t id = problem_.bodies[i].id;
    if (id != 0) names.emplace_back(id, static_cast<int>(i));
  }
  std::sort(names.begin(), names.end());
  for (size_t i = 1; i < names.size(); ++i) {
    if (names[i].first != names[i - 1].first) continue;
    Enter("bodies", names[i].second);
    Add("id", Text(names[i].first),
        Join({"another than that of bodies[", Text(names[i - 1].second), "]"}));
  }
}

void Inspector::InspectRow(const Row& row) {
  const Status status = ValidateRow(problem_, index_, impulses_.rows[index_]);
  if (status != Status::kOk) return Add("", "refused", Describe(status));
  const auto zero = [](int body, const Vector3& linear, const Vector3& angular) {
    return body == kWorld || (linear == Vector3() && angular == Vector3());
  };
  if (zero(row.body_a, row.linear_a, row.angular_a) &&
      zero(row.body_b, row.linear_b, row.angular_b)) {
    Add("linear_a", TextOf(row.linear_a), "a direction: the row does nothing");
  }
}

bool Inspector::InspectPair(int a, int b) {
  const int bodies = static_cast<int>(problem_.bodies.size());
  const auto known = [&](const char* field, int body) {
    const bool good = body >= kWorld && body < bodies;
    if (!good) Add(field, Text(body), Join({"kWorld, or 0 to ", Text(bodies - 1)}));
    return good;
  };
  const bool known_a = known("body_a", a), known_b = known("body_b", b);
  if (!known_a || !known_b) return false;
  if (a == b) Add("body_b", Text(b), "another body than body_a");
  if (a != b && !moves(a) && !moves(b)) Add("body_a", Text(a), "a body that moves, or body_b");
  return a != b;
}

bool Inspector::InspectRange(std::string_view first_field, int first, int count, size_t size,
                             std::vector<char>* taken) {
  const auto end = static_cast<std::int64_t>(first) + count;
  if (first < 0 || end > static_cast<std::int64_t>(size)) {
    Add(first_field, Text(first), Join({"0 to ", Text(static_cast<std::int64_t>(size) - count)}));
    return false;
  }
  const bool shared =
      std::find(taken->begin() + first, taken->begin() + end, 1) != taken->begin() + end;
  if (shared) Add(first_field, Text(first), "behind what others have");
  std::fill(taken->begin() + first, taken->begin() + end, char{1});
  return true;
}

void Inspector::InspectJoints() {
  std::vector<char> taken(problem_.joint_rows.size(), 0);
  Each("joints", problem_.joints, [&](const Joint& joint) {
    ExpectFinite("damping", joint.damping);
    const bool rows = joint.rows >= 1 && joint.rows <= Joint::kMostRows;
    Expect(rows, "rows", joint.rows, "1 to 32");
    if (!InspectPair(joint.body_a, joint.body_b) || !rows) return;
    if (!InspectRange("first_row", joint.first_row, joint.rows, problem_.joint_rows.size(),
                      &taken)) {
      return;
    }
    const int index = index_;
    for (int i = 0; i < joint.rows; ++i) InspectJointRow(joint, i);
    Enter("joints", index);
  });
}

void Inspector::InspectJointRow(const Joint& joint, int place) {
  Enter("joint_rows", joint.first_row + place);
  const JointRow& row = problem_.joint_rows[index_];
  const Vector3f linear_a = ToVector(row.linear_a), linear_b = ToVector(row.linear_b);
  const Vector3f angular_a = ToVector(row.angular_a), angular_b = ToVector(row.angular_b);
  ExpectFiniteVector("linear_a", linear_a);
  ExpectFiniteVector("angular_a", angular_a);
  if (!joint.opposite) ExpectFiniteVector("linear_b", linear_b);
  ExpectFiniteVector("angular_b", angular_b);
  ExpectFinite("target", row.target);

  const bool a = moves(joint.body_a), b = moves(joint.body_b);
  const bool pushes_a = a && !linear_a.isZero(0);
  const bool pushes_b = b && !(joint.opposite ? linear_a : linear_b).isZero(0);
  const bool turns = (a && !angular_a.isZero(0)) || (b && !angular_b.isZero(0));
  const bool pushes = pushes_a || pushes_b;
  if (!pushes && !turns) {
    Add("linear_a", TextOf(linear_a), "a direction: the row does nothing");
  } else if (joint.is_angular(place) && pushes) {
    Add("linear_a", TextOf(linear_a), "zeros: Joint::angular says that the row only turns");
  } else if (!joint.is_angular(place) && !pushes) {
    Add("angular_a", TextOf(angular_a), "marked in Joint::angular: the row only turns");
  }
  const bool contradicts =
      joint.opposite && a && b && !linear_b.isZero(0) &&
      (linear_a + linear_b).cwiseAbs().maxCoeff() > kUnitError * linear_a.cwiseAbs().maxCoeff();
  if (contradicts) Add("linear_b", TextOf(linear_b), "-linear_a, as Joint::opposite says");

  if (joint.soft) {
    ExpectNotNegative("compliance", row.compliance);
  } else {
    Expect(row.compliance == 0, "compliance", row.compliance, "0: Joint::soft is off");
  }
  if (joint.is_bounded(place)) {
    Expect(row.lo <= row.hi && row.lo < kInfinity, "lo", row.lo, "at most hi, and not infinity");
    Expect(row.hi > -kInfinity, "hi", row.hi, "above -infinity");
  } else {
    // zeros are what those who set no bounds leave there
    const bool unset =
        (row.lo == -kInfinity && row.hi == kInfinity) || (row.lo == 0 && row.hi == 0);
    if (!unset) Add("lo", Text(row.lo), "-infinity: Joint::bounded does not say that it is read");
  }
  Enter("impulses.joint_rows", index_);
  ExpectFinite("", impulses_.joint_rows[index_]);
}

void Inspector::InspectManifolds() {
  std::vector<char> taken(problem_.points.size(), 0);
  Each("manifolds", problem_.manifolds, [&](const Manifold& manifold) {
    const bool points = manifold.points >= 1 && manifold.points <= Manifold::kMostPoints;
    Expect(points, "points", manifold.points, "1 to 4");
    Expect(manifold.tangents >= 0 && manifold.tangents <= 2, "tangents", manifold.tangents,
           "0 to 2");
    const bool twists = !manifold.twists || !problem_.twists.empty();
    if (!twists) Add("twists", "true", "false where the problem has no twists");
    if (!InspectPair(manifold.body_a, manifold.body_b) || !points || !twists) return;
    if (!InspectRange("first_point", manifold.first_point, manifold.points, problem_.points.size(),
                      &taken)) {
      return;
    }
    const int index = index_;
    for (int i = 0; i < manifold.points; ++i) InspectPoint(manifold, manifold.first_point + i);
    Enter("manifolds", index);
  });
  Enter("contact_law", -1);
  ExpectNotNegative("bounce_speed", problem_.contact_law.bounce_speed);
}

void Inspector::InspectPoint(const Manifold& manifold, int index) {
  Enter("points", index);
  const ContactPoint& point = problem_.points[index];
  ExpectFiniteVector("arm_a", ToVector(point.arm_a));
  ExpectFiniteVector("arm_b", ToVector(point.arm_b));
  InspectDirections(point);
  ExpectFinite("bias", point.bias);
  ExpectNotNegative("restitution", point.restitution);
  ExpectNotNegative("friction", point.friction);
  if (manifold.soft) {
    ExpectNotNegative("compliance", point.compliance);
  } else {
    Expect(point.compliance == 0, "compliance", point.compliance, "0: Manifold::soft is off");
  }
  if (manifold.tangents == 0) {
    Expect(point.friction == 0, "friction", point.friction, "0: Manifold::tangents is 0");
  }
  Enter("impulses.points", index);
  ExpectFinite("normal", impulses_.points[index].normal);
  ExpectFinite("tangential[0]", impulses_.points[index].tangential[0]);
  ExpectFinite("tangential[1]", impulses_.points[index].tangential[1]);
  if (manifold.twists) InspectTwist(index);
}

void Inspector::InspectDirections(const ContactPoint& point) {
  const Vector3f normal = ToVector(point.normal), tangent = ToVector(point.tangent);
  // what is not a number fails, too
  const auto unit = [](const Vector3f& v) { return std::abs(v.norm() - 1) <= kUnitError; };
  if (!unit(normal)) return Add("normal", TextOf(normal), "a unit vector");
  if (tangent.isZero(0)) return;
  if (!unit(tangent)) return Add("tangent", TextOf(tangent), "a unit vector, or zeros");
  if (std::abs(normal.dot(tangent)) > kUnitError) {
    Add("tangent", TextOf(tangent), Join({"at right angles to normal ", TextOf(normal)}));
  }
}

void Inspector::InspectTwist(int index) {
  Enter("twists", index);
  const ContactTwist& twist = problem_.twists[index];
  ExpectNotNegative("spinning", twist.spinning);
  ExpectNotNegative("rolling", twist.rolling);
  Expect(twist.most_spinning >= 0, "most_spinning", twist.most_spinning, "0 or more");
  Expect(twist.most_rolling >= 0, "most_rolling", twist.most_rolling, "0 or more");
}

}  // namespace

std::string Describe(const Finding& finding) {
  const std::string place = finding.index >= 0 ? Join({"[", Text(finding.index), "]"}) : "";
  const std::string_view dot = finding.field.empty() ? "" : ".";
  return Join({finding.array, place, dot, finding.field, " is ", finding.value, ", must be ",
               finding.rule});
}

std::vector<Finding> ValidateStrictly(const ContactProblem& problem, const Impulses& impulses,
                                      int most) {
  if (problem.bodies.empty()) return {{"bodies", -1, "size()", "0", "1 or more"}};
  const BadSetting size = FindBadSize(problem, impulses);
  if (size.name != nullptr) {
    constexpr std::string_view kCall = ".size()";
    std::string array(size.name);
    array.resize(array.size() - kCall.size());
    return {{array, -1, "size()", Text(size.value), size.range}};
  }
  Inspector inspector(problem, impulses, most);
  inspector.Inspect();
  return std::move(inspector.findings);
}

}  // namespace cairn
