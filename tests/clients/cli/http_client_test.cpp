#include "clients/cli/http_client.h"
#include "clients/cli/user_error.h"
#include "tests/clients/cli/small_service.h"

#include <gtest/gtest.h>

#include <atomic>
#include <thread>

namespace {

using clients::HttpAnswer;
using clients::HttpClient;
using clients::UserError;
using tests::SmallService;

TEST(HttpClient, SendsWhatItIsGivenAndReadsTheAnswer)
{
    const SmallService service([](const httplib::Request& request, httplib::Response& response) {
        response.set_header("X-Saw",
                            request.method + ' ' + request.path + ' ' + request.get_header_value("X-Word"));
        response.set_content(request.body, "text/plain");
        response.status = 202;
    });
    HttpClient client(service.url("/farm"), 0, {});
    const HttpAnswer answer =
        client.send({.method = "POST", .path = "/v1/jobs", .headers = {{"X-Word", "hello"}}, .body = "body"});
    EXPECT_EQ(answer.status, 202);
    EXPECT_EQ(answer.body, "body");
    EXPECT_EQ(answer.header("x-saw"), "POST /farm/v1/jobs hello");
    EXPECT_EQ(answer.header("absent"), "");
}

TEST(HttpClient, AsksABusyServiceAgain)
{
    std::atomic<int> asked = 0;
    const SmallService service([&asked](const httplib::Request&, httplib::Response& response) {
        response.status = ++asked < 3 ? 503 : 200;
    });
    HttpClient client(service.url(), 60, {});
    EXPECT_EQ(client.send({.path = "/"}).status, 200);
    EXPECT_EQ(asked, 3);
}

TEST(HttpClient, TriesUntilItsPatienceEndsHoweverLongRetryAfterIs)
{
    std::atomic<int> asked = 0;
    const SmallService service([&asked](const httplib::Request&, httplib::Response& response) {
        response.status = ++asked < 2 ? 429 : 200;
        response.set_header("Retry-After", "1000");
    });
    HttpClient client(service.url(), 0.3, {});
    EXPECT_EQ(client.send({.path = "/"}).status, 200) << "a place was free before it was announced";
}

TEST(HttpClient, GivesTheBusyAnswerWhenItsPatienceEnds)
{
    std::atomic<int> asked = 0;
    const SmallService service([&asked](const httplib::Request&, httplib::Response& response) {
        ++asked;
        response.status = 429;
        response.set_header("Retry-After", "1000");
    });
    const HttpAnswer answer = HttpClient(service.url(), 0.3, {}).send({.path = "/"});
    EXPECT_EQ(answer.status, 429);
    EXPECT_EQ(answer.retry_after_s(), 1000.0);
    EXPECT_EQ(asked, 2) << "at once, and when patience ended";
    EXPECT_EQ(HttpClient(service.url(), 0, {}).send({.path = "/"}).status, 429);
    EXPECT_EQ(asked, 3) << "without patience it asks once";
}

TEST(HttpClient, DoesNotRepeatOtherAnswers)
{
    std::atomic<int> asked = 0;
    const SmallService service([&asked](const httplib::Request&, httplib::Response& response) {
        ++asked;
        response.status = 500;
    });
    HttpClient client(service.url(), 60, {});
    EXPECT_EQ(client.send({.path = "/"}).status, 500);
    EXPECT_EQ(asked, 1);
}

TEST(HttpClient, DoesNotWaitForAServiceThatWasNeverThere)
{
    clients::ServiceUrl gone;
    {
        const SmallService service([](const httplib::Request&, httplib::Response&) {});
        gone = service.url();
    }
    HttpClient client(gone, 3600, {});
    try {
        client.send({.path = "/"});
        FAIL() << "there is no service";
    } catch (const UserError& error) {
        EXPECT_EQ(error.code(), clients::ExitCode::unreachable);
    }
}

TEST(HttpClient, StopsBetweenTriesAndDuringOne)
{
    std::stop_source stop;
    const SmallService service([&stop](const httplib::Request&, httplib::Response& response) {
        stop.request_stop();
        response.status = 503;
        response.set_header("Retry-After", "1000");
    });
    HttpClient client(service.url(), 3600, stop.get_token());
    try {
        client.send({.path = "/"});
        FAIL() << "was interrupted";
    } catch (const UserError& error) {
        EXPECT_EQ(error.code(), clients::ExitCode::interrupted);
    }
}

} // namespace
