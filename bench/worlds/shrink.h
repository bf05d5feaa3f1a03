// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "worlds/campaign.h"

namespace cairn::bench {

/// The smallest world found that still fails, and the frame that is worst in it.
struct Shrunk {
  WorldSeed world;
  double seconds = 0;
  Finding finding;  ///< The same oracle as at first.
  Trial trial;      ///< With every substep audited.
  int worst_frame =
      0;  ///< Of the audit; where none was violated, where it flew apart, or the last.
};

/// Fewer bodies first, then less time.
/// @param result   a world that fails with the variant of that index
/// @param variant  index in the variants of the options
Shrunk Shrink(const CampaignOptions& options, const WorldResult& result, size_t variant);

/// Writes the problem of the worst frame to a file.
/// @return whether there is one: not with a solver that is not Cairn's, not of numbers that a
/// recording cannot hold
bool RecordWorstFrame(const Shrunk& shrunk, const Variant& variant, const std::string& path);

}  // namespace cairn::bench
