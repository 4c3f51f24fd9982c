// OpenCV's filters on a flat scene. They know no depth.
#include "dermis/error.hpp"
#include "opponents/opponents.hpp"

#if defined(DERMIS_BENCH_OPENCV)
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#endif

namespace dermis::bench {

#if defined(DERMIS_BENCH_OPENCV)

namespace {

/// A plane of another's memory.
cv::Mat plane_of(const Scene& scene, const std::vector<float>& planes, int channel) {
  const float* start = planes.data() + channel * scene.pixels();
  return {scene.spec.height, scene.spec.width, CV_32FC1, const_cast<float*>(start)};
}

/// The marginal on every pixel in reach; each channel has its own, so each is a plane by itself.
class Separable final : public Opponent {
 public:
  explicit Separable(const Scene& scene) : scene_(scene), scattered_(scene.light.size()) {
    const double pixel_mm = 1 / scene.px_per_mm();
    const int reach = dense_reach_px(scene.spec);
    for (int c = 0; c < 3; ++c) {
      kernels_[c] = cv::Mat(1, 2 * reach + 1, CV_32FC1);
      for (int i = -reach; i <= reach; ++i) {
        kernels_[c].at<float>(i + reach) =
            static_cast<float>(skin().strip(c, (i - 0.5) * pixel_mm, (i + 0.5) * pixel_mm));
      }
      kernels_[c] /= cv::sum(kernels_[c])[0];
    }
  }

  void run() override {
    for (int c = 0; c < 3; ++c) {
      cv::Mat to = plane_of(scene_, scattered_, c);
      cv::sepFilter2D(plane_of(scene_, scene_.light, c), to, CV_32F, kernels_[c], kernels_[c], {-1, -1}, 0,
                      cv::BORDER_REPLICATE);
    }
  }

  std::vector<float> result() override { return scattered_; }

 private:
  const Scene& scene_;
  std::array<cv::Mat, 3> kernels_;
  std::vector<float> scattered_;
};

class Bilateral final : public Opponent {
 public:
  explicit Bilateral(const Scene& scene) : scene_(scene) {
    const cv::Mat planes[] = {plane_of(scene, scene.light, 0), plane_of(scene, scene.light, 1),
                              plane_of(scene, scene.light, 2)};
    cv::merge(planes, 3, light_);
  }

  void run() override {
    constexpr int diameter_px = 15;
    constexpr double of_light = 0.3;
    cv::bilateralFilter(light_, scattered_, diameter_px, of_light, scene_.spec.kernel_px);
  }

  std::vector<float> result() override {
    std::vector<float> planes(scene_.light.size());
    cv::Mat separate[] = {plane_of(scene_, planes, 0), plane_of(scene_, planes, 1), plane_of(scene_, planes, 2)};
    cv::split(scattered_, separate);
    return planes;
  }

 private:
  const Scene& scene_;
  cv::Mat light_, scattered_;
};

}  // namespace

bool has_opencv() { return true; }

std::unique_ptr<Opponent> make_opencv_separable(const Scene& scene) { return std::make_unique<Separable>(scene); }

std::unique_ptr<Opponent> make_opencv_bilateral(const Scene& scene) { return std::make_unique<Bilateral>(scene); }

#else

bool has_opencv() { return false; }

std::unique_ptr<Opponent> make_opencv_separable(const Scene&) {
  throw Error(ErrorCode::usage, "opencv-separable", "a build without OpenCV", "OpenCV's core and imgproc");
}

std::unique_ptr<Opponent> make_opencv_bilateral(const Scene&) {
  throw Error(ErrorCode::usage, "opencv-bilateral", "a build without OpenCV", "OpenCV's core and imgproc");
}

#endif

}  // namespace dermis::bench
