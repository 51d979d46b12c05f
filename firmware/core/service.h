// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <span>

#include "firmware/core/cycle/cycle.h"
#include "firmware/core/cycle/exchange.h"
#include "firmware/core/cycle/runner.h"
#include "firmware/core/link/gate.h"
#include "firmware/core/link/link.h"
#include "firmware/core/link/setting_ticket.h"
#include "firmware/core/link/store_desk.h"
#include "firmware/core/link/uploader.h"
#include "firmware/core/operator_memory.h"
#include "firmware/core/probing.h"
#include "hal/board.h"
#include "hal/command_link.h"
#include "hal/slot_store.h"

namespace vernier {

/// Settings of a board's daemon.
struct ServiceOptions {
  Wiring wiring;
  CycleLimits limits;
  Uploader::Options upload;
  OverrunLimits overruns;
  Nonce nonce{};              // of this start of the board; must not be predictable
  ChallengeSeed seed{};       // of this start, random and secret
  TimeUs sync_patience;       // beyond a tick's time, until the clock takes the place of the sync
  ProbeSettings probe;        // where the board has one; axes are filled in from the wiring
  bool store_beside = false;  // look_after_store() has a separate context: links never wait for the medium
  std::uint32_t healthy_toggle =
      0;                         // ticks between two edges of the healthy line while all is well; 0: it is on
  bool activate = false;         // bring the correction in when the board becomes ready, once for each
                                 // enable, unless the operator deactivated or held the correction
  bool clear_on_enable = false;  // switching the enable line on clears a fault that is latched; with
                                 // `activate` the correction then comes in, as after every clearing
  bool in_controller = false;    // tick() is called in the controller's own cycle (Runner::follow_caller)
  std::uint32_t ticks_kept = Exchange::kHistory;  // for readers of the history; powers of two
  std::uint32_t touches_kept = Exchange::kTouches;
};

/// Rights of a link of the board.
struct LinkRights {
  LinkAccess access = LinkAccess::kUpload;
  bool plain_commands = false;  // commands by register, which cannot be signed, though the board has keys
};

/// The board's program. The program has four duties that may run in separate contexts: the tick, the
/// guardian, the links and the store. The guardian hands programs over, ends trials and never waits for a
/// device. The store is the only duty that waits for the medium. The guardian may interrupt the links and the
/// store at any point, the tick all three. Exchange, Programs and StoreDesk connect the four duties. The
/// constructor takes all memory.
class Service : private CommandHandler {
 public:
  /// board, store: outlive the service. Not real-time safe.
  Service(ServiceOptions options, const Board& board, SlotStore& store);

  /// Checks the image of the store and gives it to the first tick. Restores the last settings of the operator
  /// and the latched fault. Not real-time safe.
  UploadResult boot();
  /// Starts like boot(), but runs an unsigned correction image that was given at the start of the board; the
  /// store is not changed. Not real-time safe.
  UploadResult boot_with(std::span<const std::uint8_t> image);

  /// Sleeps until the next tick is due and runs the tick. Real-time safe.
  TickReport tick() noexcept;

  /// Removes the correction from the next tick on; the correction cannot be applied again. Real-time safe.
  void end() noexcept { ending_ = true; }

  /// Sets a share of all corrections, which multiplies the shares that the links give to axes.
  /// Real-time safe.
  void set_weight(WeightQ16 weight) noexcept { weight_ = weight; }

  /// Sets the delay of the probe (ProbeSettings) for later edges. Real-time safe.
  void set_probe_delay(InstantNs delay) noexcept {
    if (probing_) probing_->set_delay(delay);
  }
  /// Gives a command of the board itself, like a command from a link. If a command is already waiting, this
  /// command stays and the new command is ignored. Real-time safe.
  void order(Command command) noexcept {
    Command none = Command::kNone;
    exchange_.command.compare_exchange_strong(none, command);
  }

  /// The guardian: hands programs over to the tick, ends trials. guard() never waits. Not real-time safe.
  void guard() noexcept { uploader_.programs().guard(now()); }
  /// Serves one link: waits at most `wait` for requests and answers them. Without store_beside, serve() also
  /// does all other duties except the tick. Not real-time safe.
  HalFault serve(CommandLink& link, TimeUs wait, const LinkRights& rights = {}) noexcept;
  /// The task of the store: executes the requests of the links that need the medium, and records the actions
  /// of the guardian. Returns true if a link can collect a reply. Not real-time safe.
  bool look_after_store() noexcept;
  bool store_is_asked() const noexcept {
    return desk_.asked() ||
           settings_told_.load(std::memory_order_relaxed) != settings_asked_.load(std::memory_order_relaxed);
  }
  /// Executes the tasks of the guardian and of the store in one context, one after the other. Not real-time
  /// safe.
  void look_after_programs() noexcept;

  /// True if an operator deactivated or held the correction before this start. For the context of boot().
  bool deactivated() const noexcept { return taken_out_; }
  /// The stored state of the operator.
  const OperatorMemory& operator_memory() const noexcept { return operator_; }

  const Cycle& cycle() const noexcept { return cycle_; }
  const Runner& runner() const noexcept { return runner_; }
  Cycle& cycle() noexcept { return cycle_; }
  const Uploader& uploader() const noexcept { return uploader_; }
  const Exchange& exchange() const noexcept { return exchange_; }

 private:
  // A percentile walks a whole histogram; one of the six is brought up to date every so many ticks.
  static constexpr std::uint32_t kTicksPerPercentile = 64;
  // Ten times a second the start values of an equation, for clients that read the shares of the effects.
  static constexpr std::uint32_t kTicksPerEquation = 100;

  std::uint32_t answer(const std::uint8_t* request, std::uint32_t size, std::uint8_t* reply) override;
  void comes_over(std::uint64_t connection) override { caller_.connection = connection; }
  void ends(std::uint64_t connection) override { gate_.forget({caller_.link, connection}); }
  bool was_signed() const override { return signed_; }
  std::uint32_t ticket() const override { return ticket_; }
  std::uint32_t later(std::uint32_t ticket, std::uint8_t* reply) override;
  void fill_registers(std::uint16_t* values) override { link_.fill_registers(values); }
  CommandGiven give(std::uint16_t command) override;
  std::uint32_t leave_setting(std::uint8_t op, std::uint8_t sequence) noexcept;
  std::uint32_t setting_stored(const SettingTicket& setting, std::uint8_t* reply) noexcept;
  bool tell_settings() noexcept;
  TimeUs now() noexcept { return TimeUs(board_.clock.now().count / 1000); }
  void take_over() noexcept;
  void restore() noexcept;
  void publish_operator() noexcept;
  Command next_command() noexcept;
  void read_enable() noexcept;
  void tell_health(const TickReport& report) noexcept;
  void pump() noexcept;
  void publish(const TickReport& report) noexcept;
  void publish_health() noexcept;
  void publish_state() noexcept;
  void publish_equation() noexcept;

  ServiceOptions options_;
  Board board_;
  Exchange exchange_;
  Uploader uploader_;
  OperatorMemory operator_;
  Cycle cycle_;
  Runner runner_;
  Link link_;
  Gate gate_;
  LinkRights rights_;    // of the link that is being served
  Caller caller_;        // of the request that is being answered
  bool signed_ = false;  // the last request
  std::optional<Probing> probing_;
  StoreDesk desk_;
  std::uint32_t ticket_ = 0;                                         // the links'
  std::atomic<std::uint32_t> settings_asked_{0}, settings_told_{0};  // ticks of the newest SettingTicket
  std::uint32_t stored_seen_ = 0;  // OperatorMemory::stored_ticks(), and when the links saw it change
  TimeUs stored_seen_at_;
  bool answered_ = false;  // the store's: its reply waits for the guardian
  std::uint32_t answer_size_ = 0;
  // Owned by the tick.
  std::uint32_t until_percentile_ = kTicksPerPercentile, percentile_ = 0, until_equation_ = kTicksPerEquation;
  HealthRecord health_;
  TickRecord record_;
  StateRecord state_;
  EquationRecord equation_;
  WeightQ16 weight_ = kFullWeight;
  bool activated_ = false, ending_ = false, enabled_ = true, to_clear_ = false;
  bool taken_out_ = false;  // by a command, also one before this start; only a command activates again
  std::uint32_t until_edge_ = 0;
  bool line_ = false;
  enum class Told : std::uint8_t { kNothing, kUnwell, kWell } told_ = Told::kNothing;
};

}  // namespace vernier
