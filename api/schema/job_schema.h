// The JSON Schema (2020-12) of a job, from the same walk over its members that reads and writes one.
#pragma once

#include "api/json/json.h"

namespace api {

Json job_schema();

} // namespace api
