// SPDX-License-Identifier: MIT
#include "support/machine/build_info.h"

#include <LinearMath/btThreads.h>
#include <btBulletDynamicsCommon.h>
#include <dlfcn.h>
#include <fmt/format.h>

#include <memory>
#include <string_view>

namespace cairn::cli {
namespace {

std::string Compiler() {
#if defined(__clang__)
  return fmt::format("Clang {}.{}.{}", __clang_major__, __clang_minor__, __clang_patchlevel__);
#elif defined(__GNUC__)
  return fmt::format("GCC {}.{}.{}", __GNUC__, __GNUC_MINOR__, __GNUC_PATCHLEVEL__);
#else
  return "unknown";
#endif
}

/// The file name only: paths say more about a machine than a report should.
std::string BulletLibrary() {
  Dl_info info{};
  if (dladdr(reinterpret_cast<const void*>(&btCreateDefaultTaskScheduler), &info) == 0) return "";
  const std::string_view path = info.dli_fname;
  return std::string(path.substr(path.rfind('/') + 1));
}

/// Bullet compiles its vector code in only for some compilers and precisions; its headers decide.
std::string Rows() {
#if defined(BT_USE_SSE) || defined(BT_USE_NEON)
  return "SIMD rows";
#else
  return "scalar rows";
#endif
}

std::string Threads() {
  // Null exactly if the library was built without BT_THREADSAFE.
  const std::unique_ptr<btITaskScheduler> scheduler(btCreateDefaultTaskScheduler());
  return scheduler ? "thread-safe build" : "one thread";
}

}  // namespace

BuildInfo DescribeBuild() {
  return {.version = CAIRN_VERSION,
          .compiler = Compiler(),
          .build_type = CAIRN_BUILD_TYPE,
          .bullet_version = fmt::format("{}.{:02}", btGetVersion() / 100, btGetVersion() % 100),
          .bullet_precision = btIsDoublePrecision() ? "float64" : "float",
          .bullet_library = BulletLibrary(),
          .bullet_rows = Rows(),
          .bullet_threads = Threads()};
}

std::string DescribeBullet(const BuildInfo& build) {
  return fmt::format("Bullet {} {}, {}, {} ({})", build.bullet_version, build.bullet_precision,
                     build.bullet_rows, build.bullet_threads, build.bullet_library);
}

}  // namespace cairn::cli
