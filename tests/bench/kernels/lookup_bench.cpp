// Table look-ups beside their peers: three axes of six errors, 64 stations, one position each.
#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include "comp/error_table.h"
#include "tests/bench/kernels/counted.h"

#ifdef VERNIER_WITH_GSL
#include <gsl/gsl_interp.h>
#endif

namespace vernier::bench {
namespace {

constexpr std::size_t kStations = 64, kAxes = 3, kColumns = 6, kPoses = 256;
constexpr std::int32_t kLength = 9375000;  // nm between stations

struct Tables {
  double at[kStations];
  double value[kAxes][kStations][kColumns];   // interleaved
  double column[kAxes][kColumns][kStations];  // the same, column by column
  std::int32_t integer[kAxes][kColumns][kStations];
  Segment segments[kStations - 1];
  std::int32_t position[kPoses][kAxes];
};
Tables t;

void fill() {
  std::mt19937_64 random(20261121);
  for (std::size_t s = 0; s < kStations; ++s) t.at[s] = static_cast<double>(s) * kLength;
  for (std::size_t s = 0; s + 1 < kStations; ++s)
    t.segments[s] = {static_cast<std::int32_t>(s) * kLength, kLength,
                     static_cast<std::uint32_t>(((std::uint64_t{1} << 54) + kLength - 1) / kLength), 24};
  for (std::size_t a = 0; a < kAxes; ++a)
    for (std::size_t s = 0; s < kStations; ++s)
      for (std::size_t c = 0; c < kColumns; ++c) {
        const auto v = static_cast<std::int32_t>(random() % 100001) - 50000;  // nm, nrad
        t.value[a][s][c] = t.column[a][c][s] = t.integer[a][c][s] = v;
      }
  for (auto& pose : t.position)
    for (std::int32_t& p : pose)
      p = static_cast<std::int32_t>(random() % (std::uint64_t{kStations - 1} * kLength));
}

void look_up_now(const std::int32_t* position, std::int32_t out[kAxes][kColumns]) {
  for (std::size_t a = 0; a < kAxes; ++a) {
    const View<Segment> view{t.segments, kStations - 1};
    const std::uint32_t i = segment_of(view, position[a]);
    const std::int32_t f = fraction_in(view[i], position[a]);
    for (std::size_t c = 0; c < kColumns; ++c)
      out[a][c] = linear_between(t.integer[a][c][i], t.integer[a][c][i + 1], f);
  }
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

std::vector<Case> cases() {
  std::vector<Case> list;
  list.push_back({"linear_6x3/vernier", [](std::size_t n) {
                    for (std::size_t i = 0; i < n; ++i) {
                      std::int32_t out[kAxes][kColumns];
                      look_up_now(t.position[i % kPoses], out);
                      keep(out);
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
  if (argc > 1 && std::string(argv[1]) == "check") return 0;
  return vernier::bench::measure(vernier::bench::cases(), argc, argv);
}
