// SPDX-License-Identifier: MIT
#include "page/html_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "run/output/run_output.h"
#include "run/summary.h"
#include "support/duration.h"
#include "support/json_number.h"

namespace cairn::cli {
namespace {

using Json = nlohmann::ordered_json;

/// Of all animations of a page, in base64: with scripts and the rest the page stays below 8 MB.
constexpr size_t kAnimationBytes = 6'000'000;

/// Four digits are more than a picture shows.
Json Short(double value) {
  if (!std::isfinite(value)) return nullptr;
  return Json::parse(fmt::format("{:.4g}", value));
}

template <class Get>
Json PerFrame(const SolverResult& solver, Get get) {
  Json values = Json::array();
  for (const Frame& frame : solver.frames) values.push_back(Short(get(frame)));
  return values;
}

Json Facts(const SolverResult& solver) {
  const auto fact = [&](double FrameFacts::*member) {
    return PerFrame(solver, [member](const Frame& frame) { return frame.facts.*member; });
  };
  return {{"energy", fact(&FrameFacts::energy)},
          {"penetration", fact(&FrameFacts::penetration)},
          {"height_lost", fact(&FrameFacts::height_lost)},
          {"joint_gap", fact(&FrameFacts::joint_gap)}};
}

/// Names and kinds once, and of every span: name, kind, begin, end, sweep, colour.
Json ToJson(const Timeline& timeline) {
  std::vector<std::string> names, kinds;
  const auto number = [](std::vector<std::string>* list, const std::string& name) {
    const auto place = std::find(list->begin(), list->end(), name);
    if (place != list->end()) return place - list->begin();
    list->push_back(name);
    return static_cast<std::ptrdiff_t>(list->size()) - 1;
  };
  Json workers = Json::array();
  for (const auto& worker : timeline.workers) {
    Json spans = Json::array();
    for (const TimelineSpan& span : worker) {
      spans.push_back({number(&names, span.name), number(&kinds, span.kind),
                       std::round(span.begin * 1e4) / 1e4, std::round(span.end * 1e4) / 1e4,
                       span.sweep, span.colour});
    }
    workers.push_back(spans);
  }
  return {{"frame", timeline.frame}, {"time", Short(timeline.time)}, {"names", names},
          {"kinds", kinds},          {"workers", workers},           {"dropped", timeline.dropped}};
}

Json Curves(const SolverResult& solver) {
  Json curves = Json::array();
  for (const std::vector<CurvePoint>& curve : solver.curves) {
    Json points = Json::array();
    for (const CurvePoint& point : curve) {
      points.push_back(
          {Short(point.time), Short(point.error), point.iterations, point.factorisations});
    }
    curves.push_back(points);
  }
  return curves;
}

Json ToJson(const SolverResult& solver, const SceneResult& scene, const RunResult& run) {
  const Summary summary = Summarise(solver, scene, run.budget);
  return {{"label", solver.label},
          {"effort", solver.effort},
          {"ours", solver.is_ours},
          {"failed_at", solver.failure ? Json(solver.failure->frame) : Json(nullptr)},
          {"p50", Short(summary.p50)},
          {"time", PerFrame(solver, [](const Frame& frame) { return frame.time; })},
          {"residual", PerFrame(solver, [](const Frame& frame) { return frame.residual; })},
          {"facts", Facts(solver)},
          {"curves", Curves(solver)},
          {"timeline", ToJson(solver.timeline)}};
}

/// Rows, and ns for each of them with each number of threads and each instruction set.
Json Timings(const std::optional<Scaling>& scaling) {
  if (!scaling) return nullptr;
  const auto times = [&](const std::vector<Scaling::Timing>& timings) {
    Json values = Json::array();
    for (const Scaling::Timing& timing : timings)
      values.push_back(Short(1e6 * timing.time / scaling->rows));
    return values;
  };
  return {{"rows", scaling->rows},
          {"threads", times(scaling->threads)},
          {"targets", times(scaling->targets)}};
}

Json ToJson(const SceneResult& scene, const RunResult& run) {
  Json solvers = Json::array(), untimed = Json::array();
  for (const SolverResult& solver : scene.solvers) solvers.push_back(ToJson(solver, scene, run));
  for (const Sample& sample : scene.samples) {
    untimed.push_back(sample.frame - 1);
    untimed.push_back(sample.frame);
  }
  return {{"name", scene.name},
          {"bodies", scene.bodies},
          {"residual_every", scene.observed_every},
          {"untimed", untimed},
          {"bullet_has_zones", scene.bullet_has_zones},
          {"solvers", solvers},
          {"scaling", Timings(scene.scaling)},
          {"replay", PackAnimation(scene, kAnimationBytes / run.scenes.size())}};
}

}  // namespace

std::string PageData(const RunResult& run) {
  Json scenes = Json::array();
  for (const SceneResult& scene : run.scenes) scenes.push_back(ToJson(scene, run));
  const Json json = {{"schema", 1},
                     {"frames", run.frames},
                     {"budget", run.budget ? Json(Milliseconds(*run.budget)) : Json(nullptr)},
                     {"budgets", FixedBudgets(run)},
                     {"scenes", scenes}};
  std::string text = json.dump(-1, ' ', true);
  // "</script>" inside a text would end the element
  for (size_t at = 0; (at = text.find("</", at)) != std::string::npos;) text.replace(at, 2, "<\\/");
  return text;
}

}  // namespace cairn::cli
