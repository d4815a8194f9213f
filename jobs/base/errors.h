// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace jobs {

/// One fault of a request: where (RFC 6901 JSON pointer into the request) and what is allowed there.
struct Fault {
  std::string pointer;
  std::string detail;
};

/// A request that is well-formed JSON but asks for something that is not allowed. Carries every fault, not
/// the first.
class InvalidRequest : public std::runtime_error {
 public:
  explicit InvalidRequest(std::vector<Fault> faults)
      : std::runtime_error(faults.empty() ? "invalid request" : text_of(faults.front())),
        faults_(std::move(faults)) {}

  [[nodiscard]] const std::vector<Fault>& faults() const { return faults_; }

 private:
  static std::string text_of(const Fault& fault) {
    return fault.pointer.empty() ? fault.detail : fault.pointer + ": " + fault.detail;
  }

  std::vector<Fault> faults_;
};

/// The request is fine, but not in the state in which its object is (cancelling what has ended, say).
class WrongState : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The service has been stopped: the next one may take it.
class Stopped : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// There are so many jobs waiting that no more are taken; later there may be room.
class QueueFull : public WrongState {
 public:
  using WrongState::WrongState;
};

enum class Disk { kHasRoom, kFull };

/// The store could not be opened, read or written. `full` says that the disk has no room left.
class StorageError : public std::runtime_error {
 public:
  explicit StorageError(const std::string& what, int sqlite_extended_code = 0, Disk disk = Disk::kHasRoom)
      : std::runtime_error(what), code(sqlite_extended_code), full(disk == Disk::kFull) {}

  int code;
  bool full;
};

/// The store holds as much as it may, or a file would need more than the disk has left. The text is for the
/// user.
class StoreLimitReached : public StorageError {
 public:
  explicit StoreLimitReached(const std::string& what) : StorageError(what, 0, Disk::kFull) {}
};

/// The store holds as much as it may.
class StoreSizeReached : public StoreLimitReached {
 public:
  using StoreLimitReached::StoreLimitReached;
};

}  // namespace jobs
