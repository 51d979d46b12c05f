// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/compile/lower.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <stdexcept>

#include "tools/compile/builder.h"
#include "tools/compile/segments.h"
#include "tools/compile/symbolic/functions.h"
#include "tools/format/columns.h"
#include "tools/model/station_table.h"

namespace vernier::compile {
namespace {

constexpr int kUnitBits =
    30;  // format of -1, 0, 1: as fine as int32 allows, so that factors keep their digits
const double kTurnUnit = 360.0 / 4294967296.0;  // deg of one count of a rotary axis

double unit_of(const model::Machine& machine, ChannelKind kind, std::size_t index) {
  switch (kind) {
    case ChannelKind::kPosition:
    case ChannelKind::kVelocity:
    case ChannelKind::kAcceleration:
    case ChannelKind::kSince:
      return machine.axes[index].rotary ? kTurnUnit : 1e-6;
    case ChannelKind::kSense:
    case ChannelKind::kVisit:
      return 1;
    case ChannelKind::kCurvature:
      return 1e-9;
    case ChannelKind::kInput:
    case ChannelKind::kFeed:
    case ChannelKind::kTime:
      return 1e-6;
  }
  return 1;
}

std::string channel_name(const model::Machine& machine, ChannelKind kind, std::size_t index) {
  switch (kind) {
    case ChannelKind::kPosition:
      return machine.axes[index].name;
    case ChannelKind::kVelocity:
      return "v_" + machine.axes[index].name;
    case ChannelKind::kAcceleration:
      return "a_" + machine.axes[index].name;
    case ChannelKind::kSense:
      return "dir_" + machine.axes[index].name;
    case ChannelKind::kSince:
      return "since_" + machine.axes[index].name;
    case ChannelKind::kInput:
      return machine.inputs[index].name;
    case ChannelKind::kFeed:
      return format::columns::kFeed;
    case ChannelKind::kCurvature:
      return format::columns::kCurvature;
    case ChannelKind::kTime:
      return "time_s";
    case ChannelKind::kVisit:
      return format::columns::kVisit;
  }
  return "channel";
}

class Lowering {
 public:
  /// most_shared: sums with (terms - 1) * (uses - 1) up to this number are added term by term at
  /// each use.
  Lowering(const model::Machine& machine, const Derivation& d, std::uint32_t tick_us, std::size_t most_shared)
      : machine_(machine), d_(d), g_(d.graph), tick_us_(tick_us), most_shared_(most_shared) {}

  LoweredProgram run() {
    for (const AxisDeviation& out : d_.outputs) note_use(out.value);
    keep_pieces_of_bounds();
    std::vector<std::pair<Output, ProgramBuilder::Id>> outputs;
    for (const AxisDeviation& out : d_.outputs) {
      wanted_name_ = "deviation_" + machine_.axes[out.axis].name;
      const Id id = value(out.value);
      outputs.emplace_back(output_of(out.axis, id), id);
    }
    std::map<NodeId, std::uint32_t> register_of;
    for (const auto& [node, id] : done_) register_of[node] = b_.final_id(id);
    LoweredProgram program = b_.finish(outputs);
    program.register_of = std::move(register_of);
    return program;
  }

  /// The first `most` shares. The caller tests by the registers whether they fit.
  LoweredShares run_shares(const LoweredProgram& tick, std::size_t most, std::size_t& registers) {
    tick_ = &tick;
    for (const EffectPart& part : d_.parts)
      for (const NodeId id : part.outputs) note_use(id);
    LoweredShares result;
    std::vector<Id> ids;
    for (const EffectPart& part : d_.parts)
      for (std::size_t i = 0; i < d_.outputs.size(); ++i) {
        if (g_.is_zero(part.outputs[i])) continue;
        ++result.left_out;
        if (ids.size() == most) continue;
        try {
          ids.push_back(value(part.outputs[i]));
        } catch (const text::InputError&) {
          continue;
        }
        const Output out = output_of(d_.outputs[i].axis, ids.back());
        result.shares.push_back({out.axis, 0, out.shift, out.multiplier});
        result.names.push_back(part.name);
        result.largest.push_back(g_[part.outputs[i]].range.magnitude());
        --result.left_out;
      }
    for (std::size_t i = 0; i < ids.size(); ++i)
      result.shares[i].source = static_cast<std::uint16_t>(b_.final_id(ids[i]));
    registers = b_.size();
    LoweredProgram program = b_.finish({});
    result.constants = std::move(program.constants);
    result.instructions = std::move(program.instructions);
    result.terms = std::move(program.terms);
    result.sources = sources_;
    return result;
  }

 private:
  using Id = ProgramBuilder::Id;

  Output output_of(std::size_t axis, Id id) const {
    const model::Axis& a = machine_.axes[axis];
    const double per_unit = 1 / unit_of(machine_, ChannelKind::kPosition, axis);
    const double factor = std::ldexp(per_unit, -b_.at(id).fraction_bits);
    const int shift = std::clamp(29 - std::ilogb(factor), 0, static_cast<int>(kMaxShift));
    const auto counts = [](std::optional<double> units, double per) {
      return units ? static_cast<std::int32_t>(std::min(2147483647.0, std::floor(*units * per + 1e-6)))
                   : INT32_MAX;
    };
    Output out{};
    out.axis = static_cast<std::uint16_t>(axis);
    out.shift = static_cast<std::uint32_t>(shift);
    out.multiplier = static_cast<std::int32_t>(std::llround(std::ldexp(factor, shift)));
    out.limit = counts(a.max_correction, per_unit);
    out.slew = counts(a.max_slew, per_unit * tick_us_ * 1e-6);
    return out;
  }

  Id value(NodeId node) {
    const auto found = done_.find(node);
    if (found != done_.end()) return found->second;
    const std::string name = std::exchange(wanted_name_, {});
    const Id id = make(node, name);
    done_[node] = id;
    if (given_.contains(node)) b_.give(id);
    return id;
  }

  Id make(NodeId node, const std::string& name) {
    const Node& n = g_[node];
    if (tick_ != nullptr && n.kind != NodeKind::kConstant) {
      const auto known = tick_->register_of.find(node);
      if (known != tick_->register_of.end()) {
        sources_.push_back(static_cast<std::uint16_t>(known->second));
        return b_.imported(*tick_, known->second);
      }
      const bool looked_up = n.kind == NodeKind::kChannel || n.kind == NodeKind::kTable ||
                             n.kind == NodeKind::kFunction || n.kind == NodeKind::kLag;
      if (looked_up)
        throw text::InputError(
            "the contribution of an effect uses a value that the program of the control cycle does not "
            "compute");
    }
    switch (n.kind) {
      case NodeKind::kConstant:
        return b_.constant(n.number);
      case NodeKind::kChannel:
        return channel(n);
      case NodeKind::kSum:
        return sum(n, name);
      case NodeKind::kProduct: {
        const Id a = value(n.args[0]), b = value(n.args[1]);
        return b_.product(
            a, b, n.range,
            name.empty() ? short_name(b_.at(a).name + "_times_" + b_.at(b).name, "product") : name);
      }
      case NodeKind::kTable:
        return table(n);
      case NodeKind::kFunction:
        return function(n);
      case NodeKind::kLag:
        return lag(n);
      default:
        return choice(n);
    }
  }

  static std::string short_name(const std::string& name, const char* otherwise) {
    return name.size() <= 40 ? name : otherwise;
  }

  Id channel(const Node& n) {
    const double unit = unit_of(machine_, n.channel, n.index[0]);
    Channel c{};
    c.kind = n.channel;
    c.index = static_cast<std::uint8_t>(n.index[0]);
    c.low = std::llround(n.range.low / unit);
    c.high = std::llround(n.range.high / unit);
    double reach = 0;
    if (n.channel == ChannelKind::kPosition) {
      const model::Axis& axis = machine_.axes[n.index[0]];
      if (const model::Table* const t = machine_.table_of(n.index[0]))
        reach = std::max(std::abs(t->stations.front().loc), std::abs(t->stations.back().loc));
      // At least one revolution. Positions beyond it wrap around.
      if (axis.rotary && axis.rollover && c.high - c.low >= kTurnCounts) c.wrap = kTurnCounts;
    }
    return b_.channel(c, unit, reach, channel_name(machine_, n.channel, n.index[0]));
  }

  // Gives separate registers to the values that the bounds of the least squares and of the
  // direction use.
  void keep_pieces_of_bounds() {
    for (const Evaluation& e : d_.before) {
      given_.insert(e.values.begin(), e.values.end());
      given_.insert(e.orientation.begin(), e.orientation.end());
    }
    if (d_.orientation) {
      given_.insert(d_.orientation->values.begin(), d_.orientation->values.end());
      kept_.insert(d_.last_direction.begin(), d_.last_direction.end());
    }
    if (!d_.least_squares) return;
    const LeastSquares& l = *d_.least_squares;
    for (const auto* const matrix : {&l.jacobian, &l.square, &l.adjugate})
      for (const std::vector<NodeId>& row : *matrix) kept_.insert(row.begin(), row.end());
    kept_.insert(l.deviation.begin(), l.deviation.end());
    kept_.insert(l.weights.begin(), l.weights.end());
    kept_.insert({l.determinant, l.reciprocal});
  }

  // Registers the uses of the outputs: columns of tables are interpolated together, sine and
  // cosine are computed together.
  void note_use(NodeId node) {
    if (++uses_[node] > 1) return;
    const Node& n = g_[node];
    if (n.kind == NodeKind::kTable) columns_[{n.index[0], n.args[0]}][n.index[1]] = node;
    if (n.kind == NodeKind::kFunction && n.function == Function::kSin) sines_[n.args[0]] = node;
    if (n.kind == NodeKind::kFunction && n.function == Function::kCos) cosines_[n.args[0]] = node;
    for (const NodeId arg : n.args) {
      factors_.insert(arg);
      note_use(arg);
    }
    for (const Term& term : n.terms) note_use(term.node);
  }

  // Is it faster to add the terms of a sum to the sums that use it than to give it a register? A
  // register needs a rounding, and a multiplication and an addition per use. False if a
  // coefficient would separate a product from its fusion.
  bool goes_into_sums(NodeId id, double coefficient) const {
    const Node& n = g_[id];
    if (n.kind != NodeKind::kSum || kept_.contains(id) || factors_.contains(id)) return false;
    if (tick_ != nullptr && tick_->register_of.contains(id)) return false;
    const std::size_t more_uses = uses_.at(id) - 1;
    if (more_uses > 0 && (flat_size(id) - 1) * more_uses > most_shared_) return false;
    return std::abs(coefficient) == 1 ||
           std::none_of(n.terms.begin(), n.terms.end(), [&](const Term& t) { return fuses(t); });
  }
  void collect(double k, const Node& sum, double& number, std::map<NodeId, double>& terms) const {
    number += k * sum.number;
    for (const Term& term : sum.terms) {
      const Node& inner = g_[term.node];
      const double coefficient = k * term.coefficient;
      if (goes_into_sums(term.node, coefficient))
        collect(coefficient, inner, number, terms);
      else
        terms[term.node] += coefficient;
    }
  }
  std::size_t flat_size(NodeId id) const {
    const auto found = flat_sizes_.find(id);
    if (found != flat_sizes_.end()) return found->second;
    return flat_sizes_[id] = std::max<std::size_t>(1, flattened(g_[id]).terms.size());
  }
  Node flattened(const Node& sum) const {
    Node flat = sum;
    flat.number = 0;
    flat.terms.clear();
    std::map<NodeId, double> terms;
    collect(1, sum, flat.number, terms);
    for (const auto& [node, coefficient] : terms)
      if (coefficient != 0) flat.terms.push_back({coefficient, node});
    return flat;
  }

  // A product within a sum has no register. It is added at full length and rounded with the sum.
  bool fuses(const Term& term) const {
    return g_[term.node].kind == NodeKind::kProduct && std::abs(term.coefficient) == 1 &&
           !kept_.contains(term.node);
  }
  Id dot(const Node& n, const std::string& name) {
    std::vector<ProgramBuilder::Product> products;
    Id largest = 0;
    double size = -1;
    for (const Term& term : n.terms) {
      const Node& part = g_[term.node];
      const bool minus = term.coefficient < 0;
      if (fuses(term))
        products.push_back({value(part.args[0]), value(part.args[1]), 1, minus});
      else
        products.push_back({value(term.node), std::nullopt, std::abs(term.coefficient), minus});
      const double here = std::abs(term.coefficient) * part.range.magnitude();
      if (here > size) size = here, largest = products.back().a;
    }
    const std::string base = name.empty() ? short_name("sum_with_" + b_.at(largest).name, "sum") : name;
    return b_.dot(n.number, std::move(products), n.range, base);
  }

  // Adds terms in order of size, so that partial sums keep the finest format as long as possible.
  Id sum(const Node& whole, const std::string& name) {
    const Node n = flattened(whole);
    if (n.terms.empty()) return b_.constant(n.number);
    const std::size_t count = n.terms.size() + (n.number != 0 ? 1 : 0);
    if (count > 2 || std::any_of(n.terms.begin(), n.terms.end(), [&](const Term& t) { return fuses(t); }))
      return dot(n, name);
    struct Part {
      double k;
      Id id;
      Interval range;
    };
    std::vector<Part> parts;
    for (const Term& term : n.terms)
      parts.push_back({term.coefficient, value(term.node), term.coefficient * g_[term.node].range});
    if (n.number != 0) parts.push_back({1, b_.constant(n.number), {n.number, n.number}});
    std::stable_sort(parts.begin(), parts.end(),
                     [](const Part& a, const Part& b) { return a.range.magnitude() < b.range.magnitude(); });
    const std::string base =
        name.empty() ? short_name("sum_with_" + b_.at(parts.back().id).name, "sum") : name;
    if (parts.size() == 1)
      return b_.linear(parts[0].k, parts[0].id, 0, parts[0].id, parts[0].range,
                       name.empty() ? short_name(b_.at(parts[0].id).name + "_scaled", "scaled") : name);
    Part so_far = parts[0];
    for (std::size_t i = 1; i < parts.size(); ++i) {
      const Interval range = so_far.range + parts[i].range;
      const std::string part_name = i + 1 == parts.size() ? base : base + "_part";
      so_far = {1, b_.linear(so_far.k, so_far.id, parts[i].k, parts[i].id, range, part_name), range};
    }
    return so_far.id;
  }

  Id wrapped(Id position, double first, double period, const std::string& name, double slope_for_error) {
    const int bits = b_.at(position).fraction_bits;
    const double exact = std::ldexp(period, bits);
    const Wrap wrap = make_wrap(std::llround(std::ldexp(first, bits)), std::llround(exact));
    const double turns = b_.at(position).range.magnitude() / period + 1;
    const double error =
        turns * std::abs(exact - std::round(exact)) * b_.lsb(position) * (slope_for_error > 0 ? 1 : 0);
    return b_.plain({OpCode::kWrap, 0, static_cast<std::uint16_t>(position), b_.add_wrap(wrap), 0, 0, 0},
                    bits, {first, first + period}, error, ErrorSource::kTable, {{position, 1}},
                    name + "_in_period");
  }

  // Stations as counts of the position's register.
  std::vector<Segment> segments_of(const model::Table& table, Id position) const {
    std::vector<std::int64_t> stations;
    for (const model::Station& s : table.stations) {
      const double count = std::ldexp(s.loc, b_.at(position).fraction_bits);
      if (std::abs(count) > 2147483000.0)
        throw text::InputError({machine_.file, table.line}, s.loc_text,
                               "cannot be compiled: a station is outside the number format of the axis");
      stations.push_back(std::llround(count));
      if (stations.size() > 1 && stations.back() <= stations[stations.size() - 2])
        throw text::InputError(
            {machine_.file, table.line}, s.loc_text,
            "cannot be compiled: two stations are closer than the resolution of the axis format");
    }
    return make_segments(stations);
  }

  Id table(const Node& n) {
    const std::size_t axis = n.index[0];
    const Place place{axis, n.args[0]};
    const auto found = looked_up_.find(place);
    if (found != looked_up_.end()) return found->second.at(n.index[1]);
    const model::Table& t = *machine_.table_of(axis);
    const std::string& name = machine_.axes[axis].name;
    const double first = t.stations.front().loc, last = t.stations.back().loc;
    Id position = value(n.args[0]);
    const Interval range = g_[n.args[0]].range;
    // A corrected position is not a channel, so its format does not include the stations beyond
    // the range.
    const int bits =
        fraction_bits_for(std::max({std::abs(first), std::abs(last), range.magnitude()}) * (1 + 1e-6));
    if (g_[n.args[0]].kind != NodeKind::kChannel && b_.at(position).fraction_bits > bits)
      position = b_.reformat(position, bits);
    if (t.periodic && (range.low < first || range.high > last))
      position = wrapped(position, first, last - first, name, 1);
    const bool cubic = t.interpolation == model::Interpolation::kCubic && t.stations.size() > 2;
    std::vector<std::vector<std::int32_t>> coefficients;
    std::vector<Register> results;
    for (const auto& [column, node] : columns_.at(place)) {
      Register r;
      r.name = std::string("E") + "XYZABC"[column] + name;
      r.range = g_[node].range;
      r.source = ErrorSource::kTable;
      coefficients.push_back(cubic ? cubic_column(t, column, b_.lsb(position), r)
                                   : linear_column(t, column, b_.lsb(position), r));
      r.uses[0].from = position;
      results.push_back(r);
    }
    Id id = b_.look_up(position,
                       make_table("stations_" + name, segments_of(t, position), cubic ? 3 : 1, coefficients),
                       std::move(results));
    for (const auto& [column, node] : columns_.at(place)) looked_up_[place][column] = id++;
    return looked_up_[place].at(n.index[1]);
  }

  // Returns the coefficients of one column, and the properties of its result register.
  static std::vector<std::int32_t> linear_column(const model::Table& t, std::size_t column,
                                                 double position_lsb, Register& r) {
    double slope = 0, step = 0;
    for (std::size_t i = 1; i < t.stations.size(); ++i) {
      const double rise = std::abs(t.stations[i].value[column] - t.stations[i - 1].value[column]);
      slope = std::max(slope, rise / (t.stations[i].loc - t.stations[i - 1].loc));
      step = std::max(step, rise);
    }
    r.fraction_bits = fraction_bits_for(std::max(r.range.magnitude(), step) * 1.0000001);
    const auto count = [&](std::size_t i) {
      return std::llround(std::ldexp(t.stations[i].value[column], r.fraction_bits));
    };
    std::vector<std::int32_t> values;
    for (std::size_t i = 0; i + 1 < t.stations.size(); ++i) {
      values.push_back(static_cast<std::int32_t>(count(i)));
      values.push_back(static_cast<std::int32_t>(count(i + 1) - count(i)));
    }
    // Value and interpolation have an error of half an LSB each. A station has half an LSB of the
    // position. The fraction has less than 2^-29.
    r.own_error =
        std::ldexp(1.0, -r.fraction_bits) + 2 * slope * 0.5 * position_lsb + step * std::ldexp(1.0, -29);
    r.uses = {{0, slope}};
    return values;
  }

  static std::vector<std::int32_t> cubic_column(const model::Table& t, std::size_t column,
                                                double position_lsb, Register& r) {
    const model::StationTable exact(t);
    std::vector<CubicPiece> pieces;
    double size = 0, slope = 0;
    for (std::size_t i = 0; i + 1 < t.stations.size(); ++i) {
      const double a = t.stations[i].loc, h = t.stations[i + 1].loc - a;
      // Its values at four positions determine a cubic. End slopes follow from them without the
      // range beyond the ends.
      const auto at = [&](double f) {
        return f == 0   ? t.stations[i].value[column]
               : f == 1 ? t.stations[i + 1].value[column]
                        : exact.values(a + f * h)[column];
      };
      const double v0 = at(0), v1 = at(1.0 / 3), v2 = at(2.0 / 3), v3 = at(1);
      const double near_slope = (-11 * v0 + 18 * v1 - 9 * v2 + 2 * v3) / 2,
                   far_slope = (11 * v3 - 18 * v2 + 9 * v1 - 2 * v0) / 2;
      pieces.push_back(hermite(v0, v3, near_slope, far_slope));
      const double* const c = pieces.back().c;
      size = std::max(size, std::abs(c[0]) + std::abs(c[1]) + std::abs(c[2]) + std::abs(c[3]));
      slope = std::max(slope, (std::abs(c[1]) + 2 * std::abs(c[2]) + 3 * std::abs(c[3])) / h);
    }
    r.fraction_bits = fraction_bits_for(size * 1.001);
    std::vector<std::int32_t> values;
    for (const CubicPiece& p : pieces)
      for (const double c : p.c)
        values.push_back(static_cast<std::int32_t>(std::llround(std::ldexp(c, r.fraction_bits))));
    // Four coefficients half an LSB each, the evaluation 5/2; fraction and station as for a linear column.
    r.own_error = 4.5 * std::ldexp(1.0, -r.fraction_bits) + 2 * slope * 0.5 * position_lsb +
                  3 * size * std::ldexp(1.0, -29);
    r.uses = {{0, slope}};
    return values;
  }

  Id function(const Node& n) {
    Id argument = value(n.args[0]);
    if (n.function == Function::kSin || n.function == Function::kCos) return sine_or_cosine(n, argument);
    argument = held_in_domain(n, argument);
    const std::string name =
        short_name(std::string(name_of(n.function)) + "_" + b_.at(argument).name, name_of(n.function));
    FunctionPieces pieces;
    try {
      pieces = make_pieces(n.function, b_.counts(argument).low, b_.counts(argument).high,
                           b_.at(argument).fraction_bits);
    } catch (const std::domain_error& e) {
      throw text::InputError("cannot be compiled: " + name + ": " + e.what());
    }
    Register r;
    r.name = name;
    r.fraction_bits = pieces.fraction_bits;
    r.range = n.range;
    r.own_error = pieces.error;
    r.source = ErrorSource::kFunction;
    r.uses = {{argument, pieces.slope}};
    return b_.look_up(argument, make_table("pieces_" + name, pieces.segments, 3, {pieces.coefficients}), {r});
  }

  // A register may reach zero (by rounding, or because its integer range is wider) although the
  // exact value cannot. It is limited to the exact value's limit, which does not reduce its
  // accuracy.
  Id held_in_domain(const Node& n, Id argument) {
    const bool open =
        n.function == Function::kLog || n.function == Function::kSqrt || n.function == Function::kReciprocal;
    const Interval exact = g_[n.args[0]].range;
    const ValueRange& counts = b_.counts(argument);
    // For the integers a square is a product, which may be negative: exp(-c x^2) would be very
    // large.
    const bool steep =
        n.function == Function::kExp &&
        std::ldexp(static_cast<double>(counts.high), -b_.at(argument).fraction_bits) > exact.high + 0.1;
    if (!steep && (!open || counts.low > 0 || counts.high < 0)) return argument;
    const bool positive = !steep && exact.low > 0;
    const int bits = b_.at(argument).fraction_bits;
    const Id edge = steep ? b_.constant(exact.high + std::ldexp(1.0, -bits), bits)
                          : b_.reformat(b_.constant(0.999 * (positive ? exact.low : exact.high)), bits);
    const Instruction step{positive ? OpCode::kMax : OpCode::kMin,
                           0,
                           static_cast<std::uint16_t>(argument),
                           static_cast<std::uint16_t>(edge),
                           0,
                           0,
                           0};
    return b_.plain(step, b_.at(argument).fraction_bits, exact, 0, ErrorSource::kRounding, {{argument, 1}},
                    b_.at(argument).name + "_held");
  }

  Id sine_or_cosine(const Node& n, Id argument) {
    auto found = turns_.find(argument);
    if (found == turns_.end()) {
      const auto range = [&](const std::map<NodeId, NodeId>& nodes) {
        const auto node = nodes.find(n.args[0]);
        return node == nodes.end() ? Interval{-1, 1} : g_[node->second].range;
      };
      found = turns_.emplace(argument, b_.sine_cosine(argument, range(sines_), range(cosines_))).first;
    }
    return found->second + (n.function == Function::kCos ? 1 : 0);
  }

  Id choice(const Node& n) {
    Id a = value(n.args[0]);
    const auto one = [&](OpCode op, int bits, double gain, const char* name) {
      return b_.plain({op, 0, static_cast<std::uint16_t>(a), 0, 0, 0, 0}, bits, n.range, 0,
                      ErrorSource::kRounding, {{a, gain}}, std::string(name) + b_.at(a).name);
    };
    if (n.kind == NodeKind::kAbs) return one(OpCode::kAbs, b_.at(a).fraction_bits, 1, "abs_");
    if (n.kind == NodeKind::kSign) return b_.reformat(one(OpCode::kSign, 0, 0, "sign_"), kUnitBits);
    Id b = value(n.args[1]);
    // The finest format for both, for the full range of their registers.
    const auto reach = [&](Id id) {
      const ValueRange& r = b_.counts(id);
      return b_.lsb(id) * static_cast<double>(std::max(std::abs(r.low), std::abs(r.high)) + 1);
    };
    const double size = std::max(reach(a), reach(b));
    const int bits =
        std::min(fraction_bits_for(size), std::max(b_.at(a).fraction_bits, b_.at(b).fraction_bits));
    a = b_.reformat(a, bits);
    b = b_.reformat(b, bits);
    const bool value_kind = n.kind == NodeKind::kMin || n.kind == NodeKind::kMax;
    const OpCode op = n.kind == NodeKind::kMin     ? OpCode::kMin
                      : n.kind == NodeKind::kMax   ? OpCode::kMax
                      : n.kind == NodeKind::kEqual ? OpCode::kEqual
                                                   : OpCode::kLess;
    const double gain = value_kind ? 1 : 0;
    const std::string name = n.kind == NodeKind::kMin     ? "lower"
                             : n.kind == NodeKind::kMax   ? "higher"
                             : n.kind == NodeKind::kEqual ? "is_equal"
                                                          : "is_less";
    const Id result =
        b_.plain({op, 0, static_cast<std::uint16_t>(a), static_cast<std::uint16_t>(b), 0, 0, 0},
                 value_kind ? bits : 0, n.range, 0, ErrorSource::kRounding, {{a, gain}, {b, gain}}, name);
    return value_kind ? result : b_.reformat(result, kUnitBits);
  }

  Id lag(const Node& n) {
    const Id input = value(n.args[0]);
    const double gain = -std::expm1(-1e-6 * tick_us_ / n.number);
    const int shift = std::clamp(30 - std::ilogb(gain), 31, static_cast<int>(kMaxShift));
    const auto mantissa =
        static_cast<std::int32_t>(std::min(2147483647.0, std::round(std::ldexp(gain, shift))));
    const double width = n.range.high - n.range.low;
    // Compared with an input that is linear between ticks: half a tick of delay, at most gain *
    // width. The time constant's quantisation, the output's rounding and the accumulated
    // truncation of the state are added.
    const double error = width * (gain + std::abs(std::ldexp(mantissa, -shift) / gain - 1)) +
                         b_.lsb(input) * (0.5 + std::ldexp(1.0, -30) / gain);
    return b_.plain({OpCode::kLag, static_cast<std::uint8_t>(shift), static_cast<std::uint16_t>(input),
                     b_.add_lag(), 0, mantissa, 0},
                    b_.at(input).fraction_bits, n.range, error, ErrorSource::kLag, {{input, 1}},
                    "lagged_" + b_.at(input).name);
  }

  const model::Machine& machine_;
  const Derivation& d_;
  const Graph& g_;
  std::uint32_t tick_us_;
  std::size_t most_shared_;
  const LoweredProgram* tick_ = nullptr;  // the shares use its registers
  std::vector<std::uint16_t> sources_;
  ProgramBuilder b_;
  std::string wanted_name_;
  std::map<NodeId, Id> done_;
  std::map<NodeId, std::size_t> uses_;
  mutable std::map<NodeId, std::size_t> flat_sizes_;
  std::set<NodeId> factors_;                     // also used outside a sum
  std::set<NodeId> given_;                       // corrections that other nodes use as given values
  std::set<NodeId> kept_;                        // always have a register of their own
  using Place = std::pair<std::size_t, NodeId>;  // axis of a table, and position of its interpolation
  std::map<Place, std::map<std::size_t, NodeId>> columns_;  // column -> node
  std::map<Place, std::map<std::size_t, Id>> looked_up_;    // column -> register
  std::map<NodeId, NodeId> sines_, cosines_;                // argument -> node
  std::map<Id, Id> turns_;                                  // angle -> its sine
};

}  // namespace

namespace {

/// Returns the approximate number of instructions of the arithmetic (x86-64, printed form). It is
/// used to compare two forms of one equation.
std::size_t cost_of(const LoweredProgram& p) {
  std::size_t cost = 0;
  for (const Instruction& s : p.instructions) cost += s.op == OpCode::kLinear ? 6 : 3;
  for (const ProductTerm& t : p.terms) cost += t.shift > 0 ? 3 : 2;
  return cost;
}

}  // namespace

LoweredProgram lower(const model::Machine& machine, const Derivation& derivation, std::uint32_t tick_us) {
  LoweredProgram best = Lowering(machine, derivation, tick_us, 0).run();
  for (const std::size_t most_shared : {1u, 2u, 4u}) {
    LoweredProgram other = Lowering(machine, derivation, tick_us, most_shared).run();
    if (cost_of(other) < cost_of(best)) best = std::move(other);
  }
  return best;
}

LoweredShares lower_shares(const model::Machine& machine, const Derivation& derivation,
                           const LoweredProgram& tick) {
  for (std::size_t most = kMaxShares;; most = most * 3 / 4) {
    std::size_t registers = 0;
    LoweredShares shares = Lowering(machine, derivation, 1000, 1).run_shares(tick, most, registers);
    if (tick.registers.size() + registers <= kMaxRegisters || most == 0) return shares;
    most = std::min(most, shares.shares.size());
  }
}

}  // namespace vernier::compile
