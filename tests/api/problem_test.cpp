#include "api/problem.h"
#include "tests/support/places.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <set>
#include <string>

namespace {

using api::Problem;
using api::ProblemDetails;

TEST(ProblemDetails, AreWrittenAsRfc9457)
{
    ProblemDetails problem = api::problem_from_faults(
        422,
        "invalid_scene",
        {{"/a", "out_of_range", "0 is not in [1, 2]"}, {"/b", "wrong_type", "expected a number"}});
    problem.request_id = "r1";
    const auto json = nlohmann::json::parse(api::write_problem(problem));
    EXPECT_EQ(json["type"], "/problems/invalid_scene");
    EXPECT_EQ(json["title"], "Scene is not valid");
    EXPECT_EQ(json["status"], 422);
    EXPECT_EQ(json["code"], "invalid_scene");
    EXPECT_EQ(json["detail"], "2 faults; first: /a: 0 is not in [1, 2]");
    EXPECT_EQ(json["retryable"], false);
    EXPECT_EQ(json["request_id"], "r1");
    ASSERT_EQ(json["errors"].size(), 2u);
    EXPECT_EQ(json["errors"][1]["pointer"], "/b");
    EXPECT_EQ(json["errors"][1]["code"], "wrong_type");
}

TEST(ProblemDetails, ReadBackWhatWasWritten)
{
    for (const ProblemDetails& problem :
         {ProblemDetails{503, "draining", "later", true, "id", {}},
          ProblemDetails{
              422, "invalid_scene", "\"quoted\"\n", false, "", {{"/a~1b", "x", "é"}, {"", "y", "z"}}}}) {
        ProblemDetails read;
        ASSERT_TRUE(api::read_problem(api::write_problem(problem), read));
        EXPECT_EQ(read, problem);
    }
}

TEST(ProblemDetails, AreNotReadFromAnythingElse)
{
    ProblemDetails read;
    read.code = "untouched";
    for (const char* text : {"",
                             "{}",
                             "[]",
                             "nonsense",
                             R"({"status": "422", "code": "x"})",
                             R"({"status": 422})",
                             R"({"status": 9999999999, "code": "x"})",
                             R"({"status": 422, "code": "x", "errors": 3})",
                             R"({"status": 422, "code": "x", "errors": [3]})"})
        EXPECT_FALSE(api::read_problem(text, read)) << text;
    EXPECT_EQ(read.code, "untouched");
}

TEST(ProblemDetails, HaveATitleForEveryCode)
{
    const auto title_of = [](const char* code) {
        return nlohmann::json::parse(api::write_problem({500, code, "", false, "", {}}))["title"]
            .get<std::string>();
    };
    EXPECT_EQ(title_of("queue_full"), "Queue is full");
    EXPECT_EQ(title_of("import_crashed"), "Import crashed") << "codes outside the table read as words";
    EXPECT_EQ(title_of(""), "Error");
}

// "413, "over_limit"" in the sources is an answer with that code.
std::set<std::string> codes_in_the_sources()
{
    static const std::regex answer(R"re(\b[45]\d\d,\s*"([a-z_]+)")re");
    std::set<std::string> codes;
    for (const char* top : {"server", "api"})
        for (const auto& entry : std::filesystem::recursive_directory_iterator(
                 std::filesystem::path(tests::source_dir()) / top)) {
            if (entry.path().extension() != ".cpp") continue;
            std::ifstream file(entry.path());
            const std::string text{std::istreambuf_iterator<char>(file), {}};
            for (std::sregex_iterator found(text.begin(), text.end(), answer), end; found != end; ++found)
                codes.insert((*found)[1]);
        }
    return codes;
}

TEST(ProblemDetails, HaveEachTheirCodeInTheTableOfTitles)
{
    const std::set<std::string> codes = codes_in_the_sources();
    EXPECT_GT(codes.size(), 20U);
    for (const std::string& code : codes)
        EXPECT_TRUE(api::has_title(code)) << code << " is told, and api/problem.cpp has no title for it";
}

TEST(ProblemDetails, SurviveBytesThatAreNotUtf8)
{
    const std::string text =
        api::write_problem({422, "x", "caf\xe9", false, "\xff", {{"/\xff", "y", "\xc0"}}});
    EXPECT_TRUE(nlohmann::json::accept(text));
}

TEST(Problem, DoesNotCountTheLineThatCounts)
{
    const auto problem =
        api::problem_from_faults(422,
                                 "invalid_scene",
                                 {{"/a", "wrong_type", "expected a number"},
                                  {"", "more_faults", "4000 more faults are not listed here"}});
    EXPECT_EQ(problem.detail, "more than 1 faults; first: /a: expected a number");
}

} // namespace
