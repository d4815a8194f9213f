// SPDX-License-Identifier: Apache-2.0
#include "server/http/access.h"

#include <algorithm>
#include <cctype>
#include <vector>

#include <openssl/crypto.h>
#include <openssl/evp.h>

#include "jobs/base/content_id.h"

namespace server {

namespace {

constexpr std::size_t kShortestToken = 16;
constexpr std::size_t kLongestToken = 512;

/// Text after the name of a scheme, in upper or lower case; empty for another scheme.
std::string_view after_scheme(std::string_view authorization, std::string_view scheme) {
  if (authorization.size() <= scheme.size() || authorization[scheme.size()] != ' ') return {};
  const bool same =
      std::equal(scheme.begin(), scheme.end(), authorization.begin(),
                 [](unsigned char a, unsigned char b) { return std::tolower(a) == std::tolower(b); });
  if (!same) return {};
  const auto start = authorization.find_first_not_of(' ', scheme.size());
  return start == std::string_view::npos ? std::string_view() : authorization.substr(start);
}

/// Empty for what is no base64.
std::string decode_base64(std::string_view text) {
  if (text.empty() || text.size() % 4 != 0) return "";
  std::vector<unsigned char> bytes(text.size() / 4 * 3);
  const int size = EVP_DecodeBlock(bytes.data(), reinterpret_cast<const unsigned char*>(text.data()),
                                   static_cast<int>(text.size()));
  if (size < 0) return "";
  const auto padding = static_cast<std::size_t>(std::ranges::count(text.substr(text.size() - 2), '='));
  return {bytes.begin(), bytes.begin() + size - static_cast<std::ptrdiff_t>(padding)};
}

std::string token_in(const std::string& authorization) {
  if (const auto token = after_scheme(authorization, "Bearer"); !token.empty()) return std::string(token);
  const std::string user_and_password = decode_base64(after_scheme(authorization, "Basic"));
  const auto colon = user_and_password.find(':');
  return colon == std::string::npos ? "" : user_and_password.substr(colon + 1);
}

}  // namespace

AccessCheck::AccessCheck(const std::string& token) : digest_(token.empty() ? "" : jobs::sha256_hex(token)) {}

bool AccessCheck::is_allowed(std::string_view path, const std::string& authorization) const {
  if (digest_.empty() || is_probe(path)) return true;
  const std::string digest = jobs::sha256_hex(token_in(authorization));
  return CRYPTO_memcmp(digest.data(), digest_.data(), digest_.size()) == 0;
}

bool is_probe(std::string_view path) { return path == "/healthz" || path == "/readyz"; }

std::string describe_token_fault(std::string_view token) {
  if (token.size() < kShortestToken || token.size() > kLongestToken) {
    return "must have " + std::to_string(kShortestToken) + " to " + std::to_string(kLongestToken) +
           " characters; openssl rand -hex 24 makes a good one";
  }
  const bool good = std::ranges::all_of(
      token, [](char c) { return c > ' ' && c < '\x7f' && c != '"' && c != ',' && c != ':'; });
  return good ? "" : "must be of visible ASCII characters, without a quote, a comma or a colon";
}

}  // namespace server
