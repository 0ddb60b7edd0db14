#include "server/http/http_server.h"
#include "tests/server/http/live_service.h"
#include "tests/server/jobs/faulty_store.h"
#include "tests/support/places.h"

#include <gtest/gtest.h>

#include <chrono>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace {

using tests::code_of;
using tests::fetch;
using tests::json_of;
using tests::LiveService;
using tests::long_job;
using tests::quick_job;
using tests::RawConnection;

TEST(HttpServer, TellsStrangersWhereToGo)
{
    const LiveService service;
    const auto nowhere = service.get("/v2/jobs");
    EXPECT_EQ(code_of(nowhere), "not_found");
    EXPECT_NE(nowhere.body.find("GET /"), std::string::npos);
    const auto root = service.get("/");
    EXPECT_EQ(root.status, 200);
    EXPECT_NE(root.body.find("/v1/jobs"), std::string::npos);
    for (const char* path : {"/v1/jobs/", "//", "/v1//jobs", "/v1/jobs%0a", "/.."})
        EXPECT_EQ(service.get(path).status, 404) << path;
}

TEST(HttpServer, LinksToEveryResourceFromItsRoot)
{
    const LiveService service;
    std::set<std::string> linked, served;
    const nlohmann::json root = json_of(service.get("/")); // whose links are iterated over
    for (const auto& link : root.at("links"))
        linked.insert(link.get<std::string>());
    for (const std::string& route : service.http.routes())
        served.insert(route.substr(route.find(' ') + 1));
    EXPECT_EQ(linked, served);
}

TEST(HttpServer, NamesTheMethodsThatAPathKnows)
{
    const LiveService service;
    const auto wrong = fetch(service.http.port(), "DELETE", "/v1/jobs");
    EXPECT_EQ(code_of(wrong), "method_not_allowed");
    EXPECT_EQ(wrong.header("allow"), "GET, HEAD, OPTIONS, POST");
    const auto options = fetch(service.http.port(), "OPTIONS", "/v1/jobs");
    EXPECT_EQ(options.status, 204);
    EXPECT_EQ(options.header("allow"), "GET, HEAD, OPTIONS, POST");
    EXPECT_EQ(fetch(service.http.port(), "PATCH", "/v1/version", {}, "{}").status, 405);
    const auto head = fetch(service.http.port(), "HEAD", "/v1/version");
    EXPECT_EQ(head.status, 200);
    EXPECT_EQ(head.header("content-length"), std::to_string(service.get("/v1/version").body.size()));
}

TEST(HttpServer, PutsARequestIdOnEveryAnswer)
{
    const LiveService service;
    for (const char* path : {"/", "/healthz", "/nowhere", "/v1/jobs?nonsense=1"}) {
        EXPECT_EQ(service.get(path, {{"X-Request-Id", "my-id_7"}}).header("x-request-id"), "my-id_7") << path;
        const auto made = service.get(path, {{"X-Request-Id", "<script>"}});
        EXPECT_EQ(made.header("x-request-id").size(), 32u) << path;
        EXPECT_EQ(made.headers.count("x-request-id"), 1u) << path;
        EXPECT_EQ(made.header("x-content-type-options"), "nosniff") << path;
    }
    EXPECT_NE(service.get("/nowhere", {{"X-Request-Id", "my-id_7"}}).body.find("\"request_id\":\"my-id_7\""),
              std::string::npos);
}

TEST(HttpServer, RefusesJsonThatIsTooDeepTooLongOrNone)
{
    const LiveService service;
    const auto status = [&](const std::string& body) { return service.submit(body).status; };
    EXPECT_EQ(status(std::string(100000, '[') + std::string(100000, ']')), 400);
    std::string deep;
    for (int i = 0; i < 100000; ++i)
        deep += "{\"a\":";
    EXPECT_EQ(status(deep), 400);
    EXPECT_EQ(status("{\"seed\":1e400}"), 400);
    EXPECT_EQ(status("{\"seed\":NaN}"), 400);
    EXPECT_EQ(status("{\"seed\":1,\"seed\":2}"), 400);
    EXPECT_EQ(status("{"), 400);
    EXPECT_EQ(status("\xff\xfe"), 400);
    EXPECT_EQ(status("[]"), 422);
    EXPECT_EQ(status(R"({"scene":{"objects":[{"shape":"sphere"}]},"image":{"width":30000,"height":30000}})"),
              422);

    const auto large = service.submit(std::string((1u << 20) + 1, ' '));
    EXPECT_EQ(code_of(large), "over_limit");
    for (const char* word : {"json_bytes", "1048576", "--limit-json-bytes"})
        EXPECT_NE(large.body.find(word), std::string::npos) << large.body;
    EXPECT_TRUE(service.alive());
}

TEST(HttpServer, CountsChunkedJsonAgainstItsLimit)
{
    const LiveService service;
    RawConnection connection(service.http.port());
    connection.send("POST /v1/jobs HTTP/1.1\r\nHost: a\r\nTransfer-Encoding: chunked\r\nContent-Type: "
                    "application/json\r\n\r\n");
    for (int i = 0; i < 300 && connection.send("10000\r\n" + std::string(65536, ' ') + "\r\n"); ++i) {
    }
    const auto answer = connection.read();
    ASSERT_TRUE(answer);
    EXPECT_EQ(code_of(*answer), "over_limit");
    EXPECT_TRUE(service.alive());
}

TEST(HttpServer, GoesOnAfterEveryKindOfNonsense)
{
    const LiveService service;
    const std::vector<std::string> nonsense{
        "\r\n\r\n\r\n",
        "GET\r\n\r\n",
        std::string("GET / HTTP/1.1\r\nHost: a\r\nX: \0\r\n\r\n", 33),
        "GET /" + std::string(8000, 'a') + " HTTP/1.1\r\nHost: a\r\n\r\n",
        "POST /v1/jobs HTTP/1.1\r\nHost: a\r\nContent-Length: 5\r\nTransfer-Encoding: "
        "chunked\r\n\r\n0\r\n\r\n",
        "POST /v1/jobs HTTP/1.1\r\nHost: a\r\nContent-Encoding: gzip\r\nContent-Length: 3\r\n\r\nabc",
        "POST /v1/jobs HTTP/1.1\r\nHost: a\r\nTransfer-Encoding: chunked\r\n\r\n-2\r\nabc",
        "POST /v1/jobs HTTP/1.1\r\nHost: a\r\nContent-Type: multipart/form-data; "
        "boundary=b\r\nContent-Length: 9\r\n\r\n--b\r\n\r\n\r\nx",
        "PUT /v1/assets/sha256:00 HTTP/1.1\r\nHost: a\r\nContent-Length: 18446744073709551615\r\n\r\n",
        "OPTIONS * HTTP/1.1\r\nHost: a\r\n\r\n",
        "PRI * HTTP/2.0\r\n\r\nSM\r\n\r\n",
        "CONNECT a:443 HTTP/1.1\r\nHost: a\r\n\r\n",
        "TRACE / HTTP/1.1\r\nHost: a\r\n\r\n",
    };
    for (const std::string& bytes : nonsense) {
        RawConnection connection(service.http.port());
        connection.send(bytes);
        const auto answer = bytes == nonsense[0] ? std::nullopt : connection.read();
        if (answer) {
            EXPECT_GE(answer->status, 400) << bytes.substr(0, 60);
            EXPECT_TRUE(answer->status < 500 || answer->status == 505) << answer->status;
        }
        ASSERT_TRUE(service.alive()) << bytes.substr(0, 60);
    }
}

TEST(HttpServer, ServesUnderTheLargestLimitsThereMayBe)
{
    renderer::Limits limits;
    for (const renderer::LimitEntry& limit : renderer::limit_table())
        limits.*limit.value = limit.most;
    const LiveService service(limits);
    EXPECT_TRUE(service.alive());
    const std::size_t depth = limits.json_depth - 1;
    const std::string deep = std::string(depth, '[') + std::string(depth, ']');
    EXPECT_EQ(service.submit("{\"scene\":" + deep + "}").status, 422);
    EXPECT_EQ(service.submit("{\"scene\":[" + deep + "]}").status, 400);
    EXPECT_EQ(service.submit(quick_job(), {{"Prefer", "wait=60"}}).status, 200);
}

TEST(HttpServer, RefusesMoreWaitersThanItHasPlacesFor)
{
    renderer::Limits limits;
    limits.waiters = 0;
    const LiveService service(limits);
    const auto refused = service.submit(quick_job(), {{"Prefer", "wait=5"}});
    EXPECT_EQ(refused.status, 429);
    EXPECT_EQ(code_of(refused), "too_many_waiters");
    EXPECT_NE(refused.header("retry-after"), "");
    EXPECT_EQ(json_of(service.get("/v1/jobs")).at("jobs").size(), 0u); // refused, so not accepted either
    const auto job = service.submit(quick_job());
    EXPECT_EQ(job.status, 202);
    EXPECT_EQ(service.get(job.header("location"), {{"Prefer", "wait=5"}}).status, 429);
}

TEST(HttpServer, GivesTheWaitingPlaceBackWhenTheClientHangsUp)
{
    renderer::Limits limits;
    limits.waiters = 1;
    const LiveService service(limits);
    const std::string path = service.submit(long_job()).header("location");
    for (int i = 0; i < 3; ++i) {
        RawConnection waits(service.http.port());
        waits.send("GET " + path + "/image HTTP/1.1\r\nHost: a\r\nPrefer: wait=60\r\n\r\n");
    }
    // Were the places kept for their 60 s, this would not come to an end within the test's patience.
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(30);
    int status = 429;
    while (status == 429 && std::chrono::steady_clock::now() < deadline)
        status = service.get(path + "/image", {{"Prefer", "wait=1"}}).status;
    EXPECT_EQ(status, 504);
}

TEST(HttpServer, SaysWhenToComeBackWhileTheQueueIsFull)
{
    renderer::Limits limits;
    limits.queue_jobs = 1;
    const LiveService service(limits);
    test_support::HttpAnswer answer;
    for (int i = 0; i < 3 && answer.status != 429; ++i)
        answer = service.submit(long_job(i)); // one runs, one waits
    EXPECT_EQ(answer.status, 429);
    EXPECT_EQ(code_of(answer), "queue_full");
    EXPECT_GE(std::stoi(answer.header("retry-after")), 1);
}

TEST(HttpServer, TellsOnBothListenersWhetherItIsReady)
{
    LiveService service;
    const std::set<int> ports{service.http.port(), service.http.health_port()};
    ASSERT_EQ(ports.size(), 2u);
    for (const int port : ports) {
        EXPECT_EQ(fetch(port, "GET", "/healthz").status, 200);
        EXPECT_EQ(fetch(port, "GET", "/readyz").status, 200);
    }
    EXPECT_EQ(fetch(service.http.health_port(), "GET", "/v1/jobs").status, 404);
    service.jobs.stop();
    for (const int port : ports) {
        EXPECT_EQ(fetch(port, "GET", "/healthz").status, 200);
        const auto ready = fetch(port, "GET", "/readyz");
        EXPECT_EQ(ready.status, 503);
        EXPECT_NE(ready.body.find("draining"), std::string::npos);
    }
    const auto refused = service.submit(quick_job());
    EXPECT_EQ(refused.status, 503);
    EXPECT_EQ(code_of(refused), "draining");
    EXPECT_NE(refused.header("retry-after"), "");
}

TEST(HttpServer, IsNotReadyWhileTheDiskIsFull)
{
    tests::DiskFaults disk;
    const LiveService service({},
                              tests::bin_dir() + "/heliograph-import",
                              std::make_unique<tests::FaultyStore>(server::make_mem_store(), disk));
    const std::vector<int> ports{service.http.port(), service.http.health_port()};
    disk.full = true;
    EXPECT_EQ(code_of(service.submit(quick_job())), "storage_full");
    for (const int port : ports) {
        const auto ready = fetch(port, "GET", "/readyz");
        EXPECT_EQ(ready.status, 503);
        EXPECT_NE(ready.body.find("storage_full"), std::string::npos) << ready.body;
        EXPECT_EQ(fetch(port, "GET", "/healthz").status, 200) << "a restart would not help";
    }
    disk.full = false;
    for (const int port : ports)
        EXPECT_EQ(fetch(port, "GET", "/readyz").status, 200);
}

TEST(HttpServer, ServesOnBothListenersWhileManyAreSlow)
{
    renderer::Limits limits;
    limits.waiters = 1;
    const LiveService service(limits);
    const std::vector<int> ports{service.http.port(), service.http.health_port()};
    std::vector<std::unique_ptr<RawConnection>> slow;
    for (int i = 0; i < 40; ++i) {
        for (const int port : ports) {
            slow.push_back(std::make_unique<RawConnection>(port));
            slow.back()->send("GET / HTTP/1.1\r\nX: ");
            slow.push_back(std::make_unique<RawConnection>(port));
            slow.back()->send("POST /v1/jobs HTTP/1.1\r\nHost: a\r\nContent-Length: 100000\r\n\r\n{");
            slow.push_back(std::make_unique<RawConnection>(port)); // and one that says nothing
        }
    }
    for (int i = 0; i < 20; ++i) {
        for (const int port : ports)
            EXPECT_EQ(fetch(port, "GET", "/healthz").status, 200);
        EXPECT_EQ(service.submit(quick_job(i)).status, 202);
    }
}

} // namespace
