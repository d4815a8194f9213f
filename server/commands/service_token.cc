// SPDX-License-Identifier: Apache-2.0
#include "server/commands/service_token.h"

#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iterator>

#include "server/commands/command.h"
#include "server/http/access.h"

namespace server::commands {

namespace {

/// A secret that others may read is none. A file of another user is one that an administrator gives this one
/// to read, as a member of its group or by a list of rights, which shows as such.
void check_mode(const std::string& file) {
  struct stat status {};
  if (::stat(file.c_str(), &status) != 0)
    throw BadInput("--token-file " + file + ": " + std::strerror(errno));
  const mode_t forbidden = status.st_uid == ::geteuid() ? 0077 : 0037;
  if ((status.st_mode & forbidden) != 0)
    throw BadInput("--token-file " + file +
                   ": other users can read or write the file; restrict it with chmod 600");
}

std::string read_line(const std::string& file) {
  check_mode(file);
  std::ifstream stream(file, std::ios::binary);
  std::string text{std::istreambuf_iterator<char>(stream), {}};
  if (!stream) throw BadInput("--token-file " + file + ": cannot be read");
  while (!text.empty() && (text.back() == '\n' || text.back() == '\r')) text.pop_back();
  return text;
}

}  // namespace

std::string find_service_token(const std::string& file) {
  const char* const variable = std::getenv("RPSUP_TOKEN");
  if (file.empty() && variable == nullptr) return "";
  const std::string token = file.empty() ? variable : read_line(file);
  const std::string fault = describe_token_fault(token);
  if (!fault.empty())
    throw BadInput((file.empty() ? "RPSUP_TOKEN" : "--token-file " + file) + ": the token " + fault);
  return token;
}

}  // namespace server::commands
