// SPDX-License-Identifier: Apache-2.0
// Measurements from CSV and NPZ: what is read, and the text of every refusal.

#include <array>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "jobs/measurements/read_measurement_csv.h"
#include "jobs/measurements/read_measurement_npz.h"
#include "tests/jobs/measurements/measurement_support.h"
#include "tests/jobs/request_support.h"

namespace jobs_tests {
namespace {

using jobs::ColumnQuery;
using jobs::Measurement;
using testing::HasSubstr;

/// Faults of a file as lines "pointer detail".
template <typename Read>
std::string refusal_of_file(const Read& read) {
  std::string text;
  for (const jobs::Fault& fault : faults_of(read))
    text += (text.empty() ? "" : "\n") + fault.pointer + (fault.pointer.empty() ? "" : " ") + fault.detail;
  return text;
}

std::string csv_refusal(const std::string& text, const ColumnQuery& query = {}) {
  return refusal_of_file([&] { static_cast<void>(jobs::read_measurement_csv(text, query)); });
}

std::string npz_refusal(const std::string& archive, const ColumnQuery& query = {}) {
  return refusal_of_file([&] { static_cast<void>(jobs::read_measurement_npz(archive, query)); });
}

void expect_measured(const Measurement& measured) {
  ASSERT_EQ(measured.channels.size(), 2U);
  EXPECT_EQ(measured.channels[0].name, "slider_acceleration_m_s2");
  EXPECT_EQ(measured.channels[1].name, "crank_torque_n_m");
  ASSERT_EQ(measured.runs.size(), 1U);
  EXPECT_EQ(measured.runs[0].time_s, (std::vector<double>{0, 0.001, 0.0025}));
  ASSERT_EQ(measured.runs[0].columns.size(), 2U);
  EXPECT_EQ(measured.runs[0].columns[0], (std::vector<double>{1.5, -1.5, 0}));
  EXPECT_EQ(measured.runs[0].columns[1], (std::vector<double>{-2, 1e-3, 4}));
}

TEST(MeasurementCsv, RefusesMoreColumnsThanAnyRigHas) {
  std::string header = "time_s";
  for (int k = 0; k < 2000; ++k) header += ",c" + std::to_string(k) + "_m";
  EXPECT_THAT(csv_refusal(header + "\n"), HasSubstr("has 2001 columns; at most 1000"));
}

TEST(MeasurementCsv, RefusesTimesThatNoRateDescribes) {
  EXPECT_THAT(csv_refusal("time_s,x_m\n-1e308,1\n1e308,2\n"), HasSubstr("too far from or too near to"));
  EXPECT_THAT(csv_refusal("time_s,x_m\n0,1\n5e-324,2\n"), HasSubstr("too far from or too near to"));
}

TEST(MeasurementCsv, ReadsTimeAndChannels) {
  const Measurement measured = jobs::read_measurement_csv(kMeasuredCsv, {.name = "bench"});
  EXPECT_EQ(measured.name, "bench");
  expect_measured(measured);
}

TEST(MeasurementCsv, ReadsWhatOtherProgramsWrite) {
  // A byte order mark, line ends of Windows, quoted names, blanks, signs, an empty line at the end.
  expect_measured(jobs::read_measurement_csv(
      "\xEF\xBB\xBF\"time_s\", slider_acceleration_m_s2 ,crank_torque_n_m\r\n+0,+1.5,-2\r\n"
      " 1e-3 ,\"-1.5\",0.001\r\n0.0025,1e-400,4.0\r\n\r\n",
      {}));
  expect_measured(jobs::read_measurement_csv(
      "slider_acceleration_m_s2,crank_torque_n_m,t_s\n1.5,-2,0\n-1.5,1e-3,0.001\n0,4,0.0025", {}));
}

TEST(MeasurementCsv, ChoosesAndRenamesColumns) {
  const Measurement measured = jobs::read_measurement_csv(
      "note,acc,clock,torque\nstart,1.5,0,-2\n,-1.5,0.001,1e-3\nend,0,0.0025,4\n",
      {.time = "clock", .channels = {"acc:slider_acceleration_m_s2", "torque:crank_torque_n_m"}});
  expect_measured(measured);
  EXPECT_EQ(measured.channels[0].column, "acc");
  const std::string same = "time_s,force_n,other\n0,1,x\n1,2,y\n";
  EXPECT_EQ(jobs::read_measurement_csv(same, {.channels = {"force_n"}}).runs[0].columns[0],
            (std::vector<double>{1, 2}));
}

TEST(MeasurementCsv, HasWhatIsKnownOfSensorsAndRun) {
  using nlohmann::ordered_json;
  const jobs::ColumnQuery query{
      .sensors = ordered_json::parse(R"({"crank_torque_n_m": {"sign": -1, "gain": 2, "low_pass_hz": 900}})"),
      .parameters = ordered_json::parse(R"({"crank_velocity_rad_s": 10})")};
  const Measurement measured = jobs::read_measurement_csv(kMeasuredCsv, query);
  EXPECT_EQ(measured.channels[0].sign, 1.0);
  EXPECT_EQ(measured.channels[1].sign, -1.0);
  EXPECT_EQ(measured.channels[1].gain, 2.0);
  EXPECT_EQ(measured.channels[1].low_pass_hz, 900.0);
  EXPECT_EQ(measured.runs[0].parameters, nlohmann::json({{"crank_velocity_rad_s", 10}}));
  for (const auto& [sensors, parameters, pointer] :
       std::vector<std::array<std::string, 3>>{{R"({"x_m": {}})", "{}", "/sensors/x_m"},
                                               {R"({"crank_torque_n_m": 1})", "{}", "/sensors/crank_torque_n_m"},
                                               {R"({"crank_torque_n_m": {"gain": 0}})", "{}",
                                                "/sensors/crank_torque_n_m/gain"},
                                               {R"({"crank_torque_n_m": {"scale": 2}})", "{}",
                                                "/sensors/crank_torque_n_m/scale"},
                                               {"{}", R"({"clearance_mm": -1})", "/parameters/clearance_mm"}}) {
    EXPECT_THAT(csv_refusal(kMeasuredCsv, {.sensors = ordered_json::parse(sensors),
                                           .parameters = ordered_json::parse(parameters)}),
                HasSubstr(pointer));
  }
}

TEST(MeasurementCsv, NamesLineAndColumnOfAFault) {
  const std::string head = "time_s,force_n\n";
  EXPECT_EQ(csv_refusal(head + "0,1\n1,\"1,5\"\n"),
            "line 3, column 2 (force_n): \"1,5\" is no number; write a decimal point");
  EXPECT_EQ(csv_refusal(head + "0,1\n1,abc\n2,0x10\n"),
            "line 3, column 2 (force_n): \"abc\" is no number\n"
            "line 4, column 2 (force_n): \"0x10\" is no number");
  EXPECT_EQ(csv_refusal(head + "0,1\n1,\n"),
            "line 3, column 2 (force_n): is empty; gaps (NaN, empty cells) are not allowed in this version");
  EXPECT_EQ(csv_refusal(head + "0,1\n1,nan\n"),
            "line 3, column 2 (force_n): \"nan\" is not finite; gaps (NaN, empty cells) are not allowed in "
            "this version");
  EXPECT_THAT(csv_refusal(head + "0,1\n1,-inf\n"), HasSubstr("\"-inf\" is not finite"));
  EXPECT_THAT(csv_refusal(head + "0,1\n1,1e999\n"), HasSubstr("\"1e999\" is not finite"));
  EXPECT_EQ(csv_refusal(head + "0,1\n1,2\n1,3\n0.5,4\n"),
            "line 4, column 1 (time_s): the time must increase; 1 s follows 1 s\n"
            "line 5, column 1 (time_s): the time must increase; 0.5 s follows 1 s");
  EXPECT_EQ(csv_refusal(head + "0,1\n1\n"), "line 3 has 1 cell, but line 1 names 2 columns");
  EXPECT_THAT(csv_refusal(head + "0,1\n\n1,2\n2,3\n"), HasSubstr("line 3 is empty"));
  EXPECT_THAT(csv_refusal(head + "0,1\n1,\"2\n2,3\n"), HasSubstr("line 3: a quotation mark is not closed"));
}

TEST(MeasurementCsv, ExplainsFilesOfOtherForms) {
  EXPECT_EQ(
      csv_refusal("time_s;force_n\n0;1,5\n1;2\n"),
      "line 1: the columns are separated by semicolons; separate them by commas, and write numbers with "
      "a decimal point");
  EXPECT_THAT(csv_refusal("time_s\tforce_n\n0\t1\n"), HasSubstr("separated by tabs"));
  EXPECT_EQ(csv_refusal("time_s,force_n\ns,N\n0,1\n1,2\n"),
            "line 2 holds no numbers; a line of units is not read: the name of a channel ends in its unit");
  EXPECT_THAT(
      csv_refusal("time_s,force_n\n0,0,1,5\n0,1,2,5\n"),
      HasSubstr("line 2 has 4 cells, but line 1 names 2 columns; write numbers with a decimal point"));
  EXPECT_EQ(csv_refusal("0,1\n1,2\n"), "line 1 holds numbers; the first line must name the columns");
  EXPECT_EQ(csv_refusal(""), "the file is empty; its first line must name the columns");
  EXPECT_EQ(csv_refusal("time_s,\n0,1\n"), "line 1, column 2 has no name");
  EXPECT_EQ(csv_refusal("time_s\n0\n1\n"), "there is no channel: the only column is the time, time_s");
  EXPECT_EQ(csv_refusal("time_s,force_n\n0,1\n"), "the file has 1 samples; at least 2 are needed");
  EXPECT_EQ(csv_refusal("time_s,force_n,force_n\n0,1,1\n1,1,1\n"),
            "line 1, column 3 (force_n): another column has the same name");
}

TEST(MeasurementCsv, AsksForNamesWithUnits) {
  EXPECT_EQ(csv_refusal("time_s,acc\n0,1\n1,2\n"),
            "line 1, column 2 (acc): the name must end in a unit, as slider_acceleration_m_s2 does; "
            "channels=acc:CHANNEL in the query gives the column the name of a channel");
  EXPECT_THAT(csv_refusal("time_s,a b_n\n0,1\n1,2\n"), HasSubstr("is no name of a channel"));
  EXPECT_EQ(csv_refusal("time_s,acc\n0,1\n1,2\n", {.channels = {"accel:force_n"}}),
            "/channels/0 there is no column \"accel\"; the file has \"time_s\", \"acc\"");
  EXPECT_EQ(csv_refusal("time_s,acc\n0,1\n1,2\n", {.channels = {"acc:force"}}),
            "/channels/0 \"force\" must end in a unit, as slider_acceleration_m_s2 does");
  EXPECT_EQ(csv_refusal("time_s,acc\n0,1\n1,2\n", {.channels = {"acc:force_n", "acc:force_n"}}),
            "/channels/1 \"force_n\" stands twice");
  EXPECT_EQ(csv_refusal("time_s,acc\n0,1\n1,2\n", {.channels = {"time_s:force_n"}}),
            "/channels/0 \"time_s\" is the time");
  EXPECT_EQ(csv_refusal("time_s,acc\n0,1\n1,2\n", {.channels = {"acc:t_s"}}),
            "/channels/0 \"t_s\" is the name of the time, not of a channel");
  EXPECT_THAT(csv_refusal(kMeasuredCsv, {.time = "clock"}), HasSubstr("/time there is no column \"clock\""));
  EXPECT_EQ(csv_refusal(kMeasuredCsv, {.name = std::string(201, 'x')}),
            "/name must be a string of at most 200 bytes");
}

TEST(MeasurementCsv, TakesATimeInSecondsOnly) {
  for (const std::string name : {"time_ms", "clock_us", "t_min", "elapsed_h", "force_n", "slider_acceleration_m_s2"}) {
    const std::string fault = "line 1, column 1 (" + name + "): the time must be in seconds, as in time_s";
    EXPECT_EQ(csv_refusal(name + ",x_m\n0,1\n1,2\n"), fault);
    EXPECT_EQ(csv_refusal(name + ",x_m\n0,1\n1,2\n", {.time = name}), "/time " + fault);
  }
  for (const std::string name : {"t", "Time (s)", "clock_s"}) EXPECT_EQ(csv_refusal(name + ",x_m\n0,1\n1,2\n"), "");
}

TEST(MeasurementCsv, AdvisesWhatTheQueryCanSay) {
  EXPECT_THAT(csv_refusal("time_s,\"a,b\"\n0,1\n1,2\n"), HasSubstr("; give the column another name"));
  EXPECT_THAT(csv_refusal("time_s," + std::string(61, 'a') + "\n0,1\n1,2\n"),
              HasSubstr("; give the column another name"));
}

TEST(MeasurementCsv, ShortensLongNamesBetweenCharacters) {
  const std::string name = std::string(59, 'a') + "\u00b5" + std::string(100'000, 'b') + "_m";
  EXPECT_EQ(csv_refusal("time_s," + name + "\n0,x\n1,2\n", {.channels = {name + ":x_m"}}),
            "line 2, column 2 (" + std::string(59, 'a') + "...): \"x\" is no number");
}

TEST(MeasurementCsv, EndsWithTheFirstFaultsOfMany) {
  std::string text = "time_s,force_n\n";
  for (int k = 0; k < 1000; ++k) text += std::to_string(k) + ",x\n";
  EXPECT_EQ(faults_of([&] { static_cast<void>(jobs::read_measurement_csv(text, {})); }).size(), 20U);
}

TEST(MeasurementNpz, ReadsStoredAndDeflatedArrays) {
  for (const Packing packing : {Packing::kStored, Packing::kDeflated})
    expect_measured(jobs::read_measurement_npz(measured_npz(packing), {}));
  const std::string renamed = zip_of({{"acc.npy", npy_of<double>({1, 2}, "<f8")},
                                      {"clock.npy", npy_of<double>({0, 1}, "<f8")},
                                      {"note.npy", npy_of<double>({7}, "<f8", "()")}},
                                     Packing::kDeflated);
  const Measurement measured =
      jobs::read_measurement_npz(renamed, {.time = "clock", .channels = {"acc:force_n"}});
  EXPECT_EQ(measured.runs[0].columns[0], (std::vector<double>{1, 2}));
}

/// Archive of a time of two samples and one other array.
std::string npz_with(const std::string& array, const std::string& name = "force_n.npy") {
  return zip_of({{"time_s.npy", npy_of<double>({0, 1}, "<f8")}, {name, array}}, Packing::kStored);
}

TEST(MeasurementNpz, NamesTheArrayOfAFault) {
  EXPECT_EQ(npz_refusal(npz_with(npy_of<float>({1, 2}, ">f4"))),
            "array \"force_n\" has the type \"'>f4'\"; float64 and float32 are read, little-endian");
  EXPECT_THAT(npz_refusal(npz_with(npy_of<std::int64_t>({1, 2}, "<i8"))),
              HasSubstr("has the type \"'<i8'\""));
  EXPECT_EQ(npz_refusal(npz_with(npy_of<double>({1, 2}, "<f8", "(2, 1)"))),
            "array \"force_n\" has the shape \"(2, 1)\"; it must have one dimension");
  EXPECT_EQ(npz_refusal(npz_with(npy_of<double>({1, 2}, "<f8", "", "True"))),
            "array \"force_n\" is in Fortran order; save it in C order");
  EXPECT_EQ(npz_refusal(npz_with(npy_of<double>({1, 2}, "<f8", "(3,)"))),
            "array \"force_n\" has another length than its header says");
  EXPECT_EQ(npz_refusal(npz_with("text")), "array \"force_n\" is no file of NumPy's format");
  EXPECT_EQ(npz_refusal(npz_with(npy_of<double>({1, 2, 3}, "<f8"))),
            "array \"force_n\" has 3 samples, but the time has 2");
  EXPECT_EQ(npz_refusal(npz_with(npy_of<double>({1, std::nan("")}, "<f8"))),
            "array \"force_n\", element 1: is not finite; gaps (NaN, empty cells) are not allowed in this "
            "version");
  EXPECT_THAT(npz_refusal(npz_with(npy_of<double>({1, 2}, "<f8"), "acc.npy")),
              HasSubstr("array \"acc\": the name must end in a unit"));
  EXPECT_EQ(npz_refusal(npz_with("x", "notes.txt")), "the archive holds \"notes.txt\", no array");
  EXPECT_EQ(npz_refusal(zip_of({{"force_n.npy", npy_of<double>({1, 2}, "<f8")}}, Packing::kStored)),
            "the archive has no array time_s; time=ARRAY in the query names the array of the time");
  EXPECT_EQ(npz_refusal(zip_of({{"time_s.npy", npy_of<double>({1, 1}, "<f8")},
                                {"force_n.npy", npy_of<double>({1, 2}, "<f8")}},
                               Packing::kStored)),
            "array \"time_s\", element 1: the time must increase; 1 s follows 1 s");
  EXPECT_EQ(npz_refusal(zip_of({}, Packing::kStored)), "the archive holds no array");
}

TEST(MeasurementNpz, RefusesDamagedArchives) {
  const std::string whole = measured_npz(Packing::kDeflated);
  EXPECT_THAT(npz_refusal("PK"), HasSubstr("it is too short"));
  EXPECT_THAT(npz_refusal(kMeasuredCsv), HasSubstr("its directory is missing"));
  EXPECT_THAT(npz_refusal(whole.substr(0, whole.size() - 1)), HasSubstr("its directory is missing"));
  EXPECT_THAT(npz_refusal(whole.substr(100)), HasSubstr("no NPZ archive that can be read"));
  std::string flipped = measured_npz(Packing::kStored);
  flipped[200] = static_cast<char>(flipped[200] ^ 1);
  EXPECT_THAT(npz_refusal(flipped), HasSubstr("the checksum of \"time_s.npy\" is wrong"));
}

TEST(MeasurementNpz, RefusesAZipBombBeforeItTakesMemory) {
  // 100 MB of zeros in some 100 kB; the sizes of the directory are true.
  const std::string bomb = zip_of({{"time_s.npy", std::string(100'000'000, '\0')}}, Packing::kDeflated);
  EXPECT_THAT(npz_refusal(bomb), HasSubstr("its arrays take more than"));
  // The same with a directory that says less.
  std::string lying =
      zip_of({{"time_s.npy", std::string(1'000'000, '\0')}, {"force_n.npy", npy_of<double>({1, 2}, "<f8")}},
             Packing::kDeflated);
  const auto line = lying.find("PK\x01\x02");
  lying.replace(line + 24, 4, little_endian(1000, 4));
  EXPECT_THAT(npz_refusal(lying), HasSubstr("\"time_s.npy\" is damaged"));
  // And with one that says more than any stream of that length can hold.
  lying.replace(line + 24, 4, little_endian(60'000'000, 4));
  EXPECT_THAT(npz_refusal(lying), HasSubstr("so few bytes do not hold so many"));
}

}  // namespace
}  // namespace jobs_tests
