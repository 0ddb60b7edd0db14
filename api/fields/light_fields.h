// The members of lights; see job_fields.h.
#pragma once

#include "api/fields/ranges.h"
#include "api/fields/sees.h"
#include "renderer/description/light.h"

namespace api {

template <typename V, Sees<renderer::PointLight> X>
void fields(V& v, X& light)
{
    v.point("position", light.position, "metres");
    v.color("intensity", light.intensity, kRadiometric, "W/sr");
}

template <typename V, Sees<renderer::SpotLight> X>
void fields(V& v, X& light)
{
    v.point("position", light.position, "metres");
    v.direction("direction", light.direction, "the way the light travels");
    v.color("intensity", light.intensity, kRadiometric, "W/sr within the inner cone");
    v.number("inner_deg", light.inner_deg, kInnerAngle, "half angle of full intensity");
    v.number("outer_deg", light.outer_deg, kOuterAngle, "half angle beyond which there is none");
}

template <typename V, Sees<renderer::DirectionalLight> X>
void fields(V& v, X& light)
{
    v.direction("direction", light.direction, "the way the light travels");
    v.color("irradiance", light.irradiance, kRadiometric, "W/m^2 on a surface that faces it");
}

template <typename V, Sees<renderer::SunLight> X>
void fields(V& v, X& light)
{
    v.direction("direction", light.direction, "the way the light travels");
    v.sun_angles(light.direction);
    v.color("irradiance", light.irradiance, kRadiometric, "W/m^2 on a surface that faces its centre");
    v.number("angular_radius_deg", light.angular_radius_deg, kSunRadius, "half its angular diameter");
}

template <typename V, typename X>
void area_fields(V& v, X& light)
{
    v.color("power", light.power, kRadiometric, "W in all, instead of radiance");
    v.only_when(!light.power, {"radiance"}, "give radiance or power, not both", [&] {
        v.color("radiance", light.radiance, kRadiometric, "W/(m^2 sr), the same in every direction");
    });
    v.placement(light.world_from_light);
    v.boolean("visible_to_camera", light.visible_to_camera, "false: seen only by its light and its shadow");
}

template <typename V, Sees<renderer::RectangleLight> X>
void fields(V& v, X& light)
{
    v.extents("size",
              "width and height, metres; in the xy plane, shining towards +z",
              light.width_m,
              light.height_m);
    v.boolean("two_sided", light.two_sided, "true: it shines from its back as well");
    area_fields(v, light);
}

template <typename V, Sees<renderer::DiskLight> X>
void fields(V& v, X& light)
{
    v.number("radius", light.radius_m, kSize, "metres; in the xy plane, shining towards +z");
    v.boolean("two_sided", light.two_sided, "true: it shines from its back as well");
    area_fields(v, light);
}

template <typename V, Sees<renderer::SphereLight> X>
void fields(V& v, X& light)
{
    v.number("radius", light.radius_m, kSize, "metres; centred at the origin, shining outwards");
    area_fields(v, light);
}

} // namespace api
