// SPDX-License-Identifier: Apache-2.0
#include "server/messages/error_answer.h"

#include <new>

#include "jobs/base/errors.h"
#include "server/messages/json_text.h"
#include "server/messages/problem.h"
#include "server/messages/safe_log.h"

namespace server {

namespace {

/// A database error names files and statements: those go to the log, the user gets a number to ask with.
Response make_storage_problem(const jobs::StorageError& error, const std::string& request_id) {
  log_error("request {}: storage error {}: {}", request_id, error.code, error.what());
  if (error.full)
    return make_problem(507, "the disk that holds the store is full (request " + request_id + ")");
  return make_retry_later(503,
                          "the store cannot be read or written at the moment (request " + request_id + ")");
}

Response make_internal_problem(const char* what, const std::string& request_id) {
  log_error("request {}: {}", request_id, what);
  return make_problem(500, "something went wrong; the log has it under request " + request_id);
}

}  // namespace

Response make_error_answer(const std::exception_ptr& error, const std::string& request_id) {
  try {
    std::rethrow_exception(error);
  } catch (const HttpError& http_error) {
    return make_problem(http_error.status, http_error.what());
  } catch (const BadJson& bad_json) {
    return make_problem(400, bad_json.what());
  } catch (const jobs::InvalidRequest& invalid) {
    return make_problem(422, invalid.what(), invalid.faults());
  } catch (const jobs::QueueFull& queue_full) {
    return make_retry_later(429, queue_full.what());
  } catch (const jobs::WrongState& wrong_state) {
    return make_problem(409, wrong_state.what());
  } catch (const jobs::Stopped& stopped) {
    return make_retry_later(503, stopped.what());
  } catch (const jobs::StoreLimitReached& limit) {
    return make_problem(507, limit.what());
  } catch (const jobs::StorageError& storage_error) {
    return make_storage_problem(storage_error, request_id);
  } catch (const std::bad_alloc&) {
    log_error("request {}: no memory", request_id);
    return make_retry_later(
        503, "the machine has no memory left for this at the moment (request " + request_id + ")");
  } catch (const std::exception& other) {
    return make_internal_problem(other.what(), request_id);
  } catch (...) {
    return make_internal_problem("an exception without text", request_id);
  }
}

Response make_retry_later(int status, const std::string& detail) {
  Response response = make_problem(status, detail);
  response.headers.emplace_back("Retry-After", "5");
  return response;
}

}  // namespace server
