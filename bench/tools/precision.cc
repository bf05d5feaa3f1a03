// SPDX-License-Identifier: MIT
#include "tools/precision.h"

#include <LinearMath/btScalar.h>
#include <fmt/format.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>

#include "support/failure.h"

namespace cairn::cli {
namespace {

std::string ProgramFor(const std::string& precision) {
  return precision == "float64" ? "cairn-float64" : "cairn";
}

}  // namespace

std::string OwnPrecision() {
#ifdef BT_USE_DOUBLE_PRECISION
  return "float64";
#else
  return "float";
#endif
}

std::optional<std::string> FindSibling(const std::string& precision) {
  std::error_code error;
  const std::filesystem::path own = std::filesystem::read_symlink("/proc/self/exe", error);
  const std::filesystem::path sibling = own.parent_path() / ProgramFor(precision);
  if (error || access(sibling.c_str(), X_OK) != 0) return {};
  return sibling.string();
}

void ContinueAs(const std::string& precision, const std::vector<std::string>& arguments) {
  const std::optional<std::string> sibling = FindSibling(precision);
  if (!sibling) {
    throw Failure(kBadInput,
                  fmt::format("there is no '{}' beside this program: it is built with Cairn if the "
                              "{} libraries of Bullet are installed (Debian: libbullet-dev)",
                              ProgramFor(precision), precision));
  }
  std::vector<char*> words = {const_cast<char*>(sibling->c_str())};
  for (const std::string& argument : arguments)
    words.push_back(const_cast<char*>(argument.c_str()));
  words.push_back(nullptr);
  execv(sibling->c_str(), words.data());
  throw Failure(kBadInput, fmt::format("cannot start '{}': {}", *sibling, std::strerror(errno)));
}

std::string FirstLineOf(const std::string& program, const std::string& arguments) {
  std::string command = "'";
  for (const char c : program) command += c == '\'' ? std::string("'\\''") : std::string(1, c);
  std::FILE* const pipe = popen((command + "' " + arguments + " 2>/dev/null").c_str(), "r");
  if (pipe == nullptr) return "";
  std::array<char, 512> line{};
  const bool read = std::fgets(line.data(), static_cast<int>(line.size()), pipe) != nullptr;
  const bool fine = pclose(pipe) == 0;
  if (!read || !fine) return "";
  const std::string text = line.data();
  return text.substr(0, text.find('\n'));
}

}  // namespace cairn::cli
