#include "server/document_routes.h"

#include <string>

#include "server/openapi/document.h"
#include "server/page_routes.h"
#include "server/problem.h"
#include "server/query.h"
#include "server/web_files.h"

namespace server {

Response get_openapi(const Call& call) {
  Query(call.request, {}).check();
  static const std::string text = openapi::make_document().dump();
  return make_json(200, text);
}

Response get_docs(const Call& call) {
  if (find_web_file("/docs/swagger-ui-bundle.js") == nullptr) {
    throw HttpError(404, "this program was built without the page to try the interface with; GET /v1/openapi.json describes the interface");
  }
  return make_file_answer(call.request, call.request.path == "/docs" ? "/docs/index.html" : call.request.path);
}

}  // namespace server
