// SPDX-License-Identifier: Apache-2.0
#include "server/commands/command.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <limits>
#include <new>
#include <string_view>
#include <system_error>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "jobs/base/errors.h"
#include "server/http/memory_reserve.h"
#include "server/messages/json_text.h"
#include "server/messages/terminal_text.h"

namespace server::commands {

namespace {

constexpr const char* kNoMemory =
    "there is no memory left; ulimit -v and the unit's MemoryMax limit what a process may take";

int report(ExitCode code, const std::string& text) {
  std::cerr << "rpsup: " << terminal_text(text) << '\n';
  return code;
}

int report(const std::system_error& error) {
  const bool no_thread = error.code() == std::errc::resource_unavailable_try_again;
  return report(
      kMachineFailed,
      no_thread ? "the system allows no more threads; ulimit -v and ulimit -u limit them" : error.what());
}

int report(const jobs::InvalidRequest& error) {
  for (const jobs::Fault& fault : error.faults())
    std::cerr << (fault.pointer.empty() ? "" : terminal_text(fault.pointer) + ": ")
              << terminal_text(fault.detail) << '\n';
  return kBadInput;
}

std::string read_all(std::istream& in) { return {std::istreambuf_iterator<char>(in), {}}; }

[[noreturn]] void cannot_write(const std::string& path) {
  throw CannotWrite("cannot write " + path + ": " + std::strerror(errno));
}

bool may_make_files_in(const std::filesystem::path& folder) {
  return ::faccessat(AT_FDCWD, folder.c_str(), W_OK | X_OK, AT_EACCESS) == 0;
}

void write_in_place(const std::string& path, const std::string& text) {
  std::ofstream file(path, std::ios::binary);
  file << text << std::flush;
  if (!file) cannot_write(path);
}

/// Writes a whole text to a descriptor and to the disk. False with errno set if not every byte got there.
bool write_all(int file, std::string_view text) {
  while (!text.empty()) {
    const ssize_t written = ::write(file, text.data(), text.size());
    if (written < 0 && errno != EINTR) return false;
    text.remove_prefix(static_cast<std::size_t>(std::max<ssize_t>(written, 0)));
  }
  return ::fsync(file) == 0;
}

/// Fills a new file and closes it. False with errno set if not everything got there.
/// @param old  status of the file whose mode and owner it gets; null: there is none
bool fill_and_close(int file, const std::string& text, const struct stat* old) {
  bool written = write_all(file, text);
  if (old != nullptr) {
    // Only an administrator may give a file away; for others the file stays theirs.
    static_cast<void>(!::fchown(file, old->st_uid, old->st_gid));
    written = written && ::fchmod(file, old->st_mode & 07777) == 0;
  }
  const int error = errno;
  const bool closed = ::close(file) == 0;
  if (!written) errno = error;
  return written && closed;
}

/// Writes a file beside the one of that name and renames it: whoever reads the name sees the old file or the
/// whole new one, and a disk that is full leaves the old one as it is.
/// @param old  status of the file that is replaced, whose mode and owner stay; null: there is none
void write_beside(const std::string& path, const std::string& text, const struct stat* old) {
  const std::string beside = path + "." + std::to_string(::getpid()) + ".part";
  ::unlink(beside.c_str());  // of a process that was killed
  const mode_t mode = old == nullptr ? 0666 : 0600;
  const int file = ::open(beside.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, mode);
  if (file < 0) cannot_write(path);
  if (fill_and_close(file, text, old) && ::rename(beside.c_str(), path.c_str()) == 0) return;
  const int reason = errno;
  ::unlink(beside.c_str());
  errno = reason;
  cannot_write(path);
}

}  // namespace

int run_guarded(const std::function<int()>& command) {
  keep_memory_reserve();
  try {
    return command();
  } catch (const jobs::InvalidRequest& error) {
    return report(error);
  } catch (const BadInput& error) {
    return report(kBadInput, error.what());
  } catch (const std::bad_alloc&) {
    return report(kMachineFailed, kNoMemory);
  } catch (const std::system_error& error) {
    return report(error);
  } catch (const std::exception& error) {
    return report(kMachineFailed, error.what());
  }
}

std::string read_text(const std::string& path) {
  if (path == "-") return read_all(std::cin);
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored))
    throw BadInput("cannot read " + path + ": it is a folder");
  std::ifstream file(path, std::ios::binary);
  std::string text = file ? read_all(file) : "";
  if (!file) throw BadInput("cannot read " + path + ": " + std::strerror(errno));
  return text;
}

nlohmann::ordered_json read_json(const std::string& path) {
  const std::string text = read_text(path);
  try {
    return parse_json(text, std::numeric_limits<std::size_t>::max());
  } catch (const BadJson& error) {
    throw BadInput((path == "-" ? "standard input" : path) + ": " + error.what());
  }
}

void check_output_file(const std::string& option, const std::string& path) {
  const auto folder = std::filesystem::absolute(path).parent_path();
  std::error_code ignored;
  if (!std::filesystem::is_directory(folder, ignored))
    throw BadInput(option + " " + path + ": there is no folder " + folder.string());
  if (std::filesystem::is_directory(path, ignored)) throw BadInput(option + " " + path + ": it is a folder");
  const bool exists = std::filesystem::exists(path, ignored);
  if (faccessat(AT_FDCWD, exists ? path.c_str() : folder.c_str(), exists ? W_OK : W_OK | X_OK, AT_EACCESS) !=
      0) {
    throw CannotWrite(option + " " + path + ": cannot be written: " + std::strerror(errno));
  }
}

void check_standard_output() {
  std::cout << std::flush;
  if (!std::cout) throw CannotWrite("cannot write to standard output");
}

void write_text(const std::string& path, const std::string& text) {
  if (path == "-") {
    std::cout << (isatty(STDOUT_FILENO) != 0 ? terminal_text(text, LineEnds::kKept) : text);
    return check_standard_output();
  }
  std::error_code error;
  // The file at the end of a link is replaced, not the link.
  const auto real = std::filesystem::weakly_canonical(path, error);
  struct stat status {};
  const bool exists = ::stat(path.c_str(), &status) == 0;
  const bool linked_to_nothing = !exists && std::filesystem::is_symlink(path, error);
  if (linked_to_nothing || (exists && !S_ISREG(status.st_mode)) || !may_make_files_in(real.parent_path()))
    return write_in_place(path, text);  // a device, a pipe, or a folder that takes no file beside
  write_beside(real.string(), text, exists ? &status : nullptr);
}

}  // namespace server::commands
