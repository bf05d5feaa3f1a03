// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace cairn::cli {

/// `cairn doctor`: what this machine and this build are, and how far timings can be trusted. Takes
/// about a second. Writes the same as JSON to `json_path` unless that is empty.
void Doctor(const std::string& json_path);

/// `cairn doctor --bullet`: one line on the Bullet that this program runs with.
void DoctorBullet();

}  // namespace cairn::cli
