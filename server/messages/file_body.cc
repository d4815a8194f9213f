// SPDX-License-Identifier: Apache-2.0
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <utility>

#include "server/messages/message.h"

namespace server {

FileBody::FileBody(int descriptor, std::shared_ptr<const void> permit)
    : permit_(std::move(permit)), descriptor_(descriptor) {
  struct stat status {};
  if (::fstat(descriptor_, &status) == 0) end_ = static_cast<std::size_t>(status.st_size);
}

FileBody::~FileBody() { ::close(descriptor_); }

void FileBody::cut(std::size_t begin, std::size_t end) {
  end_ = begin_ + end;
  begin_ += begin;
}

std::size_t FileBody::read(std::size_t offset, char* to, std::size_t size) const {
  const ssize_t got = ::pread(descriptor_, to, std::min(size, this->size() - std::min(offset, this->size())),
                              static_cast<off_t>(begin_ + offset));
  return static_cast<std::size_t>(std::max<ssize_t>(got, 0));
}

}  // namespace server
