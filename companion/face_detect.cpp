// face_detect: how many faces a camera sees, and where the nearest one is. It uses OpenCV's cascade for frontal faces (package
// opencv-data).
//
// robosync-face-detect --source FILE|CAMERA --period MS --view DEG --smallest PERCENT --agreeing N [--preview FILE.png]
//                      [--no-pace]
#include <algorithm>
#include <filesystem>
#include <vector>

#include <opencv2/imgproc.hpp>
#include <opencv2/objdetect.hpp>

#include "companion/pictures.hpp"

namespace robosync::companion {
namespace {

constexpr const char* kCascade =
    "/usr/share/opencv4/haarcascades/haarcascade_frontalface_default.xml";
constexpr int kHeight =
    240;  // pictures are scaled down to this: the time for a face depends on its size in pixels
constexpr int kMostFaces = 20;

struct Seen {
  std::vector<cv::Rect> faces;  // the nearest first
  cv::Size size;                // of the picture that they are in
};

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

void tell(const Seen& seen, double view) {
  say("COUNT", static_cast<double>(std::min<std::size_t>(seen.faces.size(), kMostFaces)));
  if (seen.faces.empty()) return;
  const cv::Rect& nearest = seen.faces.front();
  say("ANGLE", angle_of(nearest.x + nearest.width / 2.0, seen.size.width, view));
  say("NEARNESS", std::min(100.0, 100.0 * nearest.height / seen.size.height));
}

void draw(cv::Mat& picture, const Seen& seen) {
  const cv::Scalar nearest(0, 220, 0), others(0, 180, 220);
  for (const cv::Rect& face : seen.faces)
    cv::rectangle(picture, face, &face == &seen.faces.front() ? nearest : others, 2);
}

void look_for_faces(const Arguments& arguments) {
  cv::CascadeClassifier cascade;
  std::error_code error;
  if (!std::filesystem::exists(kCascade, error) || !cascade.load(kCascade))
    throw Failure(Exit::asked_wrongly,
                  "there is nothing to know faces by: install the package opencv-data");
  const double view = arguments.number("view");
  watch(arguments, [&](const cv::Mat& picture, cv::Mat* drawing) {
    const cv::Mat small = made_high(picture, kHeight);
    const Seen seen = look_at(small, cascade, arguments);
    tell(seen, view);
    if (drawing == nullptr) return;
    *drawing = small;
    draw(*drawing, seen);
  });
}

}  // namespace
}  // namespace robosync::companion

int main(int count, char** texts) {
  return robosync::companion::run(robosync::companion::look_for_faces, count, texts);
}
