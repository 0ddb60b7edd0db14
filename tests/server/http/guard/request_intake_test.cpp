#include "server/http/guard/request_intake.h"

#include <gtest/gtest.h>

#include <string>
#include <string_view>
#include <vector>

namespace {

using server::kSmallBody;
using server::RequestIntake;
using Stage = RequestIntake::Stage;

std::string post(const std::string& fields)
{
    return "POST /a HTTP/1.1\r\nHost: a\r\n" + fields + "\r\n";
}

std::string read_all(RequestIntake& intake)
{
    std::string text;
    for (std::string_view bytes = intake.readable(); !bytes.empty(); bytes = intake.readable()) {
        text += bytes;
        intake.took(bytes.size());
    }
    return text;
}

// The stage that each byte leads to, where it is another than before.
std::vector<Stage> stages_of(const std::string& bytes)
{
    RequestIntake intake;
    std::vector<Stage> stages;
    for (const char& byte : bytes)
        if (const Stage stage = intake.append({&byte, 1}); stages.empty() || stages.back() != stage)
            stages.push_back(stage);
    return stages;
}

TEST(RequestIntake, IsReadyWithTheLastByteOfTheRequestAndNotBefore)
{
    using Stages = std::vector<Stage>;
    EXPECT_EQ(stages_of("GET / HTTP/1.1\r\nHost: a\r\n\r\n"), (Stages{Stage::head, Stage::ready}));
    EXPECT_EQ(stages_of("GET / HTTP/1.1\r\nHost: a\r\n\r"), (Stages{Stage::head}));
    const Stages with_body{Stage::head, Stage::body, Stage::ready};
    EXPECT_EQ(stages_of(post("Content-Length: 5\r\n") + "hello"), with_body);
    EXPECT_EQ(stages_of(post("Transfer-Encoding: chunked\r\n") + "5\r\nhello\r\n0\r\nT: x\r\n\r\n"),
              with_body);
    EXPECT_EQ(stages_of(post("Content-Length: 5\r\n") + "hell"), (Stages{Stage::head, Stage::body}));
    EXPECT_EQ(stages_of(post("Content-Length: 0\r\n")), (Stages{Stage::head, Stage::ready}));
}

TEST(RequestIntake, LetsALargeBodyGoOnOnceEnoughOfItHasCome)
{
    for (const bool chunked : {false, true}) {
        RequestIntake intake;
        intake.append(post(chunked ? "Transfer-Encoding: chunked\r\n" : "Content-Length: 1000000\r\n"));
        if (chunked) intake.append("F4240\r\n");
        EXPECT_EQ(intake.append(std::string(kSmallBody - 100, 'x')), Stage::body);
        EXPECT_EQ(intake.append(std::string(100, 'x')), Stage::large);
    }
    RequestIntake waits;
    EXPECT_EQ(waits.append(post("Content-Length: 1000000\r\nExpect: 100-continue\r\n")), Stage::large);
    RequestIntake has_come;
    EXPECT_EQ(has_come.append(post("Content-Length: 2\r\nExpect: 100-continue\r\n") + "hi"), Stage::ready);
}

TEST(RequestIntake, KeepsNobodyWaitingForChunksThatAreNone)
{
    RequestIntake intake;
    EXPECT_EQ(intake.append(post("Transfer-Encoding: chunked\r\n") + "-2\r\nabc"), Stage::ready);
    intake.begin_reading();
    EXPECT_EQ(read_all(intake), "POST /a HTTP/1.1\r\nHost: guard\r\nTransfer-Encoding: chunked\r\n\r\n");
    EXPECT_TRUE(intake.broken());
    EXPECT_FALSE(intake.body_complete());
}

TEST(RequestIntake, SaysWhyAHeadWillNotDo)
{
    RequestIntake large;
    large.append("GET / HTTP/1.1\r\nX: ");
    EXPECT_EQ(large.append(std::string(server::kMaxHeadBytes, 'x')), Stage::faulty);
    EXPECT_EQ(large.fault().status, 431);
    EXPECT_EQ(large.request_id().size(), 32u);
    RequestIntake method;
    EXPECT_EQ(method.append("BREW / HTTP/1.1\r\nHost: a\r\nX-Request-Id: mine\r\n\r\n"), Stage::faulty);
    EXPECT_EQ(method.fault().status, 405);
    EXPECT_EQ(method.request_id(), "mine");
    RequestIntake two;
    EXPECT_EQ(two.append(post("Content-Length: 1\r\nContent-Length: 1\r\n")), Stage::faulty);
    EXPECT_EQ(two.fault().status, 400);
}

TEST(RequestIntake, GivesTheBodyPieceByPieceAndKeepsWhatFollows)
{
    RequestIntake intake;
    const std::string next = "GET /next HTTP/1.1\r\nHost: a\r\n\r\n";
    intake.append(post("Content-Length: 100000\r\n") + std::string(kSmallBody, 'x'));
    intake.begin_reading();
    const std::string head = "POST /a HTTP/1.1\r\nHost: guard\r\nContent-Length: 100000\r\n\r\n";
    EXPECT_EQ(read_all(intake), head + std::string(kSmallBody, 'x'));
    EXPECT_FALSE(intake.body_complete());
    intake.append(std::string(100000 - kSmallBody, 'y') + next);
    EXPECT_EQ(read_all(intake), std::string(100000 - kSmallBody, 'y'));
    EXPECT_TRUE(intake.body_complete());
    intake.next_request();
    EXPECT_EQ(intake.stage(), Stage::ready);
    EXPECT_EQ(intake.head().target, "/next");
    intake.next_request();
    EXPECT_EQ(intake.stage(), Stage::nothing);
    EXPECT_EQ(intake.held_bytes(), 0u);
}

} // namespace
