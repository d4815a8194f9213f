// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace server {

/// A request as the routes see it: no transport in sight.
struct Request {
  std::string method;                                       ///< upper case
  std::string path;                                         ///< percent-decoded, starts with '/'
  std::vector<std::pair<std::string, std::string>> query;   ///< percent-decoded
  std::string accept;                                       ///< of the Accept header; may be empty
  std::string body;
  std::string id;                                           ///< names this request in answers and in the log
  // Of the headers of these names; empty if they are missing.
  std::string accept_encoding{};
  std::string if_match{}, if_none_match{};
  std::string prefer{};
  std::string last_event_id{};
  std::optional<std::string> idempotency_key{};
  /// Path under which clients reach the service through a proxy, as "/rpsup"; empty: at the root of its host
  std::string base_path{};
  std::string content_type{};                               ///< of the body; empty if the header is missing
  std::string range{}, if_range{};                          ///< of these headers; empty if they are missing
};

/// A file that is sent as a body and is gone when it has been.
class FileBody {
 public:
  /// @param descriptor  of a file that has no name any more; becomes this object's
  /// @param permit      let go once the file is gone
  explicit FileBody(int descriptor, std::shared_ptr<const void> permit);
  ~FileBody();
  FileBody(const FileBody&) = delete;
  FileBody& operator=(const FileBody&) = delete;

  /// Makes the body a part of the file, from one byte to before another.
  void cut(std::size_t begin, std::size_t end);

  [[nodiscard]] std::size_t size() const { return end_ - begin_; }
  /// Reads from a place in the body. @returns how many bytes there were; 0 if the file cannot be read
  [[nodiscard]] std::size_t read(std::size_t offset, char* to, std::size_t size) const;

 private:
  std::shared_ptr<const void> permit_;
  int descriptor_;
  std::size_t begin_ = 0, end_ = 0;  ///< of the body in the file
};

/// Events that follow one another on a connection that stays open.
class EventSource {
 public:
  EventSource() = default;
  virtual ~EventSource() = default;
  EventSource(const EventSource&) = delete;
  EventSource& operator=(const EventSource&) = delete;

  /// The text of what is new since the last call; empty if nothing is. One thread asks for all streams: the
  /// store may be read, and nothing be waited for.
  [[nodiscard]] virtual std::string next() = 0;
  /// @returns whether nothing will follow
  [[nodiscard]] virtual bool has_ended() const = 0;
};

/// Body that is made as it is sent.
class BodyStream {
 public:
  BodyStream() = default;
  virtual ~BodyStream() = default;
  BodyStream(const BodyStream&) = delete;
  BodyStream& operator=(const BodyStream&) = delete;

  /// Appends the next piece. False after the last. An exception ends the connection, so that the client sees
  /// that the body is not whole.
  virtual bool append_next(std::string& to) = 0;
};

/// An answer to a request.
struct Response {
  int status = 200;
  std::string content_type;                                 ///< empty: there is no body
  std::string body;
  std::vector<std::pair<std::string, std::string>> headers; ///< beside Content-Type and Content-Length
  std::shared_ptr<FileBody> file{};                         ///< stands for the body, if there is one
  std::shared_ptr<BodyStream> stream{};                     ///< the same
  std::shared_ptr<EventSource> events{};                    ///< follow the head, if there are any
  std::shared_ptr<const void> permit{};                     ///< let go once the answer has been sent
};

/// Answer that sends the client to another address.
/// @param location  relative to that of the request, which a proxy may show under another path
[[nodiscard]] inline Response make_redirect(std::string location) {
  return {.status = 308, .content_type = {}, .body = {}, .headers = {{"Location", std::move(location)}}};
}

/// Answer with a JSON text as its body.
[[nodiscard]] inline Response json_response(int status, std::string text) {
  return {
      .status = status, .content_type = "application/json", .body = std::move(text) + "\n", .headers = {}};
}

}  // namespace server
