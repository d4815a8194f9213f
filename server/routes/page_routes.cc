// SPDX-License-Identifier: Apache-2.0
#include "server/routes/page_routes.h"

#include <string>
#include <utility>

#include <nlohmann/json.hpp>

#include "jobs/base/program_info.h"
#include "server/messages/accept.h"
#include "server/messages/conditional.h"
#include "server/messages/error_answer.h"
#include "server/messages/gzip.h"
#include "server/messages/json_text.h"
#include "server/messages/problem.h"
#include "server/messages/query.h"
#include "server/routes/web_files.h"

namespace server {

Response make_file_answer(const Request& request, std::string_view path) {
  const WebFile* file = find_web_file(path);
  if (file == nullptr) throw HttpError(404, "there is nothing at " + std::string(path));
  const bool packed = wants_gzip(request.accept_encoding);
  Response response{
      .status = 200, .content_type = std::string(file->content_type), .body = {}, .headers = {}};
  const bool lasts = file->kind == WebFile::Path::kHashed;
  response.headers.emplace_back("Cache-Control",
                                lasts ? "public, max-age=31536000, immutable" : "private, no-cache");
  response.headers.emplace_back("Vary", "Accept-Encoding");
  response = with_etag(request, std::move(response), packed ? file->gzip_etag : file->etag);
  if (response.status == 304) return response;
  if (packed) response.headers.emplace_back("Content-Encoding", "gzip");
  response.body = packed ? std::string(file->gzip) : gunzip(file->gzip, file->size);
  return response;
}

bool is_page_file(std::string_view path) { return find_web_file(path) != nullptr; }

Response get_page_file(const RequestContext& context) {
  return make_file_answer(context.request,
                          context.request.path == "/" ? "/index.html" : context.request.path);
}

Response get_health(const RequestContext&) {
  return json_response(200, to_text(nlohmann::json{{"status", "ok"}, {"version", jobs::kProgramVersion}}));
}

Response get_readiness(const RequestContext& context) {
  if (context.draining) return make_retry_later(503, "the service is shutting down");
  context.service.check_store();
  try {
    context.service.check_room();
  } catch (const jobs::StorageError& error) {
    if (!error.full) throw;
    // The contents of a full store can be read and deleted.
    return json_response(200, nlohmann::json{{"status", "full"}, {"reason", error.what()}}.dump());
  }
  return json_response(200, R"({"status":"ready"})");
}

Response get_metrics(const RequestContext& context) {
  Query(context.request, {}).check();
  return {.status = 200,
          .content_type = "text/plain; version=0.0.4; charset=utf-8",
          .body = context.metrics.text(context.service.read_queue_stats(), context.service.list_executors()),
          .headers = {{"Cache-Control", "no-store"}}};
}

}  // namespace server
