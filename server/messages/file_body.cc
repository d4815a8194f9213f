// SPDX-License-Identifier: Apache-2.0
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>

#include "server/messages/message.h"

namespace server {

FileBody::~FileBody() { ::close(descriptor_); }

std::size_t FileBody::size() const {
  struct stat status {};
  return ::fstat(descriptor_, &status) == 0 ? static_cast<std::size_t>(status.st_size) : 0;
}

std::size_t FileBody::read(std::size_t offset, char* to, std::size_t size) const {
  const ssize_t got = ::pread(descriptor_, to, size, static_cast<off_t>(offset));
  return static_cast<std::size_t>(std::max<ssize_t>(got, 0));
}

}  // namespace server
