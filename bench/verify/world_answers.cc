// SPDX-License-Identifier: MIT
#include "verify/world_answers.h"

#include <memory>
#include <string>
#include <utility>

#include "cairn/bullet/constraint_solver.h"
#include "scenes/facts.h"
#include "scenes/scene.h"
#include "scenes/small_scenes.h"

namespace cairn::verify {
namespace {

/// Default settings where the world asks for one direction of friction, as by default it does.
constexpr const char* kAsBulletComes = "one-direction";

std::vector<std::pair<std::string, Settings>> AllSettings() {
  const Settings sweeps{.method = Method::kPgs};
  const Settings work{.budget = Budget::Work(20000)};
  const Settings steps{.max_sweeps = 15, .step_policy = StepPolicy::kAlways};
  return {
      {"defaults", {}}, {kAsBulletComes, {}}, {"sweeps", sweeps}, {"work", work}, {"steps", steps}};
}

Answer AnswerOf(const bench::SmallScene& small, const std::string& name, const Settings& settings) {
#ifdef BT_USE_DOUBLE_PRECISION
  const std::string precision = "float64/";
#else
  const std::string precision = "float/";
#endif
  Answer answer{precision + small.name + "/" + name, {}};
  bullet::ConstraintSolver solver(settings);
  if (name == "steps") solver.options().effort = bullet::Effort::kSettings;
  bench::World world(&solver);
  const std::unique_ptr<bench::Scene> scene = bench::Make(*bench::FindScene(small.name));
  scene->Build(&world, {.size = small.size, .friction_directions = name == kAsBulletComes ? 1 : 2});
  Hash hash;
  for (int frame = 1; frame <= kFrames; ++frame) {
    scene->BeforeStep(&world, frame - 1);
    world.Step();
    hash.Add(bench::StateHash(world));
    if (frame % (kFrames / kMarks) == 0) answer.marks.push_back(hash.value());
  }
  return answer;
}

}  // namespace

std::vector<Answer> WorldAnswers() {
  std::vector<Answer> answers;
  for (const bench::SmallScene& small : bench::kSmallScenes) {
    for (const auto& [name, settings] : AllSettings()) {
      answers.push_back(AnswerOf(small, name, settings));
    }
  }
  return answers;
}

}  // namespace cairn::verify
