// SPDX-License-Identifier: Apache-2.0
// The only file that knows libgpiod, and which of its two interfaces it has: 1.6 (Debian 12) or 2.
#include "hal/linux/gpio_lines.h"

#include <fcntl.h>
#include <gpiod.h>
#include <poll.h>

#include <cerrno>
#include <cstring>
#include <filesystem>

#include "hal/linux/system_time.h"

namespace vernier {
namespace {

constexpr const char* kConsumer = "vernier";
constexpr std::int64_t kClockMargin = 1'000'000;  // ns; a stamp further in the future is another clock's
constexpr int kMostReads = 4;                     // of the kernel's buffer in one tick

std::int64_t monotonic_ns() noexcept {
  timespec time{};
  clock_gettime(CLOCK_MONOTONIC, &time);
  return ns_of(time);
}

/// Kernels before 5.7 stamp by the time of day, which cannot be related to the tick.
void put_edge(EdgeQueue& queue, std::int64_t at, bool made, std::uint32_t number) noexcept {
  if (at > monotonic_ns() + kClockMargin) return queue.put_loss();
  queue.put({InstantNs(at), made}, number);
}

struct ChipClose {
  void operator()(gpiod_chip* chip) const noexcept { gpiod_chip_close(chip); }
};
using Chip = std::unique_ptr<gpiod_chip, ChipClose>;

bool has_label(gpiod_chip* chip, const std::string& label);

/// A path, a name below /dev, or else the label of one of the chips.
Chip open_chip(const std::string& wanted) {
  if (wanted.empty()) return errno = ENOENT, nullptr;
  if (wanted.find('/') != std::string::npos) return Chip(gpiod_chip_open(wanted.c_str()));
  if (std::filesystem::exists("/dev/" + wanted)) return Chip(gpiod_chip_open(("/dev/" + wanted).c_str()));
  std::error_code unreadable;
  for (const auto& entry : std::filesystem::directory_iterator("/dev", unreadable)) {
    if (entry.path().filename().string().rfind("gpiochip", 0) != 0) continue;
    Chip chip(gpiod_chip_open(entry.path().c_str()));
    if (chip && has_label(chip.get(), wanted)) return chip;
  }
  return errno = ENOENT, nullptr;
}

#ifdef VERNIER_GPIOD_1

/// The kernel holds sixteen edges of a line and drops the next without a word.
constexpr unsigned kKernelEdges = 16;

bool has_label(gpiod_chip* chip, const std::string& label) { return label == gpiod_chip_label(chip); }

class Line : public GpioLine {
 public:
  static std::unique_ptr<GpioLine> request(Chip chip, const GpioAddress& address, Use use) {
    gpiod_line* const line = gpiod_chip_get_line(chip.get(), address.line);
    if (line == nullptr) return nullptr;
    const int flags = address.inverted ? static_cast<int>(GPIOD_LINE_REQUEST_FLAG_ACTIVE_LOW) : 0;
    const int status = use == Use::kInput ? gpiod_line_request_input_flags(line, kConsumer, flags)
                       : use == Use::kOutput
                           ? gpiod_line_request_output_flags(line, kConsumer, flags, 0)
                           : gpiod_line_request_both_edges_events_flags(line, kConsumer, flags);
    if (status != 0) return nullptr;
    return std::unique_ptr<GpioLine>(new Line(std::move(chip), line));
  }
  ~Line() override { gpiod_line_release(line_); }

  int get() noexcept override { return gpiod_line_get_value(line_); }
  bool set(bool on) noexcept override { return gpiod_line_set_value(line_, on ? 1 : 0) == 0; }
  void read_edges(EdgeQueue& queue) noexcept override {
    gpiod_line_event events[kKernelEdges];
    for (int i = 0; i < kMostReads && queue.room() >= kKernelEdges; ++i) {
      pollfd waiting{gpiod_line_event_get_fd(line_), POLLIN, 0};
      if (::poll(&waiting, 1, 0) <= 0) return;
      const int count = gpiod_line_event_read_multiple(line_, events, kKernelEdges);
      if (count <= 0) return;
      for (int k = 0; k < count; ++k)
        put_edge(queue, ns_of(events[k].ts), events[k].event_type == GPIOD_LINE_EVENT_RISING_EDGE,
                 EdgeQueue::kNoNumber);
      // Full: this interface does not report an overflow.
      if (count == static_cast<int>(kKernelEdges)) queue.put_loss();
    }
  }

 private:
  Line(Chip chip, gpiod_line* line) : chip_(std::move(chip)), line_(line) {}
  Chip chip_;
  gpiod_line* line_;
};

#else

constexpr unsigned kKernelEdges = 64;

template <class T, void (*free)(T*)>
struct Free {
  void operator()(T* thing) const noexcept { free(thing); }
};
template <class T, void (*free)(T*)>
using Held = std::unique_ptr<T, Free<T, free> >;

bool has_label(gpiod_chip* chip, const std::string& label) {
  const Held<gpiod_chip_info, gpiod_chip_info_free> info(gpiod_chip_get_info(chip));
  return info && label == gpiod_chip_info_get_label(info.get());
}

class Line : public GpioLine {
 public:
  static std::unique_ptr<GpioLine> request(Chip chip, const GpioAddress& address, Use use) {
    const Held<gpiod_line_settings, gpiod_line_settings_free> settings(gpiod_line_settings_new());
    const Held<gpiod_line_config, gpiod_line_config_free> lines(gpiod_line_config_new());
    const Held<gpiod_request_config, gpiod_request_config_free> config(gpiod_request_config_new());
    if (!settings || !lines || !config) return nullptr;
    gpiod_line_settings_set_direction(
        settings.get(), use == Use::kOutput ? GPIOD_LINE_DIRECTION_OUTPUT : GPIOD_LINE_DIRECTION_INPUT);
    gpiod_line_settings_set_active_low(settings.get(), address.inverted);
    gpiod_line_settings_set_output_value(settings.get(), GPIOD_LINE_VALUE_INACTIVE);
    if (use == Use::kEdges) {
      gpiod_line_settings_set_edge_detection(settings.get(), GPIOD_LINE_EDGE_BOTH);
      gpiod_line_settings_set_event_clock(settings.get(), GPIOD_LINE_CLOCK_MONOTONIC);
    }
    gpiod_request_config_set_consumer(config.get(), kConsumer);
    gpiod_request_config_set_event_buffer_size(config.get(), kKernelEdges);
    if (gpiod_line_config_add_line_settings(lines.get(), &address.line, 1, settings.get()) != 0)
      return nullptr;
    gpiod_line_request* const made = gpiod_chip_request_lines(chip.get(), config.get(), lines.get());
    if (made == nullptr) return nullptr;
    return std::unique_ptr<GpioLine>(new Line(made, address.line));
  }

  int get() noexcept override {
    const gpiod_line_value value = gpiod_line_request_get_value(request_.get(), line_);
    return value == GPIOD_LINE_VALUE_ERROR ? -1 : value == GPIOD_LINE_VALUE_ACTIVE ? 1 : 0;
  }
  bool set(bool on) noexcept override {
    return gpiod_line_request_set_value(request_.get(), line_,
                                        on ? GPIOD_LINE_VALUE_ACTIVE : GPIOD_LINE_VALUE_INACTIVE) == 0;
  }
  void read_edges(EdgeQueue& queue) noexcept override {
    for (int i = 0; i < kMostReads && queue.room() >= kKernelEdges; ++i) {
      if (gpiod_line_request_wait_edge_events(request_.get(), 0) <= 0) return;
      const int count = gpiod_line_request_read_edge_events(request_.get(), events_.get(), kKernelEdges);
      for (int k = 0; k < count; ++k) {
        gpiod_edge_event* const event =
            gpiod_edge_event_buffer_get_event(events_.get(), static_cast<unsigned long>(k));
        put_edge(queue, static_cast<std::int64_t>(gpiod_edge_event_get_timestamp_ns(event)),
                 gpiod_edge_event_get_event_type(event) == GPIOD_EDGE_EVENT_RISING_EDGE,
                 static_cast<std::uint32_t>(gpiod_edge_event_get_line_seqno(event)));
      }
      if (count <= 0) return;
    }
  }

 private:
  Line(gpiod_line_request* request, unsigned line)
      : request_(request), events_(gpiod_edge_event_buffer_new(kKernelEdges)), line_(line) {}
  Held<gpiod_line_request, gpiod_line_request_release> request_;
  Held<gpiod_edge_event_buffer, gpiod_edge_event_buffer_free> events_;
  unsigned line_;
};

#endif

}  // namespace

std::unique_ptr<GpioLine> GpioLine::request(const GpioAddress& address, Use use, std::string& error) {
  Chip chip = open_chip(address.chip);
  if (!chip) {
    error = "GPIO chip " + address.chip + ": " + std::strerror(errno);
    return nullptr;
  }
  auto line = Line::request(std::move(chip), address, use);
  if (!line)
    error = "line " + std::to_string(address.line) + " of " + address.chip + ": " + std::strerror(errno);
  return line;
}

std::unique_ptr<GpioProbeLine> GpioProbeLine::open(const GpioAddress& address, std::string& error) {
  auto line = GpioLine::request(address, GpioLine::Use::kEdges, error);
  return line ? std::unique_ptr<GpioProbeLine>(new GpioProbeLine(std::move(line))) : nullptr;
}

HalFault GpioProbeLine::read_edge(ProbeEdge& edge) noexcept {
  if (queue_.empty()) line_->read_edges(queue_);
  return queue_.take(edge);
}

std::unique_ptr<GpioInput> GpioInput::open(const GpioAddress& address, std::string& error) {
  auto line = GpioLine::request(address, GpioLine::Use::kInput, error);
  return line ? std::unique_ptr<GpioInput>(new GpioInput(std::move(line))) : nullptr;
}

HalFault GpioInput::read_line(bool& on) noexcept {
  const int value = line_->get();
  if (value < 0) return HalFault::kRefused;
  on = value != 0;
  return HalFault::kNone;
}

std::unique_ptr<GpioOutput> GpioOutput::open(const GpioAddress& address, std::string& error) {
  auto line = GpioLine::request(address, GpioLine::Use::kOutput, error);
  return line ? std::unique_ptr<GpioOutput>(new GpioOutput(std::move(line))) : nullptr;
}

GpioOutput::~GpioOutput() { line_->set(false); }

HalFault GpioOutput::write_line(bool on) noexcept {
  return line_->set(on) ? HalFault::kNone : HalFault::kRefused;
}

}  // namespace vernier
