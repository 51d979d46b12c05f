// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/fleet/rollout.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstring>
#include <map>
#include <memory>
#include <thread>

#include "tables/image_format.h"
#include "tools/registry/cells.h"
#include "tools/registry/shell_command.h"
#include "tools/text/error.h"
#include "tools/text/numbers.h"
#include "tools/text/wall_time.h"
#include "tools/text/words.h"

namespace vernier::fleet {
namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

constexpr auto kLookEvery = 200ms;
// So much of a trial's time stays for the answer to reach the board.
constexpr double kTrialMargin_s = 1;

std::string fingerprint_of(const std::vector<std::uint8_t>& image) {
  ImageHeader header;
  std::memcpy(&header, image.data(), sizeof(header));
  return text::fingerprint_text(header.fingerprint);
}

/// What a board is like before and while an image is on trial.
struct Look {
  Mode mode;
  Fault fault;
  std::uint64_t faults;
};

Look look_at(upload::Client& board) {
  const upload::BoardTick tick = board.newest();
  return {tick.mode, tick.fault, board.health().faults};
}

/// Why the board is worse than it was; empty: it is not.
std::string worse(const Look& before, const Look& now) {
  if (now.fault != Fault::kNone && now.fault != before.fault)
    return fmt::format("fault {}", name_of(now.fault));
  if (now.faults > before.faults) return "a fault came and went";
  if (before.mode == Mode::kActive && now.mode == Mode::kFaulted) return "it left the active mode";
  return {};
}

/// One machine's trial; what is wrong with it, or empty.
class Trial {
 public:
  Trial(const RolloutMachine& machine, const RolloutOptions& options, const std::atomic<bool>& stop)
      : machine_(machine),
        options_(options),
        stop_(stop),
        board_(upload::open_transport(upload::parse_url(machine.url))) {
    board_.sign_with(options.key);
  }

  /// Does the board run and keep the image already (an answer that was lost with an earlier attempt)?
  bool is_kept() {
    const SlotsReply slots = board_.slots();
    return slots.confirmed != kNoSlot && slots.trial == kNoSlot &&
           text::fingerprint_text(slots.confirmed_fingerprint) == fingerprint_of(machine_.image);
  }
  std::string run() {
    SlotsReply slots = board_.slots();
    if (slots.trial != kNoSlot) {  // of an attempt that was interrupted
      board_.revert();
      slots = board_.slots();
    }
    const Look before = look_at(board_);
    const auto issued =
        std::max<std::uint64_t>(static_cast<std::uint64_t>(text::now_us()), slots.newest_issued + 1);
    board_.upload(
        upload::make_upload(machine_.image, options_.key, issued, slots.security, board_.info().board),
        [](double) {});
    std::string wrong = watch(before);
    if (wrong.empty() && !options_.judge.empty()) wrong = judge();
    if (wrong.empty()) wrong = worse(before, look_at(board_));
    if (wrong.empty() && board_.slots().trial == kNoSlot) wrong = "the board has given it up by itself";
    return wrong;
  }
  void keep() { board_.confirm(); }
  void take_back() {
    if (board_.slots().trial != kNoSlot) board_.revert();
  }

 private:
  double left_s() { return board_.slots().trial_left_ms * 1e-3 - kTrialMargin_s; }

  std::string watch(const Look& before) {
    if (left_s() < options_.watch_s)
      return fmt::format("the board's trial is {:.0f} s long, shorter than it is to be watched", left_s());
    const auto end = Clock::now() + std::chrono::duration<double>(options_.watch_s);
    while (Clock::now() < end) {
      if (stop_) return "interrupted";
      std::this_thread::sleep_for(kLookEvery);
      if (std::string wrong = worse(before, look_at(board_)); !wrong.empty()) return wrong;
    }
    return {};
  }
  std::string judge() {
    const double patience = left_s();
    std::string command = registry::command_for(options_.judge, machine_.name);
    registry::ShellCommand running(command);
    const auto end = Clock::now() + std::chrono::duration<double>(patience);
    while (!running.wait(50ms)) {
      if (stop_) return "interrupted";
      if (Clock::now() > end) return "nobody judged it within the board's trial";
    }
    if (running.status() == 0) return {};
    return fmt::format("judged {}: {}",
                       running.status() == 2 ? "worse" : "with status " + std::to_string(running.status()),
                       running.last_line());
  }

  const RolloutMachine& machine_;
  const RolloutOptions& options_;
  const std::atomic<bool>& stop_;
  upload::Client board_;
};

/// The rollout's rows of the registry.
class RolloutBook {
 public:
  RolloutBook(registry::Registry& registry, std::string name) : registry_(registry), name_(std::move(name)) {}
  void enter(const std::vector<RolloutMachine>& machines) {
    registry::Transaction transaction(registry_.database());
    for (std::size_t i = 0; i < machines.size(); ++i)
      registry_.database().run(
          "INSERT INTO rollout VALUES ($1, $2, $3, $4, $5, 'waiting', '', $6) ON CONFLICT (name, machine) DO "
          "UPDATE "
          "SET stage = excluded.stage, place = excluded.place",
          {name_, machines[i].name, registry::cell(machines[i].stage),
           registry::cell(static_cast<std::int64_t>(i)), fingerprint_of(machines[i].image),
           registry::cell(text::now_us())});
    transaction.commit();
  }
  void write(const RolloutMachine& machine, const char* state, const std::string& said) {
    registry_.database().run(
        "UPDATE rollout SET state = $1, said = $2, at_us = $3, image = $4 WHERE name = $5 AND machine = $6",
        {state, said, registry::cell(text::now_us()), fingerprint_of(machine.image), name_, machine.name});
  }

 private:
  registry::Registry& registry_;
  std::string name_;
};

[[noreturn]] void stop_at(const std::string& machine, const std::string& why) {
  throw text::LimitNotMet(machine + ": " + why + ": taken back, and the rollout stands");
}

/// Brings it to one machine; true: kept, false: the board is away.
bool bring_to(const RolloutMachine& machine, const RolloutOptions& options, RolloutBook& book,
              const std::atomic<bool>& stop, const Say& say) {
  std::unique_ptr<Trial> trial;
  try {
    trial = std::make_unique<Trial>(machine, options, stop);
    if (trial->is_kept()) {
      book.write(machine, "kept", "");
      return true;
    }
  } catch (const text::InputError& error) {
    book.write(machine, "away", error.what());
    say(machine.name + ": away: " + error.what());
    return false;
  }
  book.write(machine, "trial", "");
  std::string wrong;
  try {
    wrong = trial->run();
  } catch (const std::runtime_error& error) {
    wrong = error.what();
  }
  if (wrong.empty()) {
    trial->keep();
    book.write(machine, "kept", "");
    say(machine.name + ": kept");
    return true;
  }
  try {
    trial->take_back();
  } catch (const std::runtime_error& error) {
    wrong += fmt::format(" (the board does not answer, {}: it goes back by itself when its trial is over)",
                         error.what());
  }
  // Who interrupts has not judged: the machine waits.
  book.write(machine, wrong == "interrupted" ? "waiting" : "taken-back", wrong);
  stop_at(machine.name, wrong);
}

/// Are machines that were kept still well? Throws LimitNotMet at the first that is not.
void look_again(const std::vector<RolloutMachine>& machines, std::size_t count, const Say& say) {
  for (std::size_t i = 0; i < count; ++i) {
    try {
      upload::Client board(upload::open_transport(upload::parse_url(machines[i].url)));
      const Look now = look_at(board);
      if (now.fault != Fault::kNone)
        throw text::LimitNotMet(fmt::format("{}: fault {} since it was kept: the rollout stands",
                                            machines[i].name, name_of(now.fault)));
    } catch (const text::InputError& error) {
      say(machines[i].name + ": cannot be looked at again: " + error.what());
    }
  }
}

}  // namespace

std::vector<std::size_t> stage_ends(const std::string& stages, std::size_t machines) {
  std::vector<std::size_t> ends;
  for (const std::string& one : text::parts_of(stages, ',')) {
    const bool share = one.ends_with('%');
    const auto number = text::parse_number(share ? one.substr(0, one.size() - 1) : one);
    if (!number || *number <= 0 || (share && *number > 100) || (!share && *number != std::floor(*number)))
      throw text::InputError({}, one, "a stage is a number of machines, or a share such as 10%");
    const double count = share ? std::ceil(*number / 100 * static_cast<double>(machines)) : *number;
    const auto end = std::min(machines, static_cast<std::size_t>(std::min(count, 1e9)));
    if (ends.empty() || end > ends.back()) ends.push_back(end);
  }
  if (ends.empty() || ends.back() < machines) ends.push_back(machines);
  return ends;
}

void roll_out(registry::Registry& registry, const std::vector<RolloutMachine>& machines,
              const RolloutOptions& options, const std::atomic<bool>& stop, const Say& say,
              const std::function<void(const RolloutMachine&)>& kept) {
  RolloutBook book(registry, options.name);
  book.enter(machines);
  std::map<std::string, RolloutState> states;
  for (RolloutState& state : rollout_states(registry, options.name)) states[state.machine] = state;
  for (const auto& [machine, state] : states)
    if (state.state == "taken-back")
      throw text::LimitNotMet("this rollout stands since " + machine + " (" + state.said +
                              "): --go-on lets it go on");
  std::size_t away = 0;
  for (std::size_t i = 0; i < machines.size(); ++i) {
    if (i > 0 && machines[i].stage != machines[i - 1].stage) {
      if (away > 0)
        throw text::LimitNotMet(
            fmt::format("{} boards of this stage are away: the next stage waits for them", away));
      look_again(machines, i, say);
    }
    if (stop) throw text::LimitNotMet("interrupted");
    const RolloutState& state = states[machines[i].name];
    if (state.state == "kept" && state.image == fingerprint_of(machines[i].image)) continue;
    if (bring_to(machines[i], options, book, stop, say))
      kept(machines[i]);
    else
      ++away;
  }
  if (away > 0) throw text::LimitNotMet(fmt::format("{} boards were away: call it again", away));
}

std::vector<RolloutState> rollout_states(registry::Registry& registry, const std::string& name) {
  std::vector<RolloutState> states;
  for (const registry::Row& row :
       registry.database().run("SELECT machine, state, said, image, stage, at_us FROM "
                               "rollout WHERE name = $1 ORDER BY place, machine",
                               {name}))
    states.push_back({registry::words(row[0]), registry::words(row[1]), registry::words(row[2]),
                      registry::words(row[3]), registry::whole(row[4]), registry::whole(row[5])});
  return states;
}

void allow_rollout(registry::Registry& registry, const std::string& name) {
  registry.database().run("UPDATE rollout SET state = 'waiting' WHERE name = $1 AND state = 'taken-back'",
                          {name});
}

}  // namespace vernier::fleet
