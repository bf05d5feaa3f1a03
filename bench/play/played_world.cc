// SPDX-License-Identifier: MIT
#include "play/played_world.h"

#include "run/imported_scene.h"
#include "run/scene_choice.h"
#include "run/scene_run.h"
#include "worlds/random_world.h"

namespace cairn::play {
namespace {

class PlayedScene : public PlayedWorld {
 public:
  PlayedScene(const cli::SceneChoice& choice, btConstraintSolver* solver)
      : scene_(choice, solver) {}
  bench::World& world() override { return scene_.world(); }
  void Step(int parts) override { scene_.Step(parts); }

 private:
  cli::BuiltScene scene_;
};

class PlayedRandomWorld : public PlayedWorld {
 public:
  PlayedRandomWorld(int seed, btConstraintSolver* solver)
      : world_({.seed = static_cast<std::uint64_t>(seed)}, solver) {}
  bench::World& world() override { return world_.world(); }
  void Step(int) override { world_.Step(); }
  bool has_own_steps() const override { return true; }

 private:
  bench::RandomWorld world_;
};

class PlayedRecording : public PlayedWorld {
 public:
  PlayedRecording(const std::string& path, btConstraintSolver* solver)
      : frame_(cli::LoadRowProblem(path), solver) {}
  bench::World& world() override { return frame_.world(); }
  void Step(int) override {}
  bool has_own_steps() const override { return true; }
  cli::FrameWorld* recorded() override { return &frame_; }

 private:
  cli::FrameWorld frame_;
};

}  // namespace

std::unique_ptr<PlayedWorld> MakePlayedWorld(const SceneControls& scene,
                                             btConstraintSolver* solver) {
  if (scene.scene.ends_with(".cairn"))
    return std::make_unique<PlayedRecording>(scene.scene, solver);
  if (scene.scene == "random") return std::make_unique<PlayedRandomWorld>(scene.seed, solver);
  const auto seed = static_cast<std::uint64_t>(scene.seed);
  if (scene.scene.ends_with(".bullet")) {
    return std::make_unique<PlayedScene>(cli::ImportScene(scene.scene, seed), solver);
  }
  cli::SceneChoice choice =
      cli::ParseScene(scene.scene, scene.size == 0 ? "" : std::to_string(scene.size));
  choice.seed = seed;
  return std::make_unique<PlayedScene>(choice, solver);
}

}  // namespace cairn::play
