// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/stat.h>

#include <optional>
#include <string>
#include <string_view>

namespace server::commands {

/// File that a command writes; "-": standard output. A regular one is written beside its name, which it gets
/// once all of it is there: a reader or a full disk finds the old file or the new one. A device, a pipe, and
/// a file whose folder takes no other one are written in place.
class WrittenFile {
 public:
  /// @throws CannotWrite if it cannot be opened
  explicit WrittenFile(const std::string& path);
  ~WrittenFile();  ///< leaves the old file unless this one was kept
  WrittenFile(const WrittenFile&) = delete;
  WrittenFile& operator=(const WrittenFile&) = delete;

  /// @returns false if not all of it could be written; keep() says why
  bool append(std::string_view piece);
  /// @throws CannotWrite if not every byte reached it
  void keep();

 private:
  void open_beside(const std::string& real);
  [[nodiscard]] bool seal() const;
  [[noreturn]] void throw_unwritten(int error) const;

  std::string path_;
  std::string real_;  ///< without links
  std::string part_;  ///< name until it is kept; empty: written in place
  std::optional<struct stat> old_;  ///< status of the file that is replaced
  int descriptor_ = -1;
  bool begun_ = false;  ///< something was appended
  int error_ = 0;       ///< of append()
};

}  // namespace server::commands
