// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cerrno>
#include <mutex>
#include <utility>

#include <hdf5.h>

#include "jobs/exports/trajectory_file.h"
#include "jobs/measurements/channel_unit.h"

namespace jobs {
namespace {

constexpr hsize_t kSamplesOfChunk = 16 * 1024;
constexpr unsigned kDeflateLevel = 1;

/// Guards the library, which is not for several threads, from one object of Hdf5File to the next.
std::mutex& library_mutex() {
  static std::mutex mutex;
  return mutex;
}

/// Object of the library, which is closed at the end.
class Hdf5Object {
 public:
  using Close = herr_t (*)(hid_t);
  Hdf5Object(hid_t id, Close closer) : id_(id), closer_(closer) {}
  ~Hdf5Object() {
    if (id_ >= 0) closer_(id_);
  }
  Hdf5Object(Hdf5Object&& other) noexcept : id_(std::exchange(other.id_, -1)), closer_(other.closer_) {}
  Hdf5Object(const Hdf5Object&) = delete;
  Hdf5Object& operator=(const Hdf5Object&) = delete;
  Hdf5Object& operator=(Hdf5Object&&) = delete;

  [[nodiscard]] hid_t id() const { return id_; }
  /// @returns whether what the library still held has been written
  [[nodiscard]] bool close() { return closer_(std::exchange(id_, -1)) >= 0; }

 private:
  hid_t id_;
  Close closer_;
};

class Hdf5File final : public TrajectoryFile {
 public:
  Hdf5File(const std::filesystem::path& path, const ExportedSweep& sweep)
      : lock_(library_mutex()),
        path_(path),
        file_(check(create(path)), H5Fclose),
        trajectories_(make_group(file_.id(), "trajectories")) {
    add_attribute(file_.id(), "sweep_id", sweep.id);
    add_attribute(file_.id(), "sweep_name", sweep.name);
    add_attribute(file_.id(), "program", sweep.program);
    const Hdf5Object results = make_group(file_.id(), "results");
    for (const TableColumn& column : sweep.results) {
      if (column.is_text) add_texts(results.id(), column);
      else add_numbers(results.id(), column);
    }
  }

  void add(const std::string& job, const std::string& job_id, const TrajectoryView& view) override {
    const Hdf5Object group = make_group(trajectories_.id(), job);
    add_attribute(group.id(), "job_id", job_id);
    for (std::size_t c = 0; c < view.channels().size(); ++c) add_channel(group.id(), view, c);
  }

  void close() override {
    check(trajectories_.close() ? 0 : -1);
    check(file_.close() ? 0 : -1);
  }

 private:
  static hid_t create(const std::filesystem::path& path) {
    // The library's work at the end of the process crashes where a file could not be written.
    [[maybe_unused]] static const herr_t no_work_at_exit = H5dont_atexit();
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);  // errors are told by exceptions, not on the terminal
    return H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
  }

  hid_t check(hid_t result) const {
    if (result < 0) throw_unwritten(path_, errno);
    return result;
  }

  [[nodiscard]] Hdf5Object make_group(hid_t parent, const std::string& name) const {
    return {check(H5Gcreate2(parent, escaped(name).c_str(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT)),
            H5Gclose};
  }

  /// Name of one object: '/' would lead into a group.
  static std::string escaped(std::string name) {
    std::ranges::replace(name, '/', '.');
    return name;
  }

  /// @param text  that all are in, one after the other: Octave reads no type of UTF-8
  [[nodiscard]] Hdf5Object make_text_type(std::size_t size, std::string_view text) const {
    const bool is_ascii =
        std::ranges::all_of(text, [](char c) { return static_cast<unsigned char>(c) < 128; });
    Hdf5Object type(check(H5Tcopy(H5T_C_S1)), H5Tclose);
    check(H5Tset_size(type.id(), std::max<std::size_t>(size, 1)));
    check(H5Tset_strpad(type.id(), H5T_STR_NULLPAD));
    check(H5Tset_cset(type.id(), is_ascii ? H5T_CSET_ASCII : H5T_CSET_UTF8));
    return type;
  }

  void add_attribute(hid_t object, const char* name, const std::string& text) const {
    const Hdf5Object type = make_text_type(text.size(), text);
    const Hdf5Object scalar(check(H5Screate(H5S_SCALAR)), H5Sclose);
    const Hdf5Object attribute(
        check(H5Acreate2(object, name, type.id(), scalar.id(), H5P_DEFAULT, H5P_DEFAULT)), H5Aclose);
    check(H5Awrite(attribute.id(), type.id(), text.c_str()));
  }

  /// @param chunk  number of values that are stored together and deflated; 0: all, as they are
  [[nodiscard]] Hdf5Object make_dataset(hid_t group, const std::string& name, hid_t type, hsize_t size,
                                        hsize_t chunk) const {
    const Hdf5Object space(check(H5Screate_simple(1, &size, nullptr)), H5Sclose);
    const Hdf5Object creation(check(H5Pcreate(H5P_DATASET_CREATE)), H5Pclose);
    check(H5Pset_obj_track_times(creation.id(), false));  // no clock in the bytes
    if (chunk > 0) {
      check(H5Pset_chunk(creation.id(), 1, &chunk));
      check(H5Pset_shuffle(creation.id()));
      check(H5Pset_deflate(creation.id(), kDeflateLevel));
    }
    return {check(H5Dcreate2(group, escaped(name).c_str(), type, space.id(), H5P_DEFAULT, creation.id(),
                             H5P_DEFAULT)),
            H5Dclose};
  }

  void add_numbers(hid_t group, const TableColumn& column) const {
    const Hdf5Object dataset = make_dataset(group, column.name, H5T_NATIVE_DOUBLE, column.numbers.size(), 0);
    check(H5Dwrite(dataset.id(), H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, column.numbers.data()));
    if (!column.unit.empty()) add_attribute(dataset.id(), "unit", column.unit);
  }

  void add_texts(hid_t group, const TableColumn& column) const {
    std::size_t longest = 1;
    for (const std::string& text : column.texts) longest = std::max(longest, text.size());
    std::string cells;
    for (std::string text : column.texts) {
      text.resize(longest);
      cells += text;
    }
    const Hdf5Object type = make_text_type(longest, cells);
    const Hdf5Object dataset = make_dataset(group, column.name, type.id(), column.texts.size(), 0);
    check(H5Dwrite(dataset.id(), type.id(), H5S_ALL, H5S_ALL, H5P_DEFAULT, cells.data()));
  }

  void add_channel(hid_t group, const TrajectoryView& view, std::size_t channel) {
    const std::string& name = view.channels()[channel].key;
    const hsize_t samples = view.samples();
    const Hdf5Object dataset =
        make_dataset(group, name, H5T_NATIVE_DOUBLE, samples, std::min(samples, kSamplesOfChunk));
    if (const auto unit = find_unit(name)) add_attribute(dataset.id(), "unit", std::string(*unit));
    const Hdf5Object space(check(H5Dget_space(dataset.id())), H5Sclose);
    const auto column = view.read_column(channel);
    for (hsize_t from = 0; from < samples; from += kSamplesOfChunk) {
      values_.clear();
      column->append_next(kSamplesOfChunk, values_);
      write_values(dataset.id(), space.id(), from);
    }
  }

  /// Writes values_ into a dataset. @param space  of the dataset  @param from  place of the first value
  void write_values(hid_t dataset, hid_t space, hsize_t from) const {
    const hsize_t count = values_.size();
    check(H5Sselect_hyperslab(space, H5S_SELECT_SET, &from, nullptr, &count, nullptr));
    const Hdf5Object block(check(H5Screate_simple(1, &count, nullptr)), H5Sclose);
    check(H5Dwrite(dataset, H5T_NATIVE_DOUBLE, block.id(), space, H5P_DEFAULT, values_.data()));
  }

  const std::scoped_lock<std::mutex> lock_;
  const std::filesystem::path path_;
  Hdf5Object file_;
  Hdf5Object trajectories_;
  std::vector<double> values_;
};

}  // namespace

std::unique_ptr<TrajectoryFile> create_hdf5_file(const std::filesystem::path& file,
                                                 const ExportedSweep& sweep) {
  return std::make_unique<Hdf5File>(file, sweep);
}

}  // namespace jobs
