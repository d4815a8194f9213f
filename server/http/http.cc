// SPDX-License-Identifier: Apache-2.0
#include "server/http/http.h"

#include <strings.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <spdlog/spdlog.h>

#include "jobs/base/time_text.h"
#include "server/context/work_limit.h"
#include "server/http/access.h"
#include "server/http/http_date.h"
#include "server/http/http_guard.h"
#include "server/http/request_body.h"
#include "server/http/request_head.h"
#include "server/http/request_ids.h"
#include "server/messages/error_answer.h"
#include "server/messages/problem.h"

namespace server {

namespace {

// Nothing but what this server itself sends runs in its page, and no other page shows it in a frame.
const httplib::Headers kSecurityHeaders = {
    {"Content-Security-Policy",
     "default-src 'none'; script-src 'self'; style-src 'self'; connect-src 'self'; img-src 'self'; base-uri "
     "'none'; form-action 'none'; frame-ancestors 'none'"},
    {"Cross-Origin-Resource-Policy", "same-origin"},
    {"Referrer-Policy", "no-referrer"},
    {"X-Content-Type-Options", "nosniff"},
};

/// Mark of an answer that has ranges, until the library has added its own headers. No answer has it in the
/// end.
constexpr const char* kHasRanges = "Has-Ranges";

/// Sends a file piece by piece.
void set_file(httplib::Response& to, const std::string& content_type, std::shared_ptr<FileBody> file) {
  static constexpr std::size_t kPiece = 64 * 1024;
  const std::size_t size = file->size();
  to.set_content_provider(
      size, content_type,
      [file = std::move(file)](std::size_t offset, std::size_t length, httplib::DataSink& sink) {
        std::vector<char> piece(std::min(length, kPiece));
        const std::size_t got = file->read(offset, piece.data(), piece.size());
        return got > 0 && sink.write(piece.data(), got);
      });
}

/// Sends a body as it is made: in chunks, so that a client can tell a body that ends early; to HTTP/1.0,
/// which has none, up to the end of the connection.
void set_stream(httplib::Response& to, const std::string& version, const std::string& content_type,
                std::shared_ptr<BodyStream> stream) {
  auto provider = [stream = std::move(stream)](std::size_t, httplib::DataSink& sink) {
    std::string piece;
    if (stream->append_next(piece)) return piece.empty() || sink.write(piece.data(), piece.size());
    sink.done();
    return true;
  };
  if (version == "HTTP/1.0") to.set_content_provider(content_type, std::move(provider));
  else to.set_chunked_content_provider(content_type, std::move(provider));
}

/// Sends the head alone; the events follow on another thread.
void set_events(httplib::Response& to, const std::string& content_type, std::shared_ptr<EventSource> events) {
  to.set_content_provider(content_type, [](std::size_t, httplib::DataSink& sink) {
    sink.done();
    return true;
  });
  GuardedServer::stream_events(std::move(events));
}

void set_body(httplib::Response& to, Response& from, const std::string& version) {
  to.body = std::move(from.body);
  if (from.file) {
    set_file(to, from.content_type, std::move(from.file));
  } else if (from.stream) {
    set_stream(to, version, from.content_type, std::move(from.stream));
  } else if (from.events) {
    set_events(to, from.content_type, std::move(from.events));
  } else if (!from.content_type.empty()) {
    to.set_header("Content-Type", from.content_type);
  }
}

void copy_to(httplib::Response& to, Response from, const std::string& version = "HTTP/1.1") {
  to.status = from.status;
  set_body(to, from, version);
  for (const auto& [name, value] : from.headers) {
    if (name == "Accept-Ranges") to.set_header(kHasRanges, value);
    if (kSecurityHeaders.contains(name))
      to.headers.erase(name);  // in the place of the one that every answer has
    to.set_header(name, value);
  }
}

/// Only browsers send these. Another site's page can have them send a form or plain text without asking, but
/// not JSON.
bool is_of_a_page(const httplib::Request& request) {
  return request.has_header("Origin") || request.has_header("Sec-Fetch-Site");
}

/// Media types that a page of another site cannot send without asking.
bool is_safe_of_a_page(const std::string& content_type) {
  const std::string media_type = content_type.substr(0, content_type.find_first_of("; \t"));
  return std::ranges::any_of(
      std::array{"application/json", "text/csv", "application/octet-stream", "application/x-npz"},
      [&](const char* type) { return ::strcasecmp(media_type.c_str(), type) == 0; });
}

/// Names of codings have no case; "x-gzip" is "gzip" (RFC 9110, section 8.4.1).
BodyForm body_form(const httplib::Request& request) {
  BodyForm form{.chunked = request.has_header("Transfer-Encoding"),
                .content_length = 0,
                .coding = request.get_header_value("Content-Encoding")};
  std::ranges::transform(form.coding, form.coding.begin(), [](unsigned char c) { return std::tolower(c); });
  if (form.coding == "x-gzip") form.coding = "gzip";
  const std::string length = request.get_header_value("Content-Length");
  static_cast<void>(std::from_chars(length.data(), length.data() + length.size(), form.content_length));
  return form;
}

/// Of programs the media type is not looked at beyond this: `curl -d` calls every body a form.
std::optional<Refusal> find_media_fault(const httplib::Request& request) {
  if (request.is_multipart_form_data())
    return Refusal{415, "send the JSON text itself, not as a part of a form"};
  const bool empty = request.get_header_value("Content-Length") == "0";
  if (!empty && is_of_a_page(request) && !is_safe_of_a_page(request.get_header_value("Content-Type"))) {
    return Refusal{415, "a page sends JSON with Content-Type: application/json"};
  }
  const std::string coding = body_form(request).coding;
  if (coding.empty() || coding == "identity" || coding == "gzip" || coding == "deflate") return std::nullopt;
  return Refusal{415, "the Content-Encoding is not supported; gzip and deflate are"};
}

/// @returns whether the body may be larger than a megabyte, which chunks and codings do not tell before it
/// has come
bool may_be_large(const httplib::Request& request) {
  const BodyForm form = body_form(request);
  return form.chunked || !form.coding.empty() || form.content_length > 1024 * 1024;
}

bool has_body(const httplib::Request& request) {
  return request.has_header("Content-Length") || request.has_header("Transfer-Encoding");
}

}  // namespace

class HttpServer::Impl {
 public:
  Impl(const Routes& routes, HttpOptions http_options, const HttpLimits& http_limits)
      : options(std::move(http_options)),
        limits(http_limits),
        routes_(routes),
        origin_check_(options.address, options.cors_origins, options.names),
        access_check_(options.token),
        guard(
            http_limits,
            [this](int status, const std::string& detail) { return make_refusal(status, detail); },
            [this](Response& refusal, std::string_view head) { complete_refusal(refusal, head); }) {
    set_route_handlers();
    set_answer_handlers();
  }

  HttpOptions options;
  HttpLimits limits;

 private:
  using Handled = httplib::Server::HandlerResponse;

  void set_route_handlers() {
    guard.set_pre_routing_handler([this](const httplib::Request& request, httplib::Response& response) {
      return route_without_body(request, response);
    });
    // The library's reader is named and not used: the library would refuse forms above 8 KiB, which is what
    // `curl -d` sends, and trailers, and would take gzip without its checksum.
    const auto with_body = [this](const httplib::Request& request, httplib::Response& response,
                                  const httplib::ContentReader&) { route_with_body(request, response); };
    guard.Post(R"([\s\S]*)", with_body);
    guard.Patch(R"([\s\S]*)", with_body);
  }

  /// Handlers for answers that the library makes, and for all.
  void set_answer_handlers() {
    guard.set_default_headers(kSecurityHeaders);
    guard.set_error_handler(
        [](const httplib::Request&, httplib::Response& response) { complete_error(response); });
    guard.set_exception_handler(
        [this](const httplib::Request&, httplib::Response& response, const std::exception_ptr& error) {
          copy_to(response, make_error_answer(error, request_ids_.next()));
        });
    guard.set_post_routing_handler([this](const httplib::Request& request, httplib::Response& response) {
      tidy_headers(request, response);
      response.set_header("Date", http_date(jobs::now_unix_ms()));
      if (!response.has_header("X-Request-Id")) {  // it was refused before it came to a route
        response.set_header("X-Request-Id", request_ids_.next());
        routes_.count_unrouted(request.method, response.status);
      }
      for (const auto& [name, value] : cors_headers(request.get_header_value("Origin")))
        response.set_header(name, value);
    });
  }

  Response make_refusal(int status, const std::string& detail) {
    Response response = status == 503 ? make_retry_later(status, detail) : make_problem(status, detail);
    response.headers.emplace_back("X-Request-Id", request_ids_.next());
    for (const auto& [name, value] : kSecurityHeaders) response.headers.emplace_back(name, value);
    return response;
  }

  void complete_refusal(Response& refusal, std::string_view head) const {
    refusal.headers.emplace_back("Date", http_date(jobs::now_unix_ms()));
    for (auto& header : cors_headers(raw_header_of(head, "origin")))
      refusal.headers.push_back(std::move(header));
    routes_.count_unrouted(std::string(head.substr(0, head.find(' '))), refusal.status);
  }

  /// The library ends some requests itself, with a status and no body.
  static void complete_error(httplib::Response& response) {
    if (response.body.empty())
      copy_to(response, make_problem(response.status, "the request cannot be understood"));
  }

  /// The library says of every answer to HEAD that it has ranges.
  static void tidy_headers(const httplib::Request& request, httplib::Response& response) {
    if (request.method == "HEAD" && !response.has_header(kHasRanges)) response.headers.erase("Accept-Ranges");
    response.headers.erase(kHasRanges);
    if (response.status == 204 || response.status == 304) response.headers.erase("Content-Length");
  }

  /// Headers that let the page of another site read the answer, if it is one that may.
  std::vector<std::pair<std::string, std::string>> cors_headers(const std::string& origin) const {
    if (options.cors_origins.empty()) return {};
    if (!origin_check_.is_allowed(origin)) return {{"Vary", "Origin"}};
    return {{"Vary", "Origin"},
            {"Access-Control-Allow-Origin", origin},
            {"Access-Control-Expose-Headers",
             "Accept-Ranges, Content-Disposition, Content-Range, ETag, Location, Preference-Applied, "
             "Retry-After, X-Request-Id"}};
  }

  /// @returns whether a browser asks on behalf of such a page, before it sends the request itself
  bool is_preflight(const httplib::Request& request) const {
    return request.method == "OPTIONS" && request.has_header("Access-Control-Request-Method") &&
           origin_check_.is_allowed(request.get_header_value("Origin"));
  }

  static void answer_preflight(const httplib::Request& request, httplib::Response& response) {
    response.status = 204;
    response.set_header("Access-Control-Allow-Methods", "GET, HEAD, POST, PATCH, DELETE");
    response.set_header("Access-Control-Allow-Headers",
                        "Authorization, Content-Type, Idempotency-Key, If-Match, If-None-Match, "
                        "If-Range, Last-Event-ID, Prefer, Range");
    response.set_header("Access-Control-Max-Age", "600");
    // Chrome asks this where a page from elsewhere speaks to this machine.
    if (request.has_header("Access-Control-Request-Private-Network"))
      response.set_header("Access-Control-Allow-Private-Network", "true");
  }

  /// The second challenge makes a browser ask its user for a name, which may be anything, and a password,
  /// which is the token.
  static Response make_access_problem() {
    Response response = make_problem(401, "this service asks for its token: Authorization: Bearer TOKEN");
    response.headers.emplace_back("WWW-Authenticate", "Bearer realm=\"rpsup\"");
    response.headers.emplace_back("WWW-Authenticate", "Basic realm=\"rpsup\", charset=\"UTF-8\"");
    return response;
  }

  Handled route_without_body(const httplib::Request& request, httplib::Response& response) {
    if (const auto fault = find_origin_fault(request)) {
      copy_to(response, make_problem(fault->status, fault->detail));
      return Handled::Handled;
    }
    if (is_preflight(request)) {
      answer_preflight(request, response);
      return Handled::Handled;
    }
    if (!access_check_.is_allowed(own_path(request), request.get_header_value("Authorization"))) {
      spdlog::info("refused without the token: {} {} of {}", request.method, request.path,
                   request.remote_addr);
      copy_to(response, make_access_problem());
      return Handled::Handled;
    }
    if (request.method == "POST" || request.method == "PATCH") return Handled::Unhandled;
    answer(request, {}, response);
    return Handled::Handled;
  }

  void route_with_body(const httplib::Request& request, httplib::Response& response) {
    std::string body;
    std::shared_ptr<const void> permit;
    const std::size_t body_bytes = limits.body_bytes_of(request.path);
    if (has_body(request)) {
      auto fault = find_media_fault(request);
      if (!fault && may_be_large(request)) {
        permit = (body_bytes > limits.body_bytes ? measurement_bodies_ : large_bodies_).acquire();
        if (!permit)
          return copy_to(response, make_retry_later(503, "as many large bodies wait as may; try again"));
      }
      if (!fault) fault = read_request_body(GuardedServer::read_body, body_form(request), body_bytes, body);
      if (fault) return copy_to(response, make_problem(fault->status, fault->detail));
    }
    answer(request, std::move(body), response);
  }

  std::optional<Refusal> find_origin_fault(const httplib::Request& request) const {
    return origin_check_.find_fault({.method = request.method,
                                     .host = request.get_header_value("Host"),
                                     .origin = request.get_header_value("Origin"),
                                     .fetch_site = request.get_header_value("Sec-Fetch-Site"),
                                     .fetch_mode = request.get_header_value("Sec-Fetch-Mode"),
                                     .any_host = is_probe(own_path(request))});
  }

  /// Path below the base path, if the proxy has passed it on. "/" for the base path itself.
  [[nodiscard]] std::string own_path(const httplib::Request& request) const {
    const std::string& base = options.base_path;
    if (base.empty() || !request.path.starts_with(base)) return request.path;
    if (request.path.size() == base.size()) return "/";
    return request.path[base.size()] == '/' ? request.path.substr(base.size()) : request.path;
  }

  /// Of the option, unless the proxy says it with the request.
  [[nodiscard]] std::string base_path_of(const httplib::Request& request) const {
    const auto forwarded = find_base_path(request.get_header_value("X-Forwarded-Prefix"));
    return forwarded && !forwarded->empty() ? *forwarded : options.base_path;
  }

  static void copy_headers_to(Request& to, const httplib::Request& from) {
    to.accept = from.get_header_value("Accept");
    to.content_type = from.get_header_value("Content-Type");
    to.accept_encoding = from.get_header_value(kAcceptEncoding);
    to.if_match = from.get_header_value("If-Match");
    to.if_none_match = from.get_header_value("If-None-Match");
    to.prefer = from.get_header_value("Prefer");
    to.last_event_id = from.get_header_value("Last-Event-ID");
    to.range = from.get_header_value(kRange);
    to.if_range = from.get_header_value("If-Range");
    if (from.has_header("Idempotency-Key")) to.idempotency_key = from.get_header_value("Idempotency-Key");
  }

  Request make_request(const httplib::Request& from, std::string body) {
    Request request;
    request.method = from.method;
    request.path = own_path(from);
    request.base_path = base_path_of(from);
    request.query.assign(from.params.begin(), from.params.end());
    copy_headers_to(request, from);
    request.body = std::move(body);
    request.id = request_ids_.next();
    return request;
  }

  void answer(const httplib::Request& from, std::string body, httplib::Response& to) {
    const auto start = std::chrono::steady_clock::now();
    const Request request = make_request(from, std::move(body));
    to.set_header("X-Request-Id", request.id);
    // Without the slash a browser would take the addresses of the page for those beside it.
    const bool slash_is_missing = !options.base_path.empty() && from.path == options.base_path;
    Response response = slash_is_missing ? make_redirect(from.path.substr(from.path.rfind('/') + 1) + "/")
                                         : routes_.answer(request);
    if (response.events && !guard.reserve_event_stream(response.events))
      response = make_retry_later(503, "too many clients follow events");
    if (from.method == "HEAD") response.events.reset();
    GuardedServer::hold_until_sent(std::move(response.permit));
    copy_to(to, std::move(response), from.version);
    const std::chrono::duration<double, std::milli> took = std::chrono::steady_clock::now() - start;
    spdlog::debug("request {}: {} {} {} {:.1f} ms", request.id, request.method, request.path, to.status,
                  took.count());
  }

  const Routes& routes_;
  OriginCheck origin_check_;
  AccessCheck access_check_;
  RequestIds request_ids_;
  WorkLimit measurement_bodies_{1, 8, {}, &routes_.waiting_places()};  // of up to 64 MiB
  WorkLimit large_bodies_{6, 16, {}, &routes_.waiting_places()};       // of up to 8 MiB each, read and served

 public:
  GuardedServer guard;  // last: its handlers use what stands above
};

HttpServer::HttpServer(const Routes& routes, const HttpOptions& options)
    : HttpServer(routes, options, HttpLimits{}) {}

HttpServer::HttpServer(const Routes& routes, const HttpOptions& options, const HttpLimits& limits)
    : impl_(std::make_unique<Impl>(routes, options, limits)) {}

HttpServer::~HttpServer() = default;

int HttpServer::bind() { return impl_->guard.bind(impl_->options.address, impl_->options.port); }

bool HttpServer::listen() { return impl_->guard.accept_connections(); }

void HttpServer::stop() {
  impl_->guard.start_draining();
  impl_->guard.stop_accepting();
}

}  // namespace server
