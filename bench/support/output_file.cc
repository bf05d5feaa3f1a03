// SPDX-License-Identifier: MIT
#include "support/output_file.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <set>
#include <span>
#include <system_error>

#include "cairn/detail/whole_file.h"
#include "support/failure.h"

namespace cairn::cli {
namespace {

void RefuseIf(const std::error_code& error, const std::string& path) {
  if (!error) return;
  throw Failure(kBadInput, fmt::format("cannot write '{}': {}", path, error.message()));
}

}  // namespace

void CheckWritable(const std::string& path) { RefuseIf(TryWholeFile(path), path); }

void CheckWritable(std::span<const std::string> paths) {
  std::set<std::filesystem::path> files;
  for (const std::string& path : paths) {
    if (path.empty()) continue;
    CheckWritable(path);
    std::error_code error;
    const bool is_device =
        std::filesystem::exists(path, error) && !std::filesystem::is_regular_file(path, error);
    if (is_device) continue;
    if (!files.insert(std::filesystem::weakly_canonical(path, error)).second) {
      throw Failure(kUsage, fmt::format("'{}' is written to twice: give each file a name", path));
    }
  }
}

void CheckFolder(const std::string& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) {
    throw Failure(kBadInput, fmt::format("cannot make folder '{}': {}", folder, error.message()));
  }
  if (access(folder.c_str(), W_OK | X_OK) != 0) {
    throw Failure(kBadInput, fmt::format("cannot write into folder '{}'", folder));
  }
}

void WriteFile(const std::string& path, const std::string& text) {
  RefuseIf(WriteWholeFile(path, std::as_bytes(std::span(text))), path);
}

void FinishOutput() {
  errno = 0;
  // what was printed earlier may have failed, and then nothing is left to be flushed
  const bool before = std::ferror(stdout) != 0;
  if (std::fflush(stdout) == 0 && !before) return;
  throw Failure(kBadInput, fmt::format("cannot write the output: {}",
                                       errno != 0 ? std::strerror(errno) : "some of it is lost"));
}

}  // namespace cairn::cli
