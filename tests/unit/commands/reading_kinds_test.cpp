// SPDX-License-Identifier: GPL-3.0-or-later
// Every kind of reading in the table of tools/format goes the whole way: new, lint, fit, compare, evaluate,
// import and the Python module. The test reads the table; no kind has a line of its own here.
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <random>

#include "tools/format/columns.h"
#include "tools/format/csv_file.h"
#include "tools/format/readings.h"
#include "tools/maths/factors.h"
#include "tools/model/chain/chain.h"
#include "tools/model/chain/prediction.h"
#include "tools/model/machine_reader.h"
#include "tools/model/measurement.h"
#include "tools/text/files.h"
#include "tools/text/numbers.h"
#include "tools/text/words.h"

namespace vernier::reading_kinds_test {
namespace {

namespace fs = std::filesystem;
using format::ReadingKind;

/// Standard uncertainty of every reading: 1 µm, and as many thousandths of a degree (4 arcsec).
constexpr double kNoise = 1e-3;

/// The survey of one form alone that holds this kind.
const format::SurveyReading& survey_of(ReadingKind kind) {
  for (const format::SurveyReading& survey : format::kSurveyReadings)
    if (survey.form_count == 1 && survey.forms[0] == format::form_of(kind)) return survey;
  throw std::logic_error("no survey has this kind");
}

/// A file of cells that can be written again.
struct Cells {
  format::CsvFile csv;
  std::size_t at(const std::string& name) const {
    for (std::size_t k = 0; k < csv.columns.size(); ++k)
      if (csv.columns[k].name == name) return k;
    throw std::logic_error(name + ": no such column");
  }
  std::string& cell(std::size_t row, const std::string& name) { return csv.rows[row][at(name)]; }
  double factor(const std::string& name) const {
    return format::find_unit(csv.columns[at(name)].unit)->factor;
  }
  std::string text() const {
    std::string text;
    for (std::size_t k = 0; k < csv.columns.size(); ++k)
      text += (k > 0 ? "," : "") + format::heading(csv.columns[k].name, csv.columns[k].unit);
    text += ",u[um]\n";
    for (const auto& row : csv.rows) text += text::joined(row, ",") + ",1\n";
    return text;
  }
};

class ReadingKinds : public testing::TestWithParam<ReadingKind> {
 protected:
  ReadingKinds() { fs::create_directories(folder_); }
  ~ReadingKinds() override { fs::remove_all(folder_); }

  int run(const std::string& words) {
    const int status = std::system(
        ("cd '" + folder_ + "' && PATH=" VERNIER_BIN_DIR ":$PATH timeout 120 " + words + " >out.txt 2>&1")
            .c_str());
    said_ = text::read_file(folder_ + "/out.txt");
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }
  std::string file(const std::string& name) const { return folder_ + "/" + name; }
  nlohmann::json json(const std::string& name) const {
    return nlohmann::json::parse(text::read_file(file(name)));
  }

  /// A machine that differs from its nominal chain in all that a fit may find: 20 µm at every other station.
  static model::Machine truth(model::Machine machine) {
    constexpr double kError_mm = 0.02;
    for (model::Table& table : machine.tables)
      for (std::size_t k = 1; k < table.stations.size(); k += 2)
        for (std::size_t c = 0; c < 3; ++c)
          if (table.free[c]) table.stations[k].value[c] += kError_mm;
    return machine;
  }

  /// Fills the template: what stands beside a reading by what it is, then the readings of the true machine.
  void fill(Cells& survey, const model::Machine& machine, format::ReadingForm form) {
    for (std::size_t row = 0; row < survey.csv.rows.size(); ++row) {
      for (const format::ColumnGroup* const group : format::columns_beside(form))
        for (std::size_t k = 0; k < group->count; ++k)
          survey.cell(row, group->names[k]) = beside(*group, row, k);
      for (const char* const name : format::reading_columns(form).list()) survey.cell(row, name) = "1";
      if (format::is_of_board(GetParam()))
        for (const char* const name : format::reading_columns(form).list()) survey.cell(row, name) = "0";
      else if (format::entry_of(form).together)
        for (std::size_t k = 0; k < 3; ++k)
          survey.cell(row, format::reading_columns(form).names[k]) = k == 2 ? "1" : "0";
    }
    if (needs_other_row(form)) clear(survey, form, 0);
    const model::Measurement rows = model::parse_measurement(survey.text(), "survey", machine);
    const Eigen::VectorXd predicted = model::predict(machine, rows);
    const std::vector<Eigen::Matrix3d> rotation = model::forward(machine, rows.states).rotation;
    for (std::size_t i = 0; i < rows.observations.size(); ++i) {
      const model::Observation& o = rows.observations[i];
      if (form == format::ReadingForm::kDirection) {
        // The measured direction is the tool axis, with noise across it: once a row, though it is two
        // readings.
        if (i > 0 && rows.observations[i - 1].row == o.row) continue;
        Eigen::Vector3d axis = rotation[o.row].col(2);
        axis += Eigen::Vector3d(noise(), noise(), 0) / maths::kDegPerRad;
        axis.normalize();
        for (std::size_t k = 0; k < 3; ++k)
          survey.cell(o.row, format::reading_columns(form).names[k]) =
              text::number_text(axis[static_cast<Eigen::Index>(k)]);
        continue;
      }
      const std::string name = format::name_of(o.kind);
      constexpr double kLeast_mm = 1;  // a shorter distance has no direction
      if (format::entry_of(form).never_negative && predicted[static_cast<Eigen::Index>(i)] < kLeast_mm) {
        clear(survey, form, o.row);
        continue;
      }
      survey.cell(o.row, name) =
          text::number_text((predicted[static_cast<Eigen::Index>(i)] + noise()) / survey.factor(name));
    }
  }

  /// Takes away the reading columns that are not of this kind, where a kind has a column of its own.
  static void keep_only(Cells& survey, ReadingKind kind) {
    const format::ReadingForm form = format::form_of(kind);
    if (format::entry_of(form).together) return;
    for (const char* const name : format::reading_columns(form).list()) {
      if (name == std::string_view(format::name_of(kind))) continue;
      const auto at = static_cast<std::ptrdiff_t>(survey.at(name));
      survey.csv.columns.erase(survey.csv.columns.begin() + at);
      for (auto& row : survey.csv.rows) row.erase(row.begin() + at);
    }
  }

  static bool needs_other_row(format::ReadingForm form) {
    for (const format::ColumnGroup* const group : format::columns_beside(form))
      if (group->words) return true;
    return false;
  }
  static void clear(Cells& survey, format::ReadingForm form, std::size_t row) {
    for (const char* const name : format::reading_columns(form).list()) survey.cell(row, name).clear();
    for (const format::ColumnGroup* const group : format::columns_beside(form))
      for (const char* const name : group->list()) survey.cell(row, name).clear();
  }

  /// A word: the first row. A pure number: one of the three unit vectors. A length: a point in the volume.
  static std::string beside(const format::ColumnGroup& group, std::size_t row, std::size_t component) {
    if (group.words) return "1";
    if (format::dimension_of(group) == format::Dimension::kNone) return row % 3 == component ? "1" : "0";
    constexpr std::array<double, 3> kPoint_mm = {310, 190, -420};
    return text::number_text(kPoint_mm.at(component));
  }

  double noise() { return kNoise * normal_(random_); }

  /// The survey of the machine in machine.xml, twice through, in survey.csv.
  void write_survey() {
    const format::SurveyReading& survey = survey_of(GetParam());
    ASSERT_EQ(run("vernier new bridge --axis X:0:600 --axis Y:0:400 --axis Z:-300:0 -o machine.xml "
                  "--measurements template.csv --errors positioning --reading " +
                  std::string(survey.word)),
              0)
        << said_;
    ASSERT_EQ(run("vernier lint machine.xml template.csv"), 1)
        << "a template that nobody has filled in has no reading\n"
        << said_;
    Cells cells{format::parse_csv(text::read_file(file("template.csv")), "template.csv")};
    const auto once = cells.csv.rows;
    if (format::is_of_thing(GetParam())) return write_touches(cells);
    cells.csv.rows.insert(cells.csv.rows.end(), once.begin(), once.end());
    cells.csv.line.insert(cells.csv.line.end(), cells.csv.line.begin(), cells.csv.line.end());
    fill(cells, truth(model::read_machine(file("machine.xml"))), format::form_of(GetParam()));
    keep_only(cells, GetParam());
    text::write_file(file("survey.csv"), cells.text());
  }

  /// Every pose of the template meets a point of its own eight times: the reading is 0, and its noise is in
  /// the positions of the axes. The points of `on` are artefacts of the machine file.
  void write_touches(Cells& cells) {
    constexpr std::size_t kTimes = 8;  // one eighth of the squares is fitted away
    const std::string name = format::reading_columns(format::form_of(GetParam())).names[0];
    std::string artefacts;
    const auto once = cells.csv.rows;
    cells.csv.rows.clear();
    for (std::size_t k = 0; k < once.size(); ++k) {
      artefacts += "<artefact name=\"P" + std::to_string(k) + "\" type=\"point\"/>\n";
      for (std::size_t i = 0; i < kTimes; ++i) {
        cells.csv.rows.push_back(once[k]);
        const std::size_t row = cells.csv.rows.size() - 1;
        cells.cell(row, name) = "P" + std::to_string(k);
        for (const char* axis : {"X", "Y", "Z"})
          cells.cell(row, axis) = text::number_text(*text::parse_number(cells.cell(row, axis)) + noise());
      }
    }
    text::write_file(file("survey.csv"), cells.text());
    if (name != format::columns::kOn) return;
    std::string machine = text::read_file(file("machine.xml"));
    machine.insert(machine.find("</variables>"), artefacts);
    text::write_file(file("machine.xml"), machine);
  }

  const std::string folder_ =
      testing::TempDir() + "kinds_" + std::to_string(getpid()) + "_" + format::name_of(GetParam());
  std::string said_;
  std::mt19937 random_{20260601};  // a fixed seed
  std::normal_distribution<double> normal_;
};

TEST_P(ReadingKinds, GoFromTheTemplateToTheReport) {
  const std::string name = format::name_of(GetParam());
  SCOPED_TRACE(name);
  write_survey();
  if (HasFatalFailure()) return;
  EXPECT_EQ(run("vernier lint machine.xml survey.csv --json lint.json"), 0) << said_;
  const nlohmann::json lint = json("lint.json");
  for (const auto& finding : lint["findings"]) EXPECT_NE(finding["weight"], "error") << finding;
  ASSERT_EQ(run("vernier fit machine.xml survey.csv -o fitted.xml --json fit.json --residuals rows.csv"), 0)
      << said_;
  const nlohmann::json fit = json("fit.json");
  EXPECT_GT(fit["n_obs"].get<std::size_t>(), 50u);
  // Every kind in the residuals is of this form, and this kind is among them.
  const format::CsvFile rows = format::parse_csv(text::read_file(file("rows.csv")), "rows.csv");
  const Cells residuals{rows};
  std::size_t seen = 0;
  double squares = 0;
  for (const auto& row : rows.rows) {
    if (row[residuals.at("observation")] != name) continue;
    ++seen;
    squares += std::pow(*text::parse_number(row[residuals.at("residual")]), 2);
    EXPECT_EQ(row[residuals.at("unit")], format::unit_of(GetParam()));
  }
  ASSERT_GT(seen, 50u);
  // The noise that was added, to 25 %: some hundred readings, a few per cent of them fitted away.
  EXPECT_NEAR(std::sqrt(squares / static_cast<double>(seen)), kNoise, 0.25 * kNoise);
  ASSERT_EQ(run("vernier compare fitted.xml survey.csv -o report.html --json compare.json"), 0) << said_;
  const nlohmann::json compare = json("compare.json");
  EXPECT_EQ(compare["n_obs"], fit["n_obs"]);
  const std::string report = text::read_file(file("report.html"));
  EXPECT_NE(report.find("\"" + name + "\""), std::string::npos) << "the report does not name the kind";
}

TEST_P(ReadingKinds, AreImportedFromATableByTheirColumn) {
  write_survey();
  if (HasFatalFailure()) return;
  ASSERT_EQ(run("vernier import table survey.csv -o read.csv --machine machine.xml"), 0) << said_;
  const model::Machine machine = model::read_machine(file("machine.xml"));
  const model::Measurement before = model::read_measurement({file("survey.csv")}, machine),
                           after = model::read_measurement({file("read.csv")}, machine);
  ASSERT_EQ(before.observations.size(), after.observations.size());
  for (std::size_t i = 0; i < before.observations.size(); ++i) {
    EXPECT_EQ(before.observations[i].kind, after.observations[i].kind);
    EXPECT_NEAR(before.observations[i].value, after.observations[i].value, 1e-9);
  }
}

// Positioning of an axis is judged by what was measured along it: a coordinate of the tool point.
class ReadingKindsOfPoints : public ReadingKinds {};
TEST_P(ReadingKindsOfPoints, AreEvaluatedAlongTheirAxis) {
  write_survey();
  if (HasFatalFailure()) return;
  const std::string axis(1, "XYZ"[format::component_of(GetParam())]);
  ASSERT_EQ(run("vernier evaluate iso230-2 survey.csv --axis " + axis + " --json evaluate.json"), 0) << said_;
  EXPECT_GE(json("evaluate.json")["n_targets"].get<std::size_t>(), 4u);
}

TEST_P(ReadingKinds, AreTheSameInPython) {
#ifndef VERNIER_PYTHON
  GTEST_SKIP() << "the Python module is not built";
#else
  const std::string python = "env PYTHONPATH='" VERNIER_BIN_DIR "/../python' " VERNIER_PYTHON " ";
  if (run(python + "-c 'import numpy'") != 0) GTEST_SKIP() << "python3-numpy is not installed";
  write_survey();
  if (HasFatalFailure()) return;
  ASSERT_EQ(run("vernier compare machine.xml survey.csv --json compare.json"), 0) << said_;
  text::write_file(file("compare.py"),
                   "import vernier\n"
                   "result = vernier.compare(vernier.Machine('machine.xml'), "
                   "vernier.Measurements('survey.csv'))\n"
                   "print(result.n_obs, sorted(set(result.table['observation'])))\n");
  ASSERT_EQ(run(python + "compare.py"), 0) << said_;
  EXPECT_EQ(said_.substr(0, said_.find(' ')),
            std::to_string(json("compare.json")["n_obs"].get<std::size_t>()));
  EXPECT_NE(said_.find("'" + std::string(format::name_of(GetParam())) + "'"), std::string::npos) << said_;
#endif
}

std::vector<ReadingKind> kinds_of(bool (*is_wanted)(format::ReadingForm)) {
  std::vector<ReadingKind> kinds;
  for (const format::ReadingKindEntry& entry : format::kReadingKinds)
    if (is_wanted(entry.form)) kinds.push_back(entry.kind);
  return kinds;
}

std::string name_of_kind(const testing::TestParamInfo<ReadingKind>& kind) {
  return format::name_of(kind.param);
}

INSTANTIATE_TEST_SUITE_P(OfTheTable, ReadingKinds,
                         testing::ValuesIn(kinds_of([](format::ReadingForm) { return true; })), name_of_kind);
INSTANTIATE_TEST_SUITE_P(OfTheTable, ReadingKindsOfPoints,
                         testing::ValuesIn(kinds_of([](format::ReadingForm form) {
                           return form == format::ReadingForm::kPoint;
                         })),
                         name_of_kind);

}  // namespace
}  // namespace vernier::reading_kinds_test
