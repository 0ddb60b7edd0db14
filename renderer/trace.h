// trace: one work unit of a render: a slice of samples of a tile, as sums. A pure function.
//
// Threads  any number at once; units of one tile may be traced in any order and merged in theirs.
// Cost     proportional to pixels times samples; stops within 16 samples and one light when asked to.
#pragma once

#include "renderer/film/film.h"
#include "renderer/integrators/direct.h"
#include "renderer/pass_schedule.h"
#include "renderer/plan/plan.h"
#include "renderer/scene/scene.h"

#include <cstdint>
#include <optional>
#include <stop_token>

namespace renderer {

struct WorkUnit {
    PixelRect tile;    // of the full picture
    SampleRange slice; // of one pass
};

struct TracedUnit {
    TileSums sums;
    RayTally tally;
};

// Nothing if `stop` was requested before the end.
std::optional<TracedUnit> trace(const Scene& scene,
                                const Plan& plan,
                                std::uint64_t seed,
                                const WorkUnit& unit,
                                const std::stop_token& stop);

} // namespace renderer
