#include "api/documents.h"

#include "api/build_info.h"
#include "api/json/json.h"
#include "api/openapi_file.h"
#include "api/schema/job_schema.h"

namespace api {

namespace {

// What the processor offers, as far as it matters to rays.
std::string isa()
{
#if defined(__x86_64__)
    std::string name = "x86-64";
    if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) name += "+avx2+fma";
    if (__builtin_cpu_supports("avx512f")) name += "+avx512f";
    return name;
#elif defined(__aarch64__)
    return "aarch64";
#else
    return "unknown";
#endif
}

// The file refers to the job's schema beside it; the served document stands alone.
std::string openapi_with_schemas()
{
    Json document = Json::parse(openapi_file(), nullptr, false);
    document["info"]["version"] = build_info().version;
    document["components"]["schemas"]["JobRequest"] = job_schema();
    return text_of(document, true);
}

} // namespace

std::string_view openapi_json()
{
    static const std::string text = openapi_with_schemas();
    return text;
}

std::string write_job_schema()
{
    return text_of(job_schema(), true) + "\n";
}

std::string write_version()
{
    const BuildInfo& build = build_info();
    return text_of({{"version", build.version},
                    {"commit", build.commit},
                    {"compiler", build.compiler},
                    {"build_type", build.build_type},
                    {"isa", isa()}});
}

std::string write_discovery()
{
    return text_of({{"service", "heliograph"},
                    {"version", build_info().version},
                    {"links",
                     {{"self", "/"},
                      {"health", "/healthz"},
                      {"ready", "/readyz"},
                      {"version", "/v1/version"},
                      {"capabilities", "/v1/capabilities"},
                      {"openapi", "/v1/openapi.json"},
                      {"assets", "/v1/assets"},
                      {"asset", "/v1/assets/{digest}"},
                      {"asset_info", "/v1/assets/{digest}/info"},
                      {"jobs", "/v1/jobs"},
                      {"job", "/v1/jobs/{id}"},
                      {"cancel", "/v1/jobs/{id}/cancel"},
                      {"image", "/v1/jobs/{id}/image"},
                      {"layer", "/v1/jobs/{id}/layers/{name}"},
                      {"report", "/v1/jobs/{id}/report"},
                      {"scene", "/v1/jobs/{id}/scene"}}}});
}

std::string write_health(bool ready, const std::string& reason)
{
    Json json{{"status", ready ? "ok" : "unavailable"}};
    if (!reason.empty()) json["reason"] = reason;
    return text_of(json);
}

} // namespace api
