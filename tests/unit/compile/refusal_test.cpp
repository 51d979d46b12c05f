// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <filesystem>

#include "tests/unit/compile/poses.h"
#include "tools/model/machine_reader.h"

namespace vernier::refusal_test {

using namespace vernier::compile;
using namespace vernier::model;
using namespace vernier::text;
namespace {

std::string replaced(std::string text, const std::string& what, const std::string& by) {
  const std::size_t at = text.find(what);
  if (at == std::string::npos) throw std::logic_error("the test machine lacks " + what);
  return text.replace(at, what.size(), by);
}

CompiledMachine compile_text(const std::string& text, std::optional<double> budget_um = {}) {
  CompileOptions options;
  options.budget_um = budget_um;
  return compile_machine(parse_machine(text, "m.xml"), text, options);
}

/// The message with which the bridge is refused after one change; empty where it compiles.
std::string refusal(const std::string& what, const std::string& by) {
  try {
    compile_text(replaced(read_file(machine_path("bridge")), what, by));
  } catch (const InputError& error) {
    return error.what();
  }
  return {};
}

void expect_one_line(const std::string& message, const std::string& word, const std::string& reason) {
  EXPECT_EQ(message.find('\n'), std::string::npos) << message;
  EXPECT_NE(message.find("m.xml"), std::string::npos) << message;
  EXPECT_NE(message.find(word), std::string::npos) << message;
  EXPECT_NE(message.find(reason), std::string::npos) << message;
}

TEST(Compile, RefusesInOneLineWithTheReason) {
  expect_one_line(refusal("<BX value=\"0.0021\" nominal=\"0\"", "<BX value=\"0.0021\""), "BX",
                  "without `nominal`");
  expect_one_line(refusal("min=\"0\" max=\"600\"", "min=\"0\""), "X", "min and max");
  expect_one_line(refusal("BY*dirY", "BY*log(Y)"), "BY*log(Y)", "log");
  expect_one_line(refusal("BY*dirY", "BY/(Y-100)"), "BY/(Y-100)", "division");
  // Up to 600^6561 mm: it was an internal error.
  expect_one_line(refusal("BY*dirY", "BY*dirY+1e-3*(((X^9)^9)^9)^9"), "(((X^9)^9)^9)^9", "can exceed 1e100");
  expect_one_line(refusal("BY*dirY", "BY*dirY+1e-3*(((X^9)^9)^9)^-9"), "(((X^9)^9)^9)^-9",
                  "can exceed 1e100");
  expect_one_line(refusal("BY*dirY", "BY*atan2(Y-5,X-5)"), "atan2", "180 deg");
  expect_one_line(refusal("lag(T_column-20,600)", "lag(T_column-20,100+Y)"), "lag", "time constant");
  expect_one_line(refusal("Z=\"lYz\"", "Z=\"abs(X-100)\""), "X", "direction of motion changes in a step");
}

TEST(Compile, TakesRunAndNormalAsZeroWithANote) {
  const std::string text = read_file(machine_path("bridge"));
  const auto program_with = [&](const std::string& term) {
    return compile_text(replaced(text, "BY*dirY", "BY*dirY" + term));
  };
  const CompiledMachine plain = program_with(""), normal = program_with("+BY*nx"),
                        pretravel = program_with("+BY*cos(3*atan2(ny,nx))*ny"),
                        run = program_with("+BY*run(&quot;a&quot;)");
  EXPECT_TRUE(plain.notes.empty());
  ASSERT_EQ(normal.notes.size(), 1u);
  EXPECT_NE(normal.notes[0].find("nx, ny and nz are columns of a measurement"), std::string::npos);
  ASSERT_EQ(run.notes.size(), 1u);
  EXPECT_NE(run.notes[0].find("run(\"a\") is 0"), std::string::npos);
  // The image differs in the hash of its source alone: the equation is the same.
  for (const CompiledMachine* other : {&normal, &pretravel, &run})
    EXPECT_EQ(plain.fingerprint, other->fingerprint);
}

TEST(Compile, NamesTheTermToBlameForABudget) {
  const std::string text = read_file(machine_path("bridge"));
  EXPECT_NO_THROW(compile_text(text, 0.1));
  // Half a nm of the output's own rounding is the floor.
  try {
    compile_text(text, 0.0004);
    FAIL() << "a bound below the output's LSB";
  } catch (const LimitNotMet& no) {
    EXPECT_NE(std::string(no.what()).find("output in nm"), std::string::npos) << no.what();
  }
}

TEST(Compile, KeepsMoreOrdersForATighterBudget) {
  const std::string text = read_file(machine_path("five_axis"));
  const CompiledMachine loose = compile_text(text), tight = compile_text(text, 0.0015);
  EXPECT_GT(loose.bounds[0].total_um, 0.0015);
  EXPECT_LE(tight.bounds[0].total_um, 0.0015);
  EXPECT_GT(tight.program.instructions.size(), loose.program.instructions.size());
}

TEST(Compile, GivesAnEmptyDeviationForAPerfectMachine) {
  const std::string text =
      "<machine name=\"ideal\"><variables><machineaxes><X rotary=\"false\" min=\"0\" "
      "max=\"100\"/></machineaxes></variables>"
      "<transforms><sixdof n=\"1\" X=\"X\" Y=\"0\" Z=\"0\" rX=\"0\" rY=\"0\" "
      "rZ=\"30\"/></transforms></machine>";
  const CompiledMachine compiled = compile_text(text);
  EXPECT_EQ(compiled.program.instructions.size(), 0u);
  Compensator compensator(load_image(compiled.image, parse_machine(text, "m.xml"))->view.program());
}

TEST(LoadImageDir, RefusesAnImageOfAnotherMachineFile) {
  const std::string directory = testing::TempDir() + "/vernier-load-image";
  std::filesystem::create_directories(directory);
  const TestMachine test("planar");
  write_file(directory + "/machine.vimg", {test.compiled.image.begin(), test.compiled.image.end()});
  write_file(directory + "/machine.xml", read_file(machine_path("planar")));
  EXPECT_EQ(load_image_dir(directory)->view.axes().size, 2u);
  write_file(directory + "/machine.xml", read_file(machine_path("planar")) + "\n");
  EXPECT_THROW(load_image_dir(directory), InputError);
}

}  // namespace
}  // namespace vernier::refusal_test
