// Pictures compared as api.md defines it; and, where a comparison fails, left on disk to be looked at.
#pragma once

#include "renderer/film/film.h"

#include <cstdint>
#include <optional>
#include <string>

namespace tests {

// A colour PFM, little-endian; nothing if the file is not there or not one.
std::optional<renderer::LinearImage> read_pfm(const std::string& path);

// sqrt(mean over pixels and channels of (x - ref)^2 / (ref^2 + e)), e = (0.2 mean of ref)^2.
double relative_rmse(const renderer::LinearImage& image, const renderer::LinearImage& reference);

// Means of squares of side x side pixels, which tells what is wrong in places from noise; both sides of the picture are
// multiples of it.
renderer::LinearImage in_squares(const renderer::LinearImage& image, std::uint32_t side);

renderer::Rgb mean_of(const renderer::LinearImage& image);

// That a picture is less than `most` (a relative RMSE) from the reference, and each channel's mean within `most_of_mean` of its
// own; otherwise it is left for inspection. The error found becomes the test's property "relative_rmse".
void expect_looks_as(const std::string& name,
                     const renderer::LinearImage& image,
                     const renderer::LinearImage& reference,
                     double most,
                     double most_of_mean);

// Writes NAME.png, NAME_reference.png and NAME_error.png (black: equal, white: 10 % or more of the mean off)
// to the system's folder for temporary files, and says where.
std::string leave_for_inspection(const std::string& name,
                                 const renderer::LinearImage& image,
                                 const renderer::LinearImage& reference);

} // namespace tests
