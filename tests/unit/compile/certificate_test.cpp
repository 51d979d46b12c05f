// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/compile/certificate.h"

#include <gtest/gtest.h>

#include <unistd.h>

#include <cstdlib>

#include "tests/unit/compile/agreement.h"
#include "tests/unit/effects/candidates.h"
#include "tools/model/machine_reader.h"
#include "tools/text/files.h"

namespace vernier::certificate_test {
namespace {

bool has_gappa() { return std::system("gappa --version >/dev/null 2>&1") == 0; }

/// Exit status 0: every statement of the script is proved.
bool proved(const std::string& script) {
  const std::string file = testing::TempDir() + "/bound_" + std::to_string(::getpid()) + ".g";
  text::write_file(file, script);
  const bool ok = std::system(("timeout 200 gappa " + file + " >/dev/null 2>&1").c_str()) == 0;
  std::remove(file.c_str());
  return ok;
}

/// The same machine with half the error of each output.
std::string overstated(const TestMachine& test) {
  CompiledMachine compiled = test.compiled;
  for (const Output& out : compiled.program.outputs) compiled.program.registers[out.source].error *= 0.5;
  return print_certificate(test.machine, compiled);
}

class Certificate : public testing::TestWithParam<std::string> {};

TEST_P(Certificate, IsProvedByAnotherProgram) {
  if (!has_gappa()) GTEST_SKIP() << "no gappa on this machine";
  const TestMachine test(disturbed(model::read_machine(diagnose_test::machine_path(GetParam())), 41));
  EXPECT_TRUE(proved(print_certificate(test.machine, test.compiled)));
}

TEST(OneCertificate, IsNotProvedOfAnErrorThatIsTooSmall) {
  if (!has_gappa()) GTEST_SKIP() << "no gappa on this machine";
  const TestMachine test(disturbed(model::read_machine(diagnose_test::machine_path("xy_circle")), 41));
  EXPECT_TRUE(proved(print_certificate(test.machine, test.compiled)));
  EXPECT_FALSE(proved(overstated(test)));
}

// Beyond some thousand lines the proof takes minutes (ur10e, fibre_placement): not here.
INSTANTIATE_TEST_SUITE_P(Machines, Certificate,
                         testing::Values("five_axis_bhead_ctable", "fixed_horizontal_arm", "moving_bridge",
                                         "xy_ball_bar"),
                         [](const auto& test) { return test.param; });

TEST(OneCertificate, OfARobotSaysWhatProvesItsBound) {
  const auto certificate = [](const char* name) {
    const TestMachine test(disturbed(model::read_machine(diagnose_test::machine_path(name)), 41));
    return print_certificate(test.machine, test.compiled);
  };
  EXPECT_NE(certificate("ur10e").find("This file does not prove it."), std::string::npos);
  EXPECT_EQ(certificate("xy_ball_bar").find("This file does not prove it."), std::string::npos);
}

TEST(OneCertificate, OfAMachineWithoutErrorsIsProvedToo) {
  if (!has_gappa()) GTEST_SKIP() << "no gappa on this machine";
  const TestMachine test(model::read_machine(diagnose_test::machine_path("gantry")));
  EXPECT_TRUE(proved(print_certificate(test.machine, test.compiled)));
}

}  // namespace
}  // namespace vernier::certificate_test
