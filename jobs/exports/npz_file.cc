// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cerrno>
#include <span>
#include <utility>

#include <minizip/zip.h>
#include <zlib.h>

#include "jobs/exports/trajectory_file.h"
#include "jobs/trajectories/npz.h"

namespace jobs {
namespace {

constexpr std::size_t kSamplesOfPiece = 16 * 1024;

class NpzFile final : public TrajectoryFile {
 public:
  NpzFile(std::filesystem::path path, const ExportedSweep& sweep) : path_(std::move(path)) {
    archive_ = zipOpen64(path_.c_str(), APPEND_STATUS_CREATE);
    if (archive_ == nullptr) throw_unwritten(path_, errno);
    add_texts("sweep_id", {sweep.id});
    add_texts("sweep_name", {sweep.name});
    add_texts("program", {sweep.program});
    for (const TableColumn& column : sweep.results) {
      if (column.is_text) add_texts("results/" + column.name, column.texts);
      else add_numbers("results/" + column.name, column.numbers);
    }
  }
  ~NpzFile() override {
    if (archive_ != nullptr) zipClose(archive_, nullptr);
  }
  NpzFile(const NpzFile&) = delete;
  NpzFile& operator=(const NpzFile&) = delete;

  void add(const std::string& job, const std::string& job_id, const TrajectoryView& view) override {
    const std::string folder = "trajectories/" + job + "/";
    add_texts(folder + "job_id", {job_id});
    for (std::size_t c = 0; c < view.channels().size(); ++c) {
      begin_array(folder + view.channels()[c].key, "<f8", view.samples());
      const auto column = view.read_column(c);
      do {
        values_.clear();
        column->append_next(kSamplesOfPiece, values_);
        write_doubles(values_);
      } while (values_.size() == kSamplesOfPiece);
      end_array();
    }
  }

  void close() override { check(zipClose(std::exchange(archive_, nullptr), nullptr)); }

 private:
  void check(int result) const {
    if (result != ZIP_OK) throw_unwritten(path_, errno);
  }

  void begin_array(const std::string& name, const std::string& type, std::size_t size) {
    constexpr int kZip64 = 1;                               // its size is not known yet
    constexpr uLong kFirstDay = (1U << 21U) | (1U << 16U);  // 1980-01-01: no clock in the bytes
    zip_fileinfo info{};
    info.dosDate = kFirstDay;
    check(zipOpenNewFileInZip64(archive_, (name + ".npy").c_str(), &info, nullptr, 0, nullptr, 0, nullptr,
                                Z_DEFLATED, Z_BEST_SPEED, kZip64));
    const std::string head = npy_head(type, size);
    write(head.data(), head.size());
  }

  void end_array() { check(zipCloseFileInZip(archive_)); }

  void write(const void* bytes, std::size_t size) {
    if (size == 0) return;  // of nothing, which a null pointer may be, zlib begins the checksum anew
    check(zipWriteInFileInZip(archive_, bytes, static_cast<unsigned>(size)));
  }

  void write_doubles(std::span<const double> values) { write(values.data(), values.size_bytes()); }

  void add_numbers(const std::string& name, const std::vector<double>& numbers) {
    begin_array(name, "<f8", numbers.size());
    write_doubles(numbers);
    end_array();
  }

  void add_texts(const std::string& name, const std::vector<std::string>& texts) {
    std::vector<std::vector<char32_t>> cells;
    std::size_t longest = 1;
    for (const std::string& text : texts) {
      cells.push_back(code_points_of(text));
      longest = std::max(longest, cells.back().size());
    }
    begin_array(name, "<U" + std::to_string(longest), texts.size());
    for (std::vector<char32_t>& cell : cells) {
      cell.resize(longest);
      write(cell.data(), cell.size() * sizeof(char32_t));
    }
    end_array();
  }

  std::filesystem::path path_;
  zipFile archive_ = nullptr;
  std::vector<double> values_;
};

}  // namespace

std::unique_ptr<TrajectoryFile> create_npz_file(const std::filesystem::path& file,
                                                const ExportedSweep& sweep) {
  return std::make_unique<NpzFile>(file, sweep);
}

}  // namespace jobs
