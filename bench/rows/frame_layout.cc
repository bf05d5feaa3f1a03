// SPDX-License-Identifier: MIT
#include "rows/frame_layout.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <span>

#include "cairn/detail/eigen.h"

namespace cairn::cli {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kDensity = 1000;  // of bodies that do not turn, whose size nothing tells
constexpr double kThinnest = 0.005, kThickest = 1000;  // half extents [m]
constexpr double kSameMoment = 0.002;                  // relative

/// Two bodies that have a point in common, `arm_a` from the one and `arm_b` from the other.
struct Link {
  int body_a, body_b;
  Vector3d arm_a, arm_b;
};

Vector3d ToVector(const float* v) { return {v[0], v[1], v[2]}; }

/// The arm of rows that act along lines through one point: angular = arm x linear, in least
/// squares.
class ArmSum {
 public:
  void Add(const Vector3d& linear, const Vector3d& angular) {
    matrix_ += linear.squaredNorm() * Matrix3d::Identity() - linear * linear.transpose();
    right_ += linear.cross(angular);
  }
  Vector3d arm() const { return matrix_.completeOrthogonalDecomposition().solve(right_); }

 private:
  Matrix3d matrix_ = Matrix3d::Zero();
  Vector3d right_ = Vector3d::Zero();
};

/// None if the rows only turn.
std::optional<Link> LinkOf(std::span<const Row> rows) {
  ArmSum a, b;
  bool holds = false;
  for (const Row& row : rows) {
    a.Add(row.linear_a, row.angular_a);
    b.Add(row.linear_b, row.angular_b);
    holds |= !View(row.linear_a).isZero() || !View(row.linear_b).isZero();
  }
  if (!holds) return {};
  return Link{rows.front().body_a, rows.front().body_b, a.arm(), b.arm()};
}

/// Joints, and rows of the problem itself by the bodies they are between.
std::vector<Link> JointLinks(const RowProblem& problem) {
  const std::span<const Row> all(problem.rows.rows);
  std::vector<Link> links;
  const auto add = [&](size_t first, size_t count) {
    if (const auto link = LinkOf(all.subspan(first, count))) links.push_back(*link);
  };
  const size_t own = problem.frame.rows.size();
  for (size_t first = 0, end = 0; first < own; first = end) {
    while (end < own && all[end].body_a == all[first].body_a &&
           all[end].body_b == all[first].body_b) {
      ++end;
    }
    add(first, end - first);
  }
  size_t first = own;
  for (const Joint& joint : problem.frame.joints) {
    add(first, static_cast<size_t>(joint.rows));
    first += static_cast<size_t>(joint.rows);
  }
  return links;
}

std::vector<Link> ContactLinks(const Recording& frame) {
  std::vector<Link> links;
  for (const Manifold& manifold : frame.manifolds) {
    Link link{manifold.body_a, manifold.body_b, Vector3d::Zero(), Vector3d::Zero()};
    for (int i = 0; i < manifold.points; ++i) {
      const ContactPoint& point = frame.points[manifold.first_point + i];
      link.arm_a += ToVector(point.arm_a) / manifold.points;
      link.arm_b += ToVector(point.arm_b) / manifold.points;
    }
    links.push_back(link);
  }
  return links;
}

/// Principal axes of `inverse`, those of the world where moments are the same.
Matrix3d AxesOf(const Eigen::SelfAdjointEigenSolver<Matrix3d>& solver) {
  const Vector3d& values = solver.eigenvalues();
  const bool low = values[1] - values[0] <= kSameMoment * values[2],
             high = values[2] - values[1] <= kSameMoment * values[2];
  if (low && high) return Matrix3d::Identity();
  Matrix3d axes = solver.eigenvectors();
  if (low || high) {
    const int alone = low ? 2 : 0;
    const Vector3d axis = axes.col(alone);
    int across = 0;
    axis.cwiseAbs().minCoeff(&across);
    axes.col(1) = (Vector3d::Unit(across) - axis[across] * axis).normalized();
    axes.col(2 - alone) = axis.cross(axes.col(1));
  }
  if (axes.determinant() < 0) axes.col(0) *= -1;
  return axes;
}

FrameLayout::Box BoxOf(const Body& body) {
  FrameLayout::Box box{Vector3d::Zero(), Matrix3d::Identity(), Vector3d::Constant(kThinnest)};
  if (body.inv_mass <= 0) return box;
  box.mass = 1 / body.inv_mass;
  const Eigen::SelfAdjointEigenSolver<Matrix3d> solver(View(body.inv_inertia));
  if (solver.eigenvalues()[0] <= 0) {
    box.half.setConstant(std::clamp(0.5 * std::cbrt(box.mass / kDensity), kThinnest, kThickest));
    return box;
  }
  box.axes = AxesOf(solver);
  const Vector3d moments = solver.eigenvalues().cwiseInverse();
  for (int i = 0; i < 3; ++i) {  // m/3 (h_j^2 + h_k^2) is the moment about i
    const double squared = 1.5 / box.mass * (moments.sum() - 2 * moments[i]);
    box.half[i] = std::clamp(std::sqrt(std::max(squared, 0.0)), kThinnest, kThickest);
  }
  return box;
}

/// Places bodies from one to the next along links.
class Placer {
 public:
  Placer(std::span<const Link> links, FrameLayout* layout)
      : layout_(*layout), placed_(layout->boxes.size()), links_(layout->boxes.size()) {
    for (const Link& link : links) {
      if (link.body_a != kWorld) links_[link.body_a].push_back(link);
      if (link.body_b != kWorld) links_[link.body_b].push_back(Turned(link));
    }
  }

  void Place() {
    const auto count = static_cast<int>(placed_.size());
    for (int i = 0; i < count; ++i) {  // what stands on the world, where it stands
      for (const Link& link : links_[i]) {
        if (link.body_b != kWorld || placed_[i] || link.arm_b.isZero()) continue;
        layout_.boxes[i].centre = link.arm_b - link.arm_a;
        PlaceGroup(i);
      }
    }
    for (int i = 0; i < count; ++i) {
      if (placed_[i]) continue;
      const std::vector<int> group = PlaceGroup(i);
      const double shift = right_ + 1 - Side(group, -1);
      for (const int body : group) layout_.boxes[body].centre.x() += shift;
      right_ = Side(group, 1);
    }
  }

 private:
  static Link Turned(const Link& link) {
    return {link.body_b, link.body_a, link.arm_b, link.arm_a};
  }

  /// All that hang together with a body that is placed. @return them
  std::vector<int> PlaceGroup(int first) {
    std::vector<int> group = {first};
    placed_[first] = true;
    for (size_t i = 0; i < group.size(); ++i) {
      const Vector3d centre = layout_.boxes[group[i]].centre;
      for (const Link& link : links_[group[i]]) {
        if (link.body_b == kWorld || placed_[link.body_b]) continue;
        placed_[link.body_b] = true;
        layout_.boxes[link.body_b].centre = centre + link.arm_a - link.arm_b;
        group.push_back(link.body_b);
      }
    }
    for (const int body : group) layout_.boxes[body].group = groups_;
    ++groups_;
    right_ = std::max(right_, Side(group, 1));
    return group;
  }

  /// How far they reach along x: 1, or against it: -1 [m].
  double Side(std::span<const int> group, int sign) const {
    double most = -std::numeric_limits<double>::infinity();
    for (const int body : group) {
      const FrameLayout::Box& box = layout_.boxes[body];
      most = std::max(most, sign * box.centre.x() + box.half.norm());
    }
    return sign * most;
  }

  FrameLayout& layout_;
  std::vector<bool> placed_;
  std::vector<std::vector<Link>> links_;  ///< By body, which is body_a of all.
  double right_ = 0;
  int groups_ = 0;
};

/// The lowest place where something touches the world, else the lowest of all.
double Lowest(const FrameLayout& layout, std::span<const Link> contacts) {
  double touched = std::numeric_limits<double>::infinity(), lowest = touched;
  for (const Link& link : contacts) {
    if (link.body_a != kWorld && link.body_b != kWorld) continue;
    const bool is_a = link.body_a != kWorld;
    const double height = layout.boxes[is_a ? link.body_a : link.body_b].centre.y();
    touched = std::min(touched, height + (is_a ? link.arm_a : link.arm_b).y());
  }
  if (std::isfinite(touched)) return touched;
  for (const FrameLayout::Box& box : layout.boxes) {
    lowest = std::min(lowest, box.centre.y() - box.axes.row(1).cwiseAbs().dot(box.half));
  }
  return std::isfinite(lowest) ? lowest : 0;
}

}  // namespace

FrameLayout LayOut(const RowProblem& problem) {
  FrameLayout layout;
  for (const Body& body : problem.frame.bodies) layout.boxes.push_back(BoxOf(body));
  const std::vector<Link> contacts = ContactLinks(problem.frame), joints = JointLinks(problem);
  std::vector<Link> all = contacts;
  all.insert(all.end(), joints.begin(), joints.end());
  Placer(all, &layout).Place();

  const double lowest = Lowest(layout, contacts);
  double reach = 10;
  for (FrameLayout::Box& box : layout.boxes) {
    box.centre.y() -= lowest;
    reach = std::max(reach, 2 * box.centre.cwiseAbs().maxCoeff());
  }
  layout.ground = reach;
  for (const Link& link : joints) {
    const auto at = [&](int body, const Vector3d& arm) -> Vector3d {
      return layout.boxes[body].centre + arm;
    };
    FrameLayout::Anchors anchors{link.body_a, link.body_b, Vector3d::Zero(), Vector3d::Zero()};
    if (link.body_a != kWorld) anchors.a = at(link.body_a, link.arm_a);
    anchors.b = link.body_b != kWorld ? at(link.body_b, link.arm_b) : anchors.a;
    if (link.body_a == kWorld) anchors.a = anchors.b;
    layout.joints.push_back(anchors);
  }
  return layout;
}

}  // namespace cairn::cli
