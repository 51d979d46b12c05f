// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/offline/part_program.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <functional>
#include <numbers>
#include <optional>
#include <sstream>

#include "tools/text/error.h"
#include "tools/text/numbers.h"
#include "tools/text/words.h"

namespace vernier::offline {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

constexpr double kMmPerInch = 25.4;

/// One word of a block: X12.5, G1, (a remark), ;a remark.
struct Word {
  char letter = 0;  // upper case; ( for remarks, % and / for themselves
  double value = 0;
  std::string text;  // as it stands
};

std::vector<Word> words_of(const std::string& line, const text::Place& place) {
  std::vector<Word> words;
  for (std::size_t i = 0; i < line.size();) {
    const char c = line[i];
    if (std::isspace(static_cast<unsigned char>(c)) != 0) {
      ++i;
    } else if (c == ';' || c == '(') {
      const auto end = c == ';' ? line.size() : line.find(')', i);
      if (end == std::string::npos)
        throw text::InputError(place, line.substr(i, 20), "a remark without its end");
      const std::size_t next = std::min(end + 1, line.size());
      words.push_back({'(', 0, line.substr(i, next - i)});
      i = next;
    } else if (c == '%' || c == '/') {
      words.push_back({c, 0, std::string(1, c)});
      ++i;
    } else {
      const std::size_t from = i++;
      while (i < line.size() && std::isspace(static_cast<unsigned char>(line[i])) != 0) ++i;
      const std::size_t number = i;
      while (i < line.size() && (std::isdigit(static_cast<unsigned char>(line[i])) != 0 || line[i] == '.' ||
                                 line[i] == '-' || line[i] == '+'))
        ++i;
      const char letter = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
      const auto value = text::parse_number(line.substr(number, i - number));
      if (std::isalpha(static_cast<unsigned char>(c)) == 0 || !value)
        throw text::InputError(
            place, line.substr(from, std::max<std::size_t>(i - from, 8)),
            "not understood: parameters, expressions and loops have to be written out first");
      words.push_back({letter, *value, line.substr(from, i - from)});
    }
  }
  return words;
}

enum class Motion : std::uint8_t { kNone, kRapid, kLine, kClockwise, kCounterClockwise };

/// A move as a function of its share, 0..1.
using Curve = std::function<VectorXd(double)>;

class Translator {
 public:
  Translator(const std::string& file, const model::States& at, const std::vector<char>& known,
             const PartProgramOptions& options, Corrector& corrector)
      : file_(file),
        at_(at),
        machine_(corrector.machine()),
        options_(options),
        corrector_(corrector),
        position_(static_cast<Index>(machine_.axes.size())),
        known_(known),
        turn_(machine_.axes.size(), std::nan("")),
        sense_(machine_.axes.size(), 0) {
    for (std::size_t i = 0; i < machine_.axes.size(); ++i) {
      position_[static_cast<Index>(i)] = at.axis[i][0];
      const std::string& name = machine_.axes[i].name;
      if (name.size() != 1)
        throw text::InputError({machine_.file, machine_.axes[i].line}, name,
                               "part programs know axes of one letter; a CSV of positions takes any name");
      letters_ += static_cast<char>(std::toupper(static_cast<unsigned char>(name[0])));
    }
  }

  PartProgram translate(const std::string& text) {
    std::istringstream lines(text);
    bool marked = false;
    for (std::string line; std::getline(lines, line);) {
      if (!line.empty() && line.back() == '\r') line.pop_back();
      ++place_.line;
      if (!marked && text::trimmed(line) != "%") {
        result_.text += fmt::format("({}: machine {})\n", kCorrectedMark, machine_.name);
        marked = true;
      }
      block(line);
    }
    return std::move(result_);
  }

 private:
  /// Codes that change what coordinates or moves mean in a way that is not followed here.
  void refuse(const Word& word) const {
    static constexpr std::array kGroups = {10.0, 28.0, 30.0, 33.0, 38.2, 38.3, 38.4, 38.5, 41.0,
                                           41.1, 42.0, 42.1, 43.1, 51.0, 52.0, 53.0, 68.0, 73.0,
                                           76.0, 81.0, 82.0, 83.0, 84.0, 85.0, 86.0, 87.0, 88.0,
                                           89.0, 90.1, 92.0, 95.0, 5.0,  5.1,  5.2,  5.3};
    if (word.letter == 'G' && std::find(kGroups.begin(), kGroups.end(), word.value) != kGroups.end())
      throw text::InputError(place_, word.text,
                             "what this code does to positions is not followed; write the moves out first");
    if (word.letter == 'O' || word.letter == '#' ||
        (word.letter == 'M' && (word.value == 98 || word.value == 99)))
      throw text::InputError(place_, word.text, "subprograms and loops have to be written out first");
  }

  void take_code(double code) {
    if (code == 0) motion_ = Motion::kRapid;
    if (code == 1) motion_ = Motion::kLine;
    if (code == 2) motion_ = Motion::kClockwise;
    if (code == 3) motion_ = Motion::kCounterClockwise;
    if (code == 17 || code == 18 || code == 19) plane_ = static_cast<int>(code);
    if (code == 20) unit_ = kMmPerInch;
    if (code == 21) unit_ = 1;
    if (code == 90) absolute_ = true;
    if (code == 91) absolute_ = false;
    if (code == 93) inverse_time_ = true;
    if (code == 94) inverse_time_ = false;
    if (code == 80) motion_ = Motion::kNone;
  }

  std::optional<std::size_t> axis_of(char letter) const {
    const auto at = letters_.find(letter);
    if (at == std::string::npos) return std::nullopt;
    return at;
  }

  void block(const std::string& line) {
    place_.file = file_;
    const std::vector<Word> words = words_of(line, place_);
    bool moves = false;
    for (const Word& word : words) {
      refuse(word);
      if (word.letter == 'G') take_code(word.value);
      if (axis_of(word.letter)) moves = true;
      if (word.letter == 'F') feed_ = word.value * (inverse_time_ ? 1 : unit_);
    }
    const bool arc = motion_ == Motion::kClockwise || motion_ == Motion::kCounterClockwise;
    for (const Word& word : words) {
      moves = moves || (arc && (word.letter == 'I' || word.letter == 'J' || word.letter == 'K'));
      if (word.letter == 'G' && word.value == 4) moves = false;  // a dwell has words of its own
    }
    if (!moves) {
      result_.text += without_distance_mode(line, words) + "\n";
      return;
    }
    if (motion_ == Motion::kNone)
      throw text::InputError(place_, line.substr(0, 20), "an axis word, and no G0, G1, G2 or G3 before it");
    move(words, arc);
  }

  static bool is_distance_mode(const Word& word) {
    return word.letter == 'G' && (word.value == 90 || word.value == 91);
  }

  /// What is written is absolute, whatever was read.
  static std::string without_distance_mode(const std::string& line, const std::vector<Word>& words) {
    if (std::none_of(words.begin(), words.end(), is_distance_mode)) return line;
    std::string rest;
    for (const Word& word : words)
      if (!is_distance_mode(word)) rest += (rest.empty() ? "" : " ") + word.text;
    return rest;
  }

  /// Where a block goes: machine positions, mm and deg.
  VectorXd target_of(const std::vector<Word>& words) {
    VectorXd target = position_;
    for (const Word& word : words) {
      const auto axis = axis_of(word.letter);
      if (!axis) continue;
      const auto at = static_cast<Index>(*axis);
      const double value = word.value * (machine_.axes[*axis].rotary ? 1 : unit_);
      if (absolute_)
        target[at] = value + options_.zero[*axis];
      else if (known_[*axis] != 0)
        target[at] += value;
      else
        throw text::InputError(place_, word.text,
                               "a step from where the axis stands, which is not known: --at");
      reached_.push_back(*axis);
    }
    return target;
  }

  void move(const std::vector<Word>& words, bool arc) {
    ++result_.moves;
    reached_.clear();
    const VectorXd from = position_, to = target_of(words);
    bool start_known = true;
    for (const char known : known_) start_known = start_known && known != 0;
    for (const std::size_t axis : reached_) known_[axis] = 1;
    for (std::size_t i = 0; i < known_.size(); ++i)
      if (known_[i] == 0)
        throw text::InputError(
            place_, std::string(1, letters_[i]),
            "where this axis stands is not known yet: name it in the first move, or with --at");
    if (arc && !start_known)
      throw text::InputError(place_, words.front().text, "an arc from a place that is not known: --at");
    const Curve curve =
        arc ? arc_of(words, from, to) : Curve([&](double s) -> VectorXd { return from + s * (to - from); });
    write(words, curve, start_known, arc);
    position_ = to;
  }

  Curve arc_of(const std::vector<Word>& words, const VectorXd& from, const VectorXd& to) const {
    const std::array<char, 2> letters = plane_ == 17   ? std::array{'X', 'Y'}
                                        : plane_ == 18 ? std::array{'Z', 'X'}
                                                       : std::array{'Y', 'Z'};
    const auto first = axis_of(letters[0]), second = axis_of(letters[1]);
    if (!first || !second)
      throw text::InputError(place_, fmt::format("G{}", plane_), "the machine lacks an axis of this plane");
    const auto a = static_cast<Index>(*first), b = static_cast<Index>(*second);
    const auto find = [&](char letter) -> std::optional<double> {
      for (const Word& word : words)
        if (word.letter == letter) return word.value;
      return std::nullopt;
    };
    if (const auto turns = find('P'); turns && *turns != 1)
      throw text::InputError(place_, "P", "an arc of several turns has to be written turn by turn");
    const double sense = motion_ == Motion::kCounterClockwise ? 1 : -1;
    Eigen::Vector2d start(from[a], from[b]), end(to[a], to[b]), centre;
    const auto offset = [&](char letter) { return find(letter).value_or(0) * unit_; };
    if (const auto r = find('R')) {
      const double radius = *r * unit_;
      const Eigen::Vector2d chord = end - start;
      const double half = chord.norm() / 2, height = radius * radius - half * half;
      if (half <= 0 || height < -1e-6 * radius * radius)
        throw text::InputError(place_, "R", "no arc of this radius joins its ends");
      // The lesser arc for a positive radius, on the left of the chord for a turn to the left.
      const double side = sense * (radius > 0 ? 1 : -1);
      centre = start + chord / 2 +
               side * std::sqrt(std::max(height, 0.0)) * Eigen::Vector2d(-chord.y(), chord.x()) / (2 * half);
    } else {
      const std::array<char, 3> of_axis = {'I', 'J', 'K'};
      const auto letter_of = [&](char axis) { return of_axis[static_cast<std::size_t>(axis - 'X')]; };
      centre = start + Eigen::Vector2d(offset(letter_of(letters[0])), offset(letter_of(letters[1])));
    }
    const Eigen::Vector2d out = start - centre, in = end - centre;
    constexpr double kOff = 0.05;  // mm, and a thousandth of the radius: as controls allow
    if (out.norm() <= 0 || std::abs(out.norm() - in.norm()) > kOff + 1e-3 * out.norm())
      throw text::InputError(place_, words.front().text,
                             "the ends of the arc are not at one distance from its centre");
    double angle = std::atan2(out.x() * in.y() - out.y() * in.x(), out.dot(in));
    constexpr double kWhole = 2 * std::numbers::pi, kSame = 1e-9;
    if (sense * angle <= kSame) angle += sense * kWhole;
    return [=](double s) -> VectorXd {
      VectorXd point = from + s * (to - from);
      const double radius = out.norm() + s * (in.norm() - out.norm());
      const double at = std::atan2(out.y(), out.x()) + s * angle;
      point[a] = centre.x() + radius * std::cos(at);
      point[b] = centre.y() + radius * std::sin(at);
      return point;
    };
  }

  /// Positions along a move with the motion that belongs to them.
  model::States along(const Curve& curve, const std::vector<double>& shares, bool rapid) const {
    model::States states = model::select_states(at_, std::vector<std::size_t>(shares.size(), 0));
    constexpr double kStep = 1e-6;
    for (std::size_t k = 0; k < shares.size(); ++k) {
      const auto row = static_cast<Index>(k);
      const double s = std::clamp(shares[k], kStep, 1 - kStep);
      const VectorXd point = curve(shares[k]), slope = (curve(s + kStep) - curve(s - kStep)) / (2 * kStep);
      double path = 0;
      for (std::size_t i = 0; i < machine_.axes.size(); ++i)
        if (!machine_.axes[i].rotary) path += slope[static_cast<Index>(i)] * slope[static_cast<Index>(i)];
      path = std::sqrt(path);
      const double feed = rapid || inverse_time_ ? 0 : feed_;  // mm/min; of a rapid move nobody knows it
      states.feed[row] = feed;
      for (std::size_t i = 0; i < machine_.axes.size(); ++i) {
        const double way = slope[static_cast<Index>(i)];
        states.axis[i][row] = point[static_cast<Index>(i)];
        states.velocity[i][row] = path > 0 ? feed / 60 * way / path : 0;
        const double sense = std::abs(way) > 1e-12 ? (way > 0 ? 1 : -1) : sense_[i];
        states.direction[i][row] = sense;
        if (std::isfinite(turn_[i]) && sense == sense_[i])
          states.since[i][row] = std::abs(point[static_cast<Index>(i)] - turn_[i]);
      }
    }
    return states;
  }

  /// Shares at which the senses of all axes are the same from one to the next: 0, reversals, 1.
  std::vector<double> stretches(const Curve& curve, bool arc) const {
    std::vector<double> ends = {0};
    constexpr int kLooks = 720, kHalvings = 40;
    for (std::size_t i = 0; arc && i < machine_.axes.size(); ++i) {
      const auto axis = static_cast<Index>(i);
      const auto slope = [&](double s) {
        constexpr double kStep = 1e-7;
        return curve(s + kStep)[axis] - curve(s - kStep)[axis];
      };
      for (int k = 0; k < kLooks; ++k) {
        double low = (k + 0.5) / (kLooks + 1), high = (k + 1.5) / (kLooks + 1);
        if (slope(low) * slope(high) >= 0) continue;
        for (int n = 0; n < kHalvings; ++n)
          (slope(low) * slope((low + high) / 2) > 0 ? low : high) = (low + high) / 2;
        ends.push_back(low);
      }
    }
    ends.push_back(1);
    std::sort(ends.begin(), ends.end());
    return ends;
  }

  /// How many equal parts of a stretch are looked at: a millimetre or a tenth of a degree each, and of a
  /// curve so short that its chords stay well within the deviation.
  int looks(const Curve& curve, double from, double to, bool arc) const {
    constexpr double kStep_mm = 1, kStep_deg = 0.1;
    constexpr int kFewest = 8, kMost = 200000, kChords = 64;
    double length = 0, turn = 0, bend = 0;
    VectorXd last = curve(from), way;
    for (int k = 1; k <= kChords; ++k) {
      const VectorXd next = curve(from + (to - from) * k / kChords), step = next - last;
      double squares = 0;
      for (std::size_t i = 0; i < machine_.axes.size(); ++i) {
        const double one = step[static_cast<Index>(i)];
        if (machine_.axes[i].rotary)
          turn += std::abs(one);
        else
          squares += one * one;
      }
      length += std::sqrt(squares);
      if (k > 1) bend = std::max(bend, (step - way).norm());
      way = step;
      last = next;
    }
    // A chord of n parts of this one is off by its eighth over n^2.
    const double chords = arc ? kChords * std::sqrt(bend / options_.deviation_mm) : 0;
    return static_cast<int>(std::clamp(std::max({length / kStep_mm, turn / kStep_deg, chords}),
                                       static_cast<double>(kFewest), static_cast<double>(kMost)));
  }

  /// Which of the points a straight line from one to the next must keep to stay within the deviation of all.
  /// Ramer 1972, Douglas and Peucker 1973. What lies along a line is a matter of time, not of the path.
  void keep(const Eigen::MatrixXd& points, Index from, Index to, std::vector<Index>& kept) const {
    const VectorXd way = points.col(to) - points.col(from);
    double worst = 0;
    Index at = from;
    for (Index k = from + 1; k < to; ++k) {
      const VectorXd off = points.col(k) - points.col(from);
      const double share = way.squaredNorm() > 0 ? std::clamp(off.dot(way) / way.squaredNorm(), 0.0, 1.0) : 0;
      const double distance = (off - share * way).norm();
      if (distance <= worst) continue;
      worst = distance;
      at = k;
    }
    constexpr double kBetween = 0.8;  // the rest is for what lies between two looks
    if (worst <= kBetween * options_.deviation_mm) {
      kept.push_back(to);
      return;
    }
    keep(points, from, at, kept);
    keep(points, at, to, kept);
  }

  /// A place that is written: of the move, with the axis positions to command there.
  struct Vertex {
    double share = 0;
    VectorXd command;
  };

  /// The vertices of a move. Where an axis turns round the correction jumps: it is written there twice.
  std::vector<Vertex> vertices(const Curve& curve, bool arc) {
    std::vector<Vertex> list;
    const std::vector<double> ends = stretches(curve, arc);
    for (std::size_t part = 0; part + 1 < ends.size(); ++part) {
      const double from = ends[part], to = ends[part + 1];
      const int count = looks(curve, from, to, arc);
      std::vector<double> shares;
      for (int k = 0; k <= count; ++k) shares.push_back(from + (to - from) * k / count);
      const VectorXd begin = curve(from), end = curve(to);
      note_senses(begin, curve((from + to) / 2));
      const model::States states = along(curve, shares, false);
      const Eigen::MatrixXd there = corrector_.commands(states);
      std::vector<Index> kept;
      const VectorXd& last = list.empty() ? command_ : list.back().command;
      if (last.size() > 0 && (there.col(0) - last).norm() > options_.deviation_mm) kept.push_back(0);
      keep(there, 0, count, kept);
      std::vector<std::size_t> rows;
      for (const Index k : kept) {
        list.push_back({shares[static_cast<std::size_t>(k)], there.col(k)});
        rows.push_back(static_cast<std::size_t>(k));
      }
      corrector_.count(model::select_states(states, rows), there(Eigen::all, kept));
    }
    return list;
  }

  void note_senses(const VectorXd& from, const VectorXd& to) {
    for (std::size_t i = 0; i < machine_.axes.size(); ++i) {
      const double way = to[static_cast<Index>(i)] - from[static_cast<Index>(i)];
      const double sense = std::abs(way) > 1e-9 ? (way > 0 ? 1 : -1) : sense_[i];
      if (sense != sense_[i] && sense_[i] != 0) turn_[i] = from[static_cast<Index>(i)];
      sense_[i] = sense;
    }
  }

  void write(const std::vector<Word>& words, const Curve& curve, bool start_known, bool arc) {
    const bool rapid = motion_ == Motion::kRapid;
    std::vector<Vertex> list;
    if (rapid || !start_known) {
      // A rapid move is no path, and what comes from a place that is not known is none that could be cut.
      if (start_known) note_senses(curve(0), curve(1));
      const model::States end = along(curve, {1}, rapid);
      const Eigen::MatrixXd there = corrector_.commands(end);
      corrector_.count(end, there);
      list = {{1, there.col(0)}};
    } else {
      list = vertices(curve, arc);
    }
    std::string before, after;
    for (const Word& word : words) {
      if (axis_of(word.letter) || word.letter == 'F') continue;
      if (arc && (word.letter == 'I' || word.letter == 'J' || word.letter == 'K' || word.letter == 'R' ||
                  word.letter == 'P'))
        continue;
      const bool is_motion = word.letter == 'G' && word.value <= 3 && word.value == std::floor(word.value);
      if (is_motion || is_distance_mode(word)) continue;
      if (word.letter == '(')
        after += " " + word.text;
      else
        before += word.text + " ";
    }
    double begin = 0;
    for (std::size_t k = 0; k < list.size(); ++k) {
      std::string block = k == 0 ? before : "";
      block += std::string(result_.written == 0 ? "G90 " : "") + (rapid ? "G0" : "G1");
      for (std::size_t i = 0; i < machine_.axes.size(); ++i)
        block += fmt::format(" {}{:.{}f}", letters_[i],
                             (list[k].command[static_cast<Index>(i)] - options_.zero[i]) /
                                 (machine_.axes[i].rotary ? 1 : unit_),
                             options_.digits + (unit_ > 1 ? 1 : 0));
      // A jump at a reversal takes the shortest time that can be written.
      constexpr double kLeastShare = 1e-6;
      if (inverse_time_ && !rapid)
        block += fmt::format(" F{:.6g}", feed_ / std::max(list[k].share - begin, kLeastShare));
      else if (k == 0)
        for (const Word& word : words)
          if (word.letter == 'F') block += " " + word.text;
      result_.text += block + (k == 0 ? after : "") + "\n";
      ++result_.written;
      begin = list[k].share;
    }
    command_ = list.back().command;
  }

  const std::string& file_;
  const model::States& at_;
  const model::Machine& machine_;
  const PartProgramOptions& options_;
  Corrector& corrector_;
  text::Place place_;
  std::string letters_;
  Motion motion_ = Motion::kNone;
  int plane_ = 17;
  double unit_ = 1, feed_ = 0;  // mm or inch; mm/min, under G93 1/min
  bool absolute_ = true, inverse_time_ = false;
  VectorXd position_;  // of the machine, as the program means it
  VectorXd command_;   // what was written last; empty: nothing yet
  std::vector<char> known_;
  std::vector<double> turn_, sense_;  // where an axis last turned round, and how it moves
  std::vector<std::size_t> reached_;
  PartProgram result_;
};

}  // namespace

PartProgram corrected_program(const std::string& text, const std::string& file, const model::States& at,
                              const std::vector<char>& known, const PartProgramOptions& options,
                              Corrector& corrector) {
  refuse_corrected(text, file);
  return Translator(file, at, known, options, corrector).translate(text);
}

}  // namespace vernier::offline
