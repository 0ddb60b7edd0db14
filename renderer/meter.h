// What a meter read: every pixel of its film is an independent replicate of the same measurement.
#pragma once

#include "renderer/description/report.h"
#include "renderer/film/film.h"

namespace renderer {

MeterReading read_meter(const Film& film, MeterQuantity quantity);

} // namespace renderer
