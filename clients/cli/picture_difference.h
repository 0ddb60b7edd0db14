// PictureDifference: how far a picture is from a reference, on linear values.
//
// Source     relative_rmse as the API defines `error`: sqrt(mean over pixels and channels of (x - ref)^2 /
//            (ref^2 + e)), e = (0.2 m)^2, m the mean of ref over pixels and channels: dimming both pictures
//            does not change it.
// Precision  sums in double, in pixel order: the same pictures give the same numbers.
#pragma once

#include "renderer/film/film.h"

#include <array>
#include <cstdint>
#include <optional>
#include <string>

namespace clients {

struct PictureDifference {
    double rmse = 0;
    double relative_rmse = 0;     // 0 where both are all black; infinite where only the reference is
    double max = 0;               // largest |x - ref| of any channel
    std::array<double, 3> mean{}; // of x - ref, by channel: a bias has a sign
    // Pixels with a NaN or infinity in either picture are left out of everything above, and counted here.
    std::uint64_t non_finite_pixels = 0;
};

// Nothing if the sizes differ.
std::optional<PictureDifference> difference(const renderer::LinearImage& picture,
                                            const renderer::LinearImage& reference);

// One JSON object; an infinite number is null. And the same for people.
std::string write_json(const PictureDifference& difference);
std::string write_text(const PictureDifference& difference);

} // namespace clients
