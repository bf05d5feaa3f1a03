// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "support/command.h"

namespace cairn::cli {

// The commands of the tool, each with its options and what it writes; one file each.
Command AddRunCommand(CLI::App* app);
Command AddSmallCommand(CLI::App* run);  ///< `cairn run small`
Command AddCompareCommand(CLI::App* app);
Command AddRecordCommand(CLI::App* app);
Command AddSolveCommand(CLI::App* app);
Command AddWorldsCommand(CLI::App* app);

/// `cairn doctor`: what this machine and this build are, and how far timings can be trusted. Takes
/// about a second. Writes the same as JSON to `json_path` unless that is empty.
void Doctor(const std::string& json_path);

/// `cairn doctor --verify`: whether this machine gives the answers of the golden files, to the bit;
/// of the other precision, too, if its program is there. Takes ten seconds. @return kFine, or
/// kCheckFailed and where they first differ
int DoctorVerify();
/// The same of this precision alone, in one line.
int DoctorVerifyWorlds();

/// `cairn doctor --bullet`: one line on the Bullet that this program runs with.
void DoctorBullet();

enum class ListForm { kText, kJson };

/// `cairn list scenes`, `cairn list problems` and `cairn list solvers`, to stdout.
void ListScenes(ListForm form);
void ListProblems(ListForm form);
void ListSolvers(ListForm form);
/// All three, with what they are for; as JSON an object of the three.
void ListAll(ListForm form);

}  // namespace cairn::cli
