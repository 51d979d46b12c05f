// SPDX-License-Identifier: GPL-3.0-or-later
// bench_generate NAME DIR: everything that the benches run of one reference machine: machine.vimg, the
// printed equation.h/.cpp, given.cpp (the same with sines and cosines given), flat.cpp (the same equation in
// double), chain.txt (degrees of freedom of every transform at seeded poses, for the peers that multiply
// frames) and poses.bin's counterpart, the double deviations.
#include <fmt/format.h>

#include <cstdio>
#include <filesystem>

#include "tests/bench/poses.h"
#include "tests/bench/reference/flat_double.h"
#include "tests/bench/reference/reference_machine.h"
#include "tools/compile/print.h"
#include "tools/model/chain/evaluate.h"

namespace vernier::bench {

using namespace vernier::compile;
using namespace vernier::model;
using namespace vernier::text;
namespace {

constexpr std::size_t kPoses = 64;

double unit_of(const Axis& axis) { return axis.rotary ? 360 / 4294967296.0 : 1e-6; }

States states_of(const Machine& machine, const std::vector<CycleInput>& poses) {
  States s = make_states(poses.size(), machine);
  for (std::size_t n = 0; n < poses.size(); ++n)
    for (std::size_t i = 0; i < machine.axes.size(); ++i)
      s.axis[i][static_cast<Eigen::Index>(n)] =
          static_cast<double>(poses[n].axis[i].position.count) * unit_of(machine.axes[i]);
  return s;
}

void print_branch(const Machine& machine, const std::vector<Transform>& branch, const States& states,
                  std::string& text) {
  for (const Transform& t : branch) {
    text += t.kind == TransformKind::kSixDof ? "sixdof" : "DH";
    for (std::size_t d = 0; d < t.dof_count(); ++d)
      for (const double v : model::evaluate(machine, *t.dof[d], states)) text += fmt::format(" {:.17g}", v);
    text += "\n";
  }
}

/// Poses, then the transforms of both branches, one line each: kind, then poses x dofs.
std::string print_chain(const Machine& machine, const ImageView& view) {
  Poses poses(view);
  std::vector<CycleInput> inputs(kPoses);
  for (CycleInput& input : inputs) input = poses.next();
  const States states = states_of(machine, inputs);
  std::string text = fmt::format("{} {} {} {}\n", kPoses, machine.axes.size(), machine.workpiece.size(),
                                 machine.tool.size());
  for (const Axis& axis : machine.axes) text += axis.rotary ? "1 " : "0 ";
  text += "\n";
  print_branch(machine, machine.workpiece, states, text);
  print_branch(machine, machine.tool, states, text);
  return text;
}

/// The program with its sines and cosines given as further channels, in the order of its instructions: what
/// the rest of the equation costs.
LoweredProgram with_sines_given(const LoweredProgram& p) {
  LoweredProgram out = p;
  std::vector<std::uint32_t> sines, others;
  std::uint32_t at = p.first_result();
  out.instructions.clear();
  for (const Instruction& s : p.instructions) {
    const bool sine = s.op == OpCode::kSineCosine;
    if (!sine) out.instructions.push_back(s);
    for (std::uint32_t i = 0; i < p.results_of(s); ++i) (sine ? sines : others).push_back(at++);
  }
  std::vector<std::uint16_t> moved(p.registers.size());
  out.registers.assign(p.registers.begin(), p.registers.begin() + p.first_result());
  for (std::uint32_t i = 0; i < p.first_result(); ++i) moved[i] = static_cast<std::uint16_t>(i);
  for (const std::vector<std::uint32_t>* part : {&sines, &others})
    for (const std::uint32_t id : *part) {
      moved[id] = static_cast<std::uint16_t>(out.registers.size());
      out.registers.push_back(p.registers[id]);
    }
  out.channels.resize(p.channels.size() + sines.size());
  const auto move = [&](std::uint16_t& operand) { operand = moved[operand]; };
  for (Instruction& s : out.instructions) {
    if (s.op == OpCode::kDot) continue;
    move(s.a);
    const bool two = s.op == OpCode::kLinear || s.op == OpCode::kMultiply || s.op == OpCode::kMin ||
                     s.op == OpCode::kMax || s.op == OpCode::kEqual || s.op == OpCode::kLess;
    if (two) move(s.b);
  }
  for (ProductTerm& t : out.terms) move(t.a), move(t.b);
  for (Output& o : out.outputs) move(o.source);
  return out;
}

void generate(const std::string& name, const std::string& directory) {
  std::filesystem::create_directories(directory);
  const ReferenceMachine reference(name);
  const CompiledMachine& c = reference.compiled;
  write_file(directory + "/equation.h", c.header);
  write_file(directory + "/equation.cpp", c.source);
  write_file(directory + "/given.cpp", print_source(reference.machine, with_sines_given(c.program), 0));
  write_file(directory + "/machine.vimg", {c.image.begin(), c.image.end()});
  // What the image may be off by from the equation in double: its proved bound, in the order of the outputs.
  std::string bounds;
  for (const OutputBound& bound : c.bounds) bounds += fmt::format("{:.17g}\n", 1e3 * bound.total_um);
  write_file(directory + "/bounds.txt", bounds);
  const auto loaded = load_image(c.image, reference.machine);
  write_file(directory + "/chain.txt", print_chain(reference.machine, loaded->view));
  try {
    const Derivation d = compile::derive(reference.machine, 5e-6, c.evaluations);
    write_file(directory + "/flat.cpp",
               print_flat_double(reference.machine, d, c.program.channels, "flat_" + name));
  } catch (const InputError& e) {
    std::fprintf(stderr, "bench_generate: %s: no equation in double: %s\n", name.c_str(), e.what());
  }
}

}  // namespace
}  // namespace vernier::bench

int main(int argc, char** argv) {
  if (argc != 3) return std::fprintf(stderr, "usage: bench_generate MACHINE DIR\n"), 1;
  try {
    vernier::bench::generate(argv[1], argv[2]);
  } catch (const vernier::text::InputError& e) {
    return std::fprintf(stderr, "bench_generate: %s\n", e.what()), 1;
  }
  return 0;
}
