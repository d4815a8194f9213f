// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <cstdint>
#include <fstream>
#include <map>
#include <set>
#include <utility>

#include <matio.h>
#include <zlib.h>

#include "jobs/exports/trajectory_file.h"
#include "jobs/measurements/channel_unit.h"

namespace jobs {
namespace {

struct FreeVariable {
  void operator()(matvar_t* variable) const { Mat_VarFree(variable); }
};
using MatVariable = std::unique_ptr<matvar_t, FreeVariable>;

MatVariable checked(matvar_t* variable) {
  if (variable == nullptr) throw std::bad_alloc();
  return MatVariable(variable);
}

/// Name of a variable or a field: letters, digits and '_' after a letter, 63 at most.
std::string matlab_name(const std::string& name) {
  constexpr std::size_t kLongest = 63;
  std::string taken = name.substr(0, kLongest);
  for (char& c : taken)
    if (std::isalnum(static_cast<unsigned char>(c)) == 0) c = '_';
  if (taken.empty() || std::isalpha(static_cast<unsigned char>(taken[0])) == 0) taken = "x" + taken;
  return taken.substr(0, kLongest);
}

/// In UTF-16, as MATLAB keeps texts: the library miscounts the bytes of UTF-8.
MatVariable make_text(const std::string& text) {
  std::vector<std::uint16_t> units;
  for (const char32_t point : code_points_of(text)) {
    if (point < 0x10000) {
      units.push_back(static_cast<std::uint16_t>(point));
    } else {
      units.push_back(static_cast<std::uint16_t>(0xd800U + ((point - 0x10000U) >> 10U)));
      units.push_back(static_cast<std::uint16_t>(0xdc00U + ((point - 0x10000U) & 0x3ffU)));
    }
  }
  std::array<std::size_t, 2> dimensions{units.empty() ? 0U : 1U, units.size()};
  return checked(Mat_VarCreate(nullptr, MAT_C_CHAR, MAT_T_UINT16, 2, dimensions.data(), units.data(), 0));
}

MatVariable make_numbers(std::vector<double>& values) {
  std::array<std::size_t, 2> dimensions{values.size(), 1};
  return checked(Mat_VarCreate(nullptr, MAT_C_DOUBLE, MAT_T_DOUBLE, 2, dimensions.data(), values.data(), 0));
}

MatVariable make_cells(const std::vector<std::string>& texts) {
  std::array<std::size_t, 2> dimensions{texts.size(), 1};
  MatVariable cells =
      checked(Mat_VarCreate(nullptr, MAT_C_CELL, MAT_T_CELL, 2, dimensions.data(), nullptr, 0));
  for (std::size_t k = 0; k < texts.size(); ++k)
    Mat_VarSetCell(cells.get(), static_cast<int>(k), make_text(texts[k]).release());
  return cells;
}

/// Fields of a struct, with names that differ.
class MatStruct {
 public:
  /// @returns the name that the field has
  std::string add(const std::string& name, MatVariable value) {
    std::string taken = matlab_name(name);
    for (int k = 2; !names_.insert(taken).second; ++k) {
      const std::string end = "_" + std::to_string(k);
      taken = matlab_name(name).substr(0, 63 - end.size()) + end;
    }
    fields_.emplace_back(taken, std::move(value));
    return taken;
  }

  [[nodiscard]] MatVariable make(const std::string& name) {
    std::vector<const char*> names;
    for (const auto& field : fields_) names.push_back(field.first.c_str());
    std::array<std::size_t, 2> dimensions{1, 1};
    MatVariable made = checked(Mat_VarCreateStruct(name.c_str(), 2, dimensions.data(), names.data(),
                                                   static_cast<unsigned>(names.size())));
    for (auto& [field, value] : fields_)
      Mat_VarSetStructFieldByName(made.get(), field.c_str(), 0, value.release());
    return made;
  }

 private:
  std::set<std::string> names_;
  std::vector<std::pair<std::string, MatVariable>> fields_;
};

/// @returns whether bytes are one stream of zlib from its beginning to its checksum
bool is_whole_stream(std::string& packed) {
  z_stream stream{};
  if (inflateInit(&stream) != Z_OK) throw std::bad_alloc();
  stream.next_in = reinterpret_cast<Bytef*>(packed.data());
  stream.avail_in = static_cast<uInt>(packed.size());
  std::array<Bytef, 65536> scratch{};
  int result = Z_OK;
  while (result == Z_OK) {
    stream.next_out = scratch.data();
    stream.avail_out = scratch.size();
    result = inflate(&stream, Z_NO_FLUSH);
  }
  inflateEnd(&stream);
  return result == Z_STREAM_END && stream.avail_in == 0;
}

class MatFile final : public TrajectoryFile {
 public:
  MatFile(std::filesystem::path path, const ExportedSweep& sweep) : path_(std::move(path)) {
    file_ = Mat_CreateVer(path_.c_str(), ("MATLAB 5.0 MAT-file, " + sweep.program).c_str(), MAT_FT_MAT5);
    if (file_ == nullptr) throw_unwritten(path_, errno);
    MatStruct info;
    info.add("id", make_text(sweep.id));
    info.add("name", make_text(sweep.name));
    info.add("program", make_text(sweep.program));
    write(info.make("sweep"));
    MatStruct results;
    for (TableColumn column : sweep.results) {
      const std::string field =
          results.add(column.name, column.is_text ? make_cells(column.texts) : make_numbers(column.numbers));
      if (!column.unit.empty()) units_.insert_or_assign(field, column.unit);
    }
    write(results.make("results"));
  }
  ~MatFile() override {
    if (file_ != nullptr) Mat_Close(file_);
  }
  MatFile(const MatFile&) = delete;
  MatFile& operator=(const MatFile&) = delete;

  void add(const std::string& job, const std::string& job_id, const TrajectoryView& view) override {
    MatStruct columns;
    columns.add("job_id", make_text(job_id));
    for (std::size_t c = 0; c < view.channels().size(); ++c) {
      const std::string& name = view.channels()[c].key;
      values_.clear();
      view.read_column(c)->append_next(view.samples(), values_);
      const std::string field = columns.add(name, make_numbers(values_));
      if (const auto unit = find_unit(name)) units_.insert_or_assign(field, *unit);
    }
    write(columns.make(job));
  }

  void close() override {
    MatStruct units;
    for (const auto& [name, unit] : units_) units.add(name, make_text(unit));
    write(units.make("units"));
    errno = 0;
    const bool is_closed = Mat_Close(std::exchange(file_, nullptr)) == 0;
    if (!is_closed || !is_complete()) throw_unwritten(path_, errno);
  }

 private:
  void write(const MatVariable& variable) {
    if (Mat_VarWrite(file_, variable.get(), MAT_COMPRESSION_ZLIB) != 0) throw_unwritten(path_, errno);
    ++written_;
  }

  /// @returns whether the file has every variable whole: the library does not tell of bytes that the disk did
  /// not take, and then may write the size of those that it took. Each variable is a tag, type and size, and
  /// a stream of zlib, which ends with a checksum.
  [[nodiscard]] bool is_complete() const {
    constexpr std::streamoff kHeadBytes = 128;
    const auto size = static_cast<std::uint64_t>(std::filesystem::file_size(path_));
    std::ifstream file(path_, std::ios::binary);
    file.seekg(kHeadBytes);
    std::string packed;
    std::size_t found = 0;
    std::array<std::uint32_t, 2> tag{};
    for (; file.read(reinterpret_cast<char*>(tag.data()), sizeof tag); ++found) {
      if (tag[1] > size) return false;
      packed.resize(tag[1]);
      if (!file.read(packed.data(), static_cast<std::streamsize>(packed.size())) || !is_whole_stream(packed))
        return false;
    }
    return file.gcount() == 0 && found == written_;
  }

  std::filesystem::path path_;
  mat_t* file_ = nullptr;
  std::size_t written_ = 0;                   ///< variables
  std::map<std::string, std::string> units_;  ///< of all columns, by their fields
  std::vector<double> values_;
};

}  // namespace

std::unique_ptr<TrajectoryFile> create_mat_file(const std::filesystem::path& file,
                                                const ExportedSweep& sweep) {
  return std::make_unique<MatFile>(file, sweep);
}

}  // namespace jobs
