#include "api/schema/job_schema.h"

#include "api/fields/job_fields.h"
#include "api/schema/schema_fields.h"

namespace api {

namespace {

// A scene needs something to see; files and digests look as they must.
Json seeing_something()
{
    const Json dark{{"properties", {{"environment", {{"properties", {{"type", {{"const", "none"}}}}}}}}}};
    return {{"anyOf",
             {{{"required", {"objects"}}, {"properties", {{"objects", {{"minItems", 1}}}}}},
              {{"required", {"environment"}}, {"not", dark}}}}};
}

} // namespace

Json job_schema()
{
    Json schema = SchemaFields::schema_of(JobRequest{});
    schema["$schema"] = "https://json-schema.org/draft/2020-12/schema";
    schema["title"] = "A job for heliograph: POST /v1/jobs";
    schema["description"] =
        "Generated from api/fields/job_fields.h. Metres, degrees where a name ends in _deg, linear "
        "Rec. 709 colours; right-handed, y up.";
    schema["properties"]["scene"]["allOf"] = Json::array({seeing_something()});
    return schema;
}

} // namespace api
