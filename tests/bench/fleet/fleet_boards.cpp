// SPDX-License-Identifier: GPL-3.0-or-later
// usage: fleet_boards FIRST COUNT PORT BOOT JOURNAL
// Boards FIRST .. FIRST + COUNT - 1 in one process: the real service and link of each, on a simulated
// machine, at ports PORT on; an image runs in each. Board i is named board-i and reads T = 20 + i / 1000 degC
// and Boot = BOOT. Each tick that a board has told somebody is a line of JOURNAL: board, boot, tick, position
// of X in nm, milliseconds since 1970. Goes on until it is killed.
#include <poll.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>
#include <vector>

#include "firmware/core/service.h"
#include "hal/linux/modbus/modbus_server.h"
#include "hal/sim/plant.h"
#include "hal/sim/roaming.h"
#include "hal/sim/sim_clock.h"
#include "hal/sim/sim_slot_store.h"
#include "tables/link_format.h"
#include "tests/unit/firmware/small_machine.h"

namespace vernier {
namespace {

using WallClock = std::chrono::steady_clock;

/// Passes requests on and notes what was told of ticks.
class Noting : public CommandHandler {
 public:
  Noting(CommandHandler& handler, int board, int boot, std::FILE* journal)
      : handler_(handler), board_(board), boot_(boot), journal_(journal) {}
  std::uint32_t answer(const std::uint8_t* request, std::uint32_t size, std::uint8_t* reply) override {
    const std::uint32_t bytes = handler_.answer(request, size, reply);
    if (size >= kRequestHeaderBytes && request[0] == static_cast<std::uint8_t>(LinkOp::kTick) &&
        bytes != kLater && bytes >= kReplyHeaderBytes + sizeof(LinkTick) + sizeof(LinkAxis) && reply[2] == 0)
      note(reply + kReplyHeaderBytes);
    return bytes;
  }
  void comes_over(std::uint64_t connection) override { handler_.comes_over(connection); }
  void ends(std::uint64_t connection) override { handler_.ends(connection); }
  bool was_signed() const override { return handler_.was_signed(); }
  std::uint32_t ticket() const override { return handler_.ticket(); }
  std::uint32_t later(std::uint32_t ticket, std::uint8_t* reply) override {
    return handler_.later(ticket, reply);
  }
  void fill_registers(std::uint16_t* values) override { handler_.fill_registers(values); }
  CommandGiven give(std::uint16_t command) override { return handler_.give(command); }

 private:
  void note(const std::uint8_t* told) const {
    LinkTick tick;
    LinkAxis axis;
    std::memcpy(&tick, told, sizeof(tick));
    std::memcpy(&axis, told + sizeof(tick), sizeof(axis));
    const auto now = std::chrono::system_clock::now().time_since_epoch();
    std::fprintf(journal_, "%d %d %llu %lld %lld\n", board_, boot_,
                 static_cast<unsigned long long>(tick.number), static_cast<long long>(axis.position),
                 static_cast<long long>(std::chrono::duration_cast<std::chrono::milliseconds>(now).count()));
    std::fflush(journal_);
  }
  CommandHandler& handler_;
  int board_, boot_;
  std::FILE* journal_;
};

/// A link whose answers are noted.
class NotedLink : public CommandLink {
 public:
  NotedLink(std::unique_ptr<ModbusServer> server, int board, int boot, std::FILE* journal)
      : server_(std::move(server)), board_(board), boot_(boot), journal_(journal) {}
  HalFault serve(CommandHandler& handler, TimeUs wait) noexcept override {
    Noting noting(handler, board_, boot_, journal_);
    return server_->serve(noting, wait);
  }
  std::uint32_t handles(int* handles, std::uint32_t room) const noexcept override {
    return server_->handles(handles, room);
  }

 private:
  std::unique_ptr<ModbusServer> server_;
  int board_, boot_;
  std::FILE* journal_;
};

class SimulatedBoard {
 public:
  SimulatedBoard(int number, int port, int boot, std::FILE* journal, const std::vector<std::uint8_t>& image)
      : motion_({{0, 600'000'000}, {0, 200'000'000}},
                {InputMicro(20'000'000 + 1000 * number), InputMicro(1'000'000LL * boot)}, TimeUs(1000), 0.1,
                static_cast<std::uint64_t>(number) + 1),
        plant_(motion_, 2, 2, {}) {
    std::string error;
    auto server =
        ModbusServer::tcp("127.0.0.1", port, {kMailboxRegister, kMailboxRegisters, kLiveRegisters}, error);
    if (!server) {
      std::fprintf(stderr, "fleet_boards: %s\n", error.c_str());
      std::exit(1);
    }
    link_ = std::make_unique<NotedLink>(std::move(server), number, boot, journal);
    ServiceOptions options;
    options.wiring = {{{"X"}, {"Y"}}, {"T", "Boot"}};
    options.upload.identity.board = Name(std::string_view("board-" + std::to_string(number)));
    options.activate = true;
    options.ticks_kept = 64;
    service_ = std::make_unique<Service>(
        options, Board{.clock = clock_, .axes = plant_, .inputs = plant_, .corrections = plant_}, store_);
    if (service_->boot_with(image).fault != UploadFault::kNone) {
      std::fprintf(stderr, "fleet_boards: the image does not run\n");
      std::exit(1);
    }
    plant_.release();
    // A real board has a hundred ticks behind it, and with them its first picture of the equation, before
    // anybody can ask.
    for (int i = 0; i < 300; ++i) tick();
  }
  void tick() {
    plant_.advance();
    service_->look_after_programs();
    service_->tick();
  }
  void serve() { service_->serve(*link_, TimeUs(0)); }
  void handles(std::vector<pollfd>& all) const {
    int handles[16];
    const std::uint32_t count = link_->handles(handles, 16);
    for (std::uint32_t i = 0; i < count; ++i) all.push_back({handles[i], POLLIN, 0});
  }

 private:
  SimSlotStore store_{1 << 14};
  Roaming motion_;
  SimClock clock_;
  SimPlant plant_;
  std::unique_ptr<NotedLink> link_;
  std::unique_ptr<Service> service_;
};

int run(int first, int count, int port, int boot, const char* journal_path) {
  std::FILE* const journal = std::fopen(journal_path, "a");
  if (journal == nullptr) return 1;
  const std::string text = kSmallMachine;
  const auto image = compile_machine(parse_machine(text, "small.xml"), text, {}).image;
  std::vector<std::unique_ptr<SimulatedBoard>> boards;
  for (int i = 0; i < count; ++i)
    boards.push_back(std::make_unique<SimulatedBoard>(first + i, port + i, boot, journal, image));
  // Twenty ticks a second: more than is asked for, so that two samples are never of one tick.
  constexpr auto kTick = std::chrono::milliseconds(50);
  for (auto due = WallClock::now();;) {
    if (WallClock::now() >= due) {
      for (const auto& board : boards) board->tick();
      due = std::max(due + kTick, WallClock::now() - kTick);
    }
    std::vector<pollfd> waiting;
    for (const auto& board : boards) board->handles(waiting);
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(due - WallClock::now()).count();
    const int ready =
        ::poll(waiting.data(), waiting.size(), static_cast<int>(std::max<std::int64_t>(left, 0)));
    if (ready > 0)
      for (const auto& board : boards) board->serve();
  }
}

}  // namespace
}  // namespace vernier

int main(int argc, char** argv) {
  if (argc != 6) {
    std::fprintf(stderr, "usage: fleet_boards FIRST COUNT PORT BOOT JOURNAL\n");
    return 1;
  }
  return vernier::run(std::atoi(argv[1]), std::atoi(argv[2]), std::atoi(argv[3]), std::atoi(argv[4]),
                      argv[5]);
}
