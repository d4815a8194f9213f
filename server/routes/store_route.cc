// SPDX-License-Identifier: Apache-2.0
#include "server/routes/store_route.h"

#include <fcntl.h>

#include <filesystem>
#include <memory>
#include <string>
#include <system_error>
#include <utility>

#include "jobs/base/errors.h"
#include "server/messages/error_answer.h"
#include "server/messages/query.h"

namespace server {

namespace {

/// Beside the store, where there is most likely room, and on the same file system.
std::filesystem::path copy_of(const std::filesystem::path& store) { return store.string() + ".rpsup-copy"; }

/// Opens a file and takes its name away: it is gone when it is closed, whatever happens.
std::shared_ptr<FileBody> open_nameless(const std::filesystem::path& file,
                                        std::shared_ptr<const void> permit) {
  const int descriptor = ::open(file.c_str(), O_RDONLY | O_CLOEXEC);
  std::filesystem::remove(file);
  if (descriptor < 0) throw jobs::StorageError("the copy of the store cannot be opened");
  return std::make_shared<FileBody>(descriptor, std::move(permit));
}

}  // namespace

void remove_left_over_copy(const std::filesystem::path& store) {
  std::error_code ignored;  // a copy that is in the way is found by whoever makes the next
  std::filesystem::remove(copy_of(store), ignored);
}

Response get_store(const RequestContext& context) {
  Query(context.request, {}).check();
  auto permit = context.store_copy_limit.acquire();
  if (!permit) return make_retry_later(503, "a copy of the store is being made or sent for another request");
  remove_left_over_copy(context.service.store_file());
  const std::filesystem::path copy = copy_of(context.service.store_file());
  if (!context.service.copy_store_to(copy)) return make_retry_later(503, "the service is shutting down");
  Response response{.status = 200, .content_type = "application/vnd.sqlite3", .body = {}, .headers = {}};
  response.file = open_nameless(copy, std::move(permit));
  response.headers.emplace_back("Content-Disposition", "attachment; filename=\"rpsup-store.db\"");
  response.headers.emplace_back("Cache-Control", "no-store");
  return response;
}

}  // namespace server
