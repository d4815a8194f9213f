// SPDX-License-Identifier: Apache-2.0
// Blobs of trajectories: those of a damaged store, and those whose checksums are right and whose content is
// not.

#include <fuzzer/FuzzedDataProvider.h>

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "jobs/trajectories/byte_codec.h"
#include "jobs/trajectories/trajectory_codec.h"
#include "tests/fuzz/expect.h"

namespace {

/// Good frames around whatever the fuzzer wants to have in them.
std::string make_blob(FuzzedDataProvider& from) {
  jobs::Compressor compressor;
  jobs::ByteWriter header;
  std::string frames;
  const auto version = from.ConsumeIntegral<std::uint8_t>();
  header.number(from.ConsumeBool() ? std::uint64_t{from.ConsumeIntegral<std::uint8_t>()}
                                   : from.ConsumeIntegral<std::uint64_t>());
  const auto channels = from.ConsumeIntegralInRange<std::uint32_t>(0, 8);
  header.number(from.ConsumeProbability<float>() < 0.9F ? channels : from.ConsumeIntegral<std::uint32_t>());
  for (std::uint32_t i = 0; i < channels; ++i) {
    header.text(from.ConsumeRandomLengthString(16));
    header.text("");
    header.number(from.ConsumeIntegral<std::uint8_t>());
    header.number(from.ConsumeIntegralInRange<std::uint8_t>(0, 6));
    if (from.ConsumeBool()) {
      header.number(from.ConsumeIntegral<std::uint32_t>());  // a copy, or a wrong size
    } else {
      header.number(static_cast<std::uint32_t>(
          compressor.append_frame(from.ConsumeRandomLengthString(512), jobs::Effort::kFull, frames)));
    }
  }
  std::string packed;
  compressor.append_frame(header.bytes(), jobs::Effort::kFull, packed);
  jobs::ByteWriter blob;
  blob.number(version);
  blob.number(static_cast<std::uint32_t>(packed.size()));
  return blob.bytes() + packed + frames;
}

void check_blob(const std::string& blob) {
  const auto bytes = std::as_bytes(std::span(blob));
  const engine::Trajectory run = jobs::decode_trajectory(bytes, {});
  fuzz::expect(run.channels.size() == run.columns.size(), "each channel has its column");
  fuzz::expect(jobs::decode_channels(bytes).size() == run.channels.size(),
               "a blob says how many channels it has");
  jobs::check_is_table(run);
  const std::string packed = jobs::encode_trajectory(run);
  const engine::Trajectory back = jobs::decode_trajectory(std::as_bytes(std::span(packed)), {});
  fuzz::expect(jobs::encode_trajectory(back) == packed, "what is packed again is the same");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    if (size > 0 && data[0] % 2 == 0) {
      check_blob(std::string(reinterpret_cast<const char*>(data) + 1, size - 1));
    } else {
      FuzzedDataProvider from(data, size);
      check_blob(make_blob(from));
    }
  } catch (const jobs::DamagedTrajectory&) {
    return 0;
  }
  return 0;
}
