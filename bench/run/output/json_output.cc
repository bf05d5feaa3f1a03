// SPDX-License-Identifier: MIT
#include "run/output/run_output.h"

#include <nlohmann/json.hpp>

#include "run/summary.h"
#include "support/duration.h"
#include "support/json_number.h"

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
          {"factorisations", s.factorisations},
          {"guarded", s.guarded}};
}

Json Facts(const SolverResult& solver) {
  Json facts = Json::array();
  for (const Fact& fact : solver.facts) {
    facts.push_back({{"name", fact.name}, {"unit", fact.unit}, {"value", Number(fact.value)}});
  }
  return facts;
}

/// Values that count: null elsewhere.
Json Repetition(const std::vector<Frame>& frames, const SceneResult& scene) {
  Json times = Json::array(), residuals = Json::array();
  for (int i = 0; i < static_cast<int>(frames.size()); ++i) {
    times.push_back(IsTimed(scene, i) ? Number(frames[i].time) : Json(nullptr));
    residuals.push_back(i < scene.warmup ? Json(nullptr) : Number(frames[i].residual));
  }
  return {{"time_ms", times}, {"residual_m_s", residuals}};
}

Json ToJson(const SolverResult& solver, const SceneResult& scene, const RunResult& run) {
  Json errors = Json::array();
  for (double error : solver.velocity_errors) errors.push_back(Number(error));
  Json failure = nullptr;
  if (solver.failure) {
    failure = {{"frame", solver.failure->frame}, {"reason", solver.failure->reason}};
  }
  Json repetitions = {Repetition(solver.frames, scene)};
  for (const auto& frames : solver.repeated) repetitions.push_back(Repetition(frames, scene));
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
            {"steps_restored", PerFrame(solver, &Frame::steps_restored)},
            {"guarded", PerFrame(solver, &Frame::guarded)}}},
          {"repetitions", repetitions}};
}

Json ToJson(const std::vector<Metronome::Beat>& beats) {
  Json arithmetic = Json::array(), memory = Json::array();
  for (const Metronome::Beat& beat : beats) {
    arithmetic.push_back(beat.arithmetic);
    memory.push_back(beat.memory);
  }
  return {{"arithmetic_ms", arithmetic}, {"memory_ms", memory}};
}

Json ToJson(const std::optional<Scaling>& scaling) {
  if (!scaling) return nullptr;
  Json threads = Json::array(), targets = Json::array();
  for (const Scaling::Timing& timing : scaling->threads) {
    threads.push_back({{"threads", std::stoi(timing.name)}, {"time_ms", Number(timing.time)}});
  }
  for (const Scaling::Timing& timing : scaling->targets) {
    targets.push_back({{"simd", timing.name}, {"time_ms", Number(timing.time)}});
  }
  return {{"rows", scaling->rows}, {"by_threads", threads}, {"by_simd", targets}};
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
  Json beats = Json::array();
  for (const auto& repetition : scene.beats) beats.push_back(ToJson(repetition));
  return {{"scene", scene.name},    {"size", scene.size},
          {"seed", scene.seed},     {"bodies", scene.bodies},
          {"joints", scene.joints}, {"residual_every", scene.observed_every},
          {"samples", samples},     {"solvers", solvers},
          {"metronome", beats},     {"scaling", ToJson(scene.scaling)}};
}

}  // namespace

std::string ToJson(const RunResult& run) {
  Json context = ToJson(static_cast<const RunContext&>(run));
  context["run"] = ToJson(run.setup);
  context["run"].update({{"warmup_frames", run.warmup},
                         {"repetitions", run.repeat},
                         {"noise_shown", run.show_noise}});
  Json scenes = Json::array();
  for (const SceneResult& scene : run.scenes) scenes.push_back(ToJson(scene, run));
  const Json json = {{"schema_version", kRunSchema},
                     {"context", context},
                     {"frames", run.frames},
                     {"budget_ms", run.budget ? Json(Milliseconds(*run.budget)) : Json(nullptr)},
                     {"budget_units", Maybe(run.units)},
                     {"scenes", scenes}};
  return json.dump(1) + "\n";
}

}  // namespace cairn::cli
