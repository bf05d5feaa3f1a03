// SPDX-License-Identifier: MIT
#include "cairn/detail/whole_file.h"

#include <cerrno>
#include <cstdio>
#include <filesystem>

#include "recording/open_file.h"

#if defined(_WIN32)
#include <io.h>
#elif __has_include(<unistd.h>)
#include <unistd.h>
#endif

namespace cairn {
namespace {

namespace fs = std::filesystem;

std::error_code LastError() { return {errno != 0 ? errno : EIO, std::generic_category()}; }

/// The file that a path leads to, through links.
fs::path TargetOf(const std::string& path) {
  std::error_code error;
  const fs::path target = fs::canonical(path, error);
  return error ? fs::path(path) : target;
}

/// There is something there that cannot be exchanged for a file.
bool IsDevice(const std::string& path) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  const bool other = fs::exists(status) && !fs::is_regular_file(status);
  return other || path.starts_with("/dev/") || path.starts_with("/proc/");
}

bool ToDisk(std::FILE* file) {
  if (std::fflush(file) != 0) return false;
#if defined(_WIN32)
  return _commit(_fileno(file)) == 0 || errno == EBADF;  // pipes and devices likewise
#elif __has_include(<unistd.h>)
  // pipes and devices have nothing to wait for
  return fsync(fileno(file)) == 0 || errno == EINVAL || errno == EROFS || errno == ENOTSUP;
#else
  return true;
#endif
}

std::error_code Write(const fs::path& path, std::span<const std::byte> bytes) {
  errno = 0;
  OpenFile file(std::fopen(path.string().c_str(), "wb"));
  if (!file) return LastError();
  const bool written = std::fwrite(bytes.data(), 1, bytes.size(), file.get()) == bytes.size();
  if (!written || !ToDisk(file.get())) return LastError();
  // what was buffered elsewhere may still find the disk full
  return std::fclose(file.release()) == 0 ? std::error_code() : LastError();
}

fs::path PartOf(const fs::path& target) { return target.string() + ".part"; }

}  // namespace

std::error_code WriteWholeFile(const std::string& path, std::span<const std::byte> bytes) {
  if (IsDevice(path)) return Write(path, bytes);
  const fs::path target = TargetOf(path), part = PartOf(target);
  std::error_code failed = Write(part, bytes), ignored;
  // who could read the old file can read the new one
  const fs::file_status before = fs::status(target, ignored);
  if (!failed && fs::exists(before)) fs::permissions(part, before.permissions(), ignored);
  if (!failed) fs::rename(part, target, failed);
  if (failed) fs::remove(part, ignored);
  return failed;
}

std::error_code TryWholeFile(const std::string& path) {
  std::error_code error;
  if (fs::is_directory(path, error)) return std::make_error_code(std::errc::is_a_directory);
  if (IsDevice(path))
    return OpenFile(std::fopen(path.c_str(), "ab")) ? std::error_code() : LastError();
  const fs::path part = PartOf(TargetOf(path));
  const std::error_code failed = Write(part, {});
  fs::remove(part, error);
  return failed;
}

}  // namespace cairn
