// SPDX-License-Identifier: GPL-3.0-or-later
// Table 7-2 of a thesis: means of ball-bar tests of a robot without and with compensation.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <map>
#include <string>
#include <vector>

#include "tools/format/csv_file.h"
#include "tools/model/machine_reader.h"
#include "tools/residual/before_after.h"
#include "tools/text/files.h"
#include "tools/text/numbers.h"

namespace vernier::published_reduction_test {

using namespace vernier::model;
using namespace vernier::residual;
namespace {

/// The printed values of one row: three means, and the reduction where it is printed.
struct PrintedRow {
  std::vector<std::string> means;
  std::string reduction;
};

std::map<std::string, PrintedRow> printed_rows() {
  const std::string path = VERNIER_SOURCE_DIR "/tests/data/cobot_mill/table_7_2.csv";
  const format::CsvFile csv = format::parse_csv(text::read_file(path), path);
  std::map<std::string, PrintedRow> rows;
  for (const auto& cells : csv.rows)
    rows[cells.at(0)] = {{cells.at(1), cells.at(2), cells.at(3)}, cells.at(5)};
  return rows;
}

/// The means as readings at X = 0, where the nominal reading is 0.
Measurement readings(const Machine& machine, const std::vector<std::string>& means) {
  std::string text = "X[mm],x[mm]\n";
  for (const std::string& mean : means) text += "0," + mean + "\n";
  return parse_measurement(text, "means.csv", machine);
}

TEST(PublishedReduction, OfTheMeansOfTable7Dash2IsThePrintedOne) {
  const Machine machine = parse_machine(R"(<machine name="m"><variables><static/>
    <machineaxes><X min="0" max="1"/></machineaxes></variables>
    <transforms><sixdof X="X" Y="0" Z="0"/></transforms></machine>)",
                                        "m.xml");
  const std::map<std::string, PrintedRow> rows = printed_rows();
  for (const std::string feed : {"1000", "3000", "6000"}) {
    const PrintedRow& without = rows.at(feed + " NC");
    const BeforeAfter result = compare_before_after(machine, readings(machine, without.means),
                                                    readings(machine, rows.at(feed + " WC").means));
    const double percent = 100 * (1 - result.all.after.mean / result.all.before.mean);
    // The table divides means that it rounded to 0.1 um: 0.03 % of 0.1048 mm / 0.2247 mm.
    EXPECT_NEAR(percent, *text::parse_number(without.reduction), 0.05) << feed;
  }
}

}  // namespace
}  // namespace vernier::published_reduction_test
