// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <complex>
#include <memory>
#include <span>
#include <vector>

namespace vernier::vibration {

/// Fourier transform of real series of one length n >= 1 (FFTW). Plans are made once. Use a separate Fourier
/// for each thread.
class Fourier {
 public:
  explicit Fourier(std::size_t n);
  ~Fourier();
  Fourier(const Fourier&) = delete;
  Fourier& operator=(const Fourier&) = delete;

  /// F[k] = sum x[i] exp(-2 pi j i k / n), k = 0 .. n/2; valid until the next call. x: n values.
  std::span<const std::complex<double>> forward(std::span<const double> x);
  /// The series of the spectrum f (n/2 + 1 lines): backward(forward(x)) is x. Valid until the next call.
  std::span<const double> backward(std::span<const std::complex<double>> f);

 private:
  struct Plans;
  std::size_t n_;
  std::vector<double> series_;
  std::vector<std::complex<double>> lines_;
  std::unique_ptr<Plans> plans_;
};

}  // namespace vernier::vibration
