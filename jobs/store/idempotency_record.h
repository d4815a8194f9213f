// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>

namespace jobs {

/// Response that is stored with the row that a request makes, so that the same request sent again gets it
/// again: the Idempotency-Key header field of the IETF draft of that name.
template <typename Row>
struct IdempotencyRecord {
  std::string key;          ///< chosen by the client; empty: nothing is stored
  std::string fingerprint;  ///< identifies the request: method, route and hash of the body
  std::function<std::string(const Row&)> make_response;
};

struct StoredResponse {
  std::string fingerprint, text;
};

/// Key and fingerprint of a request, as in IdempotencyRecord, and where its response goes when it is stored.
struct IdempotentRequest {
  std::string key, fingerprint;
  std::string* response = nullptr;
};

}  // namespace jobs
