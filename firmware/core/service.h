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

/// Settings of the program of a board.
struct ServiceOptions {
  Wiring wiring;
  CycleLimits limits;
  Uploader::Options upload;
  OverrunLimits overruns;
  Nonce nonce{};              // new random number for each start of the board; it must not be predictable
  ChallengeSeed seed{};       // new random and secret number for each start
  TimeUs sync_patience;       // time after the due time of a tick; then the clock starts the tick instead of
                              // the sync signal
  ProbeSettings probe;        // settings of the touch probe if the board has one; the axes come from the
                              // wiring
  bool store_beside = false;  // true: look_after_store() runs in its own thread, so that links never wait for
                              // the medium
  std::uint32_t healthy_toggle = 0;  // number of ticks between two edges of the output `healthy` while the
                                     // board is well; 0: the output is constantly on
  bool activate = false;             // true: the correction is applied when the board becomes ready, once for
                                     // each enable signal. Exception: the operator deactivated or held the
                                     // correction
  bool clear_on_enable = false;      // true: the enable signal clears a latched fault. With `activate`, the
                                     // correction is then applied, as after every clearing of a fault
  bool in_controller = false;  // true: the controller calls tick() in its own cycle (Runner::follow_caller)
  std::uint32_t ticks_kept = Exchange::kHistory;  // numbers of stored ticks and touches for readers of the
                                                  // history; powers of two
  std::uint32_t touches_kept = Exchange::kTouches;
};

/// Access rights of a link of the board.
struct LinkRights {
  LinkAccess access = LinkAccess::kUpload;
  bool plain_commands = false;  // true: commands by register are permitted although the board has keys; such
                                // commands cannot be signed
};

/// The program of a board. The program has four duties, which may run in separate threads: the tick, the
/// guardian, the links and the store. The guardian gives programs to the tick, ends trials, and never waits
/// for a device. Only the store waits for the medium (storage). The guardian may interrupt the links and the
/// store at any point. The tick may interrupt the other three duties. Exchange, Programs and StoreDesk
/// connect the four duties. The constructor allocates all memory.
class Service : private CommandHandler {
 public:
  /// `board`, `store`: must exist longer than the service. Not real-time safe.
  Service(ServiceOptions options, const Board& board, SlotStore& store);

  /// Checks the image in the store and gives it to the first tick. boot() also restores the last settings of
  /// the operator and the latched fault. Not real-time safe.
  UploadResult boot();
  /// Starts the board like boot(), but runs an unsigned correction image that is given at the start. The
  /// store is not changed. Not real-time safe.
  UploadResult boot_with(std::span<const std::uint8_t> image);

  /// Sleeps until the next tick is due and runs the tick. Real-time safe.
  TickReport tick() noexcept;

  /// Removes the correction, beginning with the next tick. After end(), the correction cannot be applied
  /// again. Real-time safe.
  void end() noexcept { ending_ = true; }

  /// Sets the weight of all corrections. The weight of all corrections multiplies the weights that the links
  /// set for the axes. Real-time safe.
  void set_weight(WeightQ16 weight) noexcept { weight_ = weight; }

  /// Sets the delay of the probe (ProbeSettings) for later edges of its signal. Real-time safe.
  void set_probe_delay(InstantNs delay) noexcept {
    if (probing_) probing_->set_delay(delay);
  }
  /// Gives a command from the board itself, with the effect of a command from a link. If a command is already
  /// waiting, it stays, and the new command is ignored. Real-time safe.
  void order(Command command) noexcept {
    Command none = Command::kNone;
    exchange_.command.compare_exchange_strong(none, command);
  }

  /// Executes the duty of the guardian: gives programs to the tick and ends trials. The function guard()
  /// never waits. Not real-time safe.
  void guard() noexcept { uploader_.programs().guard(now()); }
  /// Serves one link: waits for requests for at most `wait`, and answers them. If store_beside is false,
  /// serve() also executes all other duties except the tick. Not real-time safe.
  HalFault serve(CommandLink& link, TimeUs wait, const LinkRights& rights = {}) noexcept;
  /// Executes the duty of the store: executes requests of the links that need the medium, and records the
  /// actions of the guardian. Returns true if a reply is ready for a link. Not real-time safe.
  bool look_after_store() noexcept;
  bool store_is_asked() const noexcept {
    return desk_.asked() ||
           settings_told_.load(std::memory_order_relaxed) != settings_asked_.load(std::memory_order_relaxed);
  }
  /// Executes the duties of the guardian and of the store in one thread, one after the other. Not real-time
  /// safe.
  void look_after_programs() noexcept;

  /// True if an operator deactivated or held the correction before this start of the board. Only the thread
  /// that calls boot() may call deactivated().
  bool deactivated() const noexcept { return taken_out_; }
  /// Returns the stored settings of the operator.
  const OperatorMemory& operator_memory() const noexcept { return operator_; }

  const Cycle& cycle() const noexcept { return cycle_; }
  const Runner& runner() const noexcept { return runner_; }
  Cycle& cycle() noexcept { return cycle_; }
  const Uploader& uploader() const noexcept { return uploader_; }
  const Exchange& exchange() const noexcept { return exchange_; }

 private:
  // A percentile needs a pass over a whole histogram. To spread the computing time, one of the six
  // percentiles is computed every kTicksPerPercentile ticks.
  static constexpr std::uint32_t kTicksPerPercentile = 64;
  // The start values of the equation are published ten times a second (every kTicksPerEquation ticks), for
  // clients that read the shares of the effects.
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
  LinkRights rights_;    // rights of the link that is being served
  Caller caller_;        // sender of the request that is being answered
  bool signed_ = false;  // true: the last request was signed
  std::optional<Probing> probing_;
  StoreDesk desk_;
  std::uint32_t ticket_ = 0;                                         // ticket for the reply to a link
  std::atomic<std::uint32_t> settings_asked_{0}, settings_told_{0};  // tick of the newest SettingTicket
  std::uint32_t stored_seen_ = 0;  // last value of OperatorMemory::stored_ticks(), and the time at which the
                                   // links saw it change
  TimeUs stored_seen_at_;
  bool answered_ = false;  // true: the reply of the store waits for the guardian
  std::uint32_t answer_size_ = 0;
  // Members that only the tick uses.
  std::uint32_t until_percentile_ = kTicksPerPercentile, percentile_ = 0, until_equation_ = kTicksPerEquation;
  HealthRecord health_;
  TickRecord record_;
  StateRecord state_;
  EquationRecord equation_;
  WeightQ16 weight_ = kFullWeight;
  bool activated_ = false, ending_ = false, enabled_ = true, to_clear_ = false;
  bool taken_out_ = false;  // true: a command deactivated the correction, possibly before this start; only a
                            // command can activate it again
  std::uint32_t until_edge_ = 0;
  bool line_ = false;
  enum class Told : std::uint8_t { kNothing, kUnwell, kWell } told_ = Told::kNothing;
};

}  // namespace vernier
