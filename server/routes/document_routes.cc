// SPDX-License-Identifier: Apache-2.0
#include "server/routes/document_routes.h"

#include <string>

#include "server/messages/problem.h"
#include "server/messages/query.h"
#include "server/openapi/document.h"
#include "server/routes/page_routes.h"
#include "server/routes/route_table.h"
#include "server/routes/web_files.h"

namespace server {

Response get_openapi(const Call& call) {
  Query(call.request, {}).check();
  static const std::string text = openapi::make_document(route_table()).dump();
  return make_json(200, text);
}

Response get_docs(const Call& call) {
  if (find_web_file("/docs/swagger-ui-bundle.js") == nullptr) {
    throw HttpError(404, "this program was built without the page to try the interface with; GET /v1/openapi.json describes the interface");
  }
  return make_file_answer(call.request, call.request.path == "/docs" ? "/docs/index.html" : call.request.path);
}

}  // namespace server
