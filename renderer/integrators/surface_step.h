// Steps that integrators share: what a ray finds where it leaves the scene, how it goes on from a surface.
#pragma once

#include "renderer/integrators/radiance.h"
#include "renderer/materials/media.h"

namespace renderer {

// What a ray sees that meets nothing. `drawn_pdf`: density of its direction where lights were asked as well, of which
// this is then one part; 0: all of it.
Rgb background(const Scene& scene, Vec3d direction, double drawn_pdf);

// What is left of light after `way` metres of what fills the place.
Rgb transmittance(const Media& media, double way);

// What the air before a hit at `distance` leaves of it, and adds: all and nothing where air does not count. For rays from the
// camera, and from mirrors and panes as if they came from it.
SkyLight::Between air_before(const Scene& scene, const Ray& ray, double distance);

// Unit direction in which a mirror or the smooth boundary of glass sends a ray on; in double, since errors of a
// direction grow over a path. `eta` as in Bsdf; nothing sensible where all light is reflected.
Vec3d reflected(const Surface& surface, Vec3d direction);
Vec3d refracted(const Surface& surface, Vec3d direction, double eta);

// Weight of the light that a ray drawn by a material finds at an emitter, beside direct_lighting's ray to it.
double emitter_weight(const Scene& scene, Vec3d from, double drawn_pdf, const SceneHit& hit);

} // namespace renderer
