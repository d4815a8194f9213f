// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "server/context/request_context.h"
#include "server/messages/message.h"

namespace server {

/// Form of a route's answer or body: media type, and name of its schema in the OpenAPI document.
struct AnswerForm {
  std::string_view media_type;
  std::string schema;
};

/// Answer with a status of its own.
struct OtherAnswer {
  int status = 200;
  AnswerForm form;
};

/// Memory and time that a route may take: little or much by the size of its request, or much in any case.
enum class Work { kBySize, kLarge };

/// One route: method and pattern, handler, and entry of the OpenAPI document, which has no other source of
/// routes.
struct Route {
  std::string_view method;
  std::string pattern;              ///< {id} stands for one segment for which is_id() holds
  Response (*handler)(const RequestContext&);
  std::string operation_id;
  std::string tag;
  std::string summary;
  std::vector<std::string_view> query = {};    ///< ids in request_parameters()
  std::vector<std::string_view> headers = {};  ///< the same, of headers
  std::string body = {};                       ///< schema of the request's JSON; empty: no body
  std::vector<AnswerForm> other_bodies = {};   ///< other forms of the body
  int success = 200;
  std::vector<AnswerForm> answers = {};        ///< forms of the answer to success; empty: without a body
  std::vector<OtherAnswer> other_answers = {};  ///< to success, too
  std::vector<int> bodiless = {};  ///< statuses of other answers without a body that are no problems
  bool partial = false;  ///< whether 206 answers a Range, with the same forms
  std::vector<int> problems = {};              ///< statuses beside those of any request
  Work work = Work::kBySize;
};

/// @returns whether a route changes something that is there, which If-Match guards
[[nodiscard]] inline bool changes_existing(const Route& route) {
  return route.method != "GET" && route.pattern.find("{id}") != std::string::npos;
}

}  // namespace server
