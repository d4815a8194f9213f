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

Response get_openapi(const RequestContext& context) {
  Query(context.request, {}).check();
  static const std::string text = openapi::make_document(route_table()).dump();
  return json_response(200, text);
}

Response get_docs(const RequestContext& context) {
  if (find_web_file("/docs/swagger-ui-bundle.js") == nullptr) {
    throw HttpError(404,
                    "this program was built without the page to try the interface with; GET /v1/openapi.json "
                    "describes the interface");
  }
  Response response = make_file_answer(
      context.request, context.request.path == "/docs" ? "/docs/index.html" : context.request.path);
  // The style sheet of the page holds its arrows and ticks itself.
  response.headers.emplace_back("Content-Security-Policy",
                                "default-src 'none'; script-src 'self'; style-src 'self'; connect-src "
                                "'self'; img-src 'self' data:; base-uri 'none'; form-action 'none'; "
                                "frame-ancestors 'none'");
  return response;
}

}  // namespace server
