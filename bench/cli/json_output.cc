// SPDX-License-Identifier: MIT
#include "cli/json_output.h"

#include <nlohmann/json.hpp>

#include "cli/duration.h"
#include "cli/json_number.h"
#include "cli/summary.h"

namespace cairn::cli {
namespace {

using Json = nlohmann::ordered_json;

template <class Member>
Json PerFrame(const SolverResult& solver, Member member) {
  Json values = Json::array();
  for (const Frame& frame : solver.frames) values.push_back(Number(frame.*member));
  return values;
}

Json ToJson(const Summary& s) {
  return {{"p50_ms", Number(s.p50)},
          {"p99_ms", Number(s.p99)},
          {"p99_9_ms", Number(s.p999)},
          {"max_ms", Number(s.max)},
          {"timed_frames", s.timed_frames},
          {"overruns", Maybe(s.overruns)},
          {"iterations_mean", Number(s.iterations)},
          {"residual_mean_m_s", Number(s.residual_mean)},
          {"residual_max_m_s", Number(s.residual_max)},
          {"velocity_error_median_m_s", Number(s.error_median)},
          {"velocity_error_max_m_s", Number(s.error_max)},
          {"steps_accepted", s.steps_accepted},
          {"steps_restored", s.steps_restored},
          {"factorisations", s.factorisations}};
}

Json Facts(const SolverResult& solver) {
  Json facts = Json::array();
  for (const Fact& fact : solver.facts) {
    facts.push_back({{"name", fact.name}, {"unit", fact.unit}, {"value", Number(fact.value)}});
  }
  return facts;
}

Json ToJson(const SolverResult& solver, const SceneResult& scene, const RunResult& run) {
  Json errors = Json::array();
  for (double error : solver.velocity_errors) errors.push_back(Number(error));
  Json failure = nullptr;
  if (solver.failure) {
    failure = {{"frame", solver.failure->frame}, {"reason", solver.failure->reason}};
  }
  return {{"solver", solver.label},
          {"effort", solver.effort},
          {"failure", failure},
          {"summary", ToJson(Summarise(solver, scene, run.budget))},
          {"fallback_share", Maybe(solver.fallback_share)},
          {"standing", Maybe(solver.standing)},
          {"facts", Facts(solver)},
          {"velocity_errors_m_s", errors},
          {"frames",
           {{"time_ms", PerFrame(solver, &Frame::time)},
            {"iterations", PerFrame(solver, &Frame::iterations)},
            {"residual_m_s", PerFrame(solver, &Frame::residual)},
            {"steps_accepted", PerFrame(solver, &Frame::steps_accepted)},
            {"steps_restored", PerFrame(solver, &Frame::steps_restored)}}}};
}

Json ToJson(const SceneResult& scene, const RunResult& run) {
  Json samples = Json::array();
  for (const Sample& sample : scene.samples) {
    samples.push_back({{"frame", sample.frame},
                       {"state_from", sample.source},
                       {"reference_residual_m_s", Number(sample.reference_residual)}});
  }
  Json solvers = Json::array();
  for (const SolverResult& solver : scene.solvers) solvers.push_back(ToJson(solver, scene, run));
  return {{"scene", scene.name},    {"size", scene.size},
          {"seed", scene.seed},     {"bodies", scene.bodies},
          {"joints", scene.joints}, {"residual_every", scene.observed_every},
          {"samples", samples},     {"solvers", solvers}};
}

}  // namespace

std::string ToJson(const RunResult& run) {
  Json scenes = Json::array();
  for (const SceneResult& scene : run.scenes) scenes.push_back(ToJson(scene, run));
  const Json json = {{"schema", 1},
                     {"context", ToJson(static_cast<const RunContext&>(run))},
                     {"frames", run.frames},
                     {"budget_ms", run.budget ? Json(Milliseconds(*run.budget)) : Json(nullptr)},
                     {"scenes", scenes}};
  return json.dump(1) + "\n";
}

}  // namespace cairn::cli
