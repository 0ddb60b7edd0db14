#include "renderer/camera/camera.h"

#include "renderer/math/transcendental.h"
#include "renderer/sampling/warp.h"

#include <cmath>

namespace renderer {

namespace {

// Where up is (nearly) the view itself, any sideways will do, but it must always be the same one: +x, as if
// the camera had been tilted there from -z; and -z for a camera that looks along x.
Vec3d sideways(Vec3d forward, Vec3d up)
{
    constexpr double kLeastSine = 1e-9;
    const Vec3d side = cross(forward, normalize(up));
    if (length(side) > kLeastSine) return normalize(side);
    const Vec3d axis = std::abs(forward.x) < 0.9 ? Vec3d{1, 0, 0} : Vec3d{0, 0, -1};
    return normalize(axis - forward * dot(axis, forward));
}

} // namespace

Camera::Camera(const CameraDescription& description, std::uint32_t width_px, std::uint32_t height_px)
    : projection_(description.projection), quantity_(description.quantity),
      needs_lens_((projection_ == Projection::perspective && description.lens_radius_m > 0) ||
                  (projection_ == Projection::meter && quantity_ == MeterQuantity::irradiance)),
      position_(description.position),
      forward_(
          normalize(description.aim_is_direction ? description.aim : description.aim - description.position)),
      right_(sideways(forward_, description.up)), up_(cross(right_, forward_)), width_(width_px),
      height_(height_px), tan_y_(projection_ == Projection::orthographic ? description.height_m / 2
                                                                         : tan_deg(description.fov_deg / 2)),
      lens_radius_m_(description.lens_radius_m),
      focus_distance_m_(description.focus_distance_m.value_or(
          description.aim_is_direction ? 1 : length(description.aim - description.position)))
{
    tan_x_ = tan_y_ * (width_ / height_);
    if (projection_ == Projection::orthographic) half_pixel_ = tan_y_ / height_;
    if (projection_ == Projection::perspective) half_pixel_per_metre_ = tan_y_ / height_;
    if (projection_ == Projection::panorama) half_pixel_per_metre_ = kPi / 2 / height_;
}

Vec3d Camera::direction(double picture_x, double picture_y) const
{
    const double x = (2 * picture_x - width_) / width_ * tan_x_;
    const double y = (height_ - 2 * picture_y) / height_ * tan_y_;
    // The basis is orthonormal, so the length is known; at the centre it is exactly 1.
    return (forward_ + right_ * x + up_ * y) / std::sqrt(1 + x * x + y * y);
}

Ray Camera::ray(double picture_x, double picture_y, Sample2 lens) const
{
    switch (projection_) {
    case Projection::perspective: {
        const Vec3d way = direction(picture_x, picture_y);
        if (!needs_lens_) return {position_, way};
        // What is in focus is a plane, so all rays of a point of the picture meet where the middle one passes it.
        const Vec3d focus = position_ + way * (focus_distance_m_ / dot(way, forward_));
        const auto [x, y] = concentric_disk(lens);
        const Vec3d from = position_ + (right_ * x + up_ * y) * lens_radius_m_;
        return {from, normalize(focus - from)};
    }
    case Projection::orthographic: {
        const double x = (2 * picture_x - width_) / width_ * tan_x_;
        const double y = (height_ - 2 * picture_y) / height_ * tan_y_;
        return {position_ + right_ * x + up_ * y, forward_};
    }
    case Projection::panorama: {
        const auto [sin_azimuth, cos_azimuth] = sin_cos_deg((2 * picture_x - width_) / width_ * 180);
        const auto [sin_zenith, cos_zenith] = sin_cos_deg(picture_y / height_ * 180);
        return {position_,
                normalize((forward_ * cos_azimuth + right_ * sin_azimuth) * sin_zenith + up_ * cos_zenith)};
    }
    case Projection::meter:
        if (quantity_ == MeterQuantity::radiance) return {position_, forward_};
        const Vec3d local = to_double(sample_cosine_hemisphere(lens));
        return {position_, normalize(right_ * local.x + up_ * local.y + forward_ * local.z)};
    }
    return {position_, forward_};
}

} // namespace renderer
