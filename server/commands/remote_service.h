// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <functional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "server/commands/remote_kinds.h"
#include "server/http/http_client.h"

namespace server::commands {

inline constexpr const char* kJsonType = "application/json";  ///< media type

/// Address of the service that a command talks to, and token.
struct RemoteOptions {
  std::string url = "http://127.0.0.1:8080";
  std::string token{};       ///< empty: none is sent
  std::string token_file{};  ///< file of the token, before `token`; empty: none
};

/// Keys and values of a query string, in their order.
using QueryItems = std::vector<std::pair<std::string, std::string>>;

/// The service, or a proxy in front of it, cannot answer now: it may if it is asked again.
class Busy : public Unreachable {
 public:
  using Unreachable::Unreachable;
};

/// A service that runs elsewhere, as the commands use it. Its refusals become what run_guarded() tells:
/// jobs::InvalidRequest where it names faults, BadInput for what else is the user's to mend, Busy for 429,
/// 502, 503 and 504, std::runtime_error for what else is the service's or the network's.
class RemoteService {
 public:
  using Json = nlohmann::ordered_json;

  /// @throws BadInput for a URL or a token that cannot be used
  explicit RemoteService(const RemoteOptions& options);

  /// Most time for a connection, and for each part of an answer.
  void set_patience(std::chrono::milliseconds time) { client_.set_patience(time); }

  [[nodiscard]] Json submit(Kind kind, const Json& request);
  /// Stores a measurement.
  /// @param media_type  of the text
  /// @param key         Idempotency-Key; empty: none is sent
  [[nodiscard]] Json submit_measurement(const std::string& text, const std::string& media_type,
                                        const QueryItems& query, const std::string& key = "");
  /// A page of a collection, the newest first, {"items": [...], "next_cursor": ...}.
  [[nodiscard]] Json list(Kind kind, const QueryItems& query = {});
  /// A resource. @throws BadInput if there is none
  [[nodiscard]] Json find(Kind kind, const std::string& id);
  /// Changes a resource. @param action  "cancel", say @param body  null: none is sent @returns the resource
  [[nodiscard]] Json change(Kind kind, const std::string& id, std::string_view action, const Json& body = {});
  void erase(Kind kind, const std::string& id);
  /// A part of a resource, byte for byte as the service gives it.
  /// @param part  "results", say
  [[nodiscard]] std::string get_part(Kind kind, const std::string& id, std::string_view part,
                                     const std::string& media_type, const QueryItems& query = {});
  /// The same, piece by piece. @param take  false: it cannot take more
  void save_part(Kind kind, const std::string& id, std::string_view part, const std::string& media_type,
                 const QueryItems& query, const std::function<bool(std::string_view)>& take);
  /// URL of a resource's page on the dashboard.
  [[nodiscard]] std::string page_of(Kind kind, const std::string& id) const;

 private:
  [[nodiscard]] Json read(const HttpClient::Answer& answer) const;
  void check(const HttpClient::Answer& answer) const;
  void check_type(const HttpClient::Answer& answer, const std::string& media_type) const;

  std::string url_;
  HttpClient client_;
};

}  // namespace server::commands
