// SPDX-License-Identifier: MIT
#include <nlohmann/json.hpp>

#include "accuracy/goals.h"
#include "accuracy/report.h"
#include "accuracy/states_output.h"
#include "cli/json_number.h"

namespace cairn::accuracy {
namespace {

using cli::Number;
using Json = nlohmann::ordered_json;

Json ToJson(const CairnResult& cairn) {
  return {{"error", ToJson(cairn.error)},
          {"least_rms_m_s", Number(cairn.least_rms)},
          {"most_rms_m_s", Number(cairn.most_rms)},
          {"residual_max_m_s", Number(cairn.residual_max)},
          {"cpu_ms", Number(cairn.cpu)},
          {"wall_ms", Number(cairn.wall)},
          {"sweeps", Number(cairn.sweeps)},
          {"factorisations", Number(cairn.factorisations)},
          {"steps_accepted", Number(cairn.accepted)},
          {"steps_restored", Number(cairn.restored)},
          {"rounds", cairn.rounds},
          {"interrupted", cairn.preempted},
          {"worth_bullet_iterations", cli::Maybe(cairn.worth)}};
}

Json ToJson(const StateResult& state, Share share) {
  return {{"budget_ms", Number(state.Budget(share))},
          {"sweeps", ToJson(state.Of(share, Kind::kSweeps))},
          {"steps", ToJson(state.Of(share, Kind::kSteps))},
          {"worse_than_sweeps", state.WorseThanSweeps(share)}};
}

Json ToJson(const StateResult& state) {
  const BulletTime& time = state.bullet_time;
  const Converged& reference = state.reference;
  return {{"frame", state.frame},
          {"bodies", state.bodies},
          {"rows", state.rows},
          {"reference",
           {{"residual_max_m_s", Number(reference.residual_max)},
            {"residual_energy_sqrt_j", Number(reference.residual_energy)},
            {"sweeps", reference.sweeps},
            {"factorisations", reference.factorisations},
            {"converged", reference.reached},
            {"spread", ToJson(reference.spread)}}},
          {"bullet",
           {{"error", ToJson(state.bullet_error)},
            {"error_of_warm_start", ToJson(state.start_error)},
            {"set_up_ms", Number(time.set_up)},
            {"iterations_ms", Number(time.iterations)},
            {"split_ms", Number(time.split)},
            {"finish_ms", Number(time.finish)},
            {"followed_iterations", state.followed},
            {"error_after_them", ToJson(state.last_error)}}},
          {"cairn_floor_ms", Number(state.floor)},
          {"in_whole_time", ToJson(state, Share::kWhole)},
          {"in_time_of_iterations", ToJson(state, Share::kIterations)}};
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
                    {"states", states}});
  }
  return {{"frames", options.frames},
          {"samples", options.samples},
          {"iterations", options.iterations},
          {"advance", options.advance},
          {"rounds", options.rounds},
          {"converged_to_m_s", kConvergedTo},
          {"reference_work_millions", options.reference},
          {"scenes", list}};
}

}  // namespace cairn::accuracy
