// SPDX-License-Identifier: MIT
#include "run/output/run_output.h"

#include <fmt/format.h>

#include "support/text_table.h"

namespace cairn::cli {
namespace {

double VelocityError(const SceneResult& scene, const SolverResult& solver, int frame) {
  for (size_t i = 0; i < scene.samples.size() && i < solver.velocity_errors.size(); ++i) {
    if (scene.samples[i].frame == frame) return solver.velocity_errors[i];
  }
  return kNotMeasured;
}

}  // namespace

std::string ToCsv(const RunResult& run) {
  std::string text =
      "scene,size,seed,solver,frame,time_ms,iterations,residual_m_s,velocity_error_m_s,"
      "steps_accepted,steps_restored,factorisations,guarded\n";
  for (const SceneResult& scene : run.scenes) {
    for (const SolverResult& solver : scene.solvers) {
      for (int i = 0; i < static_cast<int>(solver.frames.size()); ++i) {
        const Frame& frame = solver.frames[i];
        text += fmt::format("{},{},{},{},{},{},{},{},{},{},{},{},{}\n", scene.name, scene.size,
                            scene.seed, solver.label, i, FormatCell(frame.time), frame.iterations,
                            FormatCell(frame.residual), FormatCell(VelocityError(scene, solver, i)),
                            frame.steps_accepted, frame.steps_restored, frame.factorisations,
                            frame.guarded);
      }
    }
  }
  return text;
}

}  // namespace cairn::cli
