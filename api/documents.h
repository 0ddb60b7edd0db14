// The documents that a service answers about itself: all generated from the code or held against it by tests.
#pragma once

#include "renderer/description/limits.h"

#include <string>
#include <string_view>

namespace api {

std::string_view openapi_json(); // api/openapi.json, with the schemas of a job filled in
std::string write_job_schema();  // JSON Schema of POST /v1/jobs' body: api/schema/
std::string write_version();     // {version, commit, compiler, build_type, isa}
std::string
write_capabilities(const renderer::Limits& limits); // every limit (value, flag, env), model, format, default
std::string write_discovery();                      // GET /: links, those of many as templates
std::string write_health(bool ready, const std::string& reason); // /healthz, /readyz

} // namespace api
