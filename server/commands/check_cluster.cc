// SPDX-License-Identifier: Apache-2.0
#include "server/commands/check_cluster.h"

#include <iostream>

#include "jobs/cluster/check.h"
#include "server/commands/command.h"
#include "server/commands/signals.h"
#include "server/messages/terminal_text.h"

namespace server::commands {

namespace {

void print(const jobs::cluster::Finding& finding) {
  using Kind = jobs::cluster::Finding::Kind;
  std::cout << (finding.kind == Kind::kGood      ? "ok       "
                : finding.kind == Kind::kWarning ? "warning  "
                                                 : "FAULT    ")
            << terminal_text(finding.text, LineEnds::kKept) << '\n';
  if (!finding.advice.empty())
    std::cout << "         -> " << terminal_text(finding.advice, LineEnds::kKept) << '\n';
  std::cout << std::flush;
}

}  // namespace

int check_cluster(const CheckClusterOptions& options) {
  const jobs::cluster::Site site = make_site(options.cluster);
  if (site.folder.empty()) throw BadInput("--slurm-folder is missing");
  const EndSignals signals;
  bool interrupted = false;
  const auto stop_requested = [&] { return interrupted = interrupted || signals.arrived(); };
  const bool good =
      jobs::cluster::check_cluster(site, print, std::chrono::seconds(options.wait_s), stop_requested);
  if (interrupted) return kInterrupted;
  if (good) std::cout << "the cluster can be used: rpsup serve --executor slurm with the same options\n";
  return good ? kDone : kMachineFailed;
}

}  // namespace server::commands
