// SPDX-License-Identifier: MIT
#include "recording_problems.h"

#include "manifold_problems.h"

namespace cairn::test {

Recording RandomRecording(std::uint64_t seed) {
  Random random(seed + 1000);
  ManifoldScene scene = RandomManifolds(6, 9, seed);
  scene.rows = RandomPile({.bodies = 6, .contacts = 7, .pins = 2}, seed).rows;
  for (Row& row : scene.rows) row.compliance = random.Uniform(0, 0.1);
  AddJoints(4, seed, &scene);
  scene.row_impulses.clear();
  for (std::size_t i = 0; i < scene.rows.size(); ++i) {
    scene.row_impulses.push_back(random.Uniform(-1, 1));
  }
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) scene.bodies[i].id = seed + 17 * i;
  Recording recording;
  recording.Assign(scene.problem(), scene.impulses());
  recording.source = "a pile of no game";
  recording.frame = 40 + static_cast<std::int64_t>(seed);
  recording.settings.max_sweeps = 20;
  recording.settings.tolerance = 0;
  return recording;
}

}  // namespace cairn::test
