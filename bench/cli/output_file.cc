// SPDX-License-Identifier: MIT
#include "cli/output_file.h"

#include <fmt/format.h>

#include <cerrno>
#include <cstring>
#include <fstream>

#include "cli/failure.h"

namespace cairn::cli {
namespace {

[[noreturn]] void Refuse(const std::string& path) {
  throw Failure(kBadInput, fmt::format("cannot write '{}': {}", path, std::strerror(errno)));
}

}  // namespace

void CheckWritable(const std::string& path) {
  if (!std::ofstream(path, std::ios::app)) Refuse(path);
}

void WriteFile(const std::string& path, const std::string& text) {
  std::ofstream file(path, std::ios::trunc | std::ios::binary);
  file << text << std::flush;
  if (!file) Refuse(path);
}

}  // namespace cairn::cli
