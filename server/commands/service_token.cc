// SPDX-License-Identifier: Apache-2.0
#include "server/commands/service_token.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>

#include "server/commands/command.h"
#include "server/http/access.h"

namespace server::commands {

namespace {

/// Descriptor of a file that is read, closed at the end of its scope.
class OpenedFile {
 public:
  /// Non-blocking: the opening of a FIFO would wait for somebody who writes.
  explicit OpenedFile(const std::string& path)
      : descriptor_(::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC)) {}
  ~OpenedFile() {
    if (descriptor_ >= 0) ::close(descriptor_);
  }
  OpenedFile(const OpenedFile&) = delete;
  OpenedFile& operator=(const OpenedFile&) = delete;
  [[nodiscard]] int get() const { return descriptor_; }

 private:
  int descriptor_;
};

std::string read_token_line(const std::string& file) {
  const std::string option = "--token-file " + file + ": ";
  const OpenedFile opened(file);
  struct stat status {};
  if (opened.get() < 0 || ::fstat(opened.get(), &status) != 0) throw BadInput(option + std::strerror(errno));
  if (!S_ISREG(status.st_mode)) throw BadInput(option + "is no regular file");
  const std::string fault = describe_secret_fault(status);
  if (!fault.empty()) throw BadInput(option + fault);
  std::array<char, 4096> text;  // longer than any token
  const ssize_t got = ::read(opened.get(), text.data(), text.size());
  if (got < 0) throw BadInput(option + "cannot be read: " + std::strerror(errno));
  std::string line(text.data(), static_cast<std::size_t>(got));
  while (!line.empty() && (line.back() == '\n' || line.back() == '\r')) line.pop_back();
  return line;
}

}  // namespace

std::string describe_owner_fault(const struct stat& status) {
  if (status.st_uid != ::geteuid() && status.st_uid != 0)
    return "the file belongs to another user, who can change it";
  if ((status.st_mode & S_IWOTH) == 0) return "";
  return "other users can write the file; restrict it with chmod o-w";
}

std::string describe_secret_fault(const struct stat& status) {
  const mode_t forbidden = status.st_uid == ::geteuid() ? 0077 : 0037;
  if ((status.st_mode & forbidden) == 0) return describe_owner_fault(status);
  return "other users can read or write the file; restrict it with chmod 600";
}

std::string describe_file_name_fault(const std::string& name) {
  return name.empty() ? "names no file: leave the option out if there is to be no token" : "";
}

std::string find_token(const std::string& file, const char* otherwise) {
  const char* const named = std::getenv("RPSUP_TOKEN_FILE");
  if (file.empty() && named != nullptr && *named == '\0')
    throw BadInput("RPSUP_TOKEN_FILE is set and names no file: unset it if there is to be no token");
  if (file.empty() && otherwise == nullptr) return "";
  const std::string token = file.empty() ? otherwise : read_token_line(file);
  const std::string fault = describe_token_fault(token);
  if (!fault.empty())
    throw BadInput((file.empty() ? "RPSUP_TOKEN" : "--token-file " + file) + ": the token " + fault);
  return token;
}

std::string find_service_token(const std::string& file) {
  return find_token(file, std::getenv("RPSUP_TOKEN"));
}

}  // namespace server::commands
