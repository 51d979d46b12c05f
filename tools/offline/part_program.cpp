// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/offline/part_program.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <sstream>

#include "tools/offline/axis_motion.h"
#include "tools/offline/path_fit.h"
#include "tools/text/error.h"
#include "tools/text/words.h"

namespace vernier::offline {
namespace {

using Eigen::Index, Eigen::VectorXd;

constexpr double kMmPerInch = 25.4;
/// Shares of the deviation: a jump of the correction that gets a separate block, and the largest distance of
/// a block from the evaluated points; the rest is for the path between two of them.
constexpr double kJump = 0.1, kBlock = 0.8;

enum class Motion : std::uint8_t { kNone, kRapid, kLine, kClockwise, kCounterClockwise };

/// Where a written block ends: share of the move and axis positions to command there; the centre of an arc.
struct Vertex {
  double share = 0;
  VectorXd command;
  std::optional<Eigen::Vector2d> centre;
};

/// A stretch of a move with the correction in it, one point per column.
struct CorrectedStretch {
  std::vector<double> shares;
  model::States states;
  Eigen::MatrixXd commands;
  Eigen::MatrixXd between;  // at one position between every two of them, not used for the fit
};

bool is_one_of(const Word& word, std::initializer_list<double> codes) {
  return word.letter == 'G' && std::find(codes.begin(), codes.end(), word.value) != codes.end();
}

/// The output is absolute, and its arcs have their centre as a step, for every kind of input.
bool is_distance_mode(const Word& word) { return is_one_of(word, {90, 91}); }
std::string text_of(const Word& word) { return is_one_of(word, {90.1}) ? "G91.1" : word.text; }

class Translator {
 public:
  Translator(const std::string& file, const model::States& at, const std::vector<char>& known,
             const PartProgramOptions& options, Corrector& corrector)
      : file_(file),
        machine_(corrector.machine()),
        options_(options),
        corrector_(corrector),
        motion_of_(machine_, at),
        position_(static_cast<Index>(machine_.axes.size())),
        known_(known) {
    for (std::size_t i = 0; i < machine_.axes.size(); ++i) {
      position_[static_cast<Index>(i)] = at.axis[i][0];
      const std::string& name = machine_.axes[i].name;
      if (name.size() != 1)
        throw text::InputError(
            {machine_.file, machine_.axes[i].line}, name,
            "a part program can only have axis names of one letter; for other names use a CSV of positions");
      letters_ += static_cast<char>(std::toupper(static_cast<unsigned char>(name[0])));
    }
  }

  PartProgram translate(const std::string& text) {
    std::istringstream lines(text);
    bool marked = false;
    place_.file = file_;
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
    if (is_one_of(word,
                  {10, 28, 30, 33, 38.2, 38.3, 38.4, 38.5, 41, 41.1, 42, 42.1, 43.1, 51, 52,  53,  68,
                   73, 76, 81, 82, 83,   84,   85,   86,   87, 88,   89, 92,   95,   5,  5.1, 5.2, 5.3}))
      throw text::InputError(place_, word.text,
                             "this code changes positions in a way that `vernier correct` does not support; "
                             "replace it by single moves");
    if (word.letter == 'O' || word.letter == '#' ||
        (word.letter == 'M' && (word.value == 98 || word.value == 99)))
      throw text::InputError(place_, word.text,
                             "subprograms and loops are not supported: replace them by all their blocks");
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
    if (code == 90.1) absolute_centre_ = true;
    if (code == 91.1) absolute_centre_ = false;
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
      if (word.letter == 'G' && word.value == 4) moves = false;  // a dwell has different words
    }
    if (!moves) {
      result_.text += without_modes(line, words) + "\n";
      return;
    }
    if (motion_ == Motion::kNone)
      throw text::InputError(place_, line.substr(0, 20),
                             "there is no G0, G1, G2 or G3 before this axis word");
    move(words, arc);
  }

  static std::string without_modes(const std::string& line, const std::vector<Word>& words) {
    if (std::none_of(words.begin(), words.end(),
                     [](const Word& word) { return is_distance_mode(word) || text_of(word) != word.text; }))
      return line;
    std::string rest;
    for (const Word& word : words)
      if (!is_distance_mode(word)) rest += (rest.empty() ? "" : " ") + text_of(word);
    return rest;
  }

  /// Where a block goes: machine positions, mm and deg.
  VectorXd target_of(const std::vector<Word>& words, std::vector<std::size_t>& reached) {
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
        throw text::InputError(
            place_, word.text,
            "an incremental move starts at an unknown position of the axis: give this position with --at");
      reached.push_back(*axis);
    }
    return target;
  }

  void move(const std::vector<Word>& words, bool arc) {
    ++result_.moves;
    std::vector<std::size_t> reached;
    ProgramMove move{position_, target_of(words, reached), {}, 0};
    bool start_known = true;
    for (const char known : known_) start_known = start_known && known != 0;
    for (const std::size_t axis : reached) known_[axis] = 1;
    for (std::size_t i = 0; i < known_.size(); ++i)
      if (known_[i] == 0)
        throw text::InputError(
            place_, std::string(1, letters_[i]),
            "the position of this axis is not known yet: state the position in the first move, or with --at");
    if (arc && !start_known)
      throw text::InputError(place_, words.front().text,
                             "the start of this arc is not known; give it with --at");
    if (arc) move.arc = arc_of(words, arc_reading(), move.from, move.to, place_);
    const bool rapid = motion_ == Motion::kRapid;
    move.feed = rapid || inverse_time_ ? 0 : feed_;
    // A rapid move is no path. A move from an unknown position is not a cut either.
    write(words, move, rapid || !start_known ? end_of(move, start_known) : vertices(move));
    position_ = move.to;
  }

  ArcReading arc_reading() const {
    const std::array<char, 2> letters = plane_letters(plane_);
    const auto first = axis_of(letters[0]), second = axis_of(letters[1]);
    if (!first || !second)
      throw text::InputError(place_, fmt::format("G{}", plane_), "the machine lacks an axis of this plane");
    return {plane_,
            motion_ == Motion::kClockwise,
            absolute_centre_,
            unit_,
            {static_cast<Index>(*first), static_cast<Index>(*second)},
            {options_.zero[*first], options_.zero[*second]}};
  }

  std::vector<Vertex> end_of(const ProgramMove& move, bool start_known) {
    if (start_known) motion_of_.set_out(move.from, move.to);
    if (options_.watch) options_.watch({place_.line, true, false, {}});
    const model::States end = motion_of_.along(move, {1});
    const Eigen::MatrixXd there = corrector_.commands(end);
    corrector_.count(end, there);
    return {{1, there.col(0), {}}};
  }

  /// A place between every two, no simple part of the way.
  static std::vector<double> between(const std::vector<double>& shares) {
    constexpr double kGolden = 0.6180339887498949;  // golden section: the least rational share
    std::vector<double> places;
    for (std::size_t k = 0; k + 1 < shares.size(); ++k)
      places.push_back(shares[k] + kGolden * (shares[k + 1] - shares[k]));
    return places;
  }

  CorrectedStretch stretch(const ProgramMove& move, double from, double to) {
    CorrectedStretch result;
    result.shares = motion_of_.looks(move, from, to, options_.deviation_mm);
    motion_of_.set_out(move.at(from), move.at((from + to) / 2));
    result.states = motion_of_.along(move, result.shares);
    if (options_.watch)
      options_.watch(
          {place_.line, false, move.arc && (move.at(1) - move.at(0)).norm() < 1e-6, result.states});
    result.commands = corrector_.commands(result.states);
    corrector_.count(result.states, result.commands);
    result.between = corrector_.commands(motion_of_.along(move, between(result.shares)));
    return result;
  }

  /// Blocks of a path whose correction does not jump. The path begins where the block before it ends.
  void write_run(const ProgramMove& move, std::vector<CorrectedStretch>& run, std::vector<Vertex>& list) {
    if (run.empty()) return;
    std::vector<std::pair<std::size_t, Index>> of;  // stretch and point of a column
    for (std::size_t s = 0; s < run.size(); ++s)
      for (Index k = 0; k < run[s].commands.cols(); ++k) of.emplace_back(s, k);
    Eigen::MatrixXd points(position_.size(), static_cast<Index>(of.size()));
    std::optional<ArcGuide> guide;
    if (move.arc && options_.arcs) guide = ArcGuide{move.arc->axis, {}};
    for (std::size_t i = 0; i < of.size(); ++i) {
      points.col(static_cast<Index>(i)) = run[of[i].first].commands.col(of[i].second);
      if (guide)
        guide->angle.push_back(
            move.arc->angle(run[of[i].first].shares[static_cast<std::size_t>(of[i].second)]));
    }
    const VectorXd& last = list.empty() ? command_ : list.back().command;
    const bool from_last = last.size() > 0 && (points.col(0) - last).norm() <= kJump * options_.deviation_mm;
    if (from_last)
      points.col(0) = last;
    else if (last.size() > 0 || guide)
      list.push_back({run.front().shares[0], points.col(0), {}});
    Index from = 0;
    for (const PathPiece& piece : fit_path(points, guide, kBlock * options_.deviation_mm)) {
      for (Index k = from; k < piece.to; ++k) {
        const auto [part, place] = of[static_cast<std::size_t>(k)];
        if (place >= run[part].between.cols()) continue;  // from one stretch to the next
        result_.worst_mm = std::max(result_.worst_mm,
                                    distance_from(piece, points, from, guide, run[part].between.col(place)));
      }
      from = piece.to;
      VectorXd end = points.col(piece.to);
      // A whole turn ends on the very figures that it began with.
      if (piece.whole)
        for (const Index axis : guide->axis) end[axis] = points(axis, 0);
      const auto [s, k] = of[static_cast<std::size_t>(piece.to)];
      list.push_back({run[s].shares[static_cast<std::size_t>(k)], end, piece.centre});
    }
    run.clear();
  }

  /// The vertices of a move. Where an axis turns round the correction may jump: it is written there twice.
  std::vector<Vertex> vertices(const ProgramMove& move) {
    std::vector<Vertex> list;
    std::vector<CorrectedStretch> run;
    const std::vector<double> ends = motion_of_.stretches(move);
    for (std::size_t part = 0; part + 1 < ends.size(); ++part) {
      CorrectedStretch next = stretch(move, ends[part], ends[part + 1]);
      if (!run.empty() && (run.back().commands.rightCols(1) - next.commands.leftCols(1)).norm() >
                              kJump * options_.deviation_mm)
        write_run(move, run, list);
      run.push_back(std::move(next));
    }
    write_run(move, run, list);
    return list;
  }

  /// The words of a block that its blocks keep: of the first alone, but for the sign of what may be skipped.
  struct KeptWords {
    std::string each, before, feed, after;
  };
  KeptWords kept_words(const std::vector<Word>& words, bool arc) const {
    KeptWords kept;
    for (const Word& word : words) {
      if (word.letter == 'F') kept.feed = " " + word.text;
      if (axis_of(word.letter) || word.letter == 'F' || is_distance_mode(word)) continue;
      if (arc && std::string("IJKRP").find(word.letter) != std::string::npos) continue;
      if (is_one_of(word, {0, 1, 2, 3})) continue;
      if (word.letter == '(')
        kept.after += " " + word.text;
      else if (word.letter == '/')
        kept.each = "/";
      else
        kept.before += text_of(word) + " ";
    }
    return kept;
  }

  void write(const std::vector<Word>& words, const ProgramMove& move, const std::vector<Vertex>& list) {
    const KeptWords kept = kept_words(words, move.arc.has_value());
    const bool rapid = motion_ == Motion::kRapid;
    double begin = 0;
    for (std::size_t k = 0; k < list.size(); ++k) {
      const bool first = k == 0;
      result_.text += kept.each + (first ? kept.before : "") + (result_.written == 0 ? "G90 " : "");
      result_.text += rapid ? "G0" : !list[k].centre ? "G1" : motion_ == Motion::kClockwise ? "G2" : "G3";
      result_.text += position_words(list[k].command);
      if (list[k].centre) result_.text += centre_words(*list[k].centre, move.arc->axis);
      // A jump at a reversal takes the shortest time that can be written.
      constexpr double kLeastShare = 1e-6;
      if (inverse_time_ && !rapid)
        result_.text += fmt::format(" F{:.6g}", feed_ / std::max(list[k].share - begin, kLeastShare));
      else if (first)
        result_.text += kept.feed;
      result_.text += (first ? kept.after : "") + "\n";
      ++result_.written;
      if (list[k].centre) ++result_.arcs;
      begin = list[k].share;
      command_ = list[k].command;
    }
  }

  int digits() const { return options_.digits + (unit_ > 1 ? 1 : 0); }

  /// A machine position of an axis in the program's coordinates and units.
  double in_program(const VectorXd& command, std::size_t axis) const {
    return (command[static_cast<Index>(axis)] - options_.zero[axis]) /
           (machine_.axes[axis].rotary ? 1 : unit_);
  }

  std::string position_words(const VectorXd& command) const {
    std::string words;
    for (std::size_t i = 0; i < machine_.axes.size(); ++i)
      words += fmt::format(" {}{:.{}f}", letters_[i], in_program(command, i), digits());
    return words;
  }

  /// The step to the centre, from the start point as it is written.
  std::string centre_words(const Eigen::Vector2d& centre, const std::array<Index, 2>& axes) const {
    std::string words;
    const double count = std::pow(10, digits());
    VectorXd at = command_;
    for (Index k = 0; k < 2; ++k) at[axes[static_cast<std::size_t>(k)]] = centre[k];
    for (const Index axis : axes) {
      const auto i = static_cast<std::size_t>(axis);
      const double begin = std::round(in_program(command_, i) * count) / count;
      words += fmt::format(" {}{:.{}f}", static_cast<char>('I' + (letters_[i] - 'X')),
                           in_program(at, i) - begin, digits());
    }
    return words;
  }

  const std::string& file_;
  const model::Machine& machine_;
  const PartProgramOptions& options_;
  Corrector& corrector_;
  AxisMotion motion_of_;
  text::Place place_;
  std::string letters_;
  Motion motion_ = Motion::kNone;
  int plane_ = 17;
  double unit_ = 1, feed_ = 0;  // mm or inch; mm/min, under G93 1/min
  bool absolute_ = true, absolute_centre_ = false, inverse_time_ = false;
  VectorXd position_;  // of the machine, as the program means it
  VectorXd command_;   // last written positions; empty: not written yet
  std::vector<char> known_;
  PartProgram result_;
};

}  // namespace

PartProgram corrected_program(const std::string& text, const std::string& file, const model::States& at,
                              const std::vector<char>& known, const PartProgramOptions& options,
                              Corrector& corrector) {
  refuse_done(text, file, false);
  return Translator(file, at, known, options, corrector).translate(text);
}

}  // namespace vernier::offline
