// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "jobs/service.h"
#include "server/messages/message.h"
#include "server/messages/preference.h"
#include "server/routing/copy_room.h"
#include "server/routing/metrics.h"

namespace server {

/// What a route is called with.
struct Call {
  jobs::Service& service;
  const Request& request;
  std::string id;  ///< what stands in the place of {id} in the route's pattern
  bool draining;
  const Metrics& metrics;
  WaitingRoom& waiting_room;
  CopyRoom& copy_room;
};

/// True for a text that may be an id: 1 to 64 letters, digits, '-' or '_'.
[[nodiscard]] bool is_id(const std::string& text);

/// The client's Idempotency-Key, without the quotes that it may have; empty if there is none.
/// @throws HttpError 400 if it is empty or longer than 255 bytes, or has other than visible ASCII characters
[[nodiscard]] std::string find_key(const Request& request);

/// An answer that holds one JSON text.
[[nodiscard]] Response make_json(int status, std::string text);

}  // namespace server
