// SPDX-License-Identifier: Apache-2.0
#include "hal/linux/modbus/modbus_axes.h"

#include <algorithm>
#include <chrono>
#include <cstdio>

namespace vernier {
namespace {

constexpr int kTriesOfATick = 3;  // against a thread that writes at the same time

}  // namespace

int ModbusAxesSettings::first() const {
  int least = sequence;
  for (const Axis& axis : axes) least = std::min(least, axis.address);
  return least;
}

int ModbusAxesSettings::count() const {
  int last = sequence;
  for (const Axis& axis : axes) last = std::max(last, axis.address + 1);
  return last - first() + 1;
}

ModbusAxes::ModbusAxes(std::shared_ptr<ModbusLine> line, const ModbusAxesSettings& settings)
    : line_(std::move(line)), settings_(settings) {
  for (const ModbusAxesSettings::Axis& axis : settings_.axes) converters_.emplace_back(axis.scale);
  thread_ = std::thread([this] { run(); });
}

ModbusAxes::~ModbusAxes() {
  stop_ = true;
  thread_.join();
}

void ModbusAxes::take() {
  std::array<std::uint16_t, ModbusAxesSettings::kMostRegisters> registers{};
  const int first = settings_.first();
  const auto at = [&](int address) { return registers[static_cast<std::size_t>(address - first)]; };
  ++reads_;
  if (!line_->read(settings_.unit, settings_.kind, first, settings_.count(), registers.data())) {
    ++failed_;
    return;
  }
  const std::uint16_t sequence = at(settings_.sequence);
  const bool repeated = known_ && sequence == sequence_;
  // The first numbers may be old: the next sequence number decides.
  const bool first_one = !known_;
  known_ = true;
  sequence_ = sequence;
  repeated_ += repeated ? 1 : 0;
  if (repeated || first_one) return;
  version_.fetch_add(1);
  for (std::size_t k = 0; k < settings_.axes.size(); ++k) {
    const int address = settings_.axes[k].address;
    numbers_[k].store(
        static_cast<std::int32_t>(static_cast<std::uint32_t>(at(address)) << 16 | at(address + 1)));
  }
  version_.fetch_add(1);
}

void ModbusAxes::run() {
  const std::chrono::microseconds period(settings_.period.count);
  for (auto due = std::chrono::steady_clock::now(); !stop_;) {
    take();
    due = std::max(due + period, std::chrono::steady_clock::now());
    std::this_thread::sleep_until(due);
  }
}

void ModbusAxes::begin_tick() noexcept {
  fresh_ = false;
  for (int i = 0; i < kTriesOfATick && !fresh_; ++i) {
    const std::uint32_t version = version_.load();
    if (version == seen_) return;
    if (version % 2 != 0) continue;
    for (std::size_t k = 0; k < converters_.size(); ++k) taken_[k] = numbers_[k].load();
    fresh_ = version_.load() == version;
    if (fresh_) seen_ = version;
  }
}

HalFault ModbusAxes::read_axis(std::uint32_t index, AxisReading& reading) noexcept {
  if (index >= converters_.size()) return HalFault::kNoDevice;
  if (!fresh_) return HalFault::kNoReading;
  reading = {};
  reading.position = converters_[index].position_of(taken_[index]);
  return HalFault::kNone;
}

std::string ModbusAxes::account() const {
  char text[160];
  std::snprintf(
      text, sizeof text,
      "positions of modbus register %d: %llu requests, %llu failed, %llu with an unchanged sequence number",
      settings_.first(), static_cast<unsigned long long>(reads_.load()),
      static_cast<unsigned long long>(failed_.load()), static_cast<unsigned long long>(repeated_.load()));
  return text;
}

}  // namespace vernier
