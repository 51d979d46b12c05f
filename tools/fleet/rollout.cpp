// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/fleet/rollout.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <utility>

#include "tools/text/error.h"
#include "tools/text/numbers.h"
#include "tools/text/words.h"
#include "tools/upload/open_transport.h"

namespace vernier::fleet {
namespace {

std::vector<std::string> names_of(const std::vector<RolloutMachine>& machines) {
  std::vector<std::string> names;
  for (const RolloutMachine& one : machines) names.push_back(one.name);
  return names;
}

/// One call of a rollout.
class RolloutCall {
 public:
  RolloutCall(registry::Registry& registry, std::vector<RolloutMachine> machines,
              const RolloutOptions& options, const std::atomic<bool>& stop, const Say& say,
              const std::function<void(const RolloutMachine&)>& kept)
      : registry_(registry),
        machines_(std::move(machines)),
        options_(options),
        stop_(stop),
        say_(say),
        kept_(kept),
        locks_(registry, names_of(machines_), "rollout " + options.name, options.lease_s),
        book_(registry, options.name, locks_) {}

  RolloutEnd run() {
    book_.enter(machines_);
    if (options_.go_on) book_.allow();
    for (RolloutState& state : rollout_states(registry_, options_.name)) states_[state.machine] = state;
    try {
      stages();
      if (end_.stood.empty()) look_again();
    } catch (const registry::LockLost& lost) {
      end_.stood = lost.what();
      end_.in_effect.clear();
    }
    return std::move(end_);
  }

 private:
  bool is_kept(const RolloutMachine& machine) const {
    const RolloutState& state = states_.at(machine.name);
    return state.state == "kept" && state.image == text::fingerprint_text(fingerprint_of(machine));
  }

  void stages() {
    for (const auto& [machine, state] : states_)
      if (state.state == "taken-back")
        return stand(
            fmt::format("this rollout is stopped since {} ({}); the option --go-on continues the rollout",
                        machine, state.said));
    look_again();
    std::size_t away = 0;
    for (std::size_t i = 0; i < machines_.size() && end_.stood.empty(); ++i) {
      if (i > 0 && machines_[i].stage != machines_[i - 1].stage && !next_stage(away)) return;
      if (stop_) return stand("interrupted");
      if (!is_kept(machines_[i]) && !bring_to(machines_[i])) ++away;
    }
    // A machine that stopped elsewhere must not be reported as kept because of an earlier look.
    if (!end_.stood.empty() && !stop_) return look_again();
    if (away > 0) stand(fmt::format("{} boards did not answer: call `vernier fleet rollout` again", away));
  }

  bool next_stage(std::size_t away) {
    if (away > 0)
      stand(
          fmt::format("{} boards of this stage do not answer: the next stage begins when they answer", away));
    look_again();
    return end_.stood.empty();
  }

  void stand(const std::string& why) {
    if (end_.stood.empty()) end_.stood = why;
  }
  void write(const RolloutMachine& machine, const char* state, const std::string& said) {
    book_.write(machine, state, said);
    states_[machine.name].state = state;
    states_[machine.name].image = text::fingerprint_text(fingerprint_of(machine));
    say_(machine.name + ": " + state + (said.empty() ? "" : ": " + said));
  }

  /// Looks at every kept machine; the first that is not well any more stops the rollout.
  void look_again() {
    end_.in_effect.clear();
    for (const RolloutMachine& machine : machines_) {
      if (!is_kept(machine) || stop_) continue;
      const KeptLook look = look_at_kept(machine, options_, locks_, stop_);
      if (look.why.empty()) {
        end_.in_effect.insert(machine.name);
        continue;
      }
      write(machine, look.away ? "away" : "not-in-effect", "was kept, but now: " + look.why);
      stand(machine.name + ": was kept, but now: " + look.why + ": the rollout stops");
    }
  }

  /// Enters the board's key if no key is entered. Throws LimitNotMet if another machine has this key.
  void learn_key(RolloutMachine& machine) {
    if (machine.claim.key) return;
    upload::Client board(upload::open_transport(upload::parse_url(machine.url)));
    board.require_board(machine.claim);
    const auto key = board.proved_key();
    if (!key) {
      end_.notes.push_back(
          fmt::format("{}: only the name of the board was compared: the board has no key, and another board "
                      "with the same name would pass",
                      machine.name));
      return;
    }
    const std::string text = upload::board_key_text(*key);
    if (!registry_.trust_board_key(machine.name, text) && registry_.machine(machine.name).board_key != text)
      throw text::LimitNotMet(
          "the registry has the key of this board for another machine: test whether the address is right");
    machine.claim.key = key;
    end_.notes.push_back(fmt::format(
        "{}: the key of its board was not known before and was trusted on first use", machine.name));
    say_(fmt::format("{}: the key of its board is entered in the registry (first use): {}", machine.name,
                     text));
  }

  /// One machine's turn. False: the board is away, and the stage may go on.
  bool bring_to(RolloutMachine& machine) {
    TrialEnd end{TrialEnd::Kind::kAway, {}};
    try {
      learn_key(machine);
      ImageTrial trial(machine, options_, book_, locks_, stop_);
      end = trial.run(states_.at(machine.name).issued);
    } catch (const registry::LockLost&) {
      throw;
    } catch (const text::InputError& error) {
      end = {TrialEnd::Kind::kAway, error.what()};
    } catch (const text::LimitNotMet& error) {
      end = {TrialEnd::Kind::kRefused, std::string(error.what()) + "; nothing was sent"};
    }
    write(machine, name_of(end.kind), end.why);
    if (end.kind == TrialEnd::Kind::kKept) kept_(machine);
    if (end.kind == TrialEnd::Kind::kTakenBack)
      stand(fmt::format("{}: {}: the image was reverted, and the rollout stops", machine.name, end.why));
    else if (end.kind != TrialEnd::Kind::kKept && end.kind != TrialEnd::Kind::kAway)
      stand(machine.name + ": " + end.why + ": the rollout stops");
    return end.kind != TrialEnd::Kind::kAway;
  }

  registry::Registry& registry_;
  std::vector<RolloutMachine> machines_;
  const RolloutOptions& options_;
  const std::atomic<bool>& stop_;
  const Say& say_;
  const std::function<void(const RolloutMachine&)>& kept_;
  registry::MachineLocks locks_;
  RolloutBook book_;
  std::map<std::string, RolloutState> states_;
  RolloutEnd end_;
};

}  // namespace

std::vector<std::size_t> stage_ends(const std::string& stages, std::size_t machines) {
  std::vector<std::size_t> ends;
  for (const std::string& one : text::parts_of(stages, ',')) {
    const bool share = one.ends_with('%');
    const auto number = text::parse_number(share ? one.substr(0, one.size() - 1) : one);
    if (!number || *number <= 0 || (share && *number > 100) || (!share && *number != std::floor(*number)))
      throw text::InputError({}, one, "a stage must be a number of machines, or a share such as 10%");
    const double count = share ? std::ceil(*number / 100 * static_cast<double>(machines)) : *number;
    const auto end = std::min(machines, static_cast<std::size_t>(std::min(count, 1e9)));
    if (ends.empty() || end > ends.back()) ends.push_back(end);
  }
  if (ends.empty() || ends.back() < machines) ends.push_back(machines);
  return ends;
}

RolloutEnd roll_out(registry::Registry& registry, std::vector<RolloutMachine> machines,
                    const RolloutOptions& options, const std::atomic<bool>& stop, const Say& say,
                    const std::function<void(const RolloutMachine&)>& kept) {
  return RolloutCall(registry, std::move(machines), options, stop, say, kept).run();
}

}  // namespace vernier::fleet
