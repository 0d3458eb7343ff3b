// Two sensors that tell of the same motion: by what factor, and how well they agree.
#pragma once

#include <cmath>
#include <optional>

namespace vsslam {

/// The line through the origin that fits measured = scale * reference, by least squares over pairs of one interval each.
class MotionAgreement {
 public:
  void add(double reference, double measured) {
    reference_squares_ += reference * reference;
    measured_squares_ += measured * measured;
    products_ += reference * measured;
    total_ += std::abs(reference);
  }
  /// How far the reference moved in all, whichever way.
  double total() const { return total_; }
  std::optional<double> scale() const {
    return reference_squares_ > 0 ? std::optional(products_ / reference_squares_) : std::nullopt;
  }
  /// -1 to 1; 0 where the measured one does not move.
  double correlation() const {
    const double squares = reference_squares_ * measured_squares_;
    return squares > 0 ? products_ / std::sqrt(squares) : 0;
  }

 private:
  double reference_squares_ = 0, measured_squares_ = 0, products_ = 0, total_ = 0;
};

}  // namespace vsslam
