// SPDX-License-Identifier: Apache-2.0
#include "jobs/base/content_id.h"

#include <array>
#include <memory>
#include <new>

#include <openssl/evp.h>

namespace jobs {
namespace {

using Digest = std::array<unsigned char, 32>;

Digest sha256(std::string_view first, std::string_view second) {
  const std::unique_ptr<EVP_MD_CTX, decltype(&EVP_MD_CTX_free)> context(EVP_MD_CTX_new(), &EVP_MD_CTX_free);
  Digest digest{};
  const bool done = context && EVP_DigestInit_ex(context.get(), EVP_sha256(), nullptr) == 1 &&
                    EVP_DigestUpdate(context.get(), first.data(), first.size()) == 1 &&
                    EVP_DigestUpdate(context.get(), second.data(), second.size()) == 1 &&
                    EVP_DigestFinal_ex(context.get(), digest.data(), nullptr) == 1;
  if (!done) throw std::bad_alloc();  // it fails for nothing else
  return digest;
}

std::string hex_of(const Digest& digest) {
  constexpr std::string_view kHex = "0123456789abcdef";
  std::string hex;
  for (const unsigned char byte : digest) {
    hex += kHex[byte >> 4U];
    hex += kHex[byte & 15U];
  }
  return hex;
}

}  // namespace

std::string canonical_text(const nlohmann::json& completed) { return completed.dump(); }

std::string content_id(std::string_view canonical_parameters, std::string_view engine_version) {
  // The line feed cannot stand in canonical text, so no two pairs run together into one.
  return sha256_hex(canonical_parameters, "\n" + std::string(engine_version));
}

std::string sha256_hex(std::string_view text, std::string_view rest) { return hex_of(sha256(text, rest)); }

}  // namespace jobs
