// objects: which markers and vividly coloured things a camera sees; the nearest of each, and where it is. Markers are ArUco's of
// 4 × 4 squares, read by OpenCV's module aruco, and QR codes whose text is a number, read by ZXing (Debian's OpenCV cannot).
//
// robosync-objects --source FILE|CAMERA --period MS --view DEG --smallest PERCENT --vivid PERCENT --hue_from DEG --hue_to DEG
//                  [--preview FILE.png] [--no-pace]
#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include <opencv2/aruco.hpp>
#include <opencv2/imgproc.hpp>
#define ZX_USE_UTF8 1
#include <ReadBarcode.h>

#include "companion/pictures.hpp"

namespace robosync::companion {
namespace {

constexpr int kMarkerRows = 480;  // larger pictures are scaled down: each pixel takes time
constexpr int kColorRows = 240;
constexpr std::size_t kMost = 20;  // of each kind
constexpr std::size_t kLongestNumber = 3;
constexpr int kNoMarker = -1;
constexpr int kTurn = 360;
constexpr int kHues = kTurn / 2;  // OpenCV's range of hues in a byte

struct Hue {
  const char* word;
  int from;  // degrees
};
constexpr Hue kColors[] = {
#define HUE(word, from) {#word, from},
#include "companion/colors.def"
#undef HUE
};

// What to look for, from the arguments.
struct Wanted {
  explicit Wanted(const Arguments& arguments)
      : view(arguments.number("view")),
        smallest(arguments.number("smallest") / 100),
        vivid(arguments.number("vivid") / 100),
        hue_from(arguments.number("hue_from")),
        hue_to(arguments.number("hue_to")) {}

  // The range may wrap around the circle: from 340 to 20 degrees is red.
  [[nodiscard]] bool has_hue(int degrees) const {
    return hue_from <= hue_to ? degrees >= hue_from && degrees <= hue_to
                              : degrees >= hue_from || degrees <= hue_to;
  }

  double view, smallest, vivid, hue_from, hue_to;
};

// A thing in a picture; its size is relative to the picture's height.
struct Thing {
  cv::Point2f middle;
  double size;
  std::vector<cv::Point> outline;
  int number;         // of a marker
  std::size_t color;  // of a coloured thing
};

struct Seen {
  cv::Size size;              // of the picture
  std::vector<Thing> things;  // the nearest first
};

void sort(std::vector<Thing>& things) {
  std::ranges::sort(things, [](const Thing& a, const Thing& b) {
    return a.size != b.size ? a.size > b.size : a.middle.x < b.middle.x;
  });
}

// ---- markers

std::optional<int> number_in(const std::string& text) {
  int number = 0;
  const char* const end = text.data() + text.size();
  const bool is_short = !text.empty() && text.size() <= kLongestNumber && text.front() != '-';
  const auto read = std::from_chars(text.data(), end, number);
  if (!is_short || read.ec != std::errc{} || read.ptr != end) return std::nullopt;
  return number;
}

class Markers {
public:
  explicit Markers(double smallest) : smallest_(smallest) {}

  Seen look_at(const cv::Mat& picture) const {
    cv::Mat grey;
    cv::cvtColor(picture.rows > kMarkerRows ? made_high(picture, kMarkerRows) : picture, grey,
                 cv::COLOR_BGR2GRAY);
    Seen seen{grey.size(), {}};
    add_aruco(grey, seen);
    add_qr(grey, seen);
    sort(seen.things);
    return seen;
  }

private:
  void add(Seen& seen, const std::vector<cv::Point2f>& corners, int number) const {
    const double size = std::sqrt(cv::contourArea(corners)) / seen.size.height;
    if (size < smallest_) return;
    const cv::Point2f middle = (corners[0] + corners[1] + corners[2] + corners[3]) / 4;
    seen.things.push_back({middle, size, {corners.begin(), corners.end()}, number, 0});
  }

  void add_aruco(const cv::Mat& grey, Seen& seen) const {
    std::vector<std::vector<cv::Point2f>> corners;
    std::vector<int> numbers;
    cv::aruco::detectMarkers(grey, dictionary_, corners, numbers, parameters_);
    for (std::size_t i = 0; i < numbers.size(); ++i)
      add(seen, corners[i], numbers[i]);
  }

  void add_qr(const cv::Mat& grey, Seen& seen) const {
    const ZXing::ImageView view(grey.data, grey.cols, grey.rows, ZXing::ImageFormat::Lum,
                                static_cast<int>(grey.step));
    for (const ZXing::Result& code : ZXing::ReadBarcodes(view, hints_)) {
      std::vector<cv::Point2f> corners;
      for (const ZXing::PointI& corner : code.position())
        corners.push_back(cv::Point(corner.x, corner.y));
      if (const auto number = number_in(code.text())) add(seen, corners, *number);
    }
  }

  double smallest_;
  cv::Ptr<cv::aruco::Dictionary> dictionary_ =
      cv::aruco::getPredefinedDictionary(cv::aruco::DICT_4X4_50);
  cv::Ptr<cv::aruco::DetectorParameters> parameters_ = cv::aruco::DetectorParameters::create();
  ZXing::DecodeHints hints_ = ZXing::DecodeHints().setFormats(ZXing::BarcodeFormat::QRCode);
};

// ---- what has a colour

class Colors {
public:
  explicit Colors(const Wanted& wanted) : wanted_(wanted) {
    for (int hue = 0; hue < kHues; ++hue)
      of_hue_.at<unsigned char>(hue) = color_of(hue * kTurn / kHues);
  }

  Seen look_at(const cv::Mat& picture) const {
    const cv::Mat small = made_high(picture, kColorRows);
    Seen seen{small.size(), {}};
    cv::Mat calm, hsv, planes[3], colors;
    cv::GaussianBlur(small, calm, {5, 5}, 0);
    cv::cvtColor(calm, hsv, cv::COLOR_BGR2HSV);
    cv::split(hsv, planes);
    constexpr double kFull = 255, kDark = 0.2;  // in the dark a hue is random
    const cv::Mat is_vivid = (planes[1] >= kFull * wanted_.vivid) & (planes[2] >= kFull * kDark);
    cv::LUT(planes[0], of_hue_, colors);
    for (std::size_t color = 0; color < std::size(kColors); ++color)
      add(seen, (colors == static_cast<double>(color)) & is_vivid, color);
    sort(seen.things);
    return seen;
  }

private:
  static constexpr unsigned char kNone = 255;

  [[nodiscard]] unsigned char color_of(int degrees) const {
    if (!wanted_.has_hue(degrees)) return kNone;
    std::size_t color = std::size(kColors) - 1;  // the last one continues at 0
    for (std::size_t i = 0; i < std::size(kColors); ++i)
      if (degrees >= kColors[i].from) color = i;
    return static_cast<unsigned char>(color);
  }

  // A connected part of the mask is a thing if it fills its box as a ball or a block does, unlike a line.
  void add(Seen& seen, cv::Mat mask, std::size_t color) const {
    constexpr double kFills = 0.4;
    cv::morphologyEx(mask, mask, cv::MORPH_OPEN, cv::Mat::ones(3, 3, CV_8U));
    cv::Mat labels, stats, middles;
    const int count = cv::connectedComponentsWithStats(mask, labels, stats, middles);
    for (int i = 1; i < count; ++i) {
      const cv::Rect box(stats.at<int>(i, cv::CC_STAT_LEFT), stats.at<int>(i, cv::CC_STAT_TOP),
                         stats.at<int>(i, cv::CC_STAT_WIDTH), stats.at<int>(i, cv::CC_STAT_HEIGHT));
      const double size = static_cast<double>(box.height) / seen.size.height;
      if (size < wanted_.smallest || stats.at<int>(i, cv::CC_STAT_AREA) < kFills * box.area())
        continue;
      const cv::Point2f middle = cv::Point2f(box.tl() + box.br()) / 2;
      const std::vector<cv::Point> outline = {
          box.tl(), {box.x + box.width, box.y}, box.br(), {box.x, box.y + box.height}};
      seen.things.push_back({middle, size, outline, kNoMarker, color});
    }
  }

  Wanted wanted_;
  cv::Mat of_hue_ = cv::Mat(1, 256, CV_8U, cv::Scalar(kNone));
};

// ---- reports

void tell(const Seen& seen, double view, const std::string& before) {
  if (seen.things.empty()) return;
  const Thing& nearest = seen.things.front();
  say(before + "ANGLE", angle_of(nearest.middle.x, seen.size.width, view));
  say(before + "SIZE", std::min(100.0, 100 * nearest.size));
}

void tell(const Seen& colored, const Seen& markers, double view) {
  const auto count = [](const Seen& seen) {
    return static_cast<double>(std::min(seen.things.size(), kMost));
  };
  say("COUNT", count(colored));
  say("COLOR", colored.things.empty() ? "none" : kColors[colored.things.front().color].word);
  tell(colored, view, "");
  say("MARKERS", count(markers));
  say("MARKER",
      static_cast<double>(markers.things.empty() ? kNoMarker : markers.things.front().number));
  tell(markers, view, "MARKER_");
}

void draw(cv::Mat& picture, const Seen& seen) {
  const cv::Scalar nearest(0, 220, 0), others(0, 180, 220);
  for (const Thing& thing : seen.things) {
    const cv::Scalar& color = &thing == &seen.things.front() ? nearest : others;
    std::vector<cv::Point> outline = thing.outline;
    for (cv::Point& point : outline)
      point = {point.x * picture.rows / seen.size.height,
               point.y * picture.rows / seen.size.height};
    cv::polylines(picture, outline, true, color, 2);
    const std::string text =
        thing.number == kNoMarker ? kColors[thing.color].word : std::to_string(thing.number);
    cv::putText(picture, text, outline.front() + cv::Point(2, -4), cv::FONT_HERSHEY_SIMPLEX, 0.5,
                color);
  }
}

void look_for_objects(const Arguments& arguments) {
  const Wanted wanted(arguments);
  const Colors colors(wanted);
  const Markers markers(wanted.smallest);
  watch(arguments, [&](const cv::Mat& picture, cv::Mat* drawing) {
    const Seen colored = colors.look_at(picture), marked = markers.look_at(picture);
    tell(colored, marked, wanted.view);
    if (drawing == nullptr) return;
    *drawing = made_high(picture, kColorRows);
    draw(*drawing, colored);
    draw(*drawing, marked);
  });
}

}  // namespace
}  // namespace robosync::companion

int main(int count, char** texts) {
  return robosync::companion::run(robosync::companion::look_for_objects, count, texts);
}
