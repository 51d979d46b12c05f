// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/vibration/fourier.h"

#include <fftw3.h>

#include <algorithm>
#include <stdexcept>

namespace vernier::vibration {

struct Fourier::Plans {
  fftw_plan forward = nullptr, backward = nullptr;
  ~Plans() {
    if (forward != nullptr) fftw_destroy_plan(forward);
    if (backward != nullptr) fftw_destroy_plan(backward);
  }
};

Fourier::Fourier(std::size_t n) : n_(n), series_(n), lines_(n / 2 + 1), plans_(std::make_unique<Plans>()) {
  auto* lines = reinterpret_cast<fftw_complex*>(lines_.data());  // the layouts agree (FFTW manual, 4.1.1)
  plans_->forward = fftw_plan_dft_r2c_1d(static_cast<int>(n), series_.data(), lines, FFTW_ESTIMATE);
  plans_->backward = fftw_plan_dft_c2r_1d(static_cast<int>(n), lines, series_.data(), FFTW_ESTIMATE);
  if (plans_->forward == nullptr || plans_->backward == nullptr)
    throw std::runtime_error("FFTW makes no plan");
}

Fourier::~Fourier() = default;

std::span<const std::complex<double>> Fourier::forward(std::span<const double> x) {
  std::copy_n(x.begin(), n_, series_.begin());
  fftw_execute(plans_->forward);
  return lines_;
}

std::span<const double> Fourier::backward(std::span<const std::complex<double>> f) {
  std::copy_n(f.begin(), lines_.size(), lines_.begin());
  fftw_execute(plans_->backward);
  for (double& value : series_) value /= static_cast<double>(n_);
  return series_;
}

}  // namespace vernier::vibration
