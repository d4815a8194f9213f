// SPDX-License-Identifier: Apache-2.0
#include "jobs/cluster/shared_folder.h"

#include <fstream>
#include <iterator>

#include "jobs/base/content_id.h"
#include "jobs/base/provenance.h"
#include "jobs/cluster/durable_file.h"
#include "jobs/cluster/process.h"

namespace jobs::cluster {

std::filesystem::path share_program(const Site& site) {
  constexpr std::size_t kName = 12;
  const std::string bytes = read_whole(site.program.empty() ? "/proc/self/exe" : site.program);
  const auto shared = site.folder / "bin" / ("rpsup-" + sha256_hex(bytes).substr(0, kName));
  std::error_code error;
  std::filesystem::create_directories(shared.parent_path(), error);
  if (error)
    throw FileError("cannot make the folder " + shared.parent_path().string() + ": " + error.message());
  if (!std::filesystem::exists(shared, error)) write_durably(shared, bytes);
  // A service that was killed may have left a file that is no program yet.
  constexpr auto kProgram = std::filesystem::perms(0755);
  if (std::filesystem::status(shared, error).permissions() != kProgram)
    std::filesystem::permissions(shared, kProgram, error);
  if (error) throw FileError("cannot make " + shared.string() + " a program: " + error.message());
  return shared;
}

std::string make_script(const Site& site, const std::filesystem::path& program,
                        const std::string& arguments) {
  // A login shell has the functions of a site, such as module.
  std::string script = site.prologue.empty() ? "#!/bin/sh\n" : "#!/bin/bash -l\n";
  if (!site.prologue.empty()) script += "{\n" + site.prologue + "\n} || exit\n";
  if (has_portable_numerics()) script += "export GLIBC_TUNABLES=" + shell_quoted(portable_tunables()) + "\n";
  // A task has all options from the service: a fault in the user's configuration must not fail it.
  return script + "exec " + shell_quoted(program.string()) + " " + arguments + " --config /dev/null\n";
}

std::string tail_of(const std::filesystem::path& file, std::size_t most_bytes) {
  std::ifstream in(file, std::ios::binary | std::ios::ate);
  if (!in) return "";
  const auto size = static_cast<std::size_t>(in.tellg());
  in.seekg(static_cast<std::streamoff>(size > most_bytes ? size - most_bytes : 0));
  std::string text{std::istreambuf_iterator<char>(in), {}};
  while (!text.empty() && text.back() == '\n') text.pop_back();
  return text;
}

}  // namespace jobs::cluster
