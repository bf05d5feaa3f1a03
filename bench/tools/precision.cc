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

/// The path of a program beside this one, if it is there.
std::optional<std::string> FindProgram(const std::string& name) {
  std::error_code error;
  const std::filesystem::path own = std::filesystem::read_symlink("/proc/self/exe", error);
  const std::filesystem::path sibling = own.parent_path() / name;
  if (error || access(sibling.c_str(), X_OK) != 0) return {};
  return sibling.string();
}

/// Does not come back.
[[noreturn]] void Become(const std::string& program, const std::vector<std::string>& arguments) {
  std::vector<char*> words = {const_cast<char*>(program.c_str())};
  for (const std::string& argument : arguments)
    words.push_back(const_cast<char*>(argument.c_str()));
  words.push_back(nullptr);
  execv(program.c_str(), words.data());
  throw Failure(kBadInput, fmt::format("cannot start '{}': {}", program, std::strerror(errno)));
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
  return FindProgram(ProgramFor(precision));
}

void ContinueAs(const std::string& precision, const std::vector<std::string>& arguments) {
  const std::optional<std::string> sibling = FindSibling(precision);
  if (!sibling) {
    throw Failure(kBadInput,
                  fmt::format("there is no '{}' beside this program: it is built with Cairn if the "
                              "{} libraries of Bullet are installed (Debian: libbullet-dev)",
                              ProgramFor(precision), precision));
  }
  Become(*sibling, arguments);
}

void ContinueAsPlay(const std::vector<std::string>& arguments) {
  if (OwnPrecision() != "float") {
    throw Failure(kUsage, "play has Bullet in floats alone: leave out --float64");
  }
  const std::optional<std::string> program = FindProgram("cairn-play");
  if (!program) {
    throw Failure(kBadInput,
                  "there is no 'cairn-play' beside this program: it is built with Cairn "
                  "if GLFW, Dear ImGui and OpenGL are installed; bash bench/play.sh "
                  "installs and builds");
  }
  Become(*program, arguments);
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
