// Sun: a disk at infinity of one radiance, from a star's point to half the sky.
//
// Units  radiance W/(m^2 sr); angles enter in degrees, as radii.
// Source a facing surface gets pi sin^2(radius) times the radiance (half the sky: pi).
#pragma once

#include "renderer/color/rgb.h"
#include "renderer/description/light.h"
#include "renderer/math/vec3.h"
#include "renderer/sampling/sampler.h"

namespace renderer {

struct Sun {
    Vec3d toward{};              // unit, to its centre
    Vec3d across{}, upward{};    // unit, at right angles to that and to one another
    double one_minus_cosine = 0; // of its angular radius
    Rgb radiance{};
    double pdf = 0; // of every direction that sample() draws, per steradian
};

Sun prepare_sun(const SunLight& light);

// A unit direction within the disk, uniformly.
Vec3d sample(const Sun& sun, Sample2 u);

// What is seen of it in a unit direction.
inline Rgb radiance_towards(const Sun& sun, Vec3d direction)
{
    // 1 - cosine as half the squared distance of two unit vectors, which keeps its digits for small disks.
    const Vec3d apart = direction - sun.toward;
    return dot(apart, apart) / 2 <= sun.one_minus_cosine ? sun.radiance : Rgb{};
}

} // namespace renderer
