// What modules that see have in common: the pictures of a camera or a file, how an angle is told, the picture that shows what was
// seen (docs/companion.md).
#pragma once

#include <functional>
#include <string>

#include <opencv2/core.hpp>

#include "companion/worker.hpp"

namespace robosync::companion {

// So many rows high; it may be enlarged.
cv::Mat made_high(const cv::Mat& picture, int rows);

// Where the column `x` of a picture is, from straight ahead, in degrees; to the right is positive, as for a joint. `view`: from its
// left to its right edge.
double angle_of(double x, int columns, double view);

// Given a picture, it says what is known of it; where there is a `drawing`, it puts there what shows that.
using Look = std::function<void(const cv::Mat& picture, cv::Mat* drawing)>;

// Looks at the pictures of --source, one each --period, until they are over; a drawing goes once a second to --preview, if given.
// A picture is seen again and again, unless with --no-pace; a film once. Throws Failure.
void watch(const Arguments& arguments, const Look& look);

}  // namespace robosync::companion
