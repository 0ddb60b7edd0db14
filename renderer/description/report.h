// What a render says of itself: the plain structs behind report.models, .numerics, .timing and .accuracy.
#pragma once

#include "renderer/color/rgb.h"
#include "renderer/description/camera.h"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace renderer {

// One decision of the plan: a model that the scene needs, or one left out, and why.
struct ModelChoice {
    std::string name; // "direct", "phong", "watertight_triangles", "assumed_camera", ...
    std::string why;  // one sentence for the user
};

struct ModelReport {
    std::vector<ModelChoice> used;
    std::vector<ModelChoice> skipped;
};

struct NumericsReport {
    std::uint64_t non_finite_samples = 0;   // dropped and counted, never hidden
    std::uint64_t degenerate_triangles = 0; // zero area: never hit
    std::uint64_t clamped = 0;              // contributions that transport.clamp cut
    double cut_weight = 0;                  // of branches not followed: shares of a camera ray, mean of all
    double coordinate_ratio = 0;            // largest coordinate over scene diagonal
    std::string
        precision; // of the corners of meshes: "float", "double" or "mixed"; hits are decided in double
};

// What a render will take, from counts alone: rays and memory within a small factor, time only as an order of
// magnitude, since it is a nominal cost a ray.
struct Prediction {
    std::uint64_t camera_rays = 0;
    double rays = 0; // in all
    std::uint64_t memory_bytes = 0;
    double seconds = 0; // on `threads`
    std::uint32_t threads = 0;
};

// A plan in words and numbers, for whoever asks before rendering.
struct PlanReport {
    ModelReport models;
    Prediction prediction;
};

enum class StopReason : std::uint8_t { samples, time };

struct AccuracyReport {
    std::uint32_t samples = 0; // taken in every pixel: the job with `samples` set to this has the same bytes
    StopReason stop_reason = StopReason::samples;
};

// Seconds of wall time, and the plan's figures.
struct TimingReport {
    double prepare_s = 0;
    double render_s = 0;
    std::uint64_t camera_rays = 0;
    std::uint64_t shadow_rays = 0;
    std::uint64_t bounce_rays = 0; // of paths and branches beyond the camera's
};

// Of the two levels that rays go through, the one over the objects: see accel/instance_tree.h.
enum class UpperLevel : std::uint8_t {
    none,     // one object, or all joined in one, is asked directly; or every object in turn
    built,    // for this scene
    refitted, // around the objects of this scene, from that of an earlier one
};

struct GeometryReport {
    std::uint64_t triangles = 0; // unique, instances not counted
    std::uint64_t instances = 0;
    std::uint64_t bvh_bytes = 0;
    UpperLevel upper_level = UpperLevel::none;
};

// What a meter read: the mean of independent replicates, and its standard error from their spread.
struct MeterReading {
    MeterQuantity quantity = MeterQuantity::radiance;
    Rgb value{};          // W/(m^2 sr), or W/m^2
    Rgb standard_error{}; // of value
    std::uint32_t replicates = 0;
};

// How exact the tables of an atmosphere are.
struct SkyReport {
    double table_error = 0; // of the sky's radiance, against quadrature: rms over mean
};

struct RenderReport {
    ModelReport models;
    NumericsReport numerics;
    AccuracyReport accuracy;
    TimingReport timing;
    GeometryReport geometry;
    std::optional<MeterReading> meter;
    std::optional<SkyReport> sky;
    std::uint32_t threads = 0;
    std::vector<std::string> notes; // of the meshes' import, each with its mesh's name; the caller's to fill
};

} // namespace renderer
