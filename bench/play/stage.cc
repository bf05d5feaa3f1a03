// SPDX-License-Identifier: MIT
#include "play/stage.h"

#include "run/imported_scene.h"
#include "run/scene_choice.h"
#include "worlds/random_world.h"

namespace cairn::play {
namespace {

class SceneStage : public Stage {
 public:
  SceneStage(const cli::SceneChoice& choice, btConstraintSolver* solver)
      : world_(solver), info_(choice.info), scene_(choice.make()) {
    scene_->Build(&world_, {.size = choice.size, .seed = choice.seed});
  }
  bench::World& world() override { return world_; }
  void Step(int frame, int parts) override {
    scene_->BeforeStep(&world_, frame);
    world_.Step(parts);
  }

 private:
  bench::World world_;
  std::shared_ptr<const bench::SceneInfo> info_;
  std::unique_ptr<bench::Scene> scene_;
};

class RandomStage : public Stage {
 public:
  RandomStage(int seed, btConstraintSolver* solver)
      : world_({.seed = static_cast<std::uint64_t>(seed)}, solver) {}
  bench::World& world() override { return world_.world(); }
  void Step(int, int) override { world_.Step(); }
  bool has_own_steps() const override { return true; }

 private:
  bench::RandomWorld world_;
};

class RecordedStage : public Stage {
 public:
  RecordedStage(const std::string& path, btConstraintSolver* solver)
      : frame_(cli::LoadRowProblem(path), solver) {}
  bench::World& world() override { return frame_.world(); }
  void Step(int, int) override {}
  bool has_own_steps() const override { return true; }
  cli::FrameWorld* recorded() override { return &frame_; }

 private:
  cli::FrameWorld frame_;
};

}  // namespace

std::unique_ptr<Stage> MakeStage(const SceneControls& scene, btConstraintSolver* solver) {
  if (scene.scene.ends_with(".cairn")) return std::make_unique<RecordedStage>(scene.scene, solver);
  if (scene.scene == "random") return std::make_unique<RandomStage>(scene.seed, solver);
  const auto seed = static_cast<std::uint64_t>(scene.seed);
  if (scene.scene.ends_with(".bullet")) {
    return std::make_unique<SceneStage>(cli::ImportScene(scene.scene, seed), solver);
  }
  cli::SceneChoice choice =
      cli::ParseScene(scene.scene, scene.size == 0 ? "" : std::to_string(scene.size));
  choice.seed = seed;
  return std::make_unique<SceneStage>(choice, solver);
}

}  // namespace cairn::play
