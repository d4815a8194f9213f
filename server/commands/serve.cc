// SPDX-License-Identifier: Apache-2.0
#include "server/commands/serve.h"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cctype>
#include <csignal>
#include <cstddef>
#include <iostream>
#include <memory>
#include <optional>
#include <stdexcept>
#include <thread>

#include <spdlog/spdlog.h>

#include "jobs/service.h"
#include "server/commands/command.h"
#include "server/commands/log.h"
#include "server/commands/memory_limit.h"
#include "server/commands/service_token.h"
#include "server/commands/signals.h"
#include "server/context/metrics.h"
#include "server/http/http.h"
#include "server/http/http_client.h"
#include "server/http/request_head.h"
#include "server/routes/routes.h"

namespace server::commands {

namespace {

constexpr long kMegabyte = 1'000'000;

/// Without a token, whoever reaches the port may fill the disk and use the processors.
std::string checked_address(const std::string& host, const std::string& token) {
  if (host == "localhost") return "127.0.0.1";
  if (!is_address(host))
    throw BadInput("--host " + host + ": must be an IP address of this machine, such as 127.0.0.1 or ::1");
  if (token.empty() && !is_loopback(host)) {
    throw BadInput("--host " + host +
                   ": without a token only addresses of the loopback (127.0.0.1, ::1) are served, because "
                   "whoever reaches another one could fill the disk; give it one by --token-file or "
                   "RPSUP_TOKEN, or reach the service through an SSH tunnel");
  }
  return host;
}

/// Names as they stand in a Host header: no scheme, no port, in lower case.
const std::vector<std::string>& checked_names(const std::vector<std::string>& names) {
  for (const std::string& name : names) {
    const bool good = !name.empty() && std::ranges::all_of(name, [](unsigned char c) {
      return std::islower(c) != 0 || std::isdigit(c) != 0 || c == '-' || c == '.';
    });
    if (!good && !is_address(name))
      throw BadInput("--name " + name +
                     ": must be like rpsup.example.org, in lower case, without a scheme and a port");
  }
  return names;
}

std::string url(const std::string& address, int port) {
  const bool v6 = address.find(':') != std::string::npos;
  return "http://" + (v6 ? "[" + address + "]" : address) + ":" + std::to_string(port);
}

/// Origins as browsers send them: scheme, host, perhaps a port.
std::vector<std::string> checked_origins(const std::vector<std::string>& origins) {
  std::vector<std::string> normal;
  for (const std::string& origin : origins) {
    const auto url = parse_service_url(normal_origin(origin));
    if (!url || !url->prefix.empty()) {
      throw BadInput(
          "--cors-origin " + origin +
          ": must be like https://lab.example.org or http://127.0.0.1:3000, without a path; there is no word "
          "for all of them, since whatever page a user opens could then use the service");
    }
    normal.push_back(normal_origin(url->origin));
  }
  return normal;
}

std::string checked_base_path(const std::string& path) {
  const auto checked = find_base_path(path);
  if (!checked || path.find(',') != std::string::npos)
    throw BadInput("--base-path " + path +
                   ": must be like /rpsup, the path under which a proxy shows the service");
  return *checked;
}

/// Each connection and each file of the store takes one, and many systems allow 1024 unless they are asked.
void raise_file_limit() {
  constexpr rlim_t kFiles = 4096;
  rlimit limit{};
  if (::getrlimit(RLIMIT_NOFILE, &limit) != 0 || limit.rlim_cur >= kFiles) return;
  limit.rlim_cur = std::min(kFiles, limit.rlim_max);
  ::setrlimit(RLIMIT_NOFILE, &limit);
}

/// Serves on a thread of its own.
class Serving {
 public:
  explicit Serving(HttpServer& http) : http_(http) {
    thread_ = std::jthread([this] {
      failed_ = !http_.listen();
      // Ends the wait for a signal if the server ended by itself.
      if (failed_) ::kill(::getpid(), SIGTERM);
    });
  }
  ~Serving() { http_.stop(); }
  Serving(const Serving&) = delete;
  Serving& operator=(const Serving&) = delete;

  [[nodiscard]] bool has_failed() const { return failed_; }

 private:
  HttpServer& http_;
  std::atomic<bool> failed_ = false;
  std::jthread thread_;
};

std::size_t find_job_memory(const ServeOptions& options) {
  if (options.job_memory_mb) return static_cast<std::size_t>(*options.job_memory_mb * kMegabyte);
  const std::optional<std::size_t> limit = find_memory_limit("/");
  const std::size_t chosen = choose_job_memory(limit, options.threads);
  if (limit)
    spdlog::info("memory is limited to {} MB: a job may take {} MB", *limit / 1'000'000, chosen / 1'000'000);
  return chosen;
}

jobs::ServiceOptions make_service_options(const ServeOptions& options, const jobs::cluster::Site& site,
                                          const std::shared_ptr<Metrics>& metrics) {
  jobs::ServiceOptions made;
  made.store = options.store;
  made.threads = options.threads;
  made.job_limits = {.wall_time_s = options.job_time_s,
                     .steps = options.job_steps,
                     .memory_bytes = find_job_memory(options)};
  made.store_quota = {.most_bytes = options.store_limit_mb * kMegabyte,
                      .reserve_bytes = options.disk_reserve_mb * kMegabyte};
  made.site = site;
  made.executor = options.executor;
  made.start = jobs::Start::kWhenTold;
  made.log = [](const std::string& message) { spdlog::warn(message); };
  made.ran = [metrics](const jobs::JobSpec& spec, const jobs::RunRecord& run) {
    metrics->add_run(spec, run);
  };
  return made;
}

}  // namespace

int serve(const ServeOptions& options) {
  const std::string token = find_service_token(options.token_file);
  const std::string address = checked_address(options.host, token);
  const std::vector<std::string>& names = checked_names(options.names);
  const std::vector<std::string> cors_origins = checked_origins(options.cors_origins);
  const std::string base_path = checked_base_path(options.base_path);
  const jobs::cluster::Site site = make_site(options.cluster);
  if (options.executor == "slurm" && site.folder.empty())
    throw BadInput("--executor slurm needs --slurm-folder");
  raise_file_limit();
  // Before the first thread: threads take over which signals are blocked.
  const EndSignals signals;
  const Log log(options.log_level);
  const auto metrics = std::make_shared<Metrics>();
  jobs::Service service(make_service_options(options, site, metrics));
  Routes routes(service, metrics);
  HttpServer http(routes, {.address = address,
                           .port = options.port,
                           .cors_origins = cors_origins,
                           .names = names,
                           .token = token,
                           .base_path = base_path});
  const int port = http.bind();
  if (port == 0) {
    throw std::runtime_error("cannot listen on " + url(address, options.port) +
                             ": another program has this port, "
                             "or it is not this user's to take; --port 0 takes any free one");
  }
  service.start();  // not before it is sure that there will be a server
  {
    const Serving serving(http);
    spdlog::info("store {}, {} threads", options.store, options.threads);
    std::cout << "rpsup listens on " << url(address, port) << std::endl;
    signals.wait();
    if (serving.has_failed()) throw std::runtime_error("the server cannot accept connections any more");
    spdlog::info("ending: running jobs go back to the queue");
    routes.start_draining();
    service.stop();
  }
  spdlog::info("ended");
  return kDone;
}

}  // namespace server::commands
