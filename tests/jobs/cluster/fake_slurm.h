// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include "jobs/cluster/site.h"
#include "tests/jobs/service_support.h"

namespace jobs_tests {

/// Commands in the batch_index of Slurm's, each a shell script that a test writes; what they are called with
/// is noted.
class FakeSlurm {
 public:
  FakeSlurm() {
    std::filesystem::create_directories(folder());
    write("slurm", "echo \"$@\" >>'" + file("calls") + "'\ncommand=$1; shift\n. '" + folder().string() +
                       "'/$command\n");
    answer("sbatch", "echo 1");
    answer("squeue", "cat '" + file("reports") + "'");
    answer("scancel", "true");
    answer("scontrol", "echo 'MaxArraySize            = 1001'; echo 'SLURM_VERSION           = 22.05.8'");
  }

  /// @param script  of shell: what the command does from now on
  void answer(const std::string& command, const std::string& script) { write(command, script + "\n"); }
  /// Sets the output of squeue from now on. Before the first call squeue fails, so that nothing is concluded.
  void report(const std::string& lines) { replace("reports", lines); }

  [[nodiscard]] std::string calls() const {
    std::ifstream in(file("calls"));
    return (std::ostringstream() << in.rdbuf()).str();
  }
  [[nodiscard]] int count(const std::string& command) const {
    std::istringstream lines(calls());
    int count = 0;
    for (std::string line; std::getline(lines, line);) count += line.starts_with(command + " ") ? 1 : 0;
    return count;
  }

  /// A cluster that is looked at all the time.
  [[nodiscard]] jobs::cluster::Site site() const {
    jobs::cluster::Site site;
    site.folder = folder() / "shared";
    std::filesystem::create_directories(site.folder);
    site.prefix = {file("slurm")};
    site.slots = 2;
    site.queue_poll = site.folder_poll = std::chrono::milliseconds(5);
    site.grace = std::chrono::milliseconds(100);
    return site;
  }

 private:
  [[nodiscard]] std::filesystem::path folder() const { return temporary_.file().parent_path() / "slurm"; }
  [[nodiscard]] std::string file(const std::string& name) const { return (folder() / name).string(); }

  void replace(const std::string& name, const std::string& text) {
    std::ofstream(file(name + ".new")) << text;
    std::filesystem::rename(file(name + ".new"), file(name));
  }
  void write(const std::string& name, const std::string& script) {
    replace(name, "#!/bin/sh\n" + script);
    std::filesystem::permissions(file(name), std::filesystem::perms(0755));
  }

  TemporaryStore temporary_;
};

}  // namespace jobs_tests
