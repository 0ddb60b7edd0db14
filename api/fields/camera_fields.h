// The members of cameras and of transport; see job_fields.h.
#pragma once

#include "api/fields/ranges.h"
#include "api/fields/sees.h"
#include "api/words/word_table.h"
#include "renderer/description/camera.h"
#include "renderer/description/transport.h"

namespace api {

template <typename V, Sees<renderer::CameraDescription> X>
void fields(V& v, X& camera)
{
    using renderer::Projection;
    v.word("type", camera.projection, "what kind of camera this is");
    v.point("position", camera.position, "the eye, metres");
    v.aim(camera);
    v.direction("up", camera.up, "which way is up in the picture; need not be perpendicular to the view");
    v.only_when(
        camera.projection == Projection::perspective,
        {"fov_deg", "lens_radius", "focus_distance"},
        "it belongs to perspective cameras",
        [&] {
            v.number("fov_deg", camera.fov_deg, kFieldOfView, "perspective: vertical field of view, degrees");
            v.number("lens_radius",
                     camera.lens_radius_m,
                     kLensRadius,
                     "perspective: of a thin lens, metres; 0: a pinhole, everything is sharp");
            v.number(
                "focus_distance",
                camera.focus_distance_m,
                kSize,
                "perspective: metres along the view to what a lens shows sharp; left out: look_at, or 1");
        });
    v.only_when(
        camera.projection == Projection::orthographic, {"height"}, "it belongs to orthographic cameras", [&] {
            v.number("height", camera.height_m, kSize, "orthographic: metres that the picture is high");
        });
    v.only_when(camera.projection == Projection::meter, {"quantity"}, "it belongs to meters", [&] {
        v.word("quantity",
               camera.quantity,
               "meter: radiance along the direction, or irradiance on a surface that faces it");
    });
}

template <typename V, Sees<renderer::TransportDescription> X>
void fields(V& v, X& transport)
{
    v.word("type", transport.type, "auto: the plan decides, and says why");
    v.integer("max_depth",
              transport.max_depth,
              kDepth,
              "scatterings at surfaces from light to eye: 0 emission alone, 1 direct light; left out: 4 for "
              "whitted, no "
              "bound for path");
    v.number("clamp",
             transport.clamp,
             kClamp,
             "path: most that one indirect contribution adds to a channel; what is cut off is lost");
}

} // namespace api
