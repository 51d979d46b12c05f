// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/model/file_set_ups.h"

#include <gtest/gtest.h>

#include "tools/model/machine_reader.h"
#include "tools/model/parameters.h"

namespace vernier::model {
namespace {

constexpr const char* kMachine =
    "<machine><variables><static><BaseShift X=\"7\"/></static><machineaxes><X "
    "rotary=\"false\"/></machineaxes>"
    "</variables><transforms><sixdof n=\"1\" X=\"X\" Y=\"0\" Z=\"0\" rX=\"0\" rY=\"0\" "
    "rZ=\"0\"/></transforms>"
    "</machine>";

struct File {
  std::string name, text;
};

Measurement read(const std::vector<File>& files, const Machine& machine) {
  Measurement all = parse_measurement(files[0].text, files[0].name, machine, {});
  for (std::size_t i = 1; i < files.size(); ++i)
    append_measurement(all, parse_measurement(files[i].text, files[i].name, machine, {}));
  return all;
}

CompletedText set_ups(const std::vector<File>& files, const std::string& text = kMachine) {
  const Machine machine = parse_machine(text, "m.xml");
  return with_set_ups_of_files(text, machine, read(files, machine));
}

TEST(FileSetUps, SecondFileHasItsOwnBaseShiftFromThePlainOne) {
  const std::vector<File> files = {{"a/laser.csv", "X[mm],x[mm]\n1,1\n"},
                                   {"a/tracker.csv", "X[mm],y[mm]\n1,1\n2,2\n"}};
  const CompletedText own = set_ups(files);
  ASSERT_EQ(own.notes.size(), 1U);
  const Machine machine = parse_machine(own.text, "m.xml");
  ASSERT_EQ(machine.base_shifts.size(), 2U);
  const Measurement rows = read(files, machine);
  for (std::size_t row = 0; row < 3; ++row) {
    const auto shift =
        base_shift_of(machine, rows.states.names(rows.states.setup)[rows.states.of(rows.states.setup, row)]);
    ASSERT_TRUE(shift);
    EXPECT_EQ(machine.base_shifts[*shift].run.value_or(""), row == 0 ? "" : "tracker");
    EXPECT_EQ(machine.base_shifts[*shift].value[0], 7);
  }
  // The file has its set-up now: nothing is added again.
  EXPECT_EQ(set_ups(files, own.text).text, own.text);
}

/// The order of the files on the command line changes no set-up: only the plain BaseShift can serve several
/// files, so that the files with equal run labels have it, also after a file without runs.
TEST(FileSetUps, FilesWithEqualRunsShareThePlainBaseShiftInEachOrder) {
  const File tracker = {"tracker.csv", "X[mm],x[mm],y[mm],z[mm]\n1,1,1,1\n2,2,2,2\n"};
  const File laser_x = {"laser_x.csv", "X[mm],x[mm],run\n1,1,1\n2,2,2\n"};
  const File laser_y = {"laser_y.csv", "X[mm],y[mm],run\n1,1,1\n2,2,2\n"};
  for (const std::vector<File>& files : {std::vector<File>{tracker, laser_x, laser_y},
                                         {laser_x, tracker, laser_y},
                                         {laser_x, laser_y, tracker}}) {
    const CompletedText own = set_ups(files);
    ASSERT_EQ(own.notes.size(), 1U) << "with " << files[0].name << " first";
    EXPECT_EQ(own.notes[0].rfind("tracker.csv has its own set-up BaseShift[tracker]", 0), 0U) << own.notes[0];
    const Machine machine = parse_machine(own.text, "m.xml");
    ASSERT_EQ(machine.base_shifts.size(), 2U);
    const Measurement rows = read(files, machine);
    for (std::size_t row = 0; row < rows.rows(); ++row) {
      const std::string& word = rows.states.names(rows.states.setup)[rows.states.of(rows.states.setup, row)];
      const auto shift = base_shift_of(machine, word);
      ASSERT_TRUE(shift);
      EXPECT_EQ(machine.base_shifts[*shift].run.value_or("") == "tracker",
                rows.files[rows.file[row]] == "tracker.csv");
    }
  }
}

TEST(FileSetUps, TwoFilesOfOneNameAreNamedByTheirFolders) {
  const std::vector<File> files = {{"a/meas.csv", "X[mm],x[mm]\n1,1\n"},
                                   {"b/meas.csv", "X[mm],x[mm]\n1,1\n"}};
  const CompletedText own = set_ups(files);
  const Machine machine = parse_machine(own.text, "m.xml");
  ASSERT_EQ(machine.base_shifts.size(), 2U);
  const Measurement rows = read(files, machine);
  const auto word_of = [&](std::size_t row) {
    return rows.states.names(rows.states.setup)[rows.states.of(rows.states.setup, row)];
  };
  EXPECT_EQ(word_of(0), "");
  EXPECT_EQ(word_of(1), "b/meas");
}

TEST(FileSetUps, OneFileStatedSetUpsAndCheckFilesStayAsTheyAre) {
  const File one = {"one.csv", "X[mm],x[mm]\n1,1\n"};
  EXPECT_EQ(set_ups({one}).text, kMachine);
  EXPECT_EQ(set_ups({one, {"two.csv", "X[mm],x[mm],setup\n1,1,s\n"}}).text, kMachine);
  EXPECT_EQ(set_ups({one, {"two.csv", "X[mm],x[mm],role\n1,1,check\n"}}).text, kMachine);
  const File labelled = {"one.csv", "X[mm],x[mm],run\n1,1,r\n"};
  EXPECT_EQ(set_ups({labelled, {"two.csv", "X[mm],x[mm],run\n1,1,r\n"}}).text, kMachine);
  EXPECT_NE(set_ups({labelled, {"two.csv", "X[mm],x[mm],run\n1,1,q\n"}}).text, kMachine);
}

TEST(FileSetUps, TwoFilesThatStateDifferentSetUpsHaveABaseShiftForEach) {
  const File one = {"one.csv", "X[mm],x[mm],setup\n1,1,s1\n"};
  const CompletedText own = set_ups({one,
                                     {"two.csv", "X[mm],x[mm],setup\n1,1,s2\n2,2,s3\n"},
                                     {"three.csv", "X[mm],x[mm],setup\n1,1,s1\n"}});
  const Machine machine = parse_machine(own.text, "m.xml");
  ASSERT_EQ(machine.base_shifts.size(), 3U);
  EXPECT_EQ(machine.base_shifts[*base_shift_of(machine, "s2")].run, "s2");
  EXPECT_EQ(machine.base_shifts[*base_shift_of(machine, "s3")].run, "s3");
  EXPECT_FALSE(machine.base_shifts[*base_shift_of(machine, "s1")].run);
  EXPECT_EQ(own.notes.size(), 2U);
}

TEST(FileSetUps, HiddenBaseShiftStaysTheOnlyOne) {
  std::string hidden = kMachine;
  hidden.replace(hidden.find("X=\"7\""), 5, "X=\"7\" Hide=\"true\"");
  EXPECT_EQ(set_ups({{"one.csv", "X[mm],x[mm]\n1,1\n"}, {"two.csv", "X[mm],x[mm]\n1,1\n"}}, hidden).text,
            hidden);
}

/// A file of a camera on the tool, and what is added to the machine file for it.
const std::string kBoardHead = "X[mm],bx[mm],by[mm],bz[mm],brx[deg],bry[deg],brz[deg]";
CompletedText mountings(const std::vector<File>& files, const std::string& text = kMachine) {
  const Machine machine = parse_machine(text, "m.xml");
  return with_camera_mountings(text, machine, read(files, machine));
}

TEST(CameraMountings, ACameraHasAToolShiftOfItsOwn) {
  const File camera = {"cam.csv", kBoardHead + "\n1,0,0,500,1,2,3\n"};
  const CompletedText own = mountings({camera});
  ASSERT_EQ(own.notes.size(), 1U);
  const Machine machine = parse_machine(own.text, "m.xml");
  ASSERT_EQ(machine.tool_shifts.size(), 1U);
  EXPECT_FALSE(machine.tool_shifts[0].run);
  EXPECT_EQ(machine.base_shifts.size(), 1U);
  EXPECT_EQ(mountings({camera}, own.text).text, own.text);
  EXPECT_EQ(mountings({{"one.csv", "X[mm],x[mm]\n1,1\n"}}).text, kMachine);
}

// The reflector of a tracker is not at the place of the camera.
TEST(CameraMountings, BesideATrackerTheToolShiftIsOfTheSetUpOfTheCamera) {
  const File tracker = {"one.csv", "X[mm],x[mm]\n1,1\n"};
  const CompletedText own = mountings({tracker, {"cam.csv", kBoardHead + ",setup\n1,0,0,500,1,2,3,cam\n"}});
  const Machine machine = parse_machine(own.text, "m.xml");
  ASSERT_EQ(machine.tool_shifts.size(), 1U);
  EXPECT_EQ(machine.tool_shifts[0].run, "cam");
  EXPECT_FALSE(tool_shift_of(machine, ""));
  EXPECT_THROW(mountings({tracker, {"cam.csv", kBoardHead + "\n1,0,0,500,1,2,3\n"}}), text::InputError);
}

}  // namespace
}  // namespace vernier::model
