// SPDX-License-Identifier: MIT
#include "micro/row_scene.h"

#include <utility>

#include <Eigen/Geometry>

#include "micro/links.h"
#include "scenes/random.h"

namespace cairn::micro {
namespace {

using Eigen::Vector3d;
using simd::RowBound;
using simd::RowShape;

constexpr int kMostPoints = 4;

std::vector<RowShape> ContactLayout(int points) {
  std::vector<RowShape> rows(points, {.bound = RowBound::kPush});
  for (int i = 0; i < 2 * points; ++i) {
    rows.push_back({.bound = RowBound::kFriction, .parent = static_cast<std::int16_t>(i / 2)});
  }
  return rows;
}

std::vector<RowShape> HingeLayout() {
  const RowShape linear, angular = {.angular = true};
  return {linear, linear, linear, angular, angular, {.bound = RowBound::kOwn, .angular = true}};
}

std::vector<std::vector<RowShape>> LayoutsOf(SceneKind kind) {
  if (kind == SceneKind::kJoint) return {HingeLayout()};
  if (kind != SceneKind::kMixedContact) return {ContactLayout(kMostPoints)};
  std::vector<std::vector<RowShape>> layouts;
  for (int points = 1; points <= kMostPoints; ++points) layouts.push_back(ContactLayout(points));
  return layouts;
}

simd::PairForm FormOf(SceneKind kind) {
  return kind == SceneKind::kJoint           ? simd::PairForm::kJoint
         : kind == SceneKind::kStaticContact ? simd::PairForm::kSingle
                                             : simd::PairForm::kContact;
}

class Builder {
 public:
  Builder(SceneKind kind, int count) : kind_(kind) {
    scene_.form = FormOf(kind);
    scene_.layouts = LayoutsOf(kind);
    const LinkedBodies linked = MakeLinks(kind, count);
    scene_.bodies.resize(1);
    for (size_t i = 1; i < linked.cells.size(); ++i) AddBody(linked.cells[i]);
    for (const Link& link : linked.links) {
      scene_.pairs.push_back({link.a, link.b, link.layout, static_cast<int>(scene_.rows.size())});
      if (kind == SceneKind::kJoint) {
        AddHinge(link);
      } else {
        AddManifold(link);
      }
    }
  }

  RowScene Take() { return std::move(scene_); }

 private:
  Vector3d InCube(double reach) {
    // one after the other: the order in which arguments are evaluated is the compiler's choice
    const double x = random_.Within(-reach, reach), y = random_.Within(-reach, reach);
    const double z = random_.Within(-reach, reach);
    return {x, y, z};
  }

  /// A box of about one metre.
  void AddBody(const Eigen::Vector3i& cell) {
    SceneBody body;
    body.position = cell.cast<double>() + InCube(0.03);
    body.velocity = Drift(cell) + InCube(0.1);
    body.spin = InCube(0.2);
    body.inv_mass = 1 / random_.Within(0.5, 2);

    const Vector3d squares = (Vector3d::Constant(1) + InCube(0.2)).cwiseAbs2();
    const Vector3d inertia = (Vector3d::Constant(squares.sum()) - squares) / (12 * body.inv_mass);
    const Vector3d axis = InCube(1).normalized();
    const Eigen::AngleAxisd turned(random_.Within(0, 3), axis);
    body.root = turned.toRotationMatrix() * inertia.cwiseInverse().cwiseSqrt().asDiagonal();
    scene_.bodies.push_back(body);
  }

  /// Boxes of a pile fall together in clumps, so that most contacts carry load and some do not;
  /// boxes in corners fall into them.
  Vector3d Drift(const Eigen::Vector3i& cell) const {
    constexpr int kClump = 8;
    if (kind_ == SceneKind::kJoint) return Vector3d::Zero();
    if (kind_ == SceneKind::kStaticContact) return Vector3d::Constant(-0.3);
    const Vector3d within = cell.unaryExpr([](int i) { return i % kClump; }).cast<double>();
    return 0.2 * (Vector3d::Constant((kClump - 1) / 2.0) - within);
  }

  void AddManifold(const Link& link) {
    const bool is_static = link.b == 0;
    const Vector3d axis = Vector3d::Unit(link.axis);
    // towards a
    const Vector3d normal = ((is_static ? axis : Vector3d(-axis)) + InCube(0.05)).normalized();
    const Vector3d tangent = normal.unitOrthogonal(), other = normal.cross(tangent);
    const Vector3d middle = scene_.bodies[link.a].position - 0.5 * normal;

    const int count = static_cast<int>(scene_.layouts[link.layout].size()) / 3;
    std::vector<Vector3d> points;
    for (int i = 0; i < count; ++i) {
      points.push_back(middle + (i % 2 - 0.5) * 0.8 * tangent + (i / 2 - 0.5) * 0.8 * other +
                       InCube(0.03));
      AddPointRow(link, normal, points[i], 0);
    }
    const double friction = random_.Within(0.4, 0.7);
    for (int i = 0; i < count; ++i) {
      AddPointRow(link, tangent, points[i], friction);
      AddPointRow(link, other, points[i], friction);
    }
  }

  void AddHinge(const Link& link) {
    const Vector3d anchor =
        (scene_.bodies[link.a].position + scene_.bodies[link.b].position) / 2 + InCube(0.1);
    for (int i = 0; i < 3; ++i) AddPointRow(link, Vector3d::Unit(i), anchor, 0);
    const Vector3d axis = InCube(1).normalized(), first = axis.unitOrthogonal();
    AddRow(link, {Vector3d::Zero(), first, -first, 0, 0, 0});
    const Vector3d second = axis.cross(first);
    AddRow(link, {Vector3d::Zero(), second, -second, 0, 0, 0});
    AddRow(link, {Vector3d::Zero(), axis, -axis, 0, 0, 0.01});
  }

  void AddPointRow(const Link& link, const Vector3d& direction, const Vector3d& point,
                   double limit) {
    const Vector3d arm_a = point - scene_.bodies[link.a].position;
    const Vector3d arm_b = point - scene_.bodies[link.b].position;
    AddRow(link, {direction, arm_a.cross(direction), -arm_b.cross(direction), 0, 0, limit});
  }

  /// Target and step follow from the rest.
  void AddRow(const Link& link, SceneRow row) {
    if (link.b == 0) row.angular_b.setZero();
    const SceneBody &a = scene_.bodies[link.a], &b = scene_.bodies[link.b];
    row.target = -(row.linear.dot(a.velocity - b.velocity) + row.angular_a.dot(a.spin) +
                   row.angular_b.dot(b.spin));
    row.step = 1 / ((a.inv_mass + b.inv_mass) * row.linear.squaredNorm() +
                    (a.root.transpose() * row.angular_a).squaredNorm() +
                    (b.root.transpose() * row.angular_b).squaredNorm());
    scene_.rows.push_back(row);
  }

  SceneKind kind_;
  RowScene scene_;
  bench::Random random_{2};
};

}  // namespace

RowScene MakeRowScene(SceneKind kind, int count) { return Builder(kind, count).Take(); }

}  // namespace cairn::micro
