// SPDX-License-Identifier: Apache-2.0
#include "server/routes/store_route.h"

#include <fcntl.h>
#include <stdlib.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>

#include "jobs/base/content_id.h"
#include "jobs/base/errors.h"
#include "jobs/exports/write_trajectories.h"
#include "jobs/store/store_lock.h"
#include "server/messages/byte_range.h"
#include "server/messages/conditional.h"
#include "server/messages/error_answer.h"
#include "server/messages/problem.h"
#include "server/messages/query.h"
#include "server/routes/tables.h"

namespace server {

namespace {

constexpr std::string_view kExportEnd = ".rpsup-export-";

/// Beside the store, where there is most likely room, and on the same file system.
std::filesystem::path copy_of(const std::filesystem::path& store) { return store.string() + ".rpsup-copy"; }

/// Opens a file and takes its name away: it is gone when it is closed, whatever happens.
std::shared_ptr<FileBody> open_nameless(const std::filesystem::path& file,
                                        std::shared_ptr<const void> permit) {
  const int descriptor = ::open(file.c_str(), O_RDONLY | O_CLOEXEC);
  std::filesystem::remove(file);
  if (descriptor < 0) throw jobs::StorageError("the file that was made for the answer cannot be opened");
  return std::make_shared<FileBody>(descriptor, std::move(permit));
}

/// Empty file of a name that no other has, beside the store. Removed at the end, if it still has this name.
class ExportFile {
 public:
  explicit ExportFile(const std::filesystem::path& store)
      : path_(store.string() + std::string(kExportEnd) + "XXXXXX") {
    std::string name = path_.string();
    const int made = ::mkostemp(name.data(), O_CLOEXEC);
    if (made < 0)
      throw jobs::StorageError("cannot make " + name + ": " + std::strerror(errno), 0,
                               jobs::disk_state(errno));
    ::close(made);
    path_ = name;
  }
  ~ExportFile() {
    std::error_code ignored;
    std::filesystem::remove(path_, ignored);
  }
  ExportFile(const ExportFile&) = delete;
  ExportFile& operator=(const ExportFile&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

jobs::TrajectoryExport read_export(TableFormat format, Query& query) {
  jobs::TrajectoryExport wanted;
  if (format == TableFormat::kMat) wanted.format = jobs::TrajectoryFileFormat::kMat;
  if (format == TableFormat::kNpz) wanted.format = jobs::TrajectoryFileFormat::kNpz;
  wanted.query.channels = query.list("channels");
  wanted.query.from = query.number("from");
  wanted.query.to = query.number("to");
  return wanted;
}

/// Name of a file's bytes: equal only for equal bytes.
std::string etag_of(const FileBody& file) {
  constexpr std::size_t kPiece = std::size_t{1} << 20U;
  std::string piece(kPiece, '\0');
  std::string digest;
  for (std::size_t offset = 0; offset < file.size();) {
    const std::size_t got = file.read(offset, piece.data(), kPiece);
    if (got == 0) throw jobs::StorageError("the file that was made for the answer cannot be read");
    digest = jobs::sha256_hex(digest, std::string_view(piece).substr(0, got));
    offset += got;
  }
  return "\"" + digest.substr(0, 32) + "\"";
}

/// The answer with the file of trajectories of a sweep, without the file.
Response make_export_answer(const RequestContext& context, TableFormat format, const std::string& etag) {
  Response response;
  response.content_type = info_of(format).media_type;
  response.headers = {{"Vary", "Accept"},
                      {"Cache-Control", "private, no-cache"},
                      {"Content-Disposition", "attachment; filename=\"sweep-" + context.id + "." +
                                                  std::string(info_of(format).word) + "\""}};
  return with_etag(context.request, std::move(response), etag);
}

}  // namespace

void remove_left_over_files(const std::filesystem::path& store) {
  std::error_code ignored;  // a file that is in the way is found by whoever makes the next
  std::filesystem::remove(copy_of(store), ignored);
  const std::string exports = store.filename().string() + std::string(kExportEnd);
  const auto folder = std::filesystem::absolute(store, ignored).parent_path();
  for (const auto& entry : std::filesystem::directory_iterator(folder, ignored)) {
    if (entry.path().filename().string().starts_with(exports)) std::filesystem::remove(entry.path(), ignored);
  }
}

Response get_store(const RequestContext& context) {
  Query(context.request, {}).check();
  auto permit = context.store_copy_limit.acquire();
  if (!permit) return make_retry_later(503, "a copy of the store is being made or sent for another request");
  const std::filesystem::path copy = copy_of(context.service.store_file());
  std::filesystem::remove(copy);
  if (!context.service.copy_store_to(copy)) return make_retry_later(503, "the service is shutting down");
  Response response{.status = 200, .content_type = "application/vnd.sqlite3", .body = {}, .headers = {}};
  response.file = open_nameless(copy, std::move(permit));
  response.headers.emplace_back("Content-Disposition", "attachment; filename=\"rpsup-store.db\"");
  response.headers.emplace_back("Cache-Control", "no-store");
  return response;
}

Response get_trajectories(const RequestContext& context) {
  Query query(context.request, {"channels", "from", "to", "format"});
  const TableFormat format = find_trajectories_format(context.request, query);
  const jobs::TrajectoryExport wanted = read_export(format, query);
  auto permit = context.export_limit.acquire();
  if (!permit) return make_retry_later(503, "as many files of trajectories are being made or sent as may");
  const ExportFile file(context.service.store_file());
  const bool is_there =
      query.check_and([&] { return context.service.write_trajectories(context.id, wanted, file.path()); });
  if (!is_there) throw HttpError(404, "there is no sweep " + context.id);
  const auto body = open_nameless(file.path(), std::move(permit));
  const std::string etag = etag_of(*body);
  Response response = make_export_answer(context, format, etag);
  if (response.status != 200) return response;
  return answer_with_file(context.request, std::move(response), body, etag);
}

}  // namespace server
