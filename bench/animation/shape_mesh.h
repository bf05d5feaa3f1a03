// SPDX-License-Identifier: MIT
#pragma once

#include <btBulletDynamicsCommon.h>

#include <array>
#include <vector>

namespace cairn::cli {

/// Corners of triangles of a mesh or plane within a cube around its origin, three each [m].
std::vector<btVector3> TrianglesOf(const btConcaveShape& shape, btScalar half_side);

struct Vertex {
  std::array<float, 3> position, normal;
};

/// The triangles of a shape in metres, three vertices each, with flat normals: convex ones by their
/// support points, meshes and planes within 100 m of the origin. Others have none.
std::vector<Vertex> MeshOf(const btCollisionShape& shape);

}  // namespace cairn::cli
