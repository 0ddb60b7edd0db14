// The members of a job, said once: what each is called, which struct member it fills, its range and its
// meaning.
//
// Each fields(v, x) walks one struct. Three visitors take the walk: ReadFields fills it from JSON and
// collects faults, WriteFields writes it, SchemaFields writes its JSON Schema; so the three cannot disagree.
// Defaults are the member initialisers of the structs, nowhere else. `unbuilt` names members that scene.md
// knows and this build does not.
//
// A visitor has: number, integer, boolean, word, point, direction, color, textured_number,
// textured_color, coefficients, extents, object, group, kinds, list, table, unbuilt, needs, exclude, only_when, and the few
// below that stand for one place alone: aim, sun_angles, geometry, image_of, material_of, metal_of, placement,
// files, labels, fail_on, layers, preset.
#pragma once

#include "api/fields/atmosphere_fields.h"
#include "api/fields/camera_fields.h"
#include "api/fields/light_fields.h"
#include "api/fields/material_fields.h"
#include "api/fields/ranges.h"
#include "api/fields/sees.h"
#include "api/fields/texture_fields.h"
#include "api/job_request.h"
#include "api/words/word_table.h"
#include "renderer/description/scene_description.h"
#include "renderer/description/settings.h"

namespace api {

template <typename V, Sees<renderer::MeshShape> X>
void fields(V&, X&)
{
    // Its members need the scene around them: see geometry().
}

template <typename V, Sees<renderer::RectangleShape> X>
void fields(V& v, X& shape)
{
    v.extents("size", "width and height, metres; in the xy plane, facing +z", shape.width_m, shape.height_m);
}

template <typename V, Sees<renderer::DiskShape> X>
void fields(V& v, X& shape)
{
    v.number("radius", shape.radius_m, kSize, "metres; in the xy plane, facing +z");
}

template <typename V, Sees<renderer::BoxShape> X>
void fields(V& v, X& shape)
{
    v.extents("size",
              "metres along x, y, z; centred at the origin",
              shape.size_m.x,
              shape.size_m.y,
              shape.size_m.z);
}

template <typename V, Sees<renderer::SphereShape> X>
void fields(V& v, X& shape)
{
    v.number("radius", shape.radius_m, kSize, "metres; centred at the origin, exact");
}

template <typename V, Sees<renderer::ObjectDescription> X>
void fields(V& v, X& object)
{
    v.geometry(object.shape);
    v.material_of(object.material);
    v.placement(object.world_from_object);
    v.boolean("visible_to_camera", object.visible_to_camera, "false: seen only by its shadow");
    v.word("shading", object.shading, "auto: smooth where the mesh has normals, else flat");
}

template <typename V, Sees<renderer::NoEnvironment> X>
void fields(V&, X&)
{
}

template <typename V, Sees<renderer::ImageEnvironment> X>
void fields(V& v, X& environment)
{
    v.image_of(environment.image);
    v.number("rotation_deg", environment.rotation_deg, kTurn, "about +y, counter-clockwise seen from above");
    v.number("scale", environment.scale, kRadiometric, "of its numbers, to W/(m^2 sr)");
    v.needs({"image"});
}

template <typename V, Sees<renderer::ColorEnvironment> X>
void fields(V& v, X& environment)
{
    v.color("radiance", environment.radiance, kRadiometric, "W/(m^2 sr), the same from everywhere");
}

template <typename V, Sees<renderer::SceneDescription> X>
void fields(V& v, X& scene)
{
    v.object("camera", scene.camera, "left out: it frames the whole scene");
    v.kinds("environment", scene.environment, "left out: a neutral sky where nothing else shines");
    v.table("materials", scene.materials, "materials by name");
    v.list("objects", scene.objects, "objects", "what is seen");
    v.list("lights", scene.lights, nullptr, "left out: one sun where nothing else shines");
    v.object("transport", scene.transport, "how light travels");
}

template <typename V, Sees<renderer::PixelRect> X>
void fields(V& v, X& rect)
{
    v.integer("x", rect.x, kOffset, "pixels from the left");
    v.integer("y", rect.y, kOffset, "pixels from the top");
    v.integer("width", rect.width, kExtent, "pixels");
    v.integer("height", rect.height, kExtent, "pixels");
    v.needs({"width", "height"});
}

template <typename V, Sees<renderer::ImageSettings> X>
void fields(V& v, X& image)
{
    v.integer("width", image.width_px, kSide, "pixels");
    v.integer("height", image.height_px, kSide, "pixels");
    v.object("region", image.region, "crop: the same pixels as the whole picture has there");
    v.number("exposure_ev",
             image.exposure_ev,
             kExposure,
             "radiance is multiplied by 2^exposure_ev; left out: 0, under an atmosphere by its sun");
    v.word("tone", image.tone, "from radiance to display");
    v.layers(image.layers);
}

template <typename V, Sees<renderer::QualitySettings> X>
void fields(V& v, X& quality)
{
    v.integer("samples", quality.samples, kSamples, "exactly this many a pixel");
    v.number("time_s", quality.time_s, kSeconds, "the best picture in this time, in whole passes");
    v.integer("max_samples", quality.max_samples, kSamples, "ceiling for time_s");
    v.exclude("samples", "time_s", "for a ceiling beside time_s give max_samples");
    v.unbuilt({"error", "confidence"}, "available: samples, time_s, max_samples");
}

template <typename V, Sees<renderer::AccelerationSettings> X>
void fields(V& v, X& acceleration)
{
    v.group("bvh", "bounding volume hierarchies", [&](auto& bvh) {
        bvh.word("split", acceleration.split, "how nodes are divided; if not given, as pays, mesh by mesh");
        bvh.word("width", acceleration.width, "children of a node within a mesh: eight, or two");
        bvh.word("levels", acceleration.levels, "trees over the objects and within each mesh, or fewer");
    });
    v.integer("threads", acceleration.threads, kThreads, "0: every core");
    v.integer("tile", acceleration.tile_px, kTile, "side of a tile in pixels");
    v.boolean("bounds", acceleration.bounds, "where no tree is over the objects: each one's box first");
}

template <typename V, Sees<JobRequest> X>
void fields(V& v, X& job)
{
    v.files(job.files);
    v.object("scene", job.scene, "what is there");
    v.object("image", job.settings.image, "the picture");
    v.object("quality", job.settings.quality, "left out: the default number of samples");
    v.group("limits", "bounds of this job", [&](auto& limits) {
        limits.number("time_s", job.time_limit_s, kSeconds, "the job fails when it takes longer");
    });
    v.integer("seed", job.settings.seed, kSeed, "of every random number");
    v.integer("priority", job.priority, kPriority, "larger first");
    v.labels(job.labels);
    v.fail_on(job.fail_on);
    v.boolean("provenance", job.provenance, "false: the picture carries no note of its making");
    v.object("acceleration", job.settings.acceleration, "for measuring only; no member changes the picture");
    v.needs({"scene"});
}

} // namespace api
