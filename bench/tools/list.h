// SPDX-License-Identifier: MIT
#pragma once

namespace cairn::cli {

enum class ListForm { kText, kJson };

/// `cairn list scenes`, `cairn list problems` and `cairn list solvers`, to stdout.
void ListScenes(ListForm form);
void ListProblems(ListForm form);
void ListSolvers(ListForm form);
/// All three, with what they are for; as JSON an object of the three.
void ListAll(ListForm form);

}  // namespace cairn::cli
