#include "server/store_route.h"

#include <fcntl.h>

#include <filesystem>
#include <memory>
#include <mutex>
#include <string>

#include "jobs/errors.h"
#include "server/error_answer.h"
#include "server/query.h"

namespace server {

namespace {

/// Opens a file and takes its name away: it is gone when it is closed, whatever happens.
std::shared_ptr<FileBody> open_nameless(const std::filesystem::path& file) {
  const int descriptor = ::open(file.c_str(), O_RDONLY | O_CLOEXEC);
  std::filesystem::remove(file);
  if (descriptor < 0) throw jobs::StorageError("the copy of the store cannot be opened", 0, false);
  return std::make_shared<FileBody>(descriptor);
}

}  // namespace

Response get_store(const Call& call) {
  Query(call.request, {}).check();
  // One at a time: each takes as much room on the disk as the store.
  const std::unique_lock lock(call.copying, std::try_to_lock);
  if (!lock) return make_retry_later(503, "the store is being copied for another request");
  // Beside the store, where there is most likely room, and on the same file system.
  const std::filesystem::path copy = call.service.store_file().string() + ".copy";
  std::filesystem::remove(copy);  // of a process that died
  if (!call.service.copy_store_to(copy)) return make_retry_later(503, "the service is shutting down");
  Response response{.status = 200, .content_type = "application/vnd.sqlite3", .body = {}, .headers = {}, .file = open_nameless(copy)};
  response.headers.emplace_back("Content-Disposition", "attachment; filename=\"rpsup-store.db\"");
  response.headers.emplace_back("Cache-Control", "no-store");
  return response;
}

}  // namespace server
