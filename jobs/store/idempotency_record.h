// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>

namespace jobs {

/// Response to the request that makes a row. It is made in the transaction of the row, which nothing that
/// fails or is deleted afterwards can come between. With a key it is stored, too, so that the same request
/// sent again gets it again: the Idempotency-Key header field of the IETF draft of that name.
template <typename Row>
struct IdempotencyRecord {
  std::string key;          ///< chosen by the client; empty: nothing is stored
  std::string fingerprint;  ///< identifies the request: method, route and hash of the body
  std::function<std::string(const Row&)> make_response;  ///< empty: nobody asks for one
};

struct StoredResponse {
  std::string fingerprint, text;
};

/// Key and fingerprint of a request, as in IdempotencyRecord.
struct IdempotentRequest {
  std::string key, fingerprint;
};

}  // namespace jobs
