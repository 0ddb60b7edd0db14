// render: the front door. From a prepared scene to a film, deterministically, with what is to be told of it.
//
// Same scene, settings and build: the same bytes, whatever the threads, tiles and processor. A render that
// time stopped after N samples equals the one with `samples: N`.
#pragma once

#include "renderer/description/report.h"
#include "renderer/description/settings.h"
#include "renderer/film/film.h"
#include "renderer/parallel/thread_pool.h"
#include "renderer/plan/plan.h"
#include "renderer/scene/scene.h"

#include <cstdint>
#include <functional>
#include <optional>
#include <stop_token>

namespace renderer {

struct RenderProgress {
    double fraction = 0;       // of the whole render, monotone; by time where time is the goal
    std::uint32_t samples = 0; // complete in every pixel
    std::uint32_t pass = 0;    // passes complete
};

struct RenderResult {
    Film film;
    RenderReport report; // timing.prepare_s and notes are the caller's to fill
};

// Called from one of the pool's threads, one at a time, ten times a second at most, and once at the end.
using ProgressSink = std::function<void(const RenderProgress&)>;

// Runs passes until the settings are met. Nothing if `stop` was requested.
std::optional<RenderResult> render(const Scene& scene,
                                   const Plan& plan,
                                   const RenderSettings& settings,
                                   ThreadPool& pool,
                                   std::stop_token stop = {},
                                   const ProgressSink& progress = {});

} // namespace renderer
