// SPDX-License-Identifier: MIT
#include "play/view/shapes.h"

#include <BulletCollision/CollisionShapes/btConcaveShape.h>
#include <LinearMath/btConvexHullComputer.h>

#include <cmath>

namespace cairn::play {
namespace {

constexpr int kAround = 24, kRings = 16;  // of a ball
constexpr btScalar kFarAway = 100;        // [m]
constexpr int kDirections = 400;          // support points of a convex shape that has no corners

std::array<float, 3> ToArray(const btVector3& v) {
  return {static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z())};
}

void AddTriangle(const btVector3& a, const btVector3& b, const btVector3& c, Mesh* mesh) {
  const btVector3 across = (b - a).cross(c - a);
  if (across.fuzzyZero()) return;
  const auto normal = ToArray(across.normalized());
  for (const btVector3& corner : {a, b, c}) mesh->push_back({ToArray(corner), normal});
}

struct Triangles : btTriangleCallback {
  void processTriangle(btVector3* corners, int, int) override {
    AddTriangle(corners[0], corners[1], corners[2], &mesh);
  }
  Mesh mesh;
};

Mesh HullOf(const btConvexShape& shape) {
  std::vector<btVector3> points;
  for (int i = 0; i < kDirections; ++i) {
    // evenly over a ball, along a golden spiral
    const btScalar y = 1 - 2 * (btScalar(i) + btScalar(0.5)) / kDirections;
    const btScalar turn = btScalar(2.399963) * btScalar(i), r = std::sqrt(1 - y * y);
    points.push_back(
        shape.localGetSupportingVertex(btVector3(r * std::cos(turn), y, r * std::sin(turn))));
  }
  btConvexHullComputer hull;
  hull.compute(points.front().m_floats, sizeof(btVector3), static_cast<int>(points.size()), 0, 0);
  Mesh mesh;
  for (int i = 0; i < hull.faces.size(); ++i) {
    const btConvexHullComputer::Edge* const first = &hull.edges[hull.faces[i]];
    const btVector3 a = hull.vertices[first->getSourceVertex()];
    for (const auto* edge = first->getNextEdgeOfFace();
         edge->getTargetVertex() != first->getSourceVertex(); edge = edge->getNextEdgeOfFace()) {
      AddTriangle(a, hull.vertices[edge->getSourceVertex()], hull.vertices[edge->getTargetVertex()],
                  &mesh);
    }
  }
  return mesh;
}

}  // namespace

Mesh BoxMesh() {
  Mesh mesh;
  for (int axis = 0; axis < 3; ++axis) {
    for (const btScalar side : {btScalar(-1), btScalar(1)}) {
      btVector3 n(0, 0, 0), u(0, 0, 0);
      n[axis] = side;
      u[(axis + 1) % 3] = 1;
      const btVector3 v = n.cross(u);
      AddTriangle(n - u - v, n + u - v, n + u + v, &mesh);
      AddTriangle(n - u - v, n + u + v, n - u + v, &mesh);
    }
  }
  return mesh;
}

Mesh BallMesh() {
  const auto corner = [](int ring, int step) {
    const float up = SIMD_PI * static_cast<float>(ring) / kRings;
    const float turn = 2 * SIMD_PI * static_cast<float>(step) / kAround;
    const std::array<float, 3> at = {std::sin(up) * std::cos(turn), -std::cos(up),
                                     std::sin(up) * std::sin(turn)};
    return Vertex{at, at};
  };
  Mesh mesh;
  for (int i = 0; i < kRings * kAround; ++i) {
    const int ring = i / kAround, step = i % kAround;
    const Vertex a = corner(ring, step), b = corner(ring, step + 1), c = corner(ring + 1, step + 1),
                 d = corner(ring + 1, step);
    mesh.insert(mesh.end(), {a, c, b, a, d, c});
  }
  return mesh;
}

Mesh MeshOf(const btCollisionShape& shape) {
  if (shape.isConvex()) return HullOf(static_cast<const btConvexShape&>(shape));
  if (!shape.isConcave()) return {};
  Triangles triangles;
  const btVector3 reach(kFarAway, kFarAway, kFarAway);
  static_cast<const btConcaveShape&>(shape).processAllTriangles(&triangles, -reach, reach);
  return std::move(triangles.mesh);
}

}  // namespace cairn::play
