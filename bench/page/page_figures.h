// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "run/result.h"

namespace cairn::cli {

/// Pictures as SVG, for a page without scripts, or before they run.
std::string TimePlot(const SceneResult& scene, const RunResult& run);
std::string ResidualPlot(const SceneResult& scene, const RunResult& run);
std::string ErrorTimePlot(const SceneResult& scene);
std::string FactBars(const SceneResult& scene);

}  // namespace cairn::cli
