// SPDX-License-Identifier: Apache-2.0
#include "server/commands/written_file.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <iostream>
#include <iterator>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <unistd.h>

#include "server/commands/command.h"

namespace server::commands {

namespace {

bool may_make_files_in(const std::filesystem::path& folder) {
  return ::faccessat(AT_FDCWD, folder.c_str(), W_OK | X_OK, AT_EACCESS) == 0;
}

}  // namespace

WrittenFile::WrittenFile(const std::string& path) : path_(path) {
  if (path == "-") return;
  struct stat status {};
  const bool exists = ::stat(path.c_str(), &status) == 0;
  std::error_code error;
  // The file at the end of a link is replaced, not the link.
  const auto real = std::filesystem::weakly_canonical(std::filesystem::absolute(path), error);
  const bool linked_to_nothing = !exists && std::filesystem::is_symlink(path, error);
  const bool in_place =
      linked_to_nothing || (exists && !S_ISREG(status.st_mode)) || !may_make_files_in(real.parent_path());
  if (exists) old_ = status;
  if (in_place) descriptor_ = ::open(path.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0666);
  else open_beside(real.string());
  if (descriptor_ < 0) throw_unwritten(errno);
}

WrittenFile::~WrittenFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
  if (!part_.empty()) ::unlink(part_.c_str());
}

void WrittenFile::open_beside(const std::string& real) {
  real_ = real;
  part_ = real + "." + std::to_string(::getpid()) + ".part";
  ::unlink(part_.c_str());  // of a process that was killed
  descriptor_ = ::open(part_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, old_ ? 0600 : 0666);
}

bool WrittenFile::append(std::string_view piece) {
  if (path_ == "-") return static_cast<bool>(std::cout.write(piece.data(), std::ssize(piece)));
  // The old content goes with the first piece of the new. (A device or a pipe has none.)
  if (part_.empty() && !std::exchange(begun_, true)) static_cast<void>(!::ftruncate(descriptor_, 0));
  while (!piece.empty()) {
    const ssize_t written = ::write(descriptor_, piece.data(), piece.size());
    if (written < 0 && errno != EINTR) {
      error_ = errno;
      return false;
    }
    piece.remove_prefix(static_cast<std::size_t>(std::max<ssize_t>(written, 0)));
  }
  return true;
}

void WrittenFile::keep() {
  if (path_ == "-") return check_standard_output();
  if (error_ != 0) throw_unwritten(error_);
  if (!part_.empty() && !seal()) throw_unwritten(errno);
  if (::close(std::exchange(descriptor_, -1)) != 0) throw_unwritten(errno);
  if (!part_.empty() && ::rename(part_.c_str(), real_.c_str()) != 0) throw_unwritten(errno);
  part_.clear();
}

/// Gives the file mode and owner of the old one, and brings it to the disk. False with errno set if that
/// fails.
bool WrittenFile::seal() const {
  if (old_) {
    // Only an administrator may give a file away; for others the file stays theirs.
    static_cast<void>(!::fchown(descriptor_, old_->st_uid, old_->st_gid));
    if (::fchmod(descriptor_, old_->st_mode & 07777) != 0) return false;
  }
  return ::fsync(descriptor_) == 0;
}

void WrittenFile::throw_unwritten(int error) const {
  throw CannotWrite("cannot write " + path_ + ": " + std::strerror(error));
}

}  // namespace server::commands
