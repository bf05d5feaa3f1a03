// SPDX-License-Identifier: MIT
#include "run/output/run_output.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

namespace cairn::cli {
namespace {

using Json = nlohmann::ordered_json;

Json Named(const char* what, int process, int thread, const std::string& name) {
  return {
      {"name", what}, {"ph", "M"}, {"pid", process}, {"tid", thread}, {"args", {{"name", name}}}};
}

/// Microseconds to the nanosecond.
double Microseconds(double milliseconds) { return std::round(milliseconds * 1e6) / 1e3; }

Json ToEvent(const TimelineSpan& span, int process, int thread) {
  Json event = {{"name", span.name},
                {"cat", span.kind},
                {"ph", "X"},
                {"ts", Microseconds(span.begin)},
                {"dur", Microseconds(span.end - span.begin)},
                {"pid", process},
                {"tid", thread}};
  if (span.sweep >= 0) event["args"] = {{"sweep", span.sweep}, {"colour", span.colour}};
  return event;
}

void Add(const SolverResult& solver, const std::string& scene, int process, Json* events) {
  const Timeline& timeline = solver.timeline;
  events->push_back(Named("process_name", process, 0,
                          fmt::format("{}: {}, frame {}, {:.3f} ms in the solver", scene,
                                      solver.label, timeline.frame, timeline.time)));
  for (size_t worker = 0; worker < timeline.workers.size(); ++worker) {
    const int thread = static_cast<int>(worker);
    events->push_back(Named("thread_name", process, thread,
                            worker == 0 ? "the world's thread" : fmt::format("helper {}", worker)));
    for (const TimelineSpan& span : timeline.workers[worker]) {
      events->push_back(ToEvent(span, process, thread));
    }
  }
}

}  // namespace

std::string ToTrace(const RunResult& run) {
  Json events = Json::array(), notes = Json::array();
  int process = 0;
  for (const SceneResult& scene : run.scenes) {
    for (const SolverResult& solver : scene.solvers) {
      if (solver.timeline.frame < 0) {
        notes.push_back(fmt::format("{}: {} has no such frame", scene.name, solver.label));
        continue;
      }
      Add(solver, scene.name, ++process, &events);
      if (solver.timeline.dropped == 0) continue;
      notes.push_back(fmt::format("{}: {} has {} spans more, for which there was no room",
                                  scene.name, solver.label, solver.timeline.dropped));
    }
    if (!scene.bullet_has_zones) {
      notes.push_back("This Bullet was built without its profiler: no zones of it.");
    }
  }
  const Json json = {{"displayTimeUnit", "ms"},
                     {"otherData", {{"command", run.command}, {"notes", notes}}},
                     {"traceEvents", events}};
  return json.dump() + "\n";
}

}  // namespace cairn::cli
