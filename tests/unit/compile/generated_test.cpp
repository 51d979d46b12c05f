// SPDX-License-Identifier: GPL-3.0-or-later
#include <dlfcn.h>
#include <gtest/gtest.h>

#include <unistd.h>

#include <cstdlib>
#include <filesystem>

#include "tests/unit/compile/poses.h"
#include "tools/compile/sine_table.h"

namespace vernier::generated_test {

using namespace vernier::compile;
using namespace vernier::text;
namespace {

using Equation_ = void (*)(const std::int32_t*, LagState*, bool, std::int32_t*) noexcept;

/// The printed C++ of a machine, built by the compiler that builds the project and loaded.
class Printed {
 public:
  Printed(const std::string& name, const CompiledMachine& compiled) {
    directory_ =
        std::filesystem::temp_directory_path() / ("vernier-printed-" + name + "-" + std::to_string(getpid()));
    std::filesystem::create_directories(directory_);
    write_file(directory_ / "equation.h", compiled.header);
    write_file(directory_ / "equation.cpp", compiled.source);
    const std::string library = directory_ / "equation.so";
    const std::string command =
        std::string(VERNIER_CXX) +
        " -std=c++20 -O2 -Wall -Wextra -Wconversion -Wshadow -Werror -fPIC -shared -I " + VERNIER_SOURCE_DIR +
        " " + (directory_ / "equation.cpp").string() + " -o " + library;
    if (std::system(command.c_str()) != 0) throw std::runtime_error("the printed program does not compile");
    handle_ = dlopen(library.c_str(), RTLD_NOW);
    if (handle_ == nullptr) throw std::runtime_error(dlerror());
    equation =
        reinterpret_cast<Equation_>(dlsym(handle_, "_ZN7vernier9generated8equationEPKiPNS_8LagStateEbPi"));
  }
  Printed(const Printed&) = delete;
  Printed& operator=(const Printed&) = delete;
  ~Printed() {
    if (handle_ != nullptr) dlclose(handle_);
    std::filesystem::remove_all(directory_);
  }
  Equation_ equation = nullptr;

 private:
  std::filesystem::path directory_;
  void* handle_ = nullptr;
};

class Generated : public testing::TestWithParam<const char*> {};

TEST_P(Generated, IsBitIdenticalToTheExecutedProgram) {
  const TestMachine test(GetParam());
  const Printed printed(GetParam(), test.compiled);
  ASSERT_NE(printed.equation, nullptr);
  const Program& program = test.loaded->view.program();
  std::mt19937_64 random(77);
  Compensator compensator(program);
  std::vector<LagState> lags(kMaxLags);
  bool starting = true;
  for (const CycleInput& input : test.random_poses(50000, random)) {
    compensator.step(input);
    std::int32_t channels[kMaxRegisters], deviations[kMaxAxes] = {};
    for (std::uint32_t i = 0; i < program.channels.size; ++i)
      channels[i] = compensator.register_value(program.equation.first_channel() + i);
    printed.equation(channels, lags.data(), starting, deviations);
    starting = false;
    for (std::uint32_t k = 0; k < program.outputs.size; ++k)
      ASSERT_EQ(deviations[k], compensator.register_value(program.outputs[k].source));
  }
}

TEST_P(Generated, CorrectsAndSharesAsTheExecutedProgramDoes) {
  const TestMachine test(GetParam());
  const Printed printed(GetParam(), test.compiled);
  const ImageView& view = test.loaded->view;
  Compensator executed(view.program()), built_in(view.program()), dense(view.program());
  built_in.use_printed(printed.equation);
  std::vector<DenseCell> cells(dense_size(view.program().equation));
  DenseFrame frame;
  ASSERT_TRUE(dense.use_dense({cells.data(), static_cast<std::uint32_t>(cells.size()), &frame}));
  std::mt19937_64 random(78);
  std::size_t tick = 0;
  for (const CycleInput& input : test.random_poses(20000, random)) {
    const CycleOutput one = executed.step(input), two = built_in.step(input), three = dense.step(input);
    ASSERT_EQ(one.flags, two.flags);
    ASSERT_EQ(one.flags, three.flags);
    for (std::uint32_t axis = 0; axis < kMaxAxes; ++axis) {
      ASSERT_EQ(one.correction[axis].counts, two.correction[axis].counts);
      ASSERT_EQ(one.correction[axis].counts, three.correction[axis].counts);
    }
    if (++tick % 100 != 0) continue;
    std::vector<Correction> first(view.shares().shares.size), second(first), third(first);
    shares_of(executed, view.shares(), view.program(), first.data());
    shares_of(built_in, view.shares(), view.program(), second.data());
    shares_of(dense, view.shares(), view.program(), third.data());
    for (std::size_t i = 0; i < first.size(); ++i) {
      ASSERT_EQ(first[i].counts, second[i].counts);
      ASSERT_EQ(first[i].counts, third[i].counts);
    }
  }
}

TEST_P(Generated, HasTheSameBytesForTheSameInput) {
  const TestMachine first(GetParam()), second(GetParam());
  EXPECT_EQ(first.compiled.image, second.compiled.image);
  EXPECT_EQ(first.compiled.source, second.compiled.source);
  EXPECT_EQ(first.compiled.header, second.compiled.header);
}

TEST(GeneratedHeader, UnitOfADeviationIsThatOfItsAxis) {
  const Machine robot = parse_machine(
      R"(<machine name="arm"><variables><static><k value="0.01" nominal="0"/></static><machineaxes>
      <J1 rotary="true" min="-90" max="90"/><J2 rotary="true" min="10" max="90"/></machineaxes></variables>
      <transforms branch="tool"><DH n="1" theta="J1+k" d="0" a="300" alpha="0"/>
      <DH n="2" theta="J2" d="0" a="200" alpha="0"/></transforms></machine>)",
      "arm.xml");
  const std::string header = compile_machine(robot, "", {}).header;
  EXPECT_NE(header.find("axis J1, deg, "), std::string::npos) << header;
  EXPECT_EQ(header.find(", mm, "), std::string::npos) << header;
}

TEST(SineTable, IsWhatItsGeneratorPrints) {
  const std::string path = std::string(VERNIER_SOURCE_DIR) + "/comp/generated/sine_table.h";
  if (std::getenv("VERNIER_UPDATE_GOLDEN") != nullptr) write_file(path, print_sine_table());
  EXPECT_EQ(read_file(path), print_sine_table());
}

INSTANTIATE_TEST_SUITE_P(Machines, Generated, testing::Values("bridge", "five_axis", "planar"));

}  // namespace
}  // namespace vernier::generated_test
