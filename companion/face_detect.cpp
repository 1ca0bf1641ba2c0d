// face_detect: how many faces a camera sees, and where the nearest one is. By OpenCV's cascade for faces that look at the
// camera (package opencv-data).
//
// robosync-face-detect --source FILE|CAMERA --period MS --view DEG --smallest PERCENT --agreeing N [--preview FILE.png]
//                      [--no-pace]
// A picture is seen again and again, unless with --no-pace; a film once.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <memory>
#include <numbers>
#include <optional>
#include <thread>
#include <vector>

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/objdetect.hpp>
#include <opencv2/videoio.hpp>

#include "companion/worker.hpp"

namespace robosync::companion {
namespace {

constexpr const char* kCascade =
    "/usr/share/opencv4/haarcascades/haarcascade_frontalface_default.xml";
constexpr int kHeight =
    240;  // pictures are made so small: what a face takes is a matter of its size in pixels
constexpr int kMostFaces = 20;

// ---- what is seen

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
    film_.set(cv::CAP_PROP_BUFFERSIZE, 1);  // the newest picture, not one that has waited
  }

  // Waits for the next one; empty: it is over. Throws Failure (outside) when the camera fails.
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
  // So many pictures further as time has passed.
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

// ---- faces in it

struct Seen {
  std::vector<cv::Rect> faces;  // the nearest first
  cv::Size size;                // of the picture that they are in
};

cv::Mat made_small(const cv::Mat& picture) {
  const double scale = static_cast<double>(kHeight) / picture.rows;
  cv::Mat small;
  cv::resize(picture, small, {std::max(1, static_cast<int>(picture.cols * scale)), kHeight}, 0, 0,
             cv::INTER_AREA);
  return small;
}

Seen look_at(const cv::Mat& small, cv::CascadeClassifier& cascade, const Arguments& arguments) {
  constexpr double kStep = 1.1;
  cv::Mat grey;
  cv::cvtColor(small, grey, cv::COLOR_BGR2GRAY);
  cv::equalizeHist(grey, grey);
  const int least = static_cast<int>(arguments.number("smallest") / 100 * kHeight);
  Seen seen{{}, small.size()};
  cascade.detectMultiScale(grey, seen.faces, kStep, static_cast<int>(arguments.number("agreeing")),
                           0, {least, least});
  std::ranges::sort(seen.faces, [](const cv::Rect& a, const cv::Rect& b) {
    return a.height != b.height ? a.height > b.height : a.x < b.x;
  });
  return seen;
}

// Where its middle is, from straight ahead: to the right is positive, as for a joint.
double angle_of(const cv::Rect& face, const cv::Size& size, double view) {
  constexpr double kHalfTurn = 180;
  const double half = size.width / 2.0;
  const double right = (face.x + face.width / 2.0 - half) / half;
  const double edge = std::tan(std::min(view, 179.0) / 2 * std::numbers::pi / kHalfTurn);
  return std::atan(right * edge) * kHalfTurn / std::numbers::pi;
}

void tell(const Seen& seen, double view) {
  say("COUNT", static_cast<double>(std::min<std::size_t>(seen.faces.size(), kMostFaces)));
  if (seen.faces.empty()) return;
  const cv::Rect& nearest = seen.faces.front();
  say("ANGLE", angle_of(nearest, seen.size, view));
  say("NEARNESS", std::min(100.0, 100.0 * nearest.height / seen.size.height));
}

// Whoever looks at the file sees a whole one.
void draw(cv::Mat picture, const Seen& seen, const std::string& file) {
  const cv::Scalar nearest(0, 220, 0), others(0, 180, 220);
  for (const cv::Rect& face : seen.faces)
    cv::rectangle(picture, face, &face == &seen.faces.front() ? nearest : others, 2);
  const std::string unfinished = file + ".new.png";
  std::error_code error;
  if (cv::imwrite(unfinished, picture)) std::filesystem::rename(unfinished, file, error);
  if (error || !std::filesystem::exists(file, error))
    throw Failure(Exit::asked_wrongly, "cannot write " + file);
}

void watch(const Arguments& arguments) {
  cv::CascadeClassifier cascade;
  std::error_code error;
  if (!std::filesystem::exists(kCascade, error) || !cascade.load(kCascade))
    throw Failure(Exit::asked_wrongly,
                  "there is nothing to know faces by: install the package opencv-data");
  const std::string preview = arguments.text_or("preview", "");
  const double view = arguments.number("view");
  Pictures pictures(arguments.text("source"), arguments.period(), arguments.no_pace());
  constexpr std::chrono::seconds kDrawnEach{1};
  std::optional<std::chrono::steady_clock::time_point> drawn;
  for (cv::Mat picture = pictures.next(); !picture.empty(); picture = pictures.next()) {
    const cv::Mat small = made_small(picture);
    const Seen seen = look_at(small, cascade, arguments);
    tell(seen, view);
    const auto now = std::chrono::steady_clock::now();
    if (preview.empty() || (drawn && now < *drawn + kDrawnEach)) continue;
    draw(small, seen, preview);
    drawn = now;
  }
}

}  // namespace
}  // namespace robosync::companion

int main(int count, char** texts) {
  return robosync::companion::run(robosync::companion::watch, count, texts);
}
