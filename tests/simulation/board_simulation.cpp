// SPDX-License-Identifier: GPL-3.0-or-later
// board_simulation SEED|fresh HOURS: simulated hours of a board at 50 Hz with an operator, an eavesdropper, a
// medium, a line and a clock, all of which fail at random (in the manner of deterministic simulation testing:
// one seed, one thread, invariants after each step). Prints what was injected and found; exit 1 where an
// invariant broke.
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>

#include "tests/simulation/world.h"
#include "tools/text/error.h"
#include "tools/upload/client.h"

namespace {

using namespace vernier;
using namespace vernier::text;
using namespace vernier::upload;
using namespace vernier::simulation;

class Wire : public Transport {
 public:
  explicit Wire(World& world) : world_(world) {}
  std::vector<std::uint8_t> ask(const std::vector<std::uint8_t>& request) override {
    const std::vector<std::uint8_t> reply = world_.carry(request);
    if (reply.empty()) throw InputError("no reply");
    return reply;
  }
  void pause(std::chrono::milliseconds) override { world_.run(5); }

 private:
  World& world_;
};

/// Uploads, keeps or gives up, commands; loses patience as people do.
class Operator {
 public:
  explicit Operator(World& world) : world_(world) {
    for (int i = 0; i < 8; ++i) images_.push_back(image_of(i));
  }
  void act() {
    try {
      Client client(std::make_unique<Wire>(world_));
      client.sign_with(world_.key());
      clear(client);
      if (client.newest().mode == Mode::kReady && world_.one_in(2)) activate(client);
      const std::uint64_t what = world_.any() % 11;
      if (what < 5)
        upload(client);
      else if (what == 5)
        weight(client);
      else if (what == 6)
        hold(client);
      else if (what == 10)
        client.command(Command::kDeactivate), world_.took_out(kAllAxes);
      else if (what == 7)
        client.confirmed([](double) {});
      else
        client.state(), client.shares(), client.health(), client.history(0, 1);
      clear(client);
    } catch (const InputError&) {
      // No reply, or one that was changed: tried again some other time.
    } catch (const LimitNotMet&) {
      // Refused, which is an answer.
    }
  }

 private:
  void clear(Client& client) {
    if (client.newest().mode != Mode::kFaulted) return;
    ++world_.counts.faults;
    world_.may_bring_in(kAllAxes);
    client.command(Command::kClearFault);
  }
  void activate(Client& client) {
    world_.may_bring_in(kAllAxes);
    client.command(Command::kActivate);
  }
  void weight(Client& client) {
    const auto axis = static_cast<std::uint8_t>(world_.any() % 2);
    const std::uint64_t share = world_.one_in(3) ? 0 : world_.any() % 1001;
    world_.may_bring_in(1u << axis);
    client.weight(axis, 1e-3 * static_cast<double>(share));
    if (share == 0) world_.took_out(1u << axis);
  }
  void hold(Client& client) {
    client.command(Command::kHold);
    world_.run(50);
    if (client.newest().holding) world_.took_out(kAllAxes);
    world_.run(static_cast<std::int64_t>(world_.any() % 1000));
    world_.may_bring_in(kAllAxes);
    client.command(Command::kRelease);
  }
  void upload(Client& client) {
    const SlotsReply slots = client.slots();
    const std::uint64_t issued = std::max(issued_, slots.newest_issued) + 1 + world_.any() % 10;
    const std::uint32_t security = slots.security + (world_.one_in(20) ? 1u : 0u);
    const auto& image = images_[world_.any() % images_.size()];
    ImageHeader header;
    std::memcpy(&header, image.data(), sizeof(header));
    issued_ = issued;
    world_.signed_image(header.fingerprint);
    ++world_.counts.uploads;
    client.upload(make_upload(image, world_.key(), issued, security), [](double) {});
    world_.run(static_cast<std::int64_t>(world_.any() % 2000));
    const std::uint64_t deaths = world_.deaths();
    switch (world_.any() % 4) {
      case 0:
        client.revert();
        ++world_.counts.given_up;
        break;
      case 1:
        world_.run(4000);  // longer than the trial
        if (world_.deaths() == deaths && client.slots().trial != kNoSlot)
          throw Broken{"a trial nobody confirms ends"};
        ++world_.counts.timed_out;
        break;
      default:
        world_.asked_to_confirm(issued);
        client.confirm();
        if (world_.deaths() == deaths) world_.knows_confirmed(issued);
        ++world_.counts.confirmed;
    }
  }

  World& world_;
  std::vector<std::vector<std::uint8_t>> images_;
  std::uint64_t issued_ = 0;
};

void print(const Counts& c, double hours) {
  std::printf(
      "%.1f hours, %llu ticks, %llu Active, %llu faults injected: %llu late ticks, %llu clock stops, %llu "
      "deaths, %llu cut "
      "writes, %llu bits turned, %llu slow media, %llu lost, %llu doubled, %llu changed, %llu late frames, "
      "%llu forged, "
      "%llu replayed, %llu silent axes, %llu refused writes; of the drive: %llu SYNC lost, %llu TPDO lost, "
      "%llu heartbeats lost, %llu cuts, %llu EMCY, %llu times disabled, %llu restarts, %llu offsets overtaken"
      "\n%llu uploads, %llu confirmed, %llu given up, "
      "%llu timed out, "
      "%llu images lost and told, %llu faults cleared, %llu signs of life, %llu ticks of axes kept out after "
      "a death\nno invariant broken\n",
      hours, c.ticks + 0ull, c.active + 0ull, c.injected() + 0ull, c.late_ticks + 0ull, c.stops + 0ull,
      c.deaths + 0ull, c.torn_writes + 0ull, c.flips + 0ull, c.slow_media + 0ull, c.lost_frames + 0ull,
      c.doubled_frames + 0ull, c.changed_frames + 0ull, c.late_frames + 0ull, c.forged + 0ull,
      c.replayed + 0ull, c.silent_axes + 0ull, c.refused_writes + 0ull, c.drive.syncs_lost + 0ull,
      c.drive.positions_lost + 0ull, c.drive.heartbeats_lost + 0ull, c.drive.cuts + 0ull,
      c.drive.emergencies + 0ull, c.drive.disabled + 0ull, c.drive.restarts + 0ull, c.drive.overtaken + 0ull,
      c.uploads + 0ull, c.confirmed + 0ull, c.given_up + 0ull, c.timed_out + 0ull, c.images_lost + 0ull,
      c.faults + 0ull, c.signs + 0ull, c.kept_out + 0ull);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) return std::fprintf(stderr, "usage: board_simulation SEED|fresh HOURS\n"), 1;
  const bool fresh = std::string(argv[1]) == "fresh";
  const std::uint64_t seed = fresh ? std::random_device{}() : std::strtoull(argv[1], nullptr, 10);
  const double hours = std::strtod(argv[2], nullptr);
  std::printf("seed %llu\n", static_cast<unsigned long long>(seed));
  std::fflush(stdout);
  World world(seed);
  const auto ticks = static_cast<std::uint64_t>(hours * 3600e6 / static_cast<double>(kTick.count));
  try {
    Operator person(world);
    while (world.counts.ticks < ticks) {
      world.run(static_cast<std::int64_t>(world.any() % 6000));
      person.act();
    }
  } catch (const Broken& broken) {
    std::printf("BROKEN: %s\n", broken.what.c_str());
    return 1;
  }
  print(world.counts, hours);
  // A run in which little happened proves little.
  const bool enough = world.counts.active > world.counts.ticks / 8 && world.counts.injected() > ticks / 2000;
  if (!enough) std::printf("but too little happened\n");
  return enough ? 0 : 1;
}
