// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/compile/segments.h"

#include <cmath>
#include <stdexcept>

#include "tools/compile/builder.h"
#include "tools/compile/symbolic/functions.h"

namespace vernier::compile {
namespace {

constexpr double kRelativeTolerance = 1.0 / (1 << 26);  // of a function's range; a register has 31 bits
constexpr std::size_t kMostPieces = 1024;               // of a table that a small board holds

void split(Function f, std::int64_t low, std::int64_t high, double unit, double tolerance,
           std::vector<std::int64_t>& positions, double& error) {
  const Interval x{static_cast<double>(low) * unit, static_cast<double>(high) * unit};
  const double bound = std::pow(x.high - x.low, 4) / 384 * fourth_derivative_bound(f, x);
  if (bound <= tolerance || high - low <= 16 || positions.size() > kMostPieces) {
    positions.push_back(high);
    error = std::max(error, bound);
    return;
  }
  const std::int64_t middle = low + (high - low) / 2;
  split(f, low, middle, unit, tolerance, positions, error);
  split(f, middle, high, unit, tolerance, positions, error);
}

}  // namespace

Segment make_segment(std::int64_t start, std::int64_t end) {
  Segment s{};
  s.start = static_cast<std::int32_t>(start);
  s.length = static_cast<std::uint32_t>(end - start);
  // The largest shift with which ceil(2^(30+shift)/length) still fits 32 bits.
  for (s.shift = 33;; --s.shift) {
    const std::uint64_t one = std::uint64_t{1} << (30 + s.shift);
    const std::uint64_t reciprocal = (one + s.length - 1) / s.length;
    if (reciprocal > UINT32_MAX && s.shift > 0) continue;
    s.reciprocal = static_cast<std::uint32_t>(reciprocal);
    return s;
  }
}

std::vector<Segment> make_segments(const std::vector<std::int64_t>& positions) {
  std::vector<Segment> segments;
  for (std::size_t i = 0; i + 1 < positions.size(); ++i)
    segments.push_back(make_segment(positions[i], positions[i + 1]));
  return segments;
}

namespace {

// Sets the grid over the mean spacing. It is kept only if the board's own rule finds every piece
// with it.
void set_grid(LoweredTable& table) {
  const Segment last = segment_at(table.view().record(table.pieces - 1));
  const double span = static_cast<double>(last.start) + last.length - table.records[0];
  const double spacing = span / table.pieces;
  const int shift = std::min(63, 31 + std::ilogb(spacing));
  const double multiplier = std::round(std::ldexp(1.0, shift) / spacing);
  if (multiplier < 1 || multiplier > 4294967295.0) return;
  table.grid_multiplier = static_cast<std::uint32_t>(multiplier);
  table.grid_shift = static_cast<std::uint32_t>(shift);
  if (grid_finds_every_piece(table.view())) return;
  table.grid_multiplier = table.grid_shift = 0;
}

}  // namespace

LoweredTable make_table(const std::string& name, const std::vector<Segment>& segments, std::uint16_t degree,
                        const std::vector<std::vector<std::int32_t>>& columns) {
  LoweredTable table;
  table.name = name;
  table.degree = degree;
  table.columns = static_cast<std::uint16_t>(columns.size());
  table.pieces = static_cast<std::uint32_t>(segments.size());
  const std::ptrdiff_t width = degree + 1;
  for (std::size_t i = 0; i < segments.size(); ++i) {
    const Segment& s = segments[i];
    for (const std::uint32_t word : {static_cast<std::uint32_t>(s.start), s.length, s.reciprocal, s.shift})
      table.records.push_back(static_cast<std::int32_t>(word));
    for (const std::vector<std::int32_t>& column : columns) {
      const auto first = column.begin() + static_cast<std::ptrdiff_t>(i) * width;
      table.records.insert(table.records.end(), first, first + width);
    }
  }
  set_grid(table);
  return table;
}

Wrap make_wrap(std::int64_t first, std::int64_t period) {
  if (period < 4 || period > INT32_MAX)
    throw text::InputError("cannot be compiled: the period of the table does not fit the fixed-point format");
  Wrap w{};
  w.first = static_cast<std::int32_t>(first);
  w.period = static_cast<std::int32_t>(period);
  w.shift = static_cast<std::uint32_t>(30 + std::ilogb(static_cast<double>(period)));
  w.reciprocal = static_cast<std::int32_t>(((std::int64_t{1} << w.shift) + period / 2) / period);
  return w;
}

CubicPiece hermite(double near, double far, double near_slope, double far_slope) {
  const double rise = far - near;
  return {{near, near_slope, 3 * rise - 2 * near_slope - far_slope, -2 * rise + near_slope + far_slope}};
}

FunctionPieces make_pieces(Function f, std::int64_t low, std::int64_t high, int argument_bits) {
  const double unit = std::ldexp(1.0, -argument_bits);
  const Interval x{static_cast<double>(low) * unit, static_cast<double>(high) * unit};
  // Rounding of the argument may move it over the limit of the domain, which its exact range does
  // not exceed.
  const bool open_at_zero = f == Function::kLog || f == Function::kSqrt || f == Function::kReciprocal;
  if (open_at_zero && low <= 0 && (f != Function::kReciprocal || high >= 0))
    throw std::domain_error("the argument of the function comes too close to zero");
  FunctionPieces result;
  double size = f == Function::kSin || f == Function::kCos
                    ? 1
                    : std::max(std::abs(value_of(f, x.low)), std::abs(value_of(f, x.high)));
  std::vector<std::int64_t> positions;
  for (double tolerance = size * kRelativeTolerance;; tolerance *= 16) {
    positions.assign(1, low);
    result.error = 0;
    split(f, low, std::max(high, low + 1), unit, tolerance, positions, result.error);
    if (positions.size() <= kMostPieces) break;
  }
  result.segments = make_segments(positions);
  std::vector<CubicPiece> pieces;
  for (std::size_t i = 0; i + 1 < positions.size(); ++i) {
    const double a = static_cast<double>(positions[i]) * unit,
                 b = static_cast<double>(positions[i + 1]) * unit;
    pieces.push_back(
        hermite(value_of(f, a), value_of(f, b), slope_of(f, a) * (b - a), slope_of(f, b) * (b - a)));
    const double* const c = pieces.back().c;
    size = std::max(size, std::abs(c[0]) + std::abs(c[1]) + std::abs(c[2]) + std::abs(c[3]));
  }
  result.fraction_bits = fraction_bits_for(size * 1.01);
  for (const CubicPiece& piece : pieces)
    for (const double c : piece.c)
      result.coefficients.push_back(
          static_cast<std::int32_t>(std::llround(std::ldexp(c, result.fraction_bits))));
  // Four coefficients half an LSB each, the evaluation 5/2; the fraction truncates by less than 2^-29 of a
  // piece.
  result.error += 4.5 * std::ldexp(1.0, -result.fraction_bits) + size * std::ldexp(1.0, -29);
  result.slope = slope_bound(f, x);
  return result;
}

}  // namespace vernier::compile
