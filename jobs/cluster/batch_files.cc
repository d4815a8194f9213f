// SPDX-License-Identifier: Apache-2.0
#include "jobs/cluster/batch_files.h"

#include <array>
#include <fstream>
#include <span>
#include <utility>

#include "jobs/base/content_id.h"
#include "jobs/trajectories/byte_codec.h"
#include "jobs/trajectories/trajectory_codec.h"

namespace jobs::cluster {
namespace {

constexpr std::string_view kJobsMagic = "RPSUPJB1";
constexpr std::string_view kResultsMagic = "RPSUPRS1";
constexpr std::size_t kLongestDetail = 60'000;
constexpr std::uint32_t kLargestBatchHeader = 64U << 20U;

/// Position of a job's parameters behind the table.
struct JobEntry {
  BatchIndex batch_index = 0;
  std::uint64_t offset = 0;
  std::uint32_t size = 0;
};

std::string read_bytes(std::ifstream& in, std::size_t size, const std::filesystem::path& file) {
  std::string bytes(size, '\0');
  if (!in.read(bytes.data(), static_cast<std::streamsize>(size)))
    throw FileError(file.string() + " is cut off");
  return bytes;
}

std::vector<JobEntry> read_header(std::string_view bytes, BatchHeader& header) {
  ByteReader reader(std::as_bytes(std::span(bytes)));
  header.batch = reader.text();
  header.engine = reader.text();
  header.limits.wall_time_s = reader.number<double>();
  header.limits.steps = static_cast<long>(reader.number<std::int64_t>());
  header.limits.memory_bytes = reader.number<std::uint64_t>();
  header.deliver_every_s = reader.number<double>();
  std::vector<JobEntry> entries(reader.number<std::uint32_t>());
  for (JobEntry& entry : entries) {
    entry.batch_index = reader.number<BatchIndex>();
    entry.offset = reader.number<std::uint64_t>();
    entry.size = reader.number<std::uint32_t>();
  }
  return entries;
}

constexpr std::array kProvenance{&Provenance::host,     &Provenance::cpu,     &Provenance::libm,
                                 &Provenance::numerics, &Provenance::version, &Provenance::commit,
                                 &Provenance::compiler, &Provenance::engine};

void write_provenance(ByteWriter& to, const Provenance& from) {
  for (const auto text : kProvenance) to.text(from.*text);
}

Provenance read_provenance(ByteReader& from) {
  Provenance read;
  for (const auto text : kProvenance) read.*text = from.text();
  return read;
}

/// A number of bytes, then the bytes, however many.
void write_block(std::string& to, std::string_view bytes) {
  ByteWriter size;
  size.number(static_cast<std::uint64_t>(bytes.size()));
  to += size.bytes();
  to += bytes;
}

std::string read_block(ByteReader& from) {
  const auto block = from.take(from.number<std::uint64_t>());
  return {reinterpret_cast<const char*>(block.data()), block.size()};
}

std::string encode_record(const RunRecord& record) {
  ByteWriter writer;
  writer.number(static_cast<std::uint8_t>(record.end));
  writer.text(record.error_reason);
  writer.text(std::string_view(record.error_detail).substr(0, kLongestDetail));
  writer.number(static_cast<std::uint8_t>(record.error_t_s ? 1 : 0));
  writer.number(record.error_t_s.value_or(0.0));
  writer.number(record.wall_time_s);
  writer.number(record.cpu_time_s);
  return writer.bytes();
}

RunRecord decode_record(std::string_view bytes) {
  ByteReader reader(std::as_bytes(std::span(bytes)));
  RunRecord record;
  const auto end = reader.number<std::uint8_t>();
  if (end > static_cast<std::uint8_t>(RunRecord::End::kFailed))
    throw FileError("a result has ended in no known way");
  record.end = static_cast<RunRecord::End>(end);
  record.error_reason = reader.text();
  record.error_detail = reader.text();
  const bool reached = reader.number<std::uint8_t>() != 0;
  const auto error_t_s = reader.number<double>();
  if (reached) record.error_t_s = error_t_s;
  record.wall_time_s = reader.number<double>();
  record.cpu_time_s = reader.number<double>();
  return record;
}

ResultFile decode_payload(std::string_view bytes) {
  ByteReader reader(std::as_bytes(std::span(bytes)));
  ResultFile file;
  file.batch = reader.text();
  file.provenance = read_provenance(reader);
  const auto count = reader.number<std::uint32_t>();
  for (std::uint32_t i = 0; i < count; ++i) {
    BatchResult result;
    result.batch_index = reader.number<BatchIndex>();
    result.record = decode_record(read_block(reader));
    result.record.metrics = nlohmann::json::parse(read_block(reader));
    result.packed_trajectory = read_block(reader);
    file.results.push_back(std::move(result));
  }
  return file;
}

void write_header(ByteWriter& to, const BatchHeader& header) {
  to.text(header.batch);
  to.text(header.engine);
  to.number(header.limits.wall_time_s);
  to.number(static_cast<std::int64_t>(header.limits.steps));
  to.number(static_cast<std::uint64_t>(header.limits.memory_bytes));
  to.number(header.deliver_every_s);
}

/// Table of the jobs of a file.
struct JobTable {
  std::map<BatchIndex, JobEntry> entries;
  std::size_t size = 0;  ///< of all that stands before the parameters
};

/// @param header  out  @throws FileError
JobTable read_job_table(std::ifstream& in, const std::filesystem::path& file, BatchHeader& header) {
  std::uint32_t size = 0;
  if (!in.read(reinterpret_cast<char*>(&size), sizeof size) || size > kLargestBatchHeader) {
    throw FileError(file.string() + " is cut off or no file of jobs");
  }
  const std::string head = read_bytes(in, size, file);
  JobTable table{.entries = {}, .size = sizeof size + size};
  try {
    for (const JobEntry& entry : read_header(unseal(kJobsMagic, head), header))
      table.entries.emplace(entry.batch_index, entry);
  } catch (const DamagedTrajectory& error) {
    throw FileError(file.string() + " is damaged: " + error.what());
  }
  return table;
}

std::string read_job_text(std::ifstream& in, const std::filesystem::path& file, const JobTable& table,
                          BatchIndex batch_index) {
  const auto found = table.entries.find(batch_index);
  if (found == table.entries.end())
    throw FileError(file.string() + " has no job " + std::to_string(batch_index));
  in.seekg(static_cast<std::streamoff>(table.size + found->second.offset));
  std::string text = read_bytes(in, found->second.size + kSha256Digits, file);
  const std::string digest = text.substr(found->second.size);
  text.resize(found->second.size);
  if (sha256_hex(text) != digest)
    throw FileError(file.string() + " is damaged at job " + std::to_string(batch_index));
  return text;
}

}  // namespace

std::string encode_jobs(const BatchHeader& header, const BatchJobs& jobs) {
  ByteWriter writer;
  write_header(writer, header);
  writer.number(static_cast<std::uint32_t>(jobs.size()));
  std::string texts;
  for (const auto& [batch_index, parameters] : jobs) {
    writer.number(batch_index);
    writer.number(static_cast<std::uint64_t>(texts.size()));
    writer.number(static_cast<std::uint32_t>(parameters.size()));
    texts += parameters + sha256_hex(parameters);
  }
  const std::string head = seal(kJobsMagic, writer.bytes());
  ByteWriter size;
  size.number(static_cast<std::uint32_t>(head.size()));
  return size.bytes() + head + texts;
}

BatchJobs read_jobs(const std::filesystem::path& file, const std::vector<BatchIndex>& wanted,
                    BatchHeader& header) {
  std::ifstream in(file, std::ios::binary);
  if (!in) throw FileError("cannot read " + file.string());
  const JobTable table = read_job_table(in, file, header);
  BatchJobs jobs;
  for (const BatchIndex batch_index : wanted)
    jobs.emplace(batch_index, read_job_text(in, file, table, batch_index));
  return jobs;
}

std::string encode_results(const ResultFile& file) {
  ByteWriter head;
  head.text(file.batch);
  write_provenance(head, file.provenance);
  head.number(static_cast<std::uint32_t>(file.results.size()));
  std::string payload = head.bytes();
  for (const BatchResult& result : file.results) {
    ByteWriter batch_index;
    batch_index.number(result.batch_index);
    payload += batch_index.bytes();
    write_block(payload, encode_record(result.record));
    write_block(payload, result.record.metrics.dump());
    write_block(payload, result.packed_trajectory);
  }
  return seal(kResultsMagic, payload);
}

ResultFile decode_results(std::string_view bytes) {
  try {
    return decode_payload(unseal(kResultsMagic, bytes));
  } catch (const DamagedTrajectory& error) {
    throw FileError(std::string("damaged: ") + error.what());
  } catch (const nlohmann::json::exception&) {
    throw FileError("damaged: its metrics are no JSON");
  }
}

}  // namespace jobs::cluster
