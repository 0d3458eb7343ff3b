#include "sensors/camera/camera_sensor.h"

#include <immintrin.h>

#include <algorithm>
#include <cmath>

#include "sensors/camera/pixel_noise.h"

namespace vsslam {

namespace {

constexpr int kBlock = PixelNoise::kBlock;
constexpr float kLargestGrey = 255;

/// What is the same for all pixels of an image.
struct Conversion {
  float electrons_per_cdm2, read_noise_e, full_well_e, level_per_e;
  float highest_level;
};

/// What differs: where eight pixels begin; null: none.
struct EightPixels {
  const float *luminance, *gain, *offset_e, *shot, *read;
};

__m256i levels_of_eight(const EightPixels& at, const Conversion& c) {
  const __m256 zero = _mm256_setzero_ps();
  const __m256 signal =
      _mm256_mul_ps(_mm256_mul_ps(_mm256_loadu_ps(at.luminance), _mm256_set1_ps(c.electrons_per_cdm2)),
                    _mm256_loadu_ps(at.gain));
  __m256 e = signal;
  if (at.offset_e) e = _mm256_add_ps(e, _mm256_loadu_ps(at.offset_e));
  if (at.shot) {
    const __m256 sigma = _mm256_sqrt_ps(_mm256_max_ps(signal, zero));
    e = _mm256_add_ps(e, _mm256_mul_ps(sigma, _mm256_loadu_ps(at.shot)));
  }
  if (at.read) e = _mm256_add_ps(e, _mm256_mul_ps(_mm256_set1_ps(c.read_noise_e), _mm256_loadu_ps(at.read)));
  e = _mm256_min_ps(_mm256_max_ps(e, zero), _mm256_set1_ps(c.full_well_e));
  const __m256 level = _mm256_mul_ps(e, _mm256_set1_ps(c.level_per_e));
  return _mm256_cvtps_epi32(_mm256_min_ps(level, _mm256_set1_ps(c.highest_level)));
}

/// Sixteen levels within 0 .. 255.
void store_bytes(const int32_t* levels, uint8_t* grey) {
  const auto four = [&](int k) { return _mm_loadu_si128(reinterpret_cast<const __m128i*>(levels + 4 * k)); };
  const __m128i low = _mm_packus_epi32(four(0), four(1)), high = _mm_packus_epi32(four(2), four(3));
  _mm_storeu_si128(reinterpret_cast<__m128i*>(grey), _mm_packus_epi16(low, high));
}

double mean(std::span<const uint8_t> grey) {
  __m128i sum = _mm_setzero_si128();
  for (size_t i = 0; i < grey.size(); i += 16) {
    const __m128i bytes = _mm_loadu_si128(reinterpret_cast<const __m128i*>(grey.data() + i));
    sum = _mm_add_epi64(sum, _mm_sad_epu8(bytes, _mm_setzero_si128()));
  }
  const int64_t total = _mm_extract_epi64(sum, 0) + _mm_extract_epi64(sum, 1);
  return static_cast<double>(total) / static_cast<double>(grey.size());
}

std::vector<float> normals(const RandomStream& stream, size_t count) {
  std::vector<float> all(count);
  const PixelNoise noise(stream, 0);
  float block[kBlock];
  for (size_t first = 0; first < count; first += kBlock) {
    noise.block(static_cast<uint32_t>(first), block);
    std::copy_n(block, std::min(count - first, size_t{kBlock}), all.data() + first);
  }
  return all;
}

}  // namespace

ImageSensor::ImageSensor(const CameraConfig& config, std::span<const float> cos_axis, uint64_t seed)
    : config_(config), shot_(seed, "camera.shot"), read_(seed, "camera.read") {
  for (const float cosine : cos_axis)
    vignetting_.push_back(
        static_cast<float>(std::pow(static_cast<double>(cosine), config.vignetting_exponent)));
  make_fixed_pattern(seed);
  if (config.gamma != 1) make_response();
}

void ImageSensor::make_fixed_pattern(uint64_t seed) {
  gain_ = vignetting_;
  if (config_.fixed_gain_sigma > 0) {
    const std::vector<float> z = normals(RandomStream(seed, "camera.fixed_gain"), gain_.size());
    for (size_t i = 0; i < gain_.size(); ++i)
      gain_[i] *= 1 + static_cast<float>(config_.fixed_gain_sigma) * z[i];
  }
  if (config_.fixed_offset_e > 0) {
    offset_e_ = normals(RandomStream(seed, "camera.fixed_offset"), gain_.size());
    for (float& offset : offset_e_) offset *= static_cast<float>(config_.fixed_offset_e);
  }
}

void ImageSensor::make_response() {
  response_.resize(kResponseLevels);
  for (size_t i = 0; i < kResponseLevels; ++i) {
    const double signal = static_cast<double>(i) / (kResponseLevels - 1);
    response_[i] = static_cast<uint8_t>(std::lround(255 * std::pow(signal, 1 / config_.gamma)));
  }
}

float ImageSensor::electrons_per_cdm2(const Exposure& exposure) const {
  return static_cast<float>(config_.sensitivity_e_per_cdm2_ms * 1e3 * exposure.time.seconds());
}

double ImageSensor::expose(std::span<const float> luminance, const Exposure& exposure, uint64_t image,
                           std::span<uint8_t> grey) const {
  Conversion c;
  c.electrons_per_cdm2 = electrons_per_cdm2(exposure);
  c.read_noise_e = static_cast<float>(config_.read_noise_e);
  c.full_well_e = static_cast<float>(config_.full_well_e);
  c.highest_level = response_.empty() ? 255.0f : static_cast<float>(kResponseLevels - 1);
  c.level_per_e = static_cast<float>(c.highest_level * exposure.gain / config_.full_well_e);

  const PixelNoise shot_noise(shot_, image), read_noise(read_, image);
  float shot[kBlock], read[kBlock];
  int32_t levels[kBlock];
  for (size_t first = 0; first < grey.size(); first += kBlock) {
    const size_t count = std::min(grey.size() - first, size_t{kBlock});
    if (config_.shot_noise) shot_noise.block(static_cast<uint32_t>(first), shot);
    if (config_.read_noise_e > 0) read_noise.block(static_cast<uint32_t>(first), read);
    for (size_t i = 0; i < count; i += 8) {
      const EightPixels at{luminance.data() + first + i, gain_.data() + first + i,
                           offset_e_.empty() ? nullptr : offset_e_.data() + first + i,
                           config_.shot_noise ? shot + i : nullptr,
                           config_.read_noise_e > 0 ? read + i : nullptr};
      _mm256_storeu_si256(reinterpret_cast<__m256i*>(levels + i), levels_of_eight(at, c));
    }
    uint8_t* const out = grey.data() + first;
    if (response_.empty())
      for (size_t i = 0; i < count; i += 16) store_bytes(levels + i, out + i);
    else
      for (size_t i = 0; i < count; ++i) out[i] = response_[static_cast<size_t>(levels[i])];
  }
  return mean(grey);
}

void ImageSensor::expose_clean(std::span<const float> luminance, const Exposure& exposure,
                               std::span<float> grey) const {
  const float per_cdm2 =
      electrons_per_cdm2(exposure) * static_cast<float>(exposure.gain / config_.full_well_e);
  const auto highest = static_cast<float>(std::min(1.0, exposure.gain));  // of a full well
  const auto inverse_gamma = static_cast<float>(1 / config_.gamma);
  for (size_t i = 0; i < grey.size(); ++i) {
    const float signal = std::clamp(luminance[i] * per_cdm2 * vignetting_[i], 0.0f, highest);
    grey[i] = 255 * (config_.gamma == 1 ? signal : std::pow(signal, inverse_gamma));
  }
}

}  // namespace vsslam
