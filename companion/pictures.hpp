// Shared by the modules that see: pictures from a camera or a file, angles, and the preview of what was seen
// (docs/companion.md).
#pragma once

#include <functional>
#include <string>

#include <opencv2/core.hpp>

#include "companion/worker.hpp"

namespace robosync::companion {

// Scales a picture to `rows` rows; this may enlarge it.
cv::Mat made_high(const cv::Mat& picture, int rows);

// The angle of a picture's column `x` from straight ahead, in degrees; positive to the right, as for a joint. `view`: the angle
// between the picture's left and right edge.
double angle_of(double x, int columns, double view);

// Analyzes a picture and reports the result; if `drawing` is not null, it also draws the result there.
using Look = std::function<void(const cv::Mat& picture, cv::Mat* drawing)>;

// Calls `look` with the pictures of --source, one each --period, until they end. If --preview is given, writes a drawing there
// once a second. A still picture is repeated for ever, except with --no-pace; a film plays once. Throws Failure.
void watch(const Arguments& arguments, const Look& look);

}  // namespace robosync::companion
