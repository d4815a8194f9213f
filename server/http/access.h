// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace server {

/// Knows who may ask. With a token, every request has to carry it, but those that tell no more than whether
/// the service is up.
class AccessCheck {
 public:
  /// @param token  empty: everybody may ask for everything
  explicit AccessCheck(const std::string& token);

  /// @param path           percent-decoded
  /// @param authorization  value of the Authorization header: "Bearer TOKEN", or "Basic" with the token as
  /// the password, which is
  ///                       what browsers ask their users for; empty if it is missing
  [[nodiscard]] bool is_allowed(std::string_view path, const std::string& authorization) const;

 private:
  std::string digest_;  ///< of the token, so that comparing tells nothing of its length; empty: there is none
};

/// @returns whether a path is for programs that watch over this one: it tells nothing of what is stored,
/// needs no token, and is answered under every name of the host
[[nodiscard]] bool is_probe(std::string_view path);

/// Says what is wrong with a token, empty if nothing is: it is at least 16 visible ASCII characters without a
/// quote, a comma or a colon.
[[nodiscard]] std::string describe_token_fault(std::string_view token);

}  // namespace server
