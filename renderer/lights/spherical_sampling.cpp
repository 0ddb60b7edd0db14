#include "renderer/lights/spherical_sampling.h"

#include "renderer/math/transcendental.h"

#include <algorithm>
#include <cmath>

namespace renderer {

namespace {

double sine_of(double cosine)
{
    return std::sqrt(std::max(0.0, (1 - cosine) * (1 + cosine)));
}

// acos(a) + acos(b), as the angle of the product of the complex numbers that have these: from 0 to 2 pi.
double sum_of_arc_cosines(double a, double b)
{
    const double sa = sine_of(a), sb = sine_of(b);
    const double angle = atan2(sa * b + a * sb, a * b - sa * sb);
    constexpr double kTurn[2] = {0, 2 * kPi};
    return angle + kTurn[angle < 0];
}

// Angle between two directions that need not be unit: keeps its digits for small and for flat angles.
double angle_between(Vec3d a, Vec3d b)
{
    return atan2(length(cross(a, b)), dot(a, b));
}

// The part of `v` at right angles to the unit vector `axis`, as a unit vector.
Vec3d perpendicular_part(Vec3d v, Vec3d axis)
{
    const Vec3d part = v - axis * dot(v, axis);
    const double size = length(part);
    return size > 0 ? part / size : Vec3d{};
}

} // namespace

SphericalTriangle::SphericalTriangle(Vec3d a, Vec3d b, Vec3d c)
{
    const double la = length(a), lb = length(b), lc = length(c);
    if (!(la > 0 && lb > 0 && lc > 0)) return;
    a_ = a / la;
    b_ = b / lb;
    c_ = c / lc;
    const double volume = std::abs(dot(a_, cross(b_, c_)));
    const double omega = 2 * atan2(volume, 1 + dot(a_, b_) + dot(b_, c_) + dot(c_, a_));
    solid_angle_ = omega < 0 ? omega + 4 * kPi : omega;
}

Vec3d SphericalTriangle::sample(Sample2 u) const
{
    const Vec3d ab = cross(a_, b_), bc = cross(b_, c_), ca = cross(c_, a_);
    const double alpha = angle_between(ab, -ca);
    const auto [sin_alpha, cos_alpha] = sin_cos(alpha);
    const double part = static_cast<double>(u.u0) * solid_angle_;
    // The sub-triangle of that area has its third corner on the arc from a to c.
    const double beta = angle_between(bc, -ab), gamma = angle_between(ca, -bc);
    const double sum =
        kPi + part * ((alpha + beta + gamma - kPi) / solid_angle_); // the same rounding at both ends
    const auto [sin_phi, cos_phi] = sin_cos(sum - alpha);
    const double cos_c = dot(a_, b_);
    const double k1 = cos_phi + cos_alpha, k2 = sin_phi - sin_alpha * cos_c;
    const double below = (k2 * sin_phi + k1 * cos_phi) * sin_alpha;
    double cos_b = below != 0 ? (k2 + (k2 * cos_phi - k1 * sin_phi) * cos_alpha) / below : 1;
    cos_b = std::clamp(std::isfinite(cos_b) ? cos_b : 1.0, -1.0, 1.0);
    const Vec3d on_arc =
        a_ * cos_b + perpendicular_part(c_, a_) * std::sqrt(std::max(0.0, 1 - cos_b * cos_b));
    const double cos_theta = 1 - static_cast<double>(u.u1) * (1 - dot(on_arc, b_));
    const double sin_theta = std::sqrt(std::max(0.0, 1 - cos_theta * cos_theta));
    return normalize(b_ * cos_theta + perpendicular_part(on_arc, b_) * sin_theta);
}

SphericalRectangle::SphericalRectangle(Vec3d corner, const Axes& axes, double width, double height)
    : x_(axes.x), y_(axes.y), z_(axes.z)
{
    z0_ = dot(corner, z_);
    if (z0_ > 0) {
        z_ = -z_;
        z0_ = -z0_;
    }
    x0_ = dot(corner, x_);
    y0_ = dot(corner, y_);
    x1_ = x0_ + width;
    y1_ = y0_ + height;
    if (!(z0_ < 0)) return; // in its plane: it is not seen
    // Normals of the planes through the origin and a side.
    const auto unit = [](double a, double b) { return std::sqrt(a * a + b * b); };
    const double n0 = unit(z0_, y0_), n1 = unit(z0_, x1_), n2 = unit(z0_, y1_), n3 = unit(z0_, x0_);
    b0_ = -y0_ / n0;
    const double b1 = x1_ / n1, b2 = y1_ / n2, b3 = -x0_ / n3;
    b1_ = b2;
    // Inner angles: the sides are at right angles, so the normals' other parts are too.
    k_ = 2 * kPi - sum_of_arc_cosines(-b2 * b3, -b3 * b0_);
    solid_angle_ = std::max(0.0, sum_of_arc_cosines(-b0_ * b1, -b1 * b2) - k_);
}

Vec3d SphericalRectangle::sample(Sample2 u) const
{
    const double au = static_cast<double>(u.u0) * solid_angle_ + k_;
    const auto [sin_au, cos_au] = sin_cos(au);
    const double fu = (cos_au * b0_ - b1_) / sin_au;
    double cu = 1 / std::sqrt(fu * fu + b0_ * b0_);
    if (fu < 0) cu = -cu;
    cu = std::isfinite(cu) ? std::clamp(cu, -1.0, 1.0) : -1.0;
    const double xu = std::clamp(-(cu * z0_) / std::sqrt(std::max(1e-300, 1 - cu * cu)), x0_, x1_);
    const double d2 = xu * xu + z0_ * z0_;
    const double h0 = y0_ / std::sqrt(d2 + y0_ * y0_), h1 = y1_ / std::sqrt(d2 + y1_ * y1_);
    const double hv = h0 + static_cast<double>(u.u1) * (h1 - h0), left = 1 - hv * hv;
    const double yv = left > 1e-15 ? std::clamp(hv * std::sqrt(d2 / left), y0_, y1_) : y1_;
    return x_ * xu + y_ * yv + z_ * z0_;
}

} // namespace renderer
