// Camera: from a point of the picture to the ray that sees it: pinhole, thin lens, parallel, all around, meter.
//
// Units   picture points in pixels of the full picture, x to the right and y down from its top left corner,
//         so that pixel (i, j) is [i, i+1) x [j, j+1) and its centre (i + 0.5, j + 0.5); directions are unit
//         vectors.
// Frame   that of the description, in double: a field of view of 0.01 degrees and an eye 1e8 m off keep their digits.
// Source  the pinhole of M. Pharr, W. Jakob, G. Humphreys, "Physically Based Rendering", section 6.2; the
//         vertical field of view is the named one, and the aspect ratio acts on x. Thin lens: R. Cook et al.,
//         "Distributed Ray Tracing", SIGGRAPH 1984.
// Cost    some 20 operations, of a panorama two sines and cosines more; no allocation.
#pragma once

#include "renderer/description/camera.h"
#include "renderer/geometry/ray.h"
#include "renderer/math/vec3.h"
#include "renderer/sampling/sampler.h"

#include <cstdint>

namespace renderer {

class Camera {
public:
    // A description that check_description passed; width and height of the full picture, at least 1.
    Camera(const CameraDescription& description, std::uint32_t width_px, std::uint32_t height_px);

    Vec3d position() const { return position_; }
    Vec3d forward() const { return forward_; }
    Vec3d right() const { return right_; }
    Vec3d up() const { return up_; }

    // `lens` chooses where on a lens the ray starts, or where the ray of an irradiance meter goes. A camera whose
    // needs_lens() is false does not look at it.
    Ray ray(double picture_x, double picture_y, Sample2 lens) const;
    bool needs_lens() const { return needs_lens_; }
    bool is_meter() const { return projection_ == Projection::meter; }
    MeterQuantity quantity() const { return quantity_; }

    // How wide a sample's share of a surface is that lies `t` away and faces it, metres: half of its pixel's, over
    // which the samples are spread already. Of a meter: nothing.
    double width_at(double t) const { return half_pixel_ + t * half_pixel_per_metre_; }

    // Of a pinhole. The centre of the picture gives forward(), to the bit.
    Vec3d direction(double picture_x, double picture_y) const;

private:
    Projection projection_;
    MeterQuantity quantity_;
    bool needs_lens_;
    Vec3d position_, forward_, right_, up_;
    double width_, height_;
    double tan_y_, tan_x_; // of half the field of view; of parallel rays half the picture in metres
    double lens_radius_m_, focus_distance_m_;
    double half_pixel_ = 0, half_pixel_per_metre_ = 0; // of parallel rays; of others, a metre away
};

} // namespace renderer
