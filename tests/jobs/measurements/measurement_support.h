// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <zlib.h>

#include "jobs/measurements/measurement.h"

namespace jobs_tests {

inline std::string little_endian(std::uint64_t value, std::size_t bytes) {
  std::string text;
  for (std::size_t i = 0; i < bytes; ++i) text += static_cast<char>((value >> (8 * i)) & 0xffU);
  return text;
}

/// File of NumPy's format 1.0, as numpy.save writes it.
template <typename Number>
std::string npy_of(const std::vector<Number>& values, const std::string& type, const std::string& shape = "",
                   const std::string& fortran = "False") {
  const std::string length = shape.empty() ? "(" + std::to_string(values.size()) + ",)" : shape;
  std::string head = "{'descr': '" + type + "', 'fortran_order': " + fortran + ", 'shape': " + length + ", }";
  while ((10 + head.size() + 1) % 64 != 0) head += ' ';
  head += '\n';
  return "\x93NUMPY\x01" + std::string(1, '\0') + little_endian(head.size(), 2) + head +
         std::string(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(Number));
}

enum class Packing { kStored, kDeflated };

inline std::string deflated(const std::string& bytes) {
  z_stream stream{};
  deflateInit2(&stream, Z_BEST_COMPRESSION, Z_DEFLATED, -MAX_WBITS, 8, Z_DEFAULT_STRATEGY);
  std::string packed(deflateBound(&stream, bytes.size()), '\0');
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
  stream.avail_in = static_cast<uInt>(bytes.size());
  stream.next_out = reinterpret_cast<Bytef*>(packed.data());
  stream.avail_out = static_cast<uInt>(packed.size());
  deflate(&stream, Z_FINISH);
  packed.resize(stream.total_out);
  deflateEnd(&stream);
  return packed;
}

/// Archive as zipfile of Python writes it for numpy.savez: local headers have ZIP64 fields and no sizes.
inline std::string zip_of(const std::vector<std::pair<std::string, std::string>>& files, Packing packing) {
  std::string archive;
  std::string directory;
  for (const auto& [name, bytes] : files) {
    const std::string packed = packing == Packing::kDeflated ? deflated(bytes) : bytes;
    const std::string method = little_endian(packing == Packing::kDeflated ? 8 : 0, 2);
    const auto crc = crc32_z(0, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size());
    const std::string offset = little_endian(archive.size(), 4);
    const std::string zip64 = little_endian(1, 2) + little_endian(16, 2) + little_endian(bytes.size(), 8) +
                              little_endian(packed.size(), 8);
    archive += "PK\x03\x04" + little_endian(45, 2) + little_endian(0, 2) + method + little_endian(0, 4) +
               little_endian(crc, 4) + little_endian(0xffffffff, 4) + little_endian(0xffffffff, 4) +
               little_endian(name.size(), 2) + little_endian(zip64.size(), 2) + name + zip64 + packed;
    directory += "PK\x01\x02" + little_endian(45, 2) + little_endian(45, 2) + little_endian(0, 2) + method +
                 little_endian(0, 4) + little_endian(crc, 4) + little_endian(packed.size(), 4) +
                 little_endian(bytes.size(), 4) + little_endian(name.size(), 2) + little_endian(0, 8) +
                 little_endian(0, 4) + offset + name;
  }
  return archive + directory + "PK\x05\x06" + little_endian(0, 4) + little_endian(files.size(), 2) +
         little_endian(files.size(), 2) + little_endian(directory.size(), 4) +
         little_endian(archive.size(), 4) + little_endian(0, 2);
}

/// Measurement that each of the files of the tests holds.
inline constexpr const char* kMeasuredCsv =
    "time_s,slider_acceleration_m_s2,crank_torque_n_m\n0,1.5,-2\n0.001,-1.5,1e-3\n0.0025,0,4\n";

inline std::string measured_npz(Packing packing) {
  return zip_of({{"time_s.npy", npy_of<double>({0, 0.001, 0.0025}, "<f8")},
                 {"slider_acceleration_m_s2.npy", npy_of<float>({1.5F, -1.5F, 0.0F}, "<f4")},
                 {"crank_torque_n_m.npy", npy_of<double>({-2, 1e-3, 4}, "<f8")}},
                packing);
}

inline constexpr const char* kMeasuredJson = R"({"name": "bench", "channels": [
  {"name": "slider_acceleration_m_s2", "column": "acc", "sign": -1, "gain": 2, "offset": 0.5, "delay_s": 1e-4,
   "low_pass_hz": 500},
  {"name": "crank_torque_n_m"}],
  "runs": [{"parameters": {"clearance_mm": 0.25, "crank_velocity_rad_s": 15}, "time_s": [0, 0.001, 0.0025],
            "values": {"slider_acceleration_m_s2": [1.5, -1.5, 0], "crank_torque_n_m": [-2, 1e-3, 4]}},
           {"time_s": [1, 2], "values": {"slider_acceleration_m_s2": [3, 4], "crank_torque_n_m": [0, 0]}}]})";

}  // namespace jobs_tests
