// SPDX-License-Identifier: MIT
#include "animation/shape_mesh.h"

#include <BulletCollision/CollisionShapes/btConcaveShape.h>
#include <LinearMath/btConvexHullComputer.h>

#include <cmath>
#include <utility>

namespace cairn::cli {
namespace {

constexpr btScalar kFarAway = 100;  // [m]
constexpr int kDirections = 400;    // support points of a convex shape that has no corners

std::array<float, 3> ToArray(const btVector3& v) {
  return {static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z())};
}

void AddTriangle(const btVector3& a, const btVector3& b, const btVector3& c,
                 std::vector<Vertex>* mesh) {
  const btVector3 across = (b - a).cross(c - a);
  if (across.fuzzyZero()) return;
  const auto normal = ToArray(across.normalized());
  for (const btVector3& corner : {a, b, c}) mesh->push_back({ToArray(corner), normal});
}

struct Triangles : btTriangleCallback {
  void processTriangle(btVector3* triangle, int, int) override {
    corners.insert(corners.end(), triangle, triangle + 3);
  }
  std::vector<btVector3> corners;
};

std::vector<Vertex> HullOf(const btConvexShape& shape) {
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
  std::vector<Vertex> mesh;
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

std::vector<btVector3> TrianglesOf(const btConcaveShape& shape, btScalar half_side) {
  const btVector3 reach(half_side, half_side, half_side);
  Triangles triangles;
  shape.processAllTriangles(&triangles, -reach, reach);
  return std::move(triangles.corners);
}

std::vector<Vertex> MeshOf(const btCollisionShape& shape) {
  if (shape.isConvex()) return HullOf(static_cast<const btConvexShape&>(shape));
  if (!shape.isConcave()) return {};
  const std::vector<btVector3> corners =
      TrianglesOf(static_cast<const btConcaveShape&>(shape), kFarAway);
  std::vector<Vertex> mesh;
  for (size_t i = 0; i + 2 < corners.size(); i += 3) {
    AddTriangle(corners[i], corners[i + 1], corners[i + 2], &mesh);
  }
  return mesh;
}

}  // namespace cairn::cli
