#include "slam/vision/optical_flow.h"

#include <array>
#include <opencv2/imgproc.hpp>
#include <opencv2/video/tracking.hpp>

#include "slam/vision/corner_response.h"

namespace vsslam {

void OpticalFlowConfig::fields(Fields& f) {
  f("window_px", window_px, between(5, 63));
  f("levels", levels, between(0, 6));
  f("max_return_px", max_return_px, positive());
  f("smoothing_px", smoothing_px, between(0, 5));
  f.choice("equalize", equalize,
           {{"automatic", Equalize::automatic}, {"always", Equalize::always}, {"never", Equalize::never}});
  f("clip_limit", clip_limit, positive());
  f("clahe_tiles", clahe_tiles, between(1, 64));
  f("dark_grey", dark_grey, between(0, 255));
  f("bright_grey", bright_grey, between(0, 255));
  f("hysteresis_grey", hysteresis_grey, between(0, 100));
  f("max_noise_grey", max_noise_grey, positive());
  f.check(window_px % 2 == 1, "window_px", "an odd number");
  f.check(dark_grey + 2 * hysteresis_grey < bright_grey, "dark_grey",
          "below bright_grey by twice hysteresis_grey");
}

namespace {

using Points = std::vector<cv::Point2f>;

Points to_cv(const std::vector<Eigen::Vector2f>& points) {
  Points result;
  for (const Eigen::Vector2f& p : points) result.emplace_back(p.x(), p.y());
  return result;
}

GreyView view_of(const cv::Mat& image) {
  return {image.data, image.cols, image.rows, static_cast<ptrdiff_t>(image.step)};
}

// The grey values of every 16th pixel, sorted.
class GreyQuantiles {
 public:
  explicit GreyQuantiles(const cv::Mat& image) {
    for (int y = 0; y < image.rows; y += 4)
      for (int x = 0; x < image.cols; x += 4, ++count_) ++histogram_[image.at<uint8_t>(y, x)];
  }
  double operator()(double share) const {
    uint32_t below = 0;
    for (size_t grey = 0; grey < histogram_.size(); ++grey) {
      below += histogram_[grey];
      if (below >= share * count_) return static_cast<double>(grey);
    }
    return 255;
  }

 private:
  std::array<uint32_t, 256> histogram_{};
  uint32_t count_ = 0;
};

}  // namespace

struct OpticalFlow::Impl {
  struct Image {
    cv::Mat raw, seen;             // as delivered; as features see it
    std::vector<cv::Mat> pyramid;  // with derivatives
  };
  OpticalFlowConfig config;
  int width_px, height_px;
  cv::Ptr<cv::CLAHE> clahe;
  bool equalizing = false;
  double noise_grey = 0;  // of the newest image as delivered
  Image last, newest;

  Impl(const OpticalFlowConfig& c, int width, int height)
      : config(c),
        width_px(width),
        height_px(height),
        clahe(cv::createCLAHE(c.clip_limit, {c.clahe_tiles, c.clahe_tiles})) {}

  cv::Size window() const { return {config.window().width_px, config.window().height_px}; }

  void prepare(Image& image) {
    if (config.smoothing_px > 0) {
      cv::GaussianBlur(image.raw, image.seen, {0, 0}, config.smoothing_px);
    } else {
      image.raw.copyTo(image.seen);
    }
    if (equalizing) clahe->apply(image.seen, image.seen);
    cv::buildOpticalFlowPyramid(image.seen, image.pyramid, window(), config.levels, true,
                                cv::BORDER_REFLECT_101, cv::BORDER_CONSTANT, false);
  }

  bool wants_equalizing(const cv::Mat& raw) const {
    if (config.equalize != Equalize::automatic) return config.equalize == Equalize::always;
    if (noise_grey > (equalizing ? 1.3 : 1) * config.max_noise_grey) return false;
    const GreyQuantiles quantile(raw);
    constexpr double kNoContrast_grey = 8;
    if (quantile(0.98) - quantile(0.02) < kNoContrast_grey) return false;  // a covered lens
    const double median = quantile(0.5), margin = equalizing ? config.hysteresis_grey : 0;
    return median < config.dark_grey + margin || median > config.bright_grey - margin;
  }

  // From one image to another, starting at `to`, which becomes the result. False: lost.
  std::vector<uint8_t> search(const Image& a, const Image& b, const Points& from, Points& to,
                              int levels) const {
    // Finer steps changed the error against the truth by less than a thousandth of a pixel.
    const cv::TermCriteria until(cv::TermCriteria::COUNT | cv::TermCriteria::EPS, 20, 0.03);
    std::vector<uint8_t> found;
    cv::calcOpticalFlowPyrLK(a.pyramid, b.pyramid, from, to, found, cv::noArray(), window(), levels, until,
                             cv::OPTFLOW_USE_INITIAL_FLOW);
    return found;
  }
};

OpticalFlow::OpticalFlow(const OpticalFlowConfig& config, int width_px, int height_px)
    : impl_(std::make_unique<Impl>(config, width_px, height_px)) {}
OpticalFlow::~OpticalFlow() = default;

void OpticalFlow::push(const CameraFrame& image) {
  Impl& s = *impl_;
  std::swap(s.last, s.newest);
  // OpenCV has no read-only view; the copy outlives the caller's image.
  cv::Mat(s.height_px, s.width_px, CV_8U, const_cast<uint8_t*>(image.grey.data())).copyTo(s.newest.raw);
  s.noise_grey = noise_sigma_grey(view_of(s.newest.raw));
  const bool was = s.equalizing;
  s.equalizing = s.wants_equalizing(s.newest.raw);
  s.prepare(s.newest);
  // Two images can be compared only if both are equalised, or neither.
  if (was != s.equalizing && !s.last.raw.empty()) s.prepare(s.last);
}

GreyView OpticalFlow::newest() const {
  return view_of(impl_->newest.seen);
}

bool OpticalFlow::equalized() const {
  return impl_->equalizing;
}

double OpticalFlow::noise_grey() const {
  return impl_->noise_grey * (impl_->equalizing ? impl_->config.clip_limit : 1);
}

std::vector<std::optional<Eigen::Vector2f>> OpticalFlow::follow(const std::vector<Eigen::Vector2f>& last_px,
                                                                const std::vector<Eigen::Vector2f>& guess_px,
                                                                bool and_back) const {
  const Impl& s = *impl_;
  std::vector<std::optional<Eigen::Vector2f>> result(last_px.size());
  if (last_px.empty() || s.last.pyramid.empty()) return result;
  const Points from = to_cv(last_px);
  Points there = to_cv(guess_px);
  std::vector<uint8_t> found = s.search(s.last, s.newest, from, there, s.config.levels);
  if (and_back) {
    Points back = from;
    // The way back starts at home, so that one level above the image is enough.
    const std::vector<uint8_t> returned =
        s.search(s.newest, s.last, there, back, std::min(1, s.config.levels));
    const double limit2 = s.config.max_return_px * s.config.max_return_px;
    for (size_t i = 0; i < from.size(); ++i) {
      const cv::Point2f miss = back[i] - from[i];
      found[i] = found[i] && returned[i] && miss.dot(miss) <= limit2;
    }
  }
  for (size_t i = 0; i < from.size(); ++i)
    if (found[i]) result[i] = Eigen::Vector2f(there[i].x, there[i].y);
  return result;
}

}  // namespace vsslam
