// SPDX-License-Identifier: MIT
#pragma once

#include <btBulletDynamicsCommon.h>

#include <array>
#include <vector>

namespace cairn::play {

struct Vertex {
  std::array<float, 3> position, normal;
};

/// Triangles, three vertices each.
using Mesh = std::vector<Vertex>;

// Of size 1: half extents, radius.
Mesh BoxMesh();
Mesh BallMesh();

/// Any other shape, in metres: convex ones by their support points, meshes and planes by their
/// triangles within 100 m of the origin.
Mesh MeshOf(const btCollisionShape& shape);

}  // namespace cairn::play
