#include "tests/api/example_files.h"

#include <gtest/gtest.h>

#include <set>
#include <utility>

namespace {

using nlohmann::json;
using test_api::example_context;
using test_api::example_names;
using test_api::example_text;

TEST(Examples, AreMany)
{
    EXPECT_GE(example_names("valid").size(), 12u);
    EXPECT_GE(example_names("invalid").size(), 50u);
}

TEST(Examples, ValidOnesReadWithoutFault)
{
    for (const std::string& name : example_names("valid")) {
        const auto read = api::read_job(example_text("valid", name), example_context());
        const auto* problem = std::get_if<api::ProblemDetails>(&read);
        EXPECT_EQ(problem, nullptr) << name << ":\n" << test_api::faults_as_text(*problem);
    }
}

TEST(Examples, ValidOnesAreWrittenAndReadBackTheSame)
{
    for (const std::string& name : example_names("valid")) {
        const auto read = api::read_job(example_text("valid", name), example_context());
        ASSERT_TRUE(std::holds_alternative<api::JobRequest>(read)) << name;
        const auto& job = std::get<api::JobRequest>(read);
        const auto again = api::read_job(api::write_job(job), {});
        ASSERT_TRUE(std::holds_alternative<api::JobRequest>(again)) << name;
        EXPECT_TRUE(std::get<api::JobRequest>(again) == job) << name << ":\n" << api::write_job(job);
    }
}

TEST(Examples, InvalidOnesYieldExactlyTheirFaults)
{
    for (const std::string& name : example_names("invalid")) {
        const json expected = json::parse(test_api::text_of_file(
            test_api::source_folder() / "api/examples/invalid" / (name + ".problems.json")));
        const auto read = api::read_job(example_text("invalid", name), example_context());
        const auto* problem = std::get_if<api::ProblemDetails>(&read);
        if (!problem) {
            ADD_FAILURE() << name << " reads without fault";
            continue;
        }
        json got{{"status", problem->status}, {"code", problem->code}, {"errors", json::array()}};
        for (const api::Problem& fault : problem->errors)
            got["errors"].push_back({{"pointer", fault.pointer}, {"code", fault.code}});
        EXPECT_EQ(got, expected) << name << ":\n" << test_api::faults_as_text(*problem);
    }
}

TEST(Examples, EveryFaultSaysSomething)
{
    for (const std::string& name : example_names("invalid")) {
        const auto read = api::read_job(example_text("invalid", name), example_context());
        if (const auto* problem = std::get_if<api::ProblemDetails>(&read)) {
            EXPECT_FALSE(problem->detail.empty()) << name;
            for (const api::Problem& fault : problem->errors) {
                EXPECT_GT(fault.detail.size(), 10u) << name << " " << fault.pointer;
                EXPECT_LT(fault.detail.size(), 1000u) << name << " " << fault.pointer;
            }
        }
    }
}

TEST(Examples, EveryKindOfFaultHasOne)
{
    std::set<std::string> codes;
    for (const std::string& name : example_names("invalid")) {
        const auto read = api::read_job(example_text("invalid", name), example_context());
        if (const auto* problem = std::get_if<api::ProblemDetails>(&read))
            for (const api::Problem& fault : problem->errors)
                codes.insert(fault.code);
    }
    for (const char* code :
         {"unknown_member",    "unknown_value",    "unsupported", "wrong_type",        "wrong_length",
          "out_of_range",      "not_integer",      "over_limit",  "bad_name",          "missing_member",
          "bad_digest",        "missing_asset",    "conflict",    "exclusive_members", "zero_length",
          "unknown_reference", "singular",         "not_affine",  "empty_scene",       "syntax",
          "not_finite",        "duplicate_member", "not_utf8",    "too_deep"})
        EXPECT_TRUE(codes.contains(code)) << code;
}

} // namespace
