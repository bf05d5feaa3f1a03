// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "verify/answers.h"

namespace cairn::verify {

/// Small scenes in Bullet of this precision under four settings. Takes ten seconds.
std::vector<Answer> WorldAnswers();
/// Those of the golden file of this precision.
std::vector<Answer> GoldenWorldAnswers();

}  // namespace cairn::verify
