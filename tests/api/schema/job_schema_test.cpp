#include "api/documents.h"
#include "tests/api/example_files.h"
#include "tests/support/json_schema.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <set>

namespace {

using nlohmann::json;

const std::filesystem::path kFile = test_api::source_folder() / "api/schema/job.schema.json";

std::vector<std::string> faults_by_schema(const json& job)
{
    test_support::JsonSchemas schemas;
    schemas.add("job.schema.json", json::parse(api::write_job_schema()));
    return schemas.check(job, "job.schema.json#");
}

// HELIOGRAPH_WRITE_SCHEMA=1 in the environment of this test writes the file anew.
TEST(JobSchema, InTheTreeIsWhatTheCodeWrites)
{
    if (std::getenv("HELIOGRAPH_WRITE_SCHEMA"))
        std::ofstream(kFile, std::ios::binary) << api::write_job_schema();
    EXPECT_EQ(test_api::text_of_file(kFile), api::write_job_schema())
        << "write it anew: HELIOGRAPH_WRITE_SCHEMA=1 api_tests --gtest_filter=JobSchema.*";
}

TEST(JobSchema, TakesEveryValidExample)
{
    for (const std::string& name : test_api::example_names("valid"))
        for (const std::string& fault : faults_by_schema(json::parse(test_api::example_text("valid", name))))
            ADD_FAILURE() << name << ": " << fault;
}

TEST(JobSchema, TakesWhatIsWrittenWithEveryDefault)
{
    for (const std::string& name : test_api::example_names("valid")) {
        const auto read = api::read_job(test_api::example_text("valid", name), test_api::example_context());
        ASSERT_TRUE(std::holds_alternative<api::JobRequest>(read)) << name;
        for (const std::string& fault :
             faults_by_schema(json::parse(api::write_job(std::get<api::JobRequest>(read)))))
            ADD_FAILURE() << name << ": " << fault;
    }
}

TEST(JobSchema, RefusesEveryInvalidExampleWhoseFaultASchemaCanTell)
{
    // What takes the service's limits and assets, other members, or arithmetic to tell.
    const std::set<std::string> beyond_codes{"missing_asset",
                                             "bad_digest",
                                             "conflict",
                                             "unknown_reference",
                                             "over_limit",
                                             "singular",
                                             "not_affine"};
    const std::set<std::string> beyond_files{"eye_at_target",
                                             "eye_at_default_target",
                                             "spot_inside_out",
                                             "region_outside",
                                             "region_wraps_around",
                                             "scale_beyond_reach",
                                             "atmosphere_below_ground",
                                             "layers_of_a_meter"};
    std::size_t refused = 0;
    for (const std::string& name : test_api::example_names("invalid")) {
        const json job = json::parse(test_api::example_text("invalid", name), nullptr, false);
        const json expected = json::parse(test_api::example_text("invalid", name + ".problems"));
        if (job.is_discarded() || expected["status"] != 422 || beyond_files.contains(name)) continue;
        bool can_tell = false;
        for (const json& fault : expected["errors"])
            can_tell = can_tell || !beyond_codes.contains(fault["code"].get<std::string>());
        if (!can_tell) continue;
        ++refused;
        EXPECT_FALSE(faults_by_schema(job).empty()) << name << " conforms to the schema";
    }
    EXPECT_GE(refused, 60u);
}

TEST(JobSchema, DoesNotKnowWhatIsNotBuilt)
{
    const std::string schema = api::write_job_schema();
    for (const char* word : {"confidence", "target_missed"})
        EXPECT_EQ(schema.find('"' + std::string(word) + '"'), std::string::npos) << word;
}

} // namespace
