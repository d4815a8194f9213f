// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>
#include <vector>

#include "server/messages/message.h"
#include "server/routing/call.h"

namespace server {

/// A form in which a route may answer: a media type, and the name of its schema in the OpenAPI document.
struct AnswerForm {
  std::string_view media_type;
  std::string_view schema;
};

/// One route: what it is called by, what it does, and what the OpenAPI document says of it. The document has nothing beside this table.
struct Route {
  std::string_view method;
  std::string_view pattern;         ///< {id} stands for one segment that is_id
  Response (*handler)(const Call&);
  std::string_view operation_id;
  std::string_view tag;
  std::string_view summary;
  std::vector<std::string_view> query = {};    ///< ids in request_parameters()
  std::vector<std::string_view> headers = {};  ///< the same, of what stands in the head of the request
  std::string_view body = {};                  ///< schema of the JSON that is sent; empty: none is needed
  int success = 200;
  std::vector<AnswerForm> answers = {};        ///< to success; empty: without a body
  std::vector<int> bodiless = {};              ///< other answers that are no problems, without a body
  std::vector<int> problems = {};              ///< beside those that any request may meet
};

}  // namespace server
