// SPDX-License-Identifier: Apache-2.0
#include "server/http/http_client.h"

#include "server/http/httplib.h"

#include <algorithm>
#include <cctype>
#include <string_view>

namespace server {

namespace {

constexpr time_t kConnectSeconds = 5;
constexpr time_t kAnswerSeconds = 60;  // as long as the service itself takes at most for an answer

bool is_host_character(unsigned char c) {
  return std::isalnum(c) != 0 ||
         std::string_view(".-_:[]").find(static_cast<char>(c)) != std::string_view::npos;
}

bool is_path_character(unsigned char c) { return c > ' ' && c < 0x7f && c != '?' && c != '#' && c != '\\'; }

/// @returns whether a certificate is of another host. Older versions of the library call that
/// SSLServerVerification.
template <typename Error>
bool is_of_another_host(Error error) {
  if constexpr (requires { Error::SSLServerHostnameVerification; }) {
    return error == Error::SSLServerHostnameVerification;
  } else {
    return false;
  }
}

std::string describe(httplib::Error error) {
  if (is_of_another_host(error)) error = httplib::Error::SSLServerVerification;
  switch (error) {
    case httplib::Error::Connection:
      return "nothing answers there; is the service running (rpsup serve), and is --url or RPSUP_URL right?";
    case httplib::Error::ConnectionTimeout:
      return "no connection in time";
    case httplib::Error::SSLServerVerification:
      return "its certificate is not one that this machine trusts";
    case httplib::Error::SSLConnection:
    case httplib::Error::SSLLoadingCerts:
      return "no secure connection";
    default:
      return "the connection broke before the answer was there";
  }
}

}  // namespace

std::optional<ServiceUrl> parse_service_url(const std::string& url) {
  const auto scheme_end = url.find("://");
  if (scheme_end == std::string::npos) return std::nullopt;
  const std::string scheme = url.substr(0, scheme_end);
  if (scheme != "http" && scheme != "https") return std::nullopt;
  const auto host_begin = scheme_end + 3;
  const auto path_begin = std::min(url.find('/', host_begin), url.size());
  const std::string host = url.substr(host_begin, path_begin - host_begin);
  std::string prefix = url.substr(path_begin);
  if (host.empty() || host.front() == ':' || !std::ranges::all_of(host, is_host_character))
    return std::nullopt;
  if (!std::ranges::all_of(prefix, is_path_character)) return std::nullopt;
  while (prefix.ends_with('/')) prefix.pop_back();
  return ServiceUrl{.origin = scheme + "://" + host, .prefix = std::move(prefix)};
}

class HttpClient::Impl {
 public:
  Impl(const ServiceUrl& url, const std::string& token) : url_(url), client_(url.origin) {
    client_.set_connection_timeout(kConnectSeconds);
    client_.set_read_timeout(kAnswerSeconds);
    if (!token.empty()) client_.set_bearer_token_auth(token);
  }

  Answer get(const std::string& path, const std::string& accept) {
    return take(client_.Get(url_.prefix + path, httplib::Headers{{"Accept", accept}}));
  }

  Answer get(const std::string& path, const std::string& accept,
             const std::function<bool(std::string_view)>& take_piece) {
    bool good = false;
    std::string problem;
    const auto result = client_.Get(
        url_.prefix + path, httplib::Headers{{"Accept", accept}},
        [&](const httplib::Response& response) {
          good = response.status == 200;
          return true;
        },
        [&](const char* data, std::size_t size) {
          if (good) return take_piece({data, size});
          problem.append(data, size);
          return true;
        });
    Answer answer = take(result);
    answer.body = std::move(problem);
    return answer;
  }

  Answer post(const std::string& path, const std::string& body, const std::string& media_type,
              const std::string& key) {
    httplib::Headers headers;
    if (!key.empty()) headers.emplace("Idempotency-Key", key);
    return take(client_.Post(url_.prefix + path, headers, body, media_type));
  }

  Answer erase(const std::string& path) { return take(client_.Delete(url_.prefix + path)); }

  void set_patience(std::chrono::milliseconds time) {
    client_.set_connection_timeout(
        std::min<std::chrono::milliseconds>(time, std::chrono::seconds(kConnectSeconds)));
    client_.set_read_timeout(time);
  }

 private:
  [[nodiscard]] Answer take(const httplib::Result& result) const {
    if (!result)
      throw Unreachable("no answer from " + url_.origin + url_.prefix + ": " + describe(result.error()));
    return {.status = result->status,
            .content_type = result->get_header_value("Content-Type"),
            .body = result->body};
  }

  ServiceUrl url_;
  httplib::Client client_;
};

HttpClient::HttpClient(const ServiceUrl& url, const std::string& token)
    : impl_(std::make_unique<Impl>(url, token)) {}
HttpClient::~HttpClient() = default;

HttpClient::Answer HttpClient::get(const std::string& path, const std::string& accept) {
  return impl_->get(path, accept);
}
HttpClient::Answer HttpClient::get(const std::string& path, const std::string& accept,
                                   const std::function<bool(std::string_view)>& take) {
  return impl_->get(path, accept, take);
}
HttpClient::Answer HttpClient::post(const std::string& path, const std::string& body) {
  return impl_->post(path, body, "application/json", "");
}
HttpClient::Answer HttpClient::post(const std::string& path, const std::string& body,
                                    const std::string& media_type, const std::string& key) {
  return impl_->post(path, body, media_type, key);
}
HttpClient::Answer HttpClient::erase(const std::string& path) { return impl_->erase(path); }
void HttpClient::set_patience(std::chrono::milliseconds time) { impl_->set_patience(time); }

}  // namespace server
