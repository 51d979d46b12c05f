// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <complex>
#include <memory>
#include <span>
#include <vector>

namespace vernier::vibration {

/// Fourier transform of real series that all have the length n >= 1 (FFTW). The plans of FFTW are computed
/// once, when the object is constructed. Each thread needs its own object of the class Fourier.
class Fourier {
 public:
  explicit Fourier(std::size_t n);
  ~Fourier();
  Fourier(const Fourier&) = delete;
  Fourier& operator=(const Fourier&) = delete;

  /// Returns the spectrum F[k] = sum x[i] exp(-2 pi j i k / n), k = 0 .. n/2. The spectrum is valid until the
  /// next call of forward or backward. x: n values.
  std::span<const std::complex<double>> forward(std::span<const double> x);
  /// Returns the series whose spectrum is f (n/2 + 1 lines): backward(forward(x)) is x. The series is valid
  /// until the next call of forward or backward.
  std::span<const double> backward(std::span<const std::complex<double>> f);

 private:
  struct Plans;
  std::size_t n_;
  std::vector<double> series_;
  std::vector<std::complex<double>> lines_;
  std::unique_ptr<Plans> plans_;
};

}  // namespace vernier::vibration
