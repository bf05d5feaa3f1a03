// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace cairn::cli {

/// How this program was built, and which Bullet it runs with.
struct BuildInfo {
  std::string version;           ///< of Cairn
  std::string compiler;          ///< "GCC 12.2.0"
  std::string build_type;        ///< "Release"
  std::string bullet_version;    ///< "3.24"
  std::string bullet_precision;  ///< "float" or "float64"
  std::string bullet_library;    ///< File name of the library in use: "libBulletDynamics.so.3.24".
  std::string bullet_rows;       ///< "scalar rows" or "SIMD rows"
  std::string bullet_threads;    ///< "one thread" or "thread-safe build"
};

BuildInfo DescribeBuild();

/// "Bullet 3.24 float, scalar rows, one thread (libBulletDynamics.so.3.24)"
std::string DescribeBullet(const BuildInfo& build);

}  // namespace cairn::cli
