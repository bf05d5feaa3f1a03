// SPDX-License-Identifier: MIT
#include <nlohmann/json.hpp>

#include "accuracy/command.h"
#include "accuracy/states/states.h"
#include "support/json_number.h"

namespace cairn::accuracy {
namespace {

using cli::Number;
using Json = nlohmann::ordered_json;

Json ToJson(const CairnResult& cairn) {
  const ShadowFrame& frame = cairn.frame;
  return {{"error", accuracy::ToJson(cairn.error)},
          {"residual_max_m_s", Number(frame.residual_max)},
          {"cpu_ms", Number(frame.time.cpu)},
          {"wall_ms", Number(frame.time.wall)},
          {"interrupted", frame.time.preempted},
          {"build_ms", Number(frame.build)},
          {"solve_ms", Number(frame.solve)},
          {"write_ms", Number(frame.write)},
          {"sweeps", frame.sweeps},
          {"factorisations", frame.factorisations},
          {"steps_accepted", frame.accepted},
          {"steps_restored", frame.restored},
          {"worth_bullet_iterations", cli::Maybe(cairn.worth)}};
}

Json ToJson(const Tail& tail) {
  return {{"p50", Number(tail.p50)}, {"p99", Number(tail.p99)}, {"max", Number(tail.max)}};
}

Json ToJson(const FrameStatistics& frames) {
  return {{"frames", frames.frames},
          {"interrupted", frames.interrupted},
          {"share_with_a_step", Number(frames.stepped)},
          {"share_of_steps_restored", Number(frames.restored)},
          {"factorisations_per_frame", Number(frames.factorisations)},
          {"cpu_over_budget_us", ToJson(frames.cpu_over)},
          {"wall_over_budget_us", ToJson(frames.wall_over)},
          {"wall_over_budget_uninterrupted_us", ToJson(frames.wall_over_calm)},
          {"step_prediction_error", ToJson(frames.step_error)}};
}

Json ToJson(const StateResult& state) {
  const BulletTime& time = state.bullet_time;
  const bench::Converged& reference = state.reference;
  return {{"frame", state.frame},
          {"bodies", state.bodies},
          {"rows", state.rows},
          {"reference",
           {{"residual_max_m_s", Number(reference.residual_max)},
            {"residual_energy_sqrt_j", Number(reference.residual_energy)},
            {"sweeps", reference.sweeps},
            {"factorisations", reference.factorisations},
            {"converged", reference.reached},
            {"spread", accuracy::ToJson(reference.spread)}}},
          {"bullet",
           {{"error", accuracy::ToJson(state.bullet_error)},
            {"error_of_warm_start", accuracy::ToJson(state.start_error)},
            {"set_up_ms", Number(time.set_up)},
            {"iterations_ms", Number(time.iterations)},
            {"split_ms", Number(time.split)},
            {"finish_ms", Number(time.finish)},
            {"followed_iterations", state.followed},
            {"error_after_them", accuracy::ToJson(state.last_error)}}},
          {"budget_ms", Number(time.total())},
          {"sweeps", ToJson(state.Of(Kind::kSweeps))},
          {"accelerated", ToJson(state.Of(Kind::kAccelerated))},
          {"steps", ToJson(state.Of(Kind::kSteps))},
          {"worse_than_sweeps", state.StepsAreWorseThan(Kind::kSweeps)},
          {"worse_than_accelerated", state.StepsAreWorseThan(Kind::kAccelerated)}};
}

}  // namespace

Json ToJson(std::span<const SceneStates> scenes, const StatesOptions& options) {
  Json list = Json::array();
  for (const SceneStates& scene : scenes) {
    Json states = Json::array();
    for (const StateResult& state : scene.states) states.push_back(ToJson(state));
    list.push_back({{"scene", scene.scene.info->name},
                    {"size", scene.scene.size},
                    {"seed", scene.scene.seed},
                    {"goal", Number(GoalOf(scene.scene.info->name))},
                    {"empty_samples", scene.empty},
                    {"frames_with_steps", ToJson(StatisticsOf(scene.frames))},
                    {"states", states}});
  }
  return {{"frames", options.frames},
          {"samples", options.samples},
          {"iterations", options.iterations},
          {"advance", options.advance},
          {"rounds", options.rounds},
          {"converged_to_m_s", bench::kConvergedTo},
          {"reference_work_millions", options.reference},
          {"scenes", list}};
}

}  // namespace cairn::accuracy
