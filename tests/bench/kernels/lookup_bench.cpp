// SPDX-License-Identifier: GPL-3.0-or-later
// Table look-ups beside their peers: three axes of six errors, 64 stations, one position each.
#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include "comp/error_table.h"
#include "comp/sine.h"
#include "comp/three_tables.h"
#include "comp/verify.h"
#include "tests/bench/kernels/counted.h"

#ifdef VERNIER_WITH_GSL
#include <gsl/gsl_interp.h>
#endif

namespace vernier::bench {
namespace {

constexpr std::size_t kStations = 64, kAxes = 3, kColumns = 6, kPoses = 256;
constexpr std::int32_t kLength = 9375000;  // nm between stations

constexpr std::uint32_t kPieces = kStations - 1;

/// One axis as the compiler writes it: even stations, six columns.
template <unsigned kDegree>
struct Axis {
  static constexpr std::uint32_t kStride = kSegmentWords + kColumns * (kDegree + 1);
  alignas(64) std::int32_t records[kPieces * kStride];
  ErrorTable table{records, kPieces, kColumns, kDegree, kGridMultiplier, kGridShift};
  static constexpr std::uint32_t kGridShift = 54;
  static constexpr auto kGridMultiplier =
      static_cast<std::uint32_t>(((std::uint64_t{1} << kGridShift) + kLength / 2) / kLength);
};

struct Tables {
  double at[kStations];
  double value[kAxes][kStations][kColumns];   // interleaved
  double column[kAxes][kColumns][kStations];  // the same, column by column
  Axis<1> linear[kAxes];
  Axis<3> cubic[kAxes];
  std::int32_t position[kPoses][kAxes];
};
Tables t;

using Positions = std::int32_t[kPoses][kAxes];
Positions first_station, last_station, far_beyond;

template <unsigned kDegree>
void fill_axis(Axis<kDegree>& axis, std::size_t a, std::mt19937_64& random) {
  for (std::size_t s = 0; s < kPieces; ++s) {
    std::int32_t* record = axis.records + s * Axis<kDegree>::kStride;
    const Segment segment{static_cast<std::int32_t>(s) * kLength, kLength,
                          static_cast<std::uint32_t>(((std::uint64_t{1} << 54) + kLength - 1) / kLength), 24};
    std::memcpy(record, &segment, sizeof(segment));
    record += kSegmentWords;
    for (std::size_t c = 0; c < kColumns; ++c) {
      *record++ = static_cast<std::int32_t>(t.value[a][s][c]);
      *record++ = static_cast<std::int32_t>(t.value[a][s + 1][c] - t.value[a][s][c]);
      for (unsigned k = 2; k <= kDegree; ++k) *record++ = static_cast<std::int32_t>(random() % 20001) - 10000;
    }
  }
  if (!grid_finds_every_piece(axis.table))
    std::fprintf(stderr, "the bench's own grid is wrong\n"), std::exit(1);
}

void fill() {
  std::mt19937_64 random(20261121);
  for (std::size_t s = 0; s < kStations; ++s) t.at[s] = static_cast<double>(s) * kLength;
  for (std::size_t a = 0; a < kAxes; ++a)
    for (std::size_t s = 0; s < kStations; ++s)
      for (std::size_t c = 0; c < kColumns; ++c)
        t.value[a][s][c] = t.column[a][c][s] =
            static_cast<std::int32_t>(random() % 100001) - 50000;  // nm, nrad
  for (std::size_t a = 0; a < kAxes; ++a) {
    fill_axis(t.linear[a], a, random);
    fill_axis(t.cubic[a], a, random);
  }
  for (std::size_t i = 0; i < kPoses; ++i)
    for (std::size_t a = 0; a < kAxes; ++a) {
      last_station[i][a] = static_cast<std::int32_t>(kPieces) * kLength;
      far_beyond[i][a] = a == 1 ? INT32_MAX : INT32_MIN;
    }
  for (auto& pose : t.position)
    for (std::int32_t& p : pose) p = static_cast<std::int32_t>(random() % (std::uint64_t{kPieces} * kLength));
}

void look_up_double(const double* position, double out[kAxes][kColumns]) {
  for (std::size_t a = 0; a < kAxes; ++a) {
    const auto far = std::clamp<std::ptrdiff_t>(std::upper_bound(t.at, t.at + kStations, position[a]) - t.at,
                                                1, kStations - 1);
    const double f = (position[a] - t.at[far - 1]) / (t.at[far] - t.at[far - 1]);
    const double* const near = t.value[a][far - 1];
    for (std::size_t c = 0; c < kColumns; ++c) out[a][c] = near[c] + f * (near[c + kColumns] - near[c]);
  }
}

template <unsigned kDegree>
void look_up_fixed(const Axis<kDegree>* axes, const std::int32_t* position,
                   std::int32_t out[kAxes][kColumns]) {
  for (std::size_t a = 0; a < kAxes; ++a) look_up<kDegree, kColumns>(axes[a].table, position[a], out[a]);
}
template <unsigned kDegree>
void look_up_any(const Axis<kDegree>* axes, const std::int32_t* position, std::int32_t out[kAxes][kColumns]) {
  for (std::size_t a = 0; a < kAxes; ++a) look_up(axes[a].table, position[a], out[a]);
}

#if VERNIER_THREE_TABLES
ThreeTables three;
void look_up_lanes(const Axis<1>*, const std::int32_t* position, std::int32_t out[kAxes][kColumns]) {
  look_up_three(&three, lanes::Int4{position[0], position[1], position[2], position[2]}, out[0]);
}
#endif

template <auto kLookUp, unsigned kDegree>
Case over(const char* name, const Positions& positions, const Axis<kDegree>* axes) {
  return {name, [=, &positions](std::size_t n) {
            for (std::size_t i = 0; i < n; ++i) {
              std::int32_t out[kAxes][kColumns];
              kLookUp(axes, positions[i % kPoses], out);
              keep(out);
            }
          }};
}

/// Error, bias and cache lines of the linear look-up over many positions, in the tables' own LSB.
int check() {
  std::mt19937_64 random_position(7);
  constexpr int kCount = 1000000;
  double worst = 0, sum = 0;
  std::size_t lines = 0;
  for (int i = 0; i < kCount; ++i) {
    const std::size_t a = random_position() % kAxes;
    const auto p = static_cast<std::int32_t>(random_position() % (std::uint64_t{kPieces} * kLength));
    std::int32_t out[kColumns];
    look_up<1, kColumns>(t.linear[a].table, p, out);
    const auto piece = static_cast<std::size_t>(p / kLength);
    const double f = static_cast<double>(p % kLength) / kLength;
    for (std::size_t c = 0; c < kColumns; ++c) {
      const double error =
          out[c] - (t.value[a][piece][c] + f * (t.value[a][piece + 1][c] - t.value[a][piece][c]));
      worst = std::max(worst, std::abs(error));
      sum += error;
    }
  }
  // The records as an image holds them start at any multiple of 8 bytes.
  constexpr std::size_t kBytes = Axis<1>::kStride * 4;
  for (std::size_t start = 0; start < 64; start += 8) lines = std::max(lines, (start + kBytes - 1) / 64 + 1);
  std::printf(
      "linear look-up: max error %.4f LSB, bias %+.6f LSB, %zu cache lines for 3 axes (%zu where the buffer "
      "is aligned to 64)\n",
      worst, sum / (kCount * static_cast<double>(kColumns)), kAxes * lines, kAxes * ((kBytes + 63) / 64));
  return worst <= 0.51 && std::abs(sum) <= 0.01 * kCount * kColumns ? 0 : 1;
}

std::vector<Case> cases() {
  std::vector<Case> list;
  list.push_back(over<look_up_fixed<1>>("linear_6x3/vernier", t.position, t.linear));
  list.push_back(over<look_up_fixed<1>>("linear_6x3/vernier_first_station", first_station, t.linear));
  list.push_back(over<look_up_fixed<1>>("linear_6x3/vernier_last_station", last_station, t.linear));
  list.push_back(over<look_up_fixed<1>>("linear_6x3/vernier_far_beyond", far_beyond, t.linear));
#if VERNIER_THREE_TABLES
  three = three_tables(t.linear[0].table, t.linear[1].table, t.linear[2].table);
  list.push_back(over<look_up_lanes>("linear_6x3/vernier_three_tables", t.position, t.linear));
  list.push_back(over<look_up_lanes>("linear_6x3/vernier_three_tables_far_beyond", far_beyond, t.linear));
#endif
  list.push_back(over<look_up_any<1>>("linear_6x3/vernier_in_programs", t.position, t.linear));
  list.push_back(over<look_up_fixed<3>>("cubic_6x3/vernier", t.position, t.cubic));
  list.push_back(over<look_up_any<3>>("cubic_6x3/vernier_in_programs", t.position, t.cubic));
  list.push_back({"sine_cosine/vernier", [](std::size_t n) {
                    for (std::size_t i = 0; i < n; ++i) {
                      const SineCosine both =
                          sine_cosine(static_cast<std::uint32_t>(t.position[i % kPoses][0]) * 8);
                      keep(both);
                    }
                  }});
  list.push_back({"sine_cosine/libm", [](std::size_t n) {
                    for (std::size_t i = 0; i < n; ++i) {
                      const double angle = t.position[i % kPoses][0] * 1e-8;
                      double both[2] = {std::sin(angle), std::cos(angle)};
                      keep(both);
                    }
                  }});
  list.push_back({"linear_6x3/double_interleaved", [](std::size_t n) {
                    for (std::size_t i = 0; i < n; ++i) {
                      double out[kAxes][kColumns], p[kAxes];
                      for (std::size_t a = 0; a < kAxes; ++a) p[a] = t.position[i % kPoses][a];
                      look_up_double(p, out);
                      keep(out);
                    }
                  }});
#ifdef VERNIER_WITH_GSL
  for (const bool cubic : {false, true})
    list.push_back({cubic ? "cubic_6x3/gsl_cspline" : "linear_6x3/gsl_linear", [cubic](std::size_t n) {
                      static gsl_interp* interp[2][kAxes][kColumns] = {};
                      static gsl_interp_accel* accel[kAxes];
                      for (std::size_t i = 0; i < n; ++i) {
                        double out[kAxes][kColumns];
                        for (std::size_t a = 0; a < kAxes; ++a)
                          for (std::size_t c = 0; c < kColumns; ++c) {
                            gsl_interp*& g = interp[cubic][a][c];
                            if (accel[a] == nullptr) accel[a] = gsl_interp_accel_alloc();
                            if (g == nullptr) {
                              g = gsl_interp_alloc(cubic ? gsl_interp_cspline : gsl_interp_linear, kStations);
                              gsl_interp_init(g, t.at, t.column[a][c], kStations);
                            }
                            out[a][c] =
                                gsl_interp_eval(g, t.at, t.column[a][c], t.position[i % kPoses][a], accel[a]);
                          }
                        keep(out);
                      }
                    }});
#endif
  return list;
}

}  // namespace
}  // namespace vernier::bench

int main(int argc, char** argv) {
  vernier::bench::fill();
  if (argc > 1 && std::string(argv[1]) == "check") return vernier::bench::check();
  return vernier::bench::measure(vernier::bench::cases(), argc, argv);
}
