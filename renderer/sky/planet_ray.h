// PlanetRay: a straight line over a sphere, told by its closest approach to the centre.
//
// Places on it are signed distances u from that point, growing along the ray. Altitudes come from the perigee's
// altitude and u as sums of what is positive, never as the difference of two radii: a few ulp of the altitude near
// the ground, whatever the planet's size and however far the eye.
//
// Units   metres.
#pragma once

#include <algorithm>
#include <cmath>

namespace renderer {

class PlanetRay {
public:
    PlanetRay() = default;
    // From `altitude` >= 0, at an angle to the vertical whose cosine is `mu`.
    PlanetRay(double planet_radius, double altitude, double mu)
        : radius_(planet_radius), start_((planet_radius + altitude) * mu)
    {
        const double sine = std::sqrt(std::max(0.0, (1 - mu) * (1 + mu)));
        perigee_ = altitude - (planet_radius + altitude) * mu * mu / (1 + sine);
        reckon();
    }
    // From `altitude`, passing the ground at `perigee` <= altitude, which lies ahead where `descending`.
    static PlanetRay through(double planet_radius, double altitude, double perigee, bool descending)
    {
        PlanetRay ray;
        ray.radius_ = planet_radius;
        ray.perigee_ = perigee;
        ray.reckon();
        ray.start_ = ray.distance_at(altitude) * (descending ? -1 : 1);
        return ray;
    }

    [[nodiscard]] double start() const { return start_; }
    [[nodiscard]] double perigee() const { return perigee_; } // its altitude; below 0: through the ground
    [[nodiscard]] double radius_at(double u) const { return std::sqrt(impact2_ + u * u); }
    [[nodiscard]] double altitude(double u) const { return (rise_ + u * u) / (radius_ + radius_at(u)); }
    // Cosine to the vertical, of the ray's direction at u.
    [[nodiscard]] double mu(double u) const { return u / radius_at(u); }
    // The u >= 0 at which the ray is `altitude` high; 0 where it never is so low.
    [[nodiscard]] double distance_at(double altitude) const
    {
        return std::sqrt(std::max(0.0, (altitude - perigee_) * (2 * radius_ + altitude + perigee_)));
    }
    [[nodiscard]] bool hits_ground() const { return start_ < 0 && perigee_ < 0; }
    [[nodiscard]] double ground() const { return -distance_at(0); } // where it does

    // The part from the start on that lies below `top`; nothing where end <= begin.
    struct Reach {
        double begin = 0, end = 0;
    };
    [[nodiscard]] Reach reach(double top) const
    {
        if (perigee_ >= top) return {};
        const double out = distance_at(top);
        return {std::max(start_, -out), std::max(start_, hits_ground() ? ground() : out)};
    }

private:
    void reckon()
    {
        rise_ = perigee_ * (2 * radius_ + perigee_);
        impact2_ = (radius_ + perigee_) * (radius_ + perigee_);
    }

    double radius_ = 1, perigee_ = 0, start_ = 0;
    double rise_ = 0, impact2_ = 1; // (R + perigee)^2 - R^2, and (R + perigee)^2
};

} // namespace renderer
