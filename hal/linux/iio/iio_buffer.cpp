// SPDX-License-Identifier: Apache-2.0
#include "hal/linux/iio/iio_buffer.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "hal/linux/sampled_input.h"
#include "hal/linux/sysfs_attribute.h"

namespace vernier {
namespace {

namespace fs = std::filesystem;

constexpr std::int64_t kBufferScans = 256;  // of the kernel: a quarter of a second at 1 kHz

bool write_word(const std::string& path, const std::string& word, std::string& error) {
  auto attribute = SysfsAttribute::open(path, SysfsAttribute::Use::kWrite, error);
  if (!attribute) return false;
  if (attribute->write(word) == HalFault::kNone) return true;
  error = path + ": the driver refuses " + word;
  return false;
}

std::string first_line(const std::string& path) {
  std::ifstream file(path);
  std::string line;
  std::getline(file, line);
  return line;
}

/// Assigns a trigger to a device. The kernel treats an unknown name as no trigger and reports no error.
bool pull_trigger(const std::string& path, const std::string& trigger, std::string& error) {
  if (!write_word(path, trigger, error)) return false;
  if (first_line(path) == trigger) return true;
  error = path + ": no IIO trigger " + trigger;
  return false;
}

/// A channel in a scan: scans have them in the order of their index.
struct Chosen {
  std::uint32_t index = 0;
  std::size_t input = 0;
  IioElement type;
};

}  // namespace

std::unique_ptr<IioBuffer> IioBuffer::open(const IioBufferSettings& settings, std::string& error) {
  std::unique_ptr<IioBuffer> buffer(new IioBuffer(settings));
  const std::string& at = settings.directory;
  // A buffer that already runs would keep every setting.
  if (!write_word(at + "/buffer/enable", "0", error)) return nullptr;
  if (!settings.trigger.empty() && !pull_trigger(at + "/trigger/current_trigger", settings.trigger, error))
    return nullptr;
  if (!settings.frequency.empty() && !write_word(at + "/sampling_frequency", settings.frequency, error))
    return nullptr;
  if (!buffer->choose_channels(error) || !buffer->place_channels(error) || !buffer->start(error))
    return nullptr;
  return buffer;
}

/// Leaves only the wanted channels in the scans; the time stamp among those that go.
bool IioBuffer::choose_channels(std::string& error) {
  const std::string folder = settings_.directory + "/scan_elements";
  std::error_code unreadable;
  constexpr std::string_view kEnd = "_en";
  for (const auto& entry : fs::directory_iterator(folder, unreadable)) {
    const std::string file = entry.path().filename().string();
    if (!file.ends_with(kEnd)) continue;
    const bool wanted = std::any_of(
        settings_.channels.begin(), settings_.channels.end(),
        [&](const IioChannel& channel) { return file == "in_" + channel.name + std::string(kEnd); });
    if (!wanted && first_line(entry.path().string()) != "0" && !write_word(entry.path().string(), "0", error))
      return false;
  }
  if (unreadable) {
    error = folder + ": " + unreadable.message();
    return false;
  }
  for (const IioChannel& channel : settings_.channels)
    if (!write_word(folder + "/in_" + channel.name + "_en", "1", error)) return false;
  return true;
}

bool IioBuffer::place_channels(std::string& error) {
  std::vector<Chosen> chosen;
  for (std::size_t i = 0; i < settings_.channels.size(); ++i) {
    const std::string base = settings_.directory + "/scan_elements/in_" + settings_.channels[i].name;
    Chosen one;
    one.input = i;
    const std::string type = first_line(base + "_type"), index = first_line(base + "_index");
    if (!parse_iio_element(type, one.type)) {
      error = base + "_type: not understood: \"" + type + "\"";
      return false;
    }
    if (index.empty() || index.find_first_not_of("0123456789") != std::string::npos || index.size() > 6) {
      error = base + "_index: no number: \"" + index + "\"";
      return false;
    }
    one.index = static_cast<std::uint32_t>(std::stoul(index));
    chosen.push_back(one);
  }
  std::sort(chosen.begin(), chosen.end(), [](const Chosen& a, const Chosen& b) { return a.index < b.index; });
  elements_.resize(chosen.size());
  std::size_t at = 0, largest = 1;
  for (const Chosen& one : chosen) {
    const std::size_t size = one.type.bytes();
    at = iio_aligned(at, size);
    elements_[one.input] = {one.type, at, settings_.channels[one.input].scale};
    at += size;
    largest = std::max(largest, size);
  }
  scan_bytes_ = iio_aligned(at, largest);
  read_.resize(std::max(kMostBytes / scan_bytes_, std::size_t{1}) * scan_bytes_);
  waiting_.resize(kMostWaiting * scan_bytes_);
  now_.resize(scan_bytes_);
  return true;
}

bool IioBuffer::start(std::string& error) {
  const std::string folder = settings_.directory + "/buffer";
  if (!write_word(folder + "/length", std::to_string(kBufferScans), error)) return false;
  // A driver without a watermark wakes with every scan in any case.
  std::error_code absent;
  if (fs::exists(folder + "/watermark", absent) && !write_word(folder + "/watermark", "1", error))
    return false;
  fd_ = ::open(settings_.device.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
  if (fd_ < 0) {
    error = settings_.device + ": " + std::strerror(errno);
    return false;
  }
  started_ = write_word(folder + "/enable", "1", error);
  return started_;
}

IioBuffer::~IioBuffer() {
  std::string ignored;
  if (started_) static_cast<void>(write_word(settings_.directory + "/buffer/enable", "0", ignored));
  if (fd_ >= 0) ::close(fd_);
}

void IioBuffer::take(std::size_t bytes) noexcept {
  if (bytes % scan_bytes_ != 0) ++counts_.malformed;
  for (std::size_t at = 0; at + scan_bytes_ <= bytes; at += scan_bytes_) {
    ++counts_.scans;
    if (count_ == kMostWaiting) {
      first_ = (first_ + 1) % kMostWaiting;
      --count_;
      counts_.skipped += known_ ? 1 : 0;
    }
    std::memcpy(&waiting_[(first_ + count_) % kMostWaiting * scan_bytes_], &read_[at], scan_bytes_);
    ++count_;
  }
}

void IioBuffer::begin_tick() noexcept {
  for (ssize_t got = static_cast<ssize_t>(read_.size()); got == static_cast<ssize_t>(read_.size());) {
    got = ::read(fd_, read_.data(), read_.size());
    if (got > 0) take(static_cast<std::size_t>(got));
    if (got < 0 && errno != EAGAIN && errno != EINTR) ++counts_.broken;
  }
  // What filled the kernel's buffer before the first tick is old.
  if (!drained_) count_ = 0;
  drained_ = true;
  fresh_ = count_ > 0;
  if (!fresh_) {
    counts_.missing += known_ ? 1 : 0;
    return;
  }
  known_ = true;
  std::memcpy(now_.data(), &waiting_[first_ * scan_bytes_], scan_bytes_);
  first_ = (first_ + 1) % kMostWaiting;
  --count_;
}

HalFault IioBuffer::read_input(std::uint32_t input, InputMicro& value) noexcept {
  if (input >= elements_.size()) return HalFault::kNoDevice;
  if (!fresh_) return HalFault::kNoReading;
  const Element& element = elements_[input];
  const auto raw = static_cast<double>(iio_value(&now_[element.at], element.type));
  std::int64_t micro = 0;
  if (!SampledInput::scaled(SampledInput::kPerUnit * raw, element.scale.offset, element.scale.scale, micro))
    return HalFault::kNoReading;
  value = InputMicro(micro);
  return HalFault::kNone;
}

}  // namespace vernier
