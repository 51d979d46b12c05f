// SPDX-License-Identifier: GPL-3.0-or-later
// From nothing to a correction: each type of machine is begun, surveyed in simulation by its own template,
// fitted, compiled and run, as a newcomer would, without a hand on the file.
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <random>
#include <sstream>

#include "tools/create/machine_plan.h"
#include "tools/format/readings.h"
#include "tools/model/chain/prediction.h"
#include "tools/model/chain/work_poses.h"
#include "tools/model/machine_reader.h"
#include "tools/model/machine_writer.h"
#include "tools/model/measurement.h"
#include "tools/text/files.h"
#include "tools/text/numbers.h"
#include "tools/text/words.h"

namespace vernier::new_machine_test {

using namespace vernier::model;
using namespace vernier::text;
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

struct Kind {
  const char* name;
  const char* arguments;
  double left = 0.25;  // part of the deviation that a correction may leave
};
void PrintTo(const Kind& kind, std::ostream* out) { *out << kind.name; }

const Kind kKinds[] = {
    {"gantry", "gantry --axis X:0:600 --axis Y:0:400 --axis Z:-300:0"},
    {"bridge", "bridge --axis X:0:600 --axis Y:0:900 --axis Z:-300:0 --tool 20,-30,-120"},
    {"column", "column --axis X:0:600 --axis Y:0:400 --axis Z:0:300"},
    {"c_frame", "c-frame --axis X:-250:250 --axis Y:-200:200 --axis Z:-350:0"},
    // Without a Z nothing can be done about heights.
    {"c_frame_plane", "c-frame --axis X:-75:75 --axis Y:-75:75", 0.5},
    {"head_head",
     "head-head --axis X:0:2000 --axis Y:0:1200 --axis Z:-700:0 --axis C:-180:180 --axis A:-110:110"},
    {"head_table",
     "head-table --axis X:-300:300 --axis Y:-300:300 --axis Z:0:800 --axis B:-90:90 --axis C:0:360:wrap"},
    {"table_table",
     "table-table --axis X:-300:300 --axis Y:-300:300 --axis Z:0:400 --axis A:-110:30 --axis C:-180:180 "
     "--centre "
     "A:0:0:150"},
    {"arm", "arm --axis X:0:3000 --axis Y:0:1200 --axis Z:0:1500"},
    {"robot", "robot"},
};

/// What is wrong with a machine of ordinary make: 20 um and 0.005 deg a station, 0.1 mm and 0.05 deg an arm.
Machine truth_of(Machine machine, std::mt19937& draw) {
  std::uniform_real_distribution<double> unit(-1, 1);
  for (Static& item : machine.statics) {
    if (item.hidden) continue;
    const double size = item.unit == "rad" ? 2e-4 : item.unit == "deg" ? 0.02 : 0.05;
    item.value += size * unit(draw);
  }
  for (Table& table : machine.tables) {
    for (Station& station : table.stations)
      for (std::size_t c = 0; c < 6; ++c) station.value[c] = (c < 3 ? 0.02 : 0.003) * unit(draw);
    if (table.periodic) table.stations.back().value = table.stations.front().value;
  }
  machine.base_shifts.front().value = {820, -340, 115, 4, -7, 12};  // the instrument stands somewhere
  return machine;
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

class NewMachine : public testing::TestWithParam<Kind> {
 protected:
  NewMachine() {
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  ~NewMachine() override { fs::remove_all(folder_); }

  std::string in(const std::string& name) const { return folder_ + "/" + name; }
  int run(const std::string& line) const {
    const int status = std::system(
        ("cd '" + folder_ + "' && PATH=" VERNIER_BIN_DIR ":$PATH && { " + line + "; } >out.txt 2>&1")
            .c_str());
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }
  std::string said() const { return read_file(in("out.txt")); }
  Json json(const std::string& name) const { return Json::parse(read_file(in(name))); }

  /// Fills the empty cells of the template with what an instrument of 1 um reads on the true machine.
  void measure(const Machine& truth, std::mt19937& draw) const {
    std::string zeros;
    std::vector<std::vector<std::string>> rows;
    for (const std::string& line : lines_of(read_file(in("template.csv")))) {
      if (line.front() == '#') continue;
      std::vector<std::string> cells = parts_of(line, ',');
      rows.push_back(cells);
      for (std::string& cell : cells)
        if (cell.empty()) cell = "0";
      zeros += joined(cells, ",") + "\n";
    }
    const Measurement m = parse_measurement(zeros, "template.csv", truth);
    const Eigen::VectorXd readings = predict(truth, m);
    std::normal_distribution<double> noise_mm(0, 1e-3);
    std::string filled = joined(rows.front(), ",") + "\n";
    for (std::size_t row = 1, next = 0; row < rows.size(); ++row) {
      for (std::string& cell : rows[row])
        if (cell.empty()) cell = number_text(readings[static_cast<Eigen::Index>(next++)] + noise_mm(draw));
      filled += joined(rows[row], ",") + "\n";
    }
    write_file(in("meas.csv"), filled);
  }

  const std::string folder_ =
      testing::TempDir() + "new_" + std::to_string(getpid()) + "_" + std::string(GetParam().name);
};

TEST_P(NewMachine, GoesFromNothingToARunningCorrection) {
  std::mt19937 draw(20261122);
  ASSERT_EQ(
      run(std::string("vernier new ") + GetParam().arguments + " -o machine.xml --measurements template.csv"),
      0)
      << said();
  const Machine machine = read_machine(in("machine.xml"));
  const Machine truth = truth_of(machine, draw);
  write_file(in("truth.xml"), update_machine_text(read_file(in("machine.xml")), truth, true));
  measure(truth, draw);

  ASSERT_EQ(run("vernier fit machine.xml meas.csv -o fitted.xml --json fit.json"), 0) << said();
  const Json fit = json("fit.json");
  // 1 um of noise; check rows see it and what it does to the parameters, at levers of up to 3 m.
  EXPECT_LT(fit["rms_um"], 1.3) << said();
  EXPECT_LT(fit["check_rms_um"], 8) << said();
  EXPECT_GT(fit["rms_before_um"], 20);

  ASSERT_EQ(run("vernier compile fitted.xml -o image"), 0) << said();
  std::string path = "t[s]";
  for (const Axis& axis : machine.axes) path += "," + axis.name + (axis.rotary ? "[deg]" : "[mm]");
  path += "\n";
  for (int step = 0; step <= 4; ++step) {
    path += number_text(2.0 * step);
    for (std::size_t a = 0; a < machine.axes.size(); ++a) {
      const auto range = *work_range(machine, a);
      const double part = 0.2 + 0.15 * step * (a % 2 == 0 ? 1 : 0.7);
      path += "," + number_text(range[0] + part * (range[1] - range[0]));
    }
    path += "\n";
  }
  write_file(in("path.csv"), path);
  ASSERT_EQ(run("vernier simulate --truth truth.xml --image image --path path.csv --json simulate.json"), 0)
      << said();
  const Json simulated = json("simulate.json");
  EXPECT_LT(simulated["rms_after_um"].get<double>(),
            GetParam().left * simulated["rms_before_um"].get<double>())
      << simulated.dump(1);
}

TEST_P(NewMachine, TemplateHasTheColumnsOfItsReading) {
  for (const format::SurveyReading& reading : format::kSurveyReadings) {
    SCOPED_TRACE(reading.word);
    const int status = run(std::string("vernier new ") + GetParam().arguments +
                           " -o machine.xml --measurements t.csv --reading " + reading.word);
    if (status != 0) {
      // A level on the tool says nothing where the workpiece moves: fit would refuse the survey.
      EXPECT_EQ(reading.forms[0], format::ReadingForm::kInclination) << said();
      EXPECT_NE(said().find("whose workpiece does not move"), std::string::npos) << said();
      continue;
    }
    const Machine machine = read_machine(in("machine.xml"));
    // As it comes: every reading is still absent, and nothing else is wrong with it.
    const Measurement empty = parse_measurement(read_file(in("t.csv")), "t.csv", machine);
    EXPECT_TRUE(empty.observations.empty());
    EXPECT_GT(empty.rows(), 20u);
    EXPECT_TRUE(empty.candidates.empty()) << empty.candidates.front().name;
  }
}

INSTANTIATE_TEST_SUITE_P(EveryType, NewMachine, testing::ValuesIn(kKinds),
                         [](const auto& kind) { return std::string(kind.param.name); });

}  // namespace
}  // namespace vernier::new_machine_test
