#include "server/http/multipart.h"
#include "tests/support/raw_http.h"

#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

namespace {

using server::MultipartReader;

struct Parts final : server::PartTaker {
    std::vector<std::pair<std::string, std::string>> parts;
    std::size_t ended = 0;
    bool begin_part(const std::string& name) override
    {
        parts.emplace_back(name, "");
        return true;
    }
    bool take(std::string_view bytes) override
    {
        parts.back().second += bytes;
        return true;
    }
    bool end_part() override
    {
        ++ended;
        return true;
    }
};

bool feed(MultipartReader& reader, std::string_view body, std::size_t step)
{
    for (; !body.empty(); body.remove_prefix(std::min(step, body.size())))
        if (!reader.feed(body.substr(0, step))) return false;
    return true;
}

TEST(MultipartReader, GivesTheSamePartsHoweverTheBytesAreCut)
{
    const std::vector<std::pair<std::string, std::string>> sent{
        {"scene", "{\"a\": 1}"},
        {"empty", ""},
        {"tricky", "\r\n--\r\n------------------------d74496d66958873\r\n"},
        {"last", "\r\n"}};
    const auto [type, body] = test_support::form(sent);
    for (std::size_t step = 1; step <= body.size(); ++step) {
        Parts parts;
        MultipartReader reader(server::multipart_boundary(type), parts);
        ASSERT_TRUE(feed(reader, body, step)) << reader.fault();
        ASSERT_EQ(parts.parts, sent) << step;
        EXPECT_EQ(parts.ended, sent.size());
        EXPECT_TRUE(reader.finished());
    }
}

TEST(MultipartReader, PassesOverPreambleAndEpilogue)
{
    Parts parts;
    MultipartReader reader("b", parts);
    ASSERT_TRUE(
        feed(reader, "hello\r\n--b \t\r\nContent-Disposition: form-data; name=x\r\n\r\n1\r\n--b--\r\nbye", 3))
        << reader.fault();
    EXPECT_TRUE(reader.finished());
    ASSERT_EQ(parts.parts.size(), 1u);
    EXPECT_EQ(parts.parts[0], (std::pair<std::string, std::string>("x", "1")));
}

TEST(MultipartReader, ReadsNamesAsBrowsersAndCurlWriteThem)
{
    const std::vector<std::pair<std::string, std::string>> written{
        {R"(name="a%22b.obj")", "a\"b.obj"},
        {R"(name="a\"b")", "a\"b"},
        {R"(filename="n; name=no"; name="yes")", "yes"},
        {R"(name="100%.obj")", "100%.obj"},
        {R"(NAME=plain; filename=x)", "plain"}};
    for (const auto& [parameters, name] : written) {
        Parts parts;
        MultipartReader reader("b", parts);
        ASSERT_TRUE(
            reader.feed("--b\r\ncontent-disposition: form-data; " + parameters + "\r\n\r\n1\r\n--b--"))
            << reader.fault();
        ASSERT_EQ(parts.parts.size(), 1u);
        EXPECT_EQ(parts.parts[0].first, name);
    }
}

TEST(MultipartReader, SaysWhatIsWrongWithAForm)
{
    const std::vector<std::string> wrong{"--b\r\n\r\nno name\r\n--b--",
                                         "--b\r\nContent-Disposition: form-data\r\n\r\n1\r\n--b--",
                                         "--b\r\nContent-Disposition: form-data; name=\"a\r\n\r\n1\r\n--b--",
                                         "--bx\r\n",
                                         "--b\r\nX: " + std::string(20000, 'a'),
                                         "--b" + std::string(20000, ' ')};
    for (const std::string& body : wrong) {
        Parts parts;
        MultipartReader reader("b", parts);
        EXPECT_FALSE(feed(reader, body, 4096)) << body.substr(0, 100);
        EXPECT_NE(reader.fault(), "");
        EXPECT_TRUE(parts.parts.empty());
    }
}

TEST(MultipartReader, IsNotFinishedWithoutTheClosingBoundary)
{
    Parts parts;
    MultipartReader reader("b", parts);
    EXPECT_TRUE(reader.feed("--b\r\nContent-Disposition: form-data; name=a\r\n\r\n123\r\n--b"));
    EXPECT_FALSE(reader.finished());
}

TEST(MultipartBoundary, IsReadQuotedOrNotAndRefusedWhereTheStandardDoes)
{
    EXPECT_EQ(server::multipart_boundary("multipart/form-data; boundary=abc"), "abc");
    EXPECT_EQ(server::multipart_boundary("multipart/form-data; charset=x; Boundary=\"a b:c\""), "a b:c");
    EXPECT_EQ(server::multipart_boundary("multipart/form-data"), "");
    EXPECT_EQ(server::multipart_boundary("multipart/form-data; boundary="), "");
    EXPECT_EQ(server::multipart_boundary("multipart/form-data; boundary=\"" + std::string(71, 'a') + "\""),
              "");
    EXPECT_EQ(server::multipart_boundary("multipart/form-data; boundary=\"a\x01\""), "");
}

} // namespace
