// SPDX-License-Identifier: Apache-2.0
#include "jobs/cluster/durable_file.h"

#include <atomic>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <iterator>

#include <fcntl.h>
#include <unistd.h>

#include "jobs/base/content_id.h"
#include "jobs/base/machine.h"

namespace jobs::cluster {
namespace {

[[noreturn]] void fail(const std::string& what, const std::filesystem::path& file, int error) {
  throw FileError(what + " " + file.string() + ": " + std::strerror(error));
}

/// Closed with it.
struct Descriptor {
  explicit Descriptor(int opened) : number(opened) {}
  ~Descriptor() {
    if (number >= 0) ::close(number);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  int number;
};

void write_all(int file, std::string_view bytes, const std::filesystem::path& name) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(file, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) fail("cannot write", name, errno);
    bytes.remove_prefix(static_cast<std::size_t>(written));
  }
}

void flush_folder(const std::filesystem::path& folder) {
  const Descriptor opened(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (opened.number < 0 || ::fsync(opened.number) != 0) fail("cannot flush the folder", folder, errno);
}

/// No other process, on whatever machine, has the same.
std::filesystem::path temporary_name(const std::filesystem::path& file) {
  static std::atomic<int> count = 0;
  const std::string unique = host_name() + "-" + std::to_string(::getpid()) + "-" + std::to_string(++count);
  return file.parent_path() / (".tmp-" + unique + "-" + file.filename().string());
}

}  // namespace

void write_durably(const std::filesystem::path& file, std::string_view bytes) {
  const auto temporary = temporary_name(file);
  try {
    const Descriptor opened(::open(temporary.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644));
    if (opened.number < 0) fail("cannot make", temporary, errno);
    write_all(opened.number, bytes, temporary);
    if (::fsync(opened.number) != 0) fail("cannot flush", temporary, errno);
    if (::rename(temporary.c_str(), file.c_str()) != 0) fail("cannot rename to", file, errno);
    flush_folder(file.parent_path());
  } catch (const FileError&) {
    ::unlink(temporary.c_str());
    throw;
  }
}

std::string read_whole(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in) fail("cannot read", file, errno);
  std::string bytes{std::istreambuf_iterator<char>(in), {}};
  if (in.bad()) fail("cannot read", file, EIO);
  return bytes;
}

std::string seal(std::string_view magic, std::string_view bytes) {
  std::string sealed(magic);
  sealed += bytes;
  return sealed + sha256_hex(bytes);
}

std::string_view unseal(std::string_view magic, std::string_view sealed) {
  if (sealed.size() < magic.size() + kSha256Digits || !sealed.starts_with(magic))
    throw FileError("no file of this program, or one that is cut off");
  const std::string_view bytes = sealed.substr(magic.size(), sealed.size() - magic.size() - kSha256Digits);
  if (sha256_hex(bytes) != sealed.substr(sealed.size() - kSha256Digits))
    throw FileError("damaged: its checksum is another one");
  return bytes;
}

}  // namespace jobs::cluster
