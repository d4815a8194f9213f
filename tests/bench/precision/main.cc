// SPDX-License-Identifier: Apache-2.0
// Work and precision of whole jobs: every integrator over its tolerances or steps, against a tight run of
// each case.
//   bench_precision FOLDER [FROM [TO]]
// Writes precision.csv and precision.svg to the folder. FROM, TO: only some of the cases, counted from 0.

#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "tests/bench/precision/summary.h"

namespace bench {
namespace {

void write_file(const std::filesystem::path& path, const std::string& text) {
  std::ofstream file(path, std::ios::binary);
  file << text;
  file.close();
  if (!file) throw std::runtime_error("cannot write " + path.string());
}

void run(const std::filesystem::path& folder, std::size_t from, std::size_t to) {
  const std::vector<PrecisionCase> cases = precision_cases();
  const std::vector<Setting> settings = precision_settings();
  std::vector<Measurement> measurements;
  for (std::size_t i = from; i < std::min(to, cases.size()); ++i) {
    std::cerr << "precision: " << i << ", " << cases[i].name << '\n';
    const double reference = find_reference_peak(cases[i]);
    for (const Setting& setting : settings) measurements.push_back(measure(cases[i], setting, reference));
    write_file(folder / "precision.csv", write_csv(measurements));  // as far as it has come
  }
  std::cout << '\n';
  print_summary(std::cout, measurements);
  write_file(folder / "precision.svg", draw_figure(measurements));
}

}  // namespace
}  // namespace bench

int main(int argc, char** argv) {
  try {
    if (argc < 2 || argc > 4) {
      std::cerr << "usage: bench_precision FOLDER [FROM [TO]]\n";
      return 2;
    }
    const std::size_t from = argc > 2 ? std::stoul(argv[2]) : 0;
    const std::size_t to = argc > 3 ? std::stoul(argv[3]) : std::numeric_limits<std::size_t>::max();
    bench::run(argv[1], from, to);
  } catch (const std::exception& error) {
    std::cerr << "bench_precision: " << error.what() << '\n';
    return EXIT_FAILURE;
  }
}
