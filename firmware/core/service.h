// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <memory>
#include <optional>

#include "firmware/core/cycle.h"
#include "firmware/core/exchange.h"
#include "firmware/core/link.h"
#include "firmware/core/probing.h"
#include "firmware/core/runner.h"
#include "firmware/core/uploader.h"
#include "hal/board.h"
#include "hal/command_link.h"
#include "hal/slot_store.h"

namespace vernier {

/// What a board's daemon is made with.
struct ServiceOptions {
  Wiring wiring;
  CycleLimits limits;
  Uploader::Options upload;
  OverrunLimits overruns;
  TimeUs sync_patience;   // beyond a tick's time, until the clock takes the place of the sync
  ProbeSettings probe;    // where the board has one; axes are filled in from the wiring
  bool activate = false;  // bring the correction in when the board becomes ready, once for each enable
  std::uint32_t ticks_kept = Exchange::kHistory;  // for readers of the history; powers of two
  std::uint32_t touches_kept = Exchange::kTouches;
};

/// The board's program: on one side the tick, which never waits; on the other, in a thread of their own,
/// uploads and links. Between them stands Exchange. All memory is taken at construction.
class Service : private CommandHandler {
 public:
  /// board, store: outlive the service. setup.
  Service(ServiceOptions options, const Board& board, SlotStore& store);

  /// Checks what the store holds and offers it to the first tick. setup.
  UploadResult boot() { return uploader_.boot(); }

  /// Sleeps until the next tick is due and runs it. realtime.
  TickReport tick() noexcept;

  /// From the next tick on the correction is taken out and nothing brings it in again. realtime.
  void end() noexcept { ending_ = true; }

  /// Waits at most `wait` for requests of one link, answers them, and looks after trials and programs. setup.
  HalFault serve(CommandLink& link, TimeUs wait) noexcept;
  /// The same without a link: hands programs over, ends trials. setup.
  void look_after_programs() noexcept;

  const Cycle& cycle() const noexcept { return cycle_; }
  const Runner& runner() const noexcept { return runner_; }
  Cycle& cycle() noexcept { return cycle_; }
  const Uploader& uploader() const noexcept { return uploader_; }
  const Exchange& exchange() const noexcept { return exchange_; }

 private:
  // A percentile walks a whole histogram; one of the six is brought up to date every so many ticks.
  static constexpr std::uint32_t kTicksPerPercentile = 64;
  // Ten pictures a second of what each effect adds.
  static constexpr std::uint32_t kTicksPerShares = 100;

  std::uint32_t answer(const std::uint8_t* request, std::uint32_t size, std::uint8_t* reply) override;
  void fill_registers(std::uint16_t* values) override { link_.fill_registers(values); }
  bool give(std::uint16_t command) override;
  TimeUs now() noexcept { return TimeUs(board_.clock.now().count / 1000); }
  void take_over() noexcept;
  Command next_command() noexcept;
  void read_enable() noexcept;
  void tell_health(const TickReport& report) noexcept;
  void publish(const TickReport& report) noexcept;
  void publish_health() noexcept;
  void publish_shares() noexcept;

  ServiceOptions options_;
  Board board_;
  Uploader uploader_;
  Exchange exchange_;
  Cycle cycle_;
  Runner runner_;
  Link link_;
  std::optional<Probing> probing_;
  // Owned outside the tick: what runs, and what has been offered to it.
  ProgramRef running_, offered_, waiting_;
  std::uint64_t programs_ = 0;  // taken over by the tick so far
  // Owned by the tick.
  std::uint32_t until_percentile_ = kTicksPerPercentile, percentile_ = 0, until_shares_ = kTicksPerShares;
  HealthRecord health_;
  TickRecord record_;
  ShareRecord shares_;
  Correction share_corrections_[kMaxShares];
  bool activated_ = false, ending_ = false, enabled_ = true;
  enum class Told : std::uint8_t { kNothing, kUnwell, kWell } told_ = Told::kNothing;
};

}  // namespace vernier
