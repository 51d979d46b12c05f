// SPDX-License-Identifier: GPL-3.0-or-later
// The equation of one reference machine in every form, and its peers, over the same seeded poses:
// machine_bench DIR list | count CASE N | time | check. Built by tests/bench/run, which prints the table.
#include <algorithm>
#include <cmath>
#include <fstream>
#include <memory>

#include "comp/dense.h"
#include "comp/verify.h"
#include "tests/bench/kernels/counted.h"
#include "tests/bench/kernels/frame_peers.h"
#include "tests/bench/poses.h"

#ifdef __x86_64__
#include <emmintrin.h>
#endif

// The printed equation of the machine, and the same with its sines and cosines given.
namespace vernier::generated {
void equation(const std::int32_t* channel, LagState* lag, bool starting, std::int32_t* deviation) noexcept;
}
namespace vernier::given {
void equation(const std::int32_t* channel, LagState* lag, bool starting, std::int32_t* deviation) noexcept;
}
#ifndef VERNIER_NO_FLAT
namespace vernier::VERNIER_FLAT {
void flat(const double* channel, double* deviation);
}
#endif

namespace vernier::bench {
namespace {

constexpr std::size_t kPoses = 64;

struct Bench {
  std::unique_ptr<std::uint64_t[]> words;
  std::uint32_t bytes = 0;
  ImageView view;
  std::vector<CycleInput> poses;
  std::vector<std::vector<std::int32_t>> registers;  // per pose, constants and channels in place
  std::vector<std::vector<std::int32_t>> given;      // channels, then sines and cosines
  std::vector<std::vector<double>> real_channels;    // the same in double
  std::unique_ptr<Compensator> compensator;
  LagState lags[kMaxLags] = {};
  std::vector<Chain> chains;
  std::vector<DenseCell> cells;
  std::vector<DenseFrame> frames;  // per pose, constants and channels in place

  const Program& program() const { return view.program(); }
  DenseMemory dense(std::size_t pose) {
    return {cells.data(), static_cast<std::uint32_t>(cells.size()), &frames[pose]};
  }
};

// Units of one count: mm or deg, mm/s..., 1; as the compiler takes them.
double unit_of(const Bench& b, const Channel& c) {
  const bool rotary = c.kind <= ChannelKind::kSince && (b.view.axes()[c.index].flags & kRotary) != 0;
  switch (c.kind) {
    case ChannelKind::kSense:
    case ChannelKind::kVisit:
      return 1;
    case ChannelKind::kCurvature:
      return 1e-9;
    default:
      return rotary ? 360 / 4294967296.0 : 1e-6;
  }
}

double quantity_of(const Bench& b, const Channel& c, const CycleInput& input) {
  const auto value = [&]() -> std::int64_t {
    const AxisInput& axis = input.axis[c.index % kMaxAxes];
    switch (c.kind) {
      case ChannelKind::kPosition:
        return axis.position.count;
      case ChannelKind::kVelocity:
        return axis.velocity.count;
      case ChannelKind::kAcceleration:
        return axis.acceleration.count;
      case ChannelKind::kSense:
        return axis.sense;
      case ChannelKind::kSince:
        return axis.since.count;
      case ChannelKind::kInput:
        return input.input[c.index].count;
      case ChannelKind::kFeed:
        return input.feed.count;
      case ChannelKind::kCurvature:
        return input.curvature.count;
      case ChannelKind::kTime:
        return input.time.count;
      default:
        return input.visit.count;
    }
  }();
  return static_cast<double>(std::clamp(value, c.low, c.high)) * unit_of(b, c);
}

void read_image(const std::string& directory, Bench& b) {
  std::ifstream file(directory + "/machine.vimg", std::ios::binary);
  std::vector<char> bytes((std::istreambuf_iterator<char>(file)), {});
  b.bytes = static_cast<std::uint32_t>(bytes.size());
  b.words = std::make_unique<std::uint64_t[]>(bytes.size() / 8 + 8);
  std::copy(bytes.begin(), bytes.end(), reinterpret_cast<char*>(b.words.get()));
  static ImageWorkspace workspace;
  const ImageFault fault =
      b.view.open(reinterpret_cast<const std::uint8_t*>(b.words.get()), b.bytes, workspace);
  if (fault != ImageFault::kNone)
    std::fprintf(stderr, "%s: %s\n", directory.c_str(), describe(fault)), std::exit(1);
}

std::vector<std::int32_t> given_channels(const Bench& b) {
  const Equation& e = b.program().equation;
  std::vector<std::int32_t> given;
  for (std::uint32_t r = e.first_channel(); r < e.first_result(); ++r)
    given.push_back(b.compensator->register_value(r));
  std::uint32_t at = e.first_result();
  for (const Instruction& step : e.instructions) {
    if (step.op == OpCode::kSineCosine)
      for (std::uint32_t k = 0; k < 2; ++k) given.push_back(b.compensator->register_value(at + k));
    at += results_of(step, e.tables);
  }
  return given;
}

void make_poses(Bench& b) {
  Poses poses(b.view);
  b.compensator = std::make_unique<Compensator>(b.program());
  const std::uint32_t inputs = b.program().equation.first_result();
  for (std::size_t i = 0; i < kPoses; ++i) {
    b.poses.push_back(poses.next());
    b.compensator->step(b.poses.back());
    std::vector<std::int32_t> registers(kMaxRegisters);
    for (std::uint32_t r = 0; r < inputs; ++r) registers[r] = b.compensator->register_value(r);
    b.registers.push_back(std::move(registers));
    b.given.push_back(given_channels(b));
    std::vector<double> real;
    for (const Channel& c : b.program().channels) real.push_back(quantity_of(b, c, b.poses.back()));
    b.real_channels.push_back(std::move(real));
  }
  const Equation& e = b.program().equation;
  b.cells.resize(dense_size(e));
  b.frames.resize(kPoses + 1);  // the last one for the whole tick
  for (std::size_t i = 0; i < kPoses; ++i) {
    if (!make_dense(e, b.dense(i))) std::fprintf(stderr, "no dense form\n"), std::exit(1);
    for (std::uint32_t r = e.first_channel(); r < inputs; ++r) b.frames[i].registers[r] = b.registers[i][r];
    b.frames[i].lags = b.lags;
  }
  b.compensator = std::make_unique<Compensator>(b.program());
  b.compensator->use_dense(b.dense(kPoses));
}

void print_equation(Bench& b, std::size_t i, std::int32_t* deviation) {
  generated::equation(b.registers[i].data() + b.program().equation.first_channel(), b.lags, i == 0,
                      deviation);
}

/// Printed against executed, bit for bit, and against the same equation in double: within the proved bound
/// (nm; of a turning axis at a metre from it).
int check(Bench& b, const std::string& directory) {
  std::ifstream bounds(directory + "/bounds.txt");
  double bound_nm[kMaxAxes];
  std::fill(bound_nm, bound_nm + kMaxAxes, INFINITY);
  for (std::uint32_t k = 0; k < b.program().outputs.size && bounds >> bound_nm[k]; ++k) continue;
  LagState lags[kMaxLags] = {};
  double worst_nm = 0;
  bool known = false;
  for (std::size_t i = 0; i < kPoses; ++i) {
    LagState lags_before[kMaxLags];
    std::copy(lags, lags + kMaxLags, lags_before);
    run_equation(b.program().equation, b.registers[i].data(), lags, i == 0);
    LagState dense_lags[kMaxLags] = {};
    std::copy(lags_before, lags_before + kMaxLags, dense_lags);
    b.frames[i].lags = dense_lags;
    b.frames[i].starting = i == 0;
    run_dense(b.dense(i));
    b.frames[i].lags = b.lags;
    b.frames[i].starting = false;
    const auto same = [](std::int32_t executed, Word dense) { return executed == dense; };
    if (!std::equal(b.registers[i].begin(), b.registers[i].begin() + b.program().equation.register_count(),
                    b.frames[i].registers, same))
      return std::fprintf(stderr, "dense and executed form differ at pose %zu\n", i), 1;
    std::int32_t printed[kMaxAxes] = {};
    double flat[kMaxAxes] = {};
    print_equation(b, i, printed);
    std::int32_t given[kMaxAxes] = {};
    if (b.program().equation.lag_count == 0) {
      given::equation(b.given[i].data(), lags, false, given);
      if (!std::equal(given, given + kMaxAxes, printed))
        return std::fprintf(stderr, "given sines differ\n"), 1;
    }
#ifndef VERNIER_NO_FLAT
    VERNIER_FLAT::flat(b.real_channels[i].data(), flat);
#else
    std::fill(flat, flat + kMaxAxes, NAN);
#endif
    for (std::uint32_t k = 0; k < b.program().outputs.size; ++k) {
      const Output& out = b.program().outputs[k];
      const std::int32_t executed = b.registers[i][out.source];
      if (executed != printed[k])
        return std::fprintf(stderr, "printed and executed form differ at pose %zu\n", i), 1;
      const double counts =
          std::ldexp(static_cast<double>(executed) * out.multiplier, -static_cast<int>(out.shift));
      const bool rotary = (b.view.axes()[out.axis].flags & kRotary) != 0;
      // Counts are nm, or 2^-32 turns; the equation is in mm, or deg.
      constexpr double kNmPerCountAtMetre = 2 * 3.14159265358979323846 * 1e9 / 4294967296.0;
      const double per_unit = rotary ? 4294967296.0 / 360 : 1e6,
                   nm_per_count = rotary ? kNmPerCountAtMetre : 1;
      if (std::isnan(flat[k])) continue;
      const double off_nm = nm_per_count * std::abs(counts - flat[k] * per_unit);
      known = true;
      worst_nm = std::max(worst_nm, off_nm);
      if (!rotary && off_nm > bound_nm[k] + 1)
        return std::fprintf(stderr, "pose %zu: %.3f nm from the equation in double, proved %.3f\n", i, off_nm,
                            bound_nm[k]),
               1;
    }
  }
  std::printf("operations %u\nimage_bytes %u\nnm_from_double %s\n", b.program().equation.instructions.size,
              b.bytes, known ? std::to_string(worst_nm).c_str() : "absent");
  return 0;
}

void flush(const void* from, std::size_t bytes) {
#ifdef __x86_64__
  const char* const at = static_cast<const char*>(from);
  for (std::size_t i = 0; i < bytes; i += 64) _mm_clflush(at + i);
  _mm_mfence();
#else
  (void)from, (void)bytes;
#endif
}

std::vector<Case> cases_of(Bench& b) {
  std::vector<Case> cases;
  const auto over_poses = [&cases](const char* name, auto body) {
    cases.push_back({name, [body](std::size_t n) {
                       for (std::size_t i = 0; i < n; ++i) body(i % kPoses);
                     }});
  };
  over_poses("step", [&b](std::size_t i) { keep(b.compensator->step(b.poses[i])); });
  over_poses("interpreted", [&b](std::size_t i) {
    run_equation(b.program().equation, b.registers[i].data(), b.lags, false);
  });
  over_poses("executed", [&b](std::size_t i) { run_dense(b.dense(i)); });
  over_poses("printed", [&b](std::size_t i) {
    std::int32_t deviation[kMaxAxes];
    generated::equation(b.registers[i].data() + b.program().equation.first_channel(), b.lags, false,
                        deviation);
    keep(deviation);
  });
  over_poses("given", [&b](std::size_t i) {
    std::int32_t deviation[kMaxAxes];
    given::equation(b.given[i].data(), b.lags, false, deviation);
    keep(deviation);
  });
#ifndef VERNIER_NO_FLAT
  over_poses("double", [&b](std::size_t i) {
    double deviation[kMaxAxes];
    VERNIER_FLAT::flat(b.real_channels[i].data(), deviation);
    keep(deviation);
  });
#endif
#ifdef VERNIER_WITH_EIGEN
  over_poses("eigen", [&b](std::size_t i) { keep(eigen_chain(b.chains[i])); });
#endif
#ifdef VERNIER_WITH_KDL
  over_poses("kdl", [&b](std::size_t i) { keep(kdl_chain(b.chains[i])); });
#endif
  over_poses("step_cold", [&b](std::size_t i) {
    flush(b.words.get(), b.bytes);
    flush(b.cells.data(), b.cells.size() * sizeof(DenseCell));
    keep(b.compensator->step(b.poses[i]));
  });
  over_poses("flush_alone", [&b](std::size_t) {
    flush(b.words.get(), b.bytes);
    flush(b.cells.data(), b.cells.size() * sizeof(DenseCell));
  });
  over_poses("step_low", [&b](std::size_t) { keep(b.compensator->step(b.poses[0])); });
  return cases;
}

}  // namespace
}  // namespace vernier::bench

int main(int argc, char** argv) {
  if (argc < 3)
    return std::fprintf(stderr, "usage: machine_bench DIR list | count CASE N | time | check\n"), 1;
  using namespace vernier::bench;
  static Bench bench;
  read_image(argv[1], bench);
  make_poses(bench);
  bench.chains = read_chains(std::string(argv[1]) + "/chain.txt");
  if (std::string(argv[2]) == "check") return check(bench, argv[1]);
  return measure(cases_of(bench), argc - 1, argv + 1);
}
