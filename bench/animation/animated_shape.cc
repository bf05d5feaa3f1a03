// SPDX-License-Identifier: MIT
#include "animation/animated_shape.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "animation/shape_mesh.h"

namespace cairn::cli {
namespace {

/// Corners of triangles that a page carries of one mesh; a larger one is drawn as its box.
constexpr size_t kMostNumbers = 9 * 20000;
/// Planes end somewhere [m].
constexpr float kPlaneHalfSide = 100, kPlaneHalfThickness = 0.5F;

AnimatedShape Box(const btVector3& half) {
  return {.kind = "box", .numbers = {float(half.x()), float(half.y()), float(half.z())}};
}

AnimatedShape Bounds(const btCollisionShape& shape) {
  btVector3 low, high;
  shape.getAabb(btTransform::getIdentity(), low, high);
  return Box((high - low) / 2);
}

AnimatedShape Hull(const btConvexHullShape& hull) {
  AnimatedShape shape{.kind = "hull", .numbers = {}};
  for (int i = 0; i < hull.getNumPoints(); ++i) {
    const btVector3 corner = hull.getScaledPoint(i);
    for (int axis = 0; axis < 3; ++axis) shape.numbers.push_back(float(corner[axis]));
  }
  return shape;
}

AnimatedShape Mesh(const btConcaveShape& mesh) {
  const std::vector<btVector3> corners = TrianglesOf(mesh, btScalar(1e6));
  if (corners.empty() || 3 * corners.size() > kMostNumbers) return Bounds(mesh);
  AnimatedShape shape{.kind = "triangles", .numbers = {}};
  for (const btVector3& corner : corners) {
    for (int axis = 0; axis < 3; ++axis) shape.numbers.push_back(float(corner[axis]));
  }
  return shape;
}

/// The way from y to another axis of Bullet's shapes.
btTransform FromY(int axis) {
  const btVector3 about = axis == 0 ? btVector3(0, 0, 1) : btVector3(1, 0, 0);
  return btTransform(btQuaternion(about, axis == 1 ? btScalar(0) : SIMD_HALF_PI));
}

bool IsDrawnAsBounds(const btCollisionShape& shape) {
  switch (shape.getShapeType()) {
    case BOX_SHAPE_PROXYTYPE:
    case SPHERE_SHAPE_PROXYTYPE:
    case CONVEX_HULL_SHAPE_PROXYTYPE:
      return false;
    default:
      return !shape.isConcave() || ToAnimatedShape(shape).kind == "box";
  }
}

}  // namespace

AnimatedShape ToAnimatedShape(const btCollisionShape& shape) {
  switch (shape.getShapeType()) {
    case BOX_SHAPE_PROXYTYPE:
      return Box(static_cast<const btBoxShape&>(shape).getHalfExtentsWithMargin());
    case SPHERE_SHAPE_PROXYTYPE:
      return {"sphere", {float(static_cast<const btSphereShape&>(shape).getRadius())}};
    case CYLINDER_SHAPE_PROXYTYPE: {
      const auto& cylinder = static_cast<const btCylinderShape&>(shape);
      const btScalar half = cylinder.getHalfExtentsWithMargin()[cylinder.getUpAxis()];
      return {"cylinder", {float(cylinder.getRadius()), float(2 * half)}};
    }
    case CAPSULE_SHAPE_PROXYTYPE: {
      const auto& capsule = static_cast<const btCapsuleShape&>(shape);
      return {"capsule", {float(capsule.getRadius()), float(2 * capsule.getHalfHeight())}};
    }
    case CONVEX_HULL_SHAPE_PROXYTYPE:
      return Hull(static_cast<const btConvexHullShape&>(shape));
    case STATIC_PLANE_PROXYTYPE:
      return {"box", {kPlaneHalfSide, kPlaneHalfThickness, kPlaneHalfSide}};
    default:
      return shape.isConcave() ? Mesh(static_cast<const btConcaveShape&>(shape)) : Bounds(shape);
  }
}

btTransform AxisOf(const btCollisionShape& shape) {
  switch (shape.getShapeType()) {
    case CYLINDER_SHAPE_PROXYTYPE:
      return FromY(static_cast<const btCylinderShape&>(shape).getUpAxis());
    case CAPSULE_SHAPE_PROXYTYPE:
      return FromY(static_cast<const btCapsuleShape&>(shape).getUpAxis());
    case STATIC_PLANE_PROXYTYPE: {
      const auto& plane = static_cast<const btStaticPlaneShape&>(shape);
      const btVector3& normal = plane.getPlaneNormal();
      const btQuaternion turn = shortestArcQuat(btVector3(0, 1, 0), normal);
      return btTransform(turn, normal * (plane.getPlaneConstant() - kPlaneHalfThickness));
    }
    default:
      break;
  }
  if (!IsDrawnAsBounds(shape)) return btTransform::getIdentity();
  btVector3 low, high;
  shape.getAabb(btTransform::getIdentity(), low, high);
  return btTransform(btQuaternion::getIdentity(), (low + high) / 2);
}

}  // namespace cairn::cli
