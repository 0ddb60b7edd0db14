#include "api/json/parse_json.h"

#include <gtest/gtest.h>

#include <string>

namespace {

api::Problem refused(const std::string& text, const renderer::Limits& limits = {}, int status = 400)
{
    const auto parsed = api::parse_json(text, limits);
    const auto* problem = std::get_if<api::ProblemDetails>(&parsed);
    if (!problem) {
        ADD_FAILURE() << "parses: " << text.substr(0, 80);
        return {};
    }
    EXPECT_EQ(problem->status, status);
    EXPECT_EQ(problem->errors.size(), 1u);
    return problem->errors.empty() ? api::Problem{} : problem->errors[0];
}

bool parses(const std::string& text, const renderer::Limits& limits = {})
{
    return std::holds_alternative<api::Json>(api::parse_json(text, limits));
}

TEST(ParseJson, KeepsEveryKindOfValue)
{
    const auto parsed = api::parse_json(
        R"( {"a": [1, -2, 2.5, 18446744073709551615, true, false, null, "é\u00e9\ud83d\ude00"], "b": {"c": {}}, "d": []} )",
        {});
    ASSERT_TRUE(std::holds_alternative<api::Json>(parsed));
    const api::Json& json = std::get<api::Json>(parsed);
    EXPECT_EQ(json["a"][0].get<int>(), 1);
    EXPECT_EQ(json["a"][1].get<int>(), -2);
    EXPECT_EQ(json["a"][2].get<double>(), 2.5);
    EXPECT_EQ(json["a"][3].get<std::uint64_t>(), 18446744073709551615u);
    EXPECT_TRUE(json["a"][6].is_null());
    EXPECT_EQ(json["a"][7].get<std::string>(), "éé\xf0\x9f\x98\x80");
    EXPECT_TRUE(json["b"]["c"].is_object());
    EXPECT_TRUE(json["d"].is_array());
}

TEST(ParseJson, TakesAByteOrderMark)
{
    EXPECT_TRUE(parses("\xef\xbb\xbf{}"));
}

TEST(ParseJson, RefusesDeepNestingAtOnce)
{
    constexpr int kDeep = 100'000;
    std::string arrays, objects, mixed;
    for (int i = 0; i < kDeep; ++i) {
        arrays += '[';
        objects += R"({"a":)";
        mixed += R"([{"a":)";
    }
    for (const std::string& opening : {arrays, objects, mixed}) {
        const api::Problem fault = refused(opening);
        EXPECT_EQ(fault.code, "too_deep");
        EXPECT_NE(fault.detail.find("json_depth, 64"), std::string::npos) << fault.detail;
        EXPECT_NE(fault.detail.find("--limit-json-depth"), std::string::npos) << fault.detail;
    }
    EXPECT_EQ(refused(arrays + std::string(kDeep, ']')).code, "too_deep");
}

TEST(ParseJson, HoldsTheDepthToTheValue)
{
    EXPECT_TRUE(parses(std::string(64, '[') + std::string(64, ']')));
    EXPECT_FALSE(parses(std::string(65, '[') + std::string(65, ']')));
    renderer::Limits limits;
    limits.json_depth = 2;
    EXPECT_TRUE(parses("[[1]]", limits));
    EXPECT_FALSE(parses("[[[]]]", limits));
}

// A raised limit may let a value in that must not be copied or dumped, but letting it go must not recurse
// either.
TEST(ParseJson, LetsAVeryDeepValueGoWhereTheLimitIsRaised)
{
    renderer::Limits limits;
    limits.json_depth = 1'000'000;
    limits.json_values = 1'000'000;
    limits.json_bytes = 10'000'000;
    EXPECT_TRUE(parses(std::string(300'000, '[') + std::string(300'000, ']'), limits));
}

TEST(ParseJson, CountsValues)
{
    std::string many = "[0";
    for (int i = 1; i < 200'000; ++i)
        many += ",0";
    const api::Problem fault = refused(many + "]"); // 200,000 numbers and their array
    EXPECT_EQ(fault.code, "too_many_values");
    EXPECT_EQ(fault.pointer, "/199999");
    EXPECT_NE(fault.detail.find("--limit-json-values"), std::string::npos) << fault.detail;
    renderer::Limits limits;
    limits.json_values = 3;
    EXPECT_TRUE(parses("[1,2]", limits));
    EXPECT_FALSE(parses("[1,2,3]", limits));
}

TEST(ParseJson, RefusesABodyOverTheLimitUnread)
{
    const std::string body = "[" + std::string(1u << 20, ' ') + "]";
    const api::Problem fault = refused(body, {}, 413);
    EXPECT_EQ(fault.code, "over_limit");
    EXPECT_NE(fault.detail.find("json_bytes, 1048576 bytes"), std::string::npos) << fault.detail;
    EXPECT_NE(fault.detail.find("--limit-json-bytes"), std::string::npos) << fault.detail;
    EXPECT_TRUE(parses("[" + std::string((1u << 20) - 2, ' ') + "]"));
}

TEST(ParseJson, TellsLineAndColumn)
{
    EXPECT_EQ(refused("{\n  \"a\": 1,\n  \"b\": tru,\n}").detail.substr(0, 17), "line 3, column 11");
    EXPECT_EQ(refused("[1,]").detail.substr(0, 16), "line 1, column 4");
    EXPECT_EQ(refused("[1").detail.substr(0, 6), "line 1");
}

TEST(ParseJson, TellsWhatIsWrongInPlainWords)
{
    EXPECT_NE(refused("").detail.find("empty"), std::string::npos);
    EXPECT_NE(refused("[NaN]").detail.find("no NaN"), std::string::npos);
    EXPECT_NE(refused("{\"a\" 1}").detail.find("expected ':'"), std::string::npos)
        << refused("{\"a\" 1}").detail;
    const std::string detail = refused("{\"a\": \"" + std::string(500'000, 'x')).detail;
    EXPECT_LT(detail.size(), 500u) << "what was read is not quoted at length";
    for (const char* text : {"[1", "{'a':1}", "[1e400]", "\xff"})
        EXPECT_EQ(refused(text).detail.find("json.exception"), std::string::npos) << text;
}

TEST(ParseJson, RefusesNumbersThatAreNotFinite)
{
    for (const char* text : {"1e400", "-1e400", "[1e309]"}) {
        EXPECT_EQ(refused(text).code, "not_finite") << text;
    }
    EXPECT_EQ(refused(R"({"a": [0, {"b": 1e999}]})").pointer, "/a/1/b");
    EXPECT_TRUE(parses("[1.7976931348623157e308, 5e-324, 1e-400]"));
    const std::string digits(100'000, '9');
    EXPECT_EQ(refused("[" + digits + "]").code, "not_finite");
}

TEST(ParseJson, RefusesAMemberWrittenTwice)
{
    EXPECT_EQ(refused(R"({"a": 1, "a": 1})").pointer, "/a");
    EXPECT_EQ(refused(R"({"x": [{}, {"a/b": 1, "a\/b": 2}]})").pointer, "/x/1/a~1b")
        << "escapes spell the same name";
    EXPECT_EQ(refused(R"({"a": 1, "\u0061": 1})").code, "duplicate_member");
    EXPECT_TRUE(parses(R"([{"a": 1}, {"a": 1}])"));
}

TEST(ParseJson, RefusesWhatIsNotUtf8)
{
    for (const char* bytes : {"\xff", "\xc0\xaf", "\xed\xa0\x80", "\xf4\x90\x80\x80", "\xe2\x82", "caf\xe9"})
        EXPECT_EQ(refused(std::string("[\"") + bytes + "\"]").code, "not_utf8") << bytes;
    EXPECT_FALSE(parses(std::string("\xff\xfe{\0}\0", 6)));
    EXPECT_FALSE(parses(std::string("{\"a\": 1\0}", 9)));
}

TEST(ParseJson, SurvivesEveryCutOfADocument)
{
    const std::string whole =
        R"({"a": [1, -2.5e-3, true, null], "b": {"c": "é\u00e9\\\"", "d": [[], {}]}, "e": false})";
    for (std::size_t length = 0; length < whole.size(); ++length)
        EXPECT_FALSE(parses(whole.substr(0, length))) << length;
    EXPECT_TRUE(parses(whole));
}

TEST(ParseJson, SurvivesEveryByteChanged)
{
    const std::string whole = R"({"a": [1, -2.5e-3, true], "b": {"c": "\u00e9"}})";
    for (std::size_t at = 0; at < whole.size(); ++at)
        for (int byte = 0; byte < 256; ++byte) {
            std::string text = whole;
            text[at] = static_cast<char>(byte);
            const auto parsed = api::parse_json(text, {});
            if (const auto* problem = std::get_if<api::ProblemDetails>(&parsed)) {
                EXPECT_EQ(problem->status, 400);
            }
        }
}

} // namespace
