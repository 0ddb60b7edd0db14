// Uniform sampling of what a triangle or a rectangle covers of the sphere of directions.
//
// Frame   the point that looks is the origin.
// Units   solid angles in steradians.
// Source  triangle: J. Arvo, "Stratified Sampling of Spherical Triangles", SIGGRAPH 1995; its solid angle: A. Van
//         Oosterom, J. Strackee, "The Solid Angle of a Plane Triangle", IEEE Trans. Biomed. Eng. 30, 1983.
//         rectangle: C. Urena, M. Fajardo, A. King, "An Area-Preserving Parametrization for Spherical Rectangles",
//         EGSR 2013.
#pragma once

#include "renderer/math/vec3.h"
#include "renderer/sampling/sampler.h"

namespace renderer {

class SphericalTriangle {
public:
    SphericalTriangle(Vec3d a, Vec3d b, Vec3d c);       // corners, none at the origin
    double solid_angle() const { return solid_angle_; } // 0 where the origin lies in the plane
    Vec3d sample(Sample2 u) const;                      // a unit direction; solid_angle() > 0

private:
    Vec3d a_, b_, c_; // unit
    double solid_angle_ = 0;
};

class SphericalRectangle {
public:
    // One corner and two sides at right angles.
    // `axes`: unit, along the sides and at right angles to both; `corner`: the one that both sides leave from.
    struct Axes {
        Vec3d x, y, z;
    };
    SphericalRectangle(Vec3d corner, const Axes& axes, double width, double height);
    double solid_angle() const { return solid_angle_; }
    Vec3d sample(Sample2 u) const; // a point of the rectangle; solid_angle() > 0

private:
    Vec3d x_, y_, z_;               // axes; z towards the origin's side
    double x0_, x1_, y0_, y1_, z0_; // z0_ <= 0
    double b0_ = 0, b1_ = 0, k_ = 0, solid_angle_ = 0;
};

} // namespace renderer
