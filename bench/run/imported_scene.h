// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>

#include "run/scene_choice.h"

namespace cairn::cli {

/// A world that Bullet's serializer saved, as a scene: its bodies, shapes and joints, and its
/// gravity. Its solver settings are left out, those of all scenes hold. Multi-bodies, which is what
/// PyBullet makes of articulated URDF files, are left out too: Bullet solves them otherwise.
/// @throws Failure (kBadInput) if the file cannot be read, has no body with mass, or this program
/// was built without Bullet's importer.
SceneChoice ImportScene(const std::string& path, std::uint64_t seed);

}  // namespace cairn::cli
