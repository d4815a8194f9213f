// SPDX-License-Identifier: Apache-2.0
#include "server/commands/command.h"

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <limits>
#include <new>
#include <system_error>

#include <fcntl.h>
#include <unistd.h>

#include "jobs/base/errors.h"
#include "server/commands/written_file.h"
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
  WrittenFile file(path);
  if (path == "-" && isatty(STDOUT_FILENO) != 0) file.append(terminal_text(text, LineEnds::kKept));
  else file.append(text);
  file.keep();
}

}  // namespace server::commands
