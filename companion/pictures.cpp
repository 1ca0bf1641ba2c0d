// See pictures.hpp.
#include "companion/pictures.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <optional>
#include <thread>

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>

namespace robosync::companion {
namespace {

class Pictures {
public:
  Pictures(const std::string& source, std::chrono::milliseconds period, bool no_pace)
      : period_(period), no_pace_(no_pace), next_(std::chrono::steady_clock::now()) {
    std::error_code error;
    is_file_ = std::filesystem::is_regular_file(source, error);
    if (is_file_) still_ = cv::imread(source, cv::IMREAD_COLOR);
    if (!still_.empty()) return;
    if (!film_.open(source))
      throw is_file_ ? Failure(Exit::asked_wrongly, source + " is neither a picture nor a film")
                     : Failure(Exit::outside, "there is no camera " + source);
    film_.set(cv::CAP_PROP_BUFFERSIZE, 1);  // the newest picture, not an older one from a buffer
  }

  // Waits for the next picture; empty: there are no more. Throws Failure (outside) if the camera fails.
  cv::Mat next() {
    if (is_file_ && !no_pace_) {
      next_ += period_;
      std::this_thread::sleep_until(next_);
    }
    if (!still_.empty()) {
      const bool over = no_pace_ && shown_;
      shown_ = true;
      return over ? cv::Mat() : still_;
    }
    return is_file_ ? of_film() : of_camera();
  }

private:
  // Skips as many pictures as the period takes.
  cv::Mat of_film() {
    const double rate = std::clamp(film_.get(cv::CAP_PROP_FPS), 1.0, 1000.0);
    passed_ += std::chrono::duration<double>(period_).count() * rate;
    for (; passed_ >= 2; --passed_)
      if (!film_.grab()) return {};
    --passed_;
    cv::Mat picture;
    film_.read(picture);
    return picture;
  }

  cv::Mat of_camera() {
    cv::Mat picture;
    do {
      if (!film_.read(picture) || picture.empty())
        throw Failure(Exit::outside, "the camera gives no more pictures");
    } while (std::chrono::steady_clock::now() < next_);
    next_ = std::chrono::steady_clock::now() + period_;
    return picture;
  }

  std::chrono::milliseconds period_;
  bool no_pace_, is_file_ = false, shown_ = false;
  std::chrono::steady_clock::time_point next_;
  cv::Mat still_;
  cv::VideoCapture film_;
  double passed_ = 0;
};

// Replaces the file in one step, so that readers always see a complete one.
void save(const cv::Mat& picture, const std::string& file) {
  const std::string unfinished = file + ".new.png";
  std::error_code error;
  if (cv::imwrite(unfinished, picture)) std::filesystem::rename(unfinished, file, error);
  if (error || !std::filesystem::exists(file, error))
    throw Failure(Exit::asked_wrongly, "cannot write " + file);
}

}  // namespace

cv::Mat made_high(const cv::Mat& picture, int rows) {
  const double scale = static_cast<double>(rows) / picture.rows;
  cv::Mat result;
  cv::resize(picture, result, {std::max(1, static_cast<int>(picture.cols * scale)), rows}, 0, 0,
             cv::INTER_AREA);
  return result;
}

double angle_of(double x, int columns, double view) {
  constexpr double kHalfTurn = 180;
  const double half = columns / 2.0;
  const double right = (x - half) / half;
  const double edge = std::tan(std::min(view, 179.0) / 2 * std::numbers::pi / kHalfTurn);
  return std::atan(right * edge) * kHalfTurn / std::numbers::pi;
}

void watch(const Arguments& arguments, const Look& look) {
  const std::string preview = arguments.text_or("preview", "");
  Pictures pictures(arguments.text("source"), arguments.period(), arguments.no_pace());
  constexpr std::chrono::seconds kDrawnEach{1};
  std::optional<std::chrono::steady_clock::time_point> drawn;
  for (cv::Mat picture = pictures.next(); !picture.empty(); picture = pictures.next()) {
    const auto now = std::chrono::steady_clock::now();
    const bool draws = !preview.empty() && (!drawn || now >= *drawn + kDrawnEach);
    cv::Mat drawing;
    look(picture, draws ? &drawing : nullptr);
    if (!draws) continue;
    save(drawing, preview);
    drawn = now;
  }
}

}  // namespace robosync::companion
