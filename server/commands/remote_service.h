// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "server/http/http_client.h"

namespace server::commands {

/// Address of the service that a command talks to, and token.
struct RemoteOptions {
  std::string url = "http://127.0.0.1:8080";
  std::string token{};       ///< empty: none is sent
  std::string token_file{};  ///< file of the token, before `token`; empty: none
};

/// A service that runs elsewhere, as the commands use it. Its refusals become what run_guarded() tells:
/// jobs::InvalidRequest where it names faults, BadInput for what else is the user's to mend,
/// std::runtime_error for what is the service's or the network's.
class RemoteService {
 public:
  enum class Kind { kSweep, kJob };

  struct Resource {
    Kind kind = Kind::kSweep;
    nlohmann::ordered_json json;
  };

  /// @throws BadInput for a URL or a token that cannot be used
  explicit RemoteService(const RemoteOptions& options);

  [[nodiscard]] nlohmann::ordered_json submit(Kind kind, const nlohmann::ordered_json& request);
  /// Stores a measurement. @param query  keys and values @param media_type  of the text
  [[nodiscard]] nlohmann::ordered_json submit_measurement(
      const std::string& text, const std::string& media_type,
      const std::vector<std::pair<std::string, std::string>>& query);
  /// The newest sweeps, {"items": [...], "next_cursor": ...}.
  [[nodiscard]] nlohmann::ordered_json list_sweeps();
  /// The sweep or job of that id. @throws BadInput if there is neither
  [[nodiscard]] Resource find(const std::string& id);
  [[nodiscard]] Resource cancel(const std::string& id);
  /// The table of results, byte for byte as the service gives it. @param media_type  text/csv,
  /// application/json or application/x-ndjson
  [[nodiscard]] std::string results(const std::string& sweep_id, const std::string& media_type);

 private:
  [[nodiscard]] nlohmann::ordered_json read(const HttpClient::Answer& answer) const;
  void check(const HttpClient::Answer& answer) const;

  std::string url_;
  HttpClient client_;
};

}  // namespace server::commands
