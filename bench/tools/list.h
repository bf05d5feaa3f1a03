// SPDX-License-Identifier: MIT
#pragma once

namespace cairn::cli {

enum class ListForm { kText, kJson };

/// `cairn list scenes`, `cairn list problems` and `cairn list solvers`, to stdout.
void ListScenes(ListForm form);
void ListProblems(ListForm form);
void ListSolvers(ListForm form);

}  // namespace cairn::cli
