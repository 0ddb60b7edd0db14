#include "renderer/camera/camera.h"

#include "renderer/math/transcendental.h"

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
    : position_(description.position),
      forward_(
          normalize(description.aim_is_direction ? description.aim : description.aim - description.position)),
      right_(sideways(forward_, description.up)), up_(cross(right_, forward_)), width_(width_px),
      height_(height_px), tan_x_(tan_deg(description.fov_deg / 2) * (width_ / height_)),
      tan_y_(tan_deg(description.fov_deg / 2))
{
}

Vec3d Camera::direction(double picture_x, double picture_y) const
{
    const double x = (2 * picture_x - width_) / width_ * tan_x_;
    const double y = (height_ - 2 * picture_y) / height_ * tan_y_;
    // The basis is orthonormal, so the length is known; at the centre it is exactly 1.
    return (forward_ + right_ * x + up_ * y) / std::sqrt(1 + x * x + y * y);
}

} // namespace renderer
