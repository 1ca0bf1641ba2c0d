// Draws a picture for the tests and rates of `objects`: a grey wall, 640 × 480, and before it
//   marker:NUMBER:X:Y:SIDE:TURN:TILT  one of ArUco's (4 × 4 squares, the first fifty); X, Y: its middle; turned in the picture, and
//                                     then about its upright axis, in degrees, as a camera sees it from so far that the picture is 53
//                                     degrees wide
//   qr:TEXT:X:Y:SIDE:TURN:TILT        a QR code, likewise
//   ball:HUE:X:Y:SIZE:VIVID           lit from before it; hue in degrees, how vivid in percent
//   boxes:COUNT                       grey and pale, anywhere
// with noise of that standard deviation, in 255ths of white. The same arguments draw the same.
//
// robosync-draw FILE.png SEED NOISE THING…    one picture
// robosync-draw                               one for each line of stdin, which has the same
#include <array>
#include <cmath>
#include <cstdio>
#include <iostream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include <opencv2/aruco.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/objdetect.hpp>

namespace {

constexpr int kColumns = 640, kRows = 480;
constexpr double kDegree = CV_PI / 180;

std::vector<std::string> parts_of(const std::string& text, char between) {
  std::vector<std::string> parts;
  std::istringstream in(text);
  for (std::string part; std::getline(in, part, between);)
    parts.push_back(part);
  return parts;
}

// With the white margin that it is printed with.
cv::Mat code_of(const std::string& kind, const std::string& what, int& margin) {
  cv::Mat code;
  constexpr int kSquare = 16, kAdded = 2 * kSquare;
  int has = 0;
  if (kind == "marker") {
    cv::aruco::drawMarker(cv::aruco::getPredefinedDictionary(cv::aruco::DICT_4X4_50),
                          std::stoi(what), 6 * kSquare, code);
  } else {
    cv::QRCodeEncoder::create()->encode(what, code);
    cv::resize(code, code, {}, kSquare, kSquare, cv::INTER_NEAREST);
    has = 2 * kSquare;  // the encoder draws a part of it
  }
  margin = has + kAdded;
  cv::copyMakeBorder(code, code, kAdded, kAdded, kAdded, kAdded, cv::BORDER_CONSTANT,
                     cv::Scalar(255));
  return code;
}

void draw_code(cv::Mat& picture, const std::vector<std::string>& thing) {
  int margin = 0;
  const cv::Mat code = code_of(thing.at(0), thing.at(1), margin);
  const double x = std::stod(thing.at(2)), y = std::stod(thing.at(3));
  const double turn = std::stod(thing.at(5)) * kDegree, tilt = std::stod(thing.at(6)) * kDegree;
  const double half = std::stod(thing.at(4)) / 2 * code.rows / (code.rows - 2.0 * margin);
  const auto corner = [&](double across, double down) {
    const double a = half * (across * std::cos(turn) - down * std::sin(turn));
    const double b = half * (across * std::sin(turn) + down * std::cos(turn));
    const double nearer = kColumns / (kColumns + a * std::sin(tilt));
    return cv::Point2f(static_cast<float>(x + a * std::cos(tilt) * nearer),
                       static_cast<float>(y + b * nearer));
  };
  const auto side = static_cast<float>(code.rows);
  const std::array<cv::Point2f, 4> from = {cv::Point2f(0, 0), {side, 0}, {side, side}, {0, side}};
  const std::array<cv::Point2f, 4> to = {corner(-1, -1), corner(1, -1), corner(1, 1),
                                         corner(-1, 1)};
  const cv::Mat how = cv::getPerspectiveTransform(from.data(), to.data());
  cv::Mat drawn, where;
  cv::warpPerspective(code, drawn, how, picture.size(), cv::INTER_AREA);
  cv::warpPerspective(cv::Mat(code.size(), CV_8U, cv::Scalar(255)), where, how, picture.size());
  cv::cvtColor(drawn, drawn, cv::COLOR_GRAY2BGR);
  drawn.copyTo(picture, where);
}

void draw_ball(cv::Mat& picture, const std::vector<std::string>& thing) {
  const double hue = std::stod(thing.at(1)), x = std::stod(thing.at(2)), y = std::stod(thing.at(3));
  const double radius = std::stod(thing.at(4)) / 2, vivid = std::stod(thing.at(5)) / 100;
  cv::Mat hsv;
  cv::cvtColor(picture, hsv, cv::COLOR_BGR2HSV);
  cv::Mat where(picture.size(), CV_8U, cv::Scalar(0));
  for (int row = 0; row < kRows; ++row)
    for (int column = 0; column < kColumns; ++column) {
      const double away = std::hypot(column - x, row - y) / radius;
      if (away > 1) continue;
      hsv.at<cv::Vec3b>(row, column) = {cv::saturate_cast<uchar>(hue / 2),
                                        cv::saturate_cast<uchar>(255 * vivid),
                                        cv::saturate_cast<uchar>(230 * (1 - 0.5 * away * away))};
      where.at<uchar>(row, column) = 255;
    }
  cv::Mat drawn;
  cv::cvtColor(hsv, drawn, cv::COLOR_HSV2BGR);
  drawn.copyTo(picture, where);
}

void draw_boxes(cv::Mat& picture, const std::vector<std::string>& thing) {
  cv::RNG& chance = cv::theRNG();
  for (int i = std::stoi(thing.at(1)); i > 0; --i) {
    const cv::Rect box(chance.uniform(-40, kColumns), chance.uniform(-40, kRows),
                       chance.uniform(10, 200), chance.uniform(10, 200));
    const int grey = chance.uniform(0, 230);
    const cv::Scalar color(grey, grey + chance.uniform(0, 25), grey + chance.uniform(0, 25));
    cv::rectangle(picture, box, color, cv::FILLED);
  }
}

void draw(const std::vector<std::string>& arguments) {
  cv::theRNG().state = std::stoull(arguments.at(1)) + 1;
  cv::Mat picture(kRows, kColumns, CV_8UC3, cv::Scalar::all(150));
  for (std::size_t i = 3; i < arguments.size(); ++i) {
    const auto thing = parts_of(arguments[i], ':');
    if (thing.at(0) == "ball")
      draw_ball(picture, thing);
    else if (thing.at(0) == "boxes")
      draw_boxes(picture, thing);
    else
      draw_code(picture, thing);
  }
  cv::Mat noise(picture.size(), CV_16SC3);
  cv::randn(noise, cv::Scalar::all(0), cv::Scalar::all(std::stod(arguments.at(2))));
  cv::add(picture, noise, picture, cv::noArray(), CV_8U);
  if (!cv::imwrite(arguments.at(0), picture))
    throw std::runtime_error("cannot write " + arguments[0]);
}

}  // namespace

int main(int count, char** texts) {
  try {
    if (count > 1) draw({texts + 1, texts + count});
    for (std::string line; count == 1 && std::getline(std::cin, line);)
      draw(parts_of(line, ' '));
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "robosync-draw: %s\n", error.what());
    return 2;
  }
}
