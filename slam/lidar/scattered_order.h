// The numbers 0 .. n-1, each once, in an order that jumps about.
//
// Whoever keeps the first point of each cube must not visit points in order of firing: the first to reach a cube is one
// that noise has pushed ahead, outwards before the robot and inwards behind it, and the scan comes out turned. (At 30 mm
// of noise a corridor bent by 0.08 degrees every 10 m.)
#pragma once

#include <cstddef>
#include <numeric>

namespace vsslam {

class ScatteredOrder {
 public:
  /// Steps of the golden section, which come near no earlier place for long (Knuth, TAOCP 3, 6.4).
  explicit ScatteredOrder(size_t n) : n_(n), step_(static_cast<size_t>(0.6180339887 * static_cast<double>(n))) {
    while (step_ > 1 && std::gcd(step_, n_) != 1) --step_;
    if (step_ == 0) step_ = 1;
  }
  size_t next() {
    const size_t now = at_;
    at_ = at_ + step_ >= n_ ? at_ + step_ - n_ : at_ + step_;
    return now;
  }

 private:
  size_t n_, step_, at_ = 0;
};

}  // namespace vsslam
