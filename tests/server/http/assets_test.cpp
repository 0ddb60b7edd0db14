#include "server/store/blob_reader.h"
#include "tests/server/http/live_service.h"
#include "tests/support/places.h"

#include <gtest/gtest.h>

#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <memory>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

namespace {

using tests::bytes_of;
using tests::code_of;
using tests::fetch;
using tests::HttpAnswer;
using tests::json_of;
using tests::LiveService;
using tests::RawConnection;

const std::string kBytes = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";

std::string path_of(const std::string& bytes)
{
    return "/v1/assets/" + server::digest_of(bytes);
}

HttpAnswer put(const LiveService& service, const std::string& path, const std::string& bytes)
{
    return fetch(service.http.port(), "PUT", path, {}, bytes);
}

TEST(Assets, PutIsIdempotent)
{
    const LiveService service;
    const auto first = put(service, path_of(kBytes), kBytes);
    EXPECT_EQ(first.status, 201);
    EXPECT_EQ(first.header("location"), path_of(kBytes));
    EXPECT_EQ(json_of(first).at("digest"), server::digest_of(kBytes));
    EXPECT_EQ(json_of(first).at("bytes"), kBytes.size());
    EXPECT_EQ(put(service, path_of(kBytes), kBytes).status, 200);
}

TEST(Assets, AreMendedByPuttingThemAgainWhenTheDiskDamagedThem)
{
    const LiveService service;
    put(service, path_of(kBytes), kBytes);
    {
        std::fstream file(service.blobs.path(server::BlobStore::Kind::asset, server::digest_of(kBytes)),
                          std::ios::in | std::ios::out | std::ios::binary);
        file.seekp(2);
        file.put('1'); // a bit of '0'
    }
    const auto damaged = service.get(path_of(kBytes));
    EXPECT_EQ(damaged.status, 500);
    EXPECT_EQ(code_of(damaged), "asset_damaged");
    EXPECT_NE(json_of(damaged).at("detail").get<std::string>().find("PUT " + path_of(kBytes)),
              std::string::npos);
    EXPECT_EQ(put(service, path_of(kBytes), kBytes).status, 201);
    EXPECT_EQ(service.get(path_of(kBytes)).body, kBytes);
    EXPECT_EQ(put(service, path_of(kBytes), kBytes).status, 200);
}

TEST(Assets, PutRefusesBytesOfAnotherDigest)
{
    const LiveService service;
    const auto wrong = put(service, path_of(kBytes), kBytes + "#");
    EXPECT_EQ(wrong.status, 422);
    EXPECT_EQ(code_of(wrong), "digest_mismatch");
    EXPECT_NE(wrong.body.find(server::digest_of(kBytes + "#")), std::string::npos);
    EXPECT_EQ(service.get(path_of(kBytes)).status, 404);
    for (const char* digest : {"sha256:abc",
                               "md5:00",
                               "SHA256:E3B0C44298FC1C149AFBF4C8996FB92427AE41E4649B934CA495991B7852B855",
                               "..%2f..%2fetc%2fpasswd"}) {
        const auto answer = put(service, std::string("/v1/assets/") + digest, kBytes);
        EXPECT_GE(answer.status, 404) << digest;
        EXPECT_LT(answer.status, 500) << digest;
    }
    EXPECT_TRUE(service.blobs.list(server::BlobStore::Kind::asset).empty());
}

TEST(Assets, PostNamesWhatItWasGiven)
{
    const LiveService service;
    const auto posted = service.post("/v1/assets", kBytes);
    EXPECT_EQ(posted.status, 201);
    EXPECT_EQ(posted.header("location"), path_of(kBytes));
    EXPECT_EQ(service.post("/v1/assets", kBytes).status, 200);
    EXPECT_EQ(code_of(service.post("/v1/assets", "")), "empty_body");
    const auto [type, body] = test_support::form({{"file", kBytes}});
    EXPECT_EQ(service.post("/v1/assets", body, {{"Content-Type", type}}).status, 415);
}

TEST(Assets, AreHadWholeInPartOrNotAtAll)
{
    const LiveService service;
    service.post("/v1/assets", kBytes);
    const std::string path = path_of(kBytes), etag = '"' + server::digest_of(kBytes) + '"';
    const auto whole = service.get(path);
    EXPECT_EQ(whole.status, 200);
    EXPECT_EQ(whole.body, kBytes);
    EXPECT_EQ(whole.header("etag"), etag);
    EXPECT_EQ(whole.header("accept-ranges"), "bytes");
    EXPECT_EQ(whole.header("content-type"), "application/octet-stream");
    EXPECT_EQ(whole.header("x-content-type-options"), "nosniff");
    EXPECT_EQ(whole.header("repr-digest").rfind("sha-256=:", 0), 0u);

    const auto part = service.get(path, {{"Range", "bytes=2-4"}});
    EXPECT_EQ(part.status, 206);
    EXPECT_EQ(part.body, kBytes.substr(2, 3));
    EXPECT_EQ(part.header("content-range"), "bytes 2-4/" + std::to_string(kBytes.size()));
    EXPECT_EQ(service.get(path, {{"Range", "bytes=2-4"}, {"If-Range", etag}}).status, 206);
    EXPECT_EQ(service.get(path, {{"Range", "bytes=2-4"}, {"If-Range", "\"other\""}}).body, kBytes);
    const auto beyond = service.get(path, {{"Range", "bytes=1000-"}});
    EXPECT_EQ(code_of(beyond), "range_not_satisfiable");
    EXPECT_EQ(beyond.header("content-range"), "bytes */" + std::to_string(kBytes.size()));
    std::string many = "bytes=0-";
    for (int i = 0; i < 500; ++i)
        many += ",0-";
    EXPECT_EQ(service.get(path, {{"Range", many}}).body, kBytes);

    const auto known = service.get(path, {{"If-None-Match", "\"x\", " + etag}});
    EXPECT_EQ(known.status, 304);
    EXPECT_EQ(known.body, "");
    const auto head = fetch(service.http.port(), "HEAD", path);
    EXPECT_EQ(head.status, 200);
    EXPECT_EQ(head.header("content-length"), std::to_string(kBytes.size()));
    EXPECT_EQ(head.header("etag"), etag);
    EXPECT_EQ(fetch(service.http.port(), "HEAD", path_of("else")).status, 404);
    EXPECT_EQ(code_of(service.get(path_of("else"))), "not_found");
}

void flip_a_byte(const std::filesystem::path& file, std::uint64_t offset)
{
    std::fstream stream(file, std::ios::in | std::ios::out | std::ios::binary);
    stream.seekg(static_cast<std::streamoff>(offset));
    const char was = static_cast<char>(stream.get());
    stream.seekp(static_cast<std::streamoff>(offset));
    stream.put(static_cast<char>(was ^ 1));
}

TEST(Assets, AreBrokenOffBeforeTheFirstByteThatIsDamaged)
{
    const LiveService service;
    const std::string big(3 * server::kBlobPiece, 'x'), path = path_of(big);
    put(service, path, big);
    EXPECT_TRUE(service.get(path).body == big);
    flip_a_byte(service.blobs.path(server::BlobStore::Kind::asset, server::digest_of(big)), big.size() - 1);

    RawConnection connection(service.http.port());
    connection.send("GET " + path + " HTTP/1.1\r\nHost: a\r\n\r\n");
    EXPECT_THROW(connection.read(), std::runtime_error); // told its length, and ended early
    EXPECT_TRUE(connection.wait_closed());
    EXPECT_EQ(code_of(service.get(path)), "asset_damaged"); // known now, before there is a head
    EXPECT_EQ(fetch(service.http.port(), "HEAD", path).status, 404);
    EXPECT_EQ(put(service, path, big).status, 201);
    EXPECT_TRUE(service.get(path).body == big);
}

TEST(Assets, AreRefusedInPartWhereThePartIsDamaged)
{
    const LiveService service;
    const std::string big(3 * server::kBlobPiece, 'x'), path = path_of(big);
    put(service, path, big);
    EXPECT_EQ(service.get(path, {{"Range", "bytes=1-5"}}).status, 206);
    flip_a_byte(service.blobs.path(server::BlobStore::Kind::asset, server::digest_of(big)),
                server::kBlobPiece + 9);
    EXPECT_EQ(service.get(path, {{"Range", "bytes=1-5"}}).body, "xxxxx");
    const std::string around =
        std::to_string(server::kBlobPiece + 5) + "-" + std::to_string(2 * server::kBlobPiece);
    EXPECT_EQ(code_of(service.get(path, {{"Range", "bytes=" + around}})), "asset_damaged");
}

std::uint64_t peak_memory_kib()
{
    std::ifstream status("/proc/self/status");
    for (std::string line; std::getline(status, line);)
        if (line.rfind("VmHWM:", 0) == 0) return std::stoull(line.substr(6));
    return 0;
}

TEST(Assets, AreSentWithoutBeingHeldInMemory)
{
#ifdef HELIOGRAPH_SANITIZED
    GTEST_SKIP() << "the sanitizer holds what was freed";
#endif
    LiveService service;
    constexpr std::size_t kMiB = 1 << 20, kSize = 96 * kMiB;
    const auto writer = service.blobs.write(server::BlobStore::Kind::asset);
    const std::vector<std::byte> chunk(kMiB, std::byte{'x'});
    for (std::size_t at = 0; at < kSize; at += kMiB)
        writer->append(chunk);
    const std::string path = "/v1/assets/" + writer->digest();
    writer->commit();
    std::ofstream("/proc/self/clear_refs") << "5"; // the peak begins anew
    const std::uint64_t before = peak_memory_kib();
    for (const std::string range : {"", "Range: bytes=1-\r\n"}) {
        RawConnection connection(service.http.port());
        connection.send("GET " + path + " HTTP/1.1\r\nHost: a\r\nConnection: close\r\n" + range + "\r\n");
        const auto head = connection.read_head();
        ASSERT_TRUE(head);
        EXPECT_EQ(head->header("content-length"), std::to_string(kSize - (range.empty() ? 0 : 1)));
        EXPECT_TRUE(connection.wait_closed());
    }
    EXPECT_LT(peak_memory_kib() - before, kSize / 1024 / 4);
}

TEST(Assets, OverTheLimitAreRefusedWithItsNameHoweverTheyCome)
{
    renderer::Limits limits;
    limits.asset_bytes = 1000;
    const LiveService service(limits);
    const std::string big(1001, 'x');
    const auto announced = service.post("/v1/assets", big);
    EXPECT_EQ(announced.status, 413);
    for (const char* word : {"asset_bytes", "1000", "--limit-asset-bytes"})
        EXPECT_NE(announced.body.find(word), std::string::npos);

    RawConnection chunked(service.http.port());
    chunked.send("POST /v1/assets HTTP/1.1\r\nHost: a\r\nTransfer-Encoding: chunked\r\n\r\n");
    for (int i = 0; i < 100 && chunked.send("10000\r\n" + std::string(65536, 'x') + "\r\n"); ++i) {
    }
    const auto refused = chunked.read();
    ASSERT_TRUE(refused);
    EXPECT_EQ(refused->status, 413);
    EXPECT_EQ(refused->header("connection"), "close");

    EXPECT_EQ(service.post("/v1/assets", big.substr(0, 1000)).status, 201);
    EXPECT_EQ(service.blobs.list(server::BlobStore::Kind::asset).size(), 1u);
}

TEST(Assets, RefusalComesBeforeTheBodyIsSent)
{
    renderer::Limits limits;
    limits.asset_bytes = 1000;
    const LiveService service(limits);
    RawConnection connection(service.http.port());
    connection.send("PUT " + path_of("x") +
                    " HTTP/1.1\r\nHost: a\r\nContent-Length: 314572800\r\nExpect: 100-continue\r\n\r\n");
    const auto answer = connection.read_head();
    ASSERT_TRUE(answer);
    EXPECT_EQ(answer->status, 413);
}

TEST(Assets, MakeRoomByForgettingTheLeastUsed)
{
    renderer::Limits limits;
    limits.total_asset_bytes = 250;
    const LiveService service(limits);
    const std::string a(100, 'a'), b(100, 'b'), c(100, 'c');
    EXPECT_EQ(service.post("/v1/assets", a).status, 201);
    EXPECT_EQ(service.post("/v1/assets", b).status, 201);
    EXPECT_EQ(service.get(path_of(a)).status, 200);
    EXPECT_EQ(service.post("/v1/assets", c).status, 201);
    EXPECT_EQ(service.get(path_of(a)).status, 200);
    EXPECT_EQ(service.get(path_of(b)).status, 404);
    const auto too_much = service.post("/v1/assets", std::string(251, 'd'));
    EXPECT_EQ(too_much.status, 503);
    EXPECT_EQ(code_of(too_much), "storage_full");
    EXPECT_NE(too_much.header("retry-after"), "");
}

TEST(Assets, NeedALength)
{
    const LiveService service;
    RawConnection connection(service.http.port());
    connection.send("POST /v1/assets HTTP/1.1\r\nHost: a\r\n\r\n");
    const auto answer = connection.read();
    ASSERT_TRUE(answer);
    EXPECT_EQ(code_of(*answer), "length_required");
}

TEST(Assets, InfoTellsWhatAMeshHoldsAndWhyAnotherDoesNotImport)
{
    const LiveService service;
    const std::string knot = bytes_of(tests::asset_dir() + "/knot.ply");
    service.post("/v1/assets", knot);
    const auto info = service.get(path_of(knot) + "/info");
    ASSERT_EQ(info.status, 200) << info.body;
    EXPECT_NE(info.body.find("6144"), std::string::npos) << info.body;

    const std::string broken = bytes_of(tests::asset_dir() + "/broken/truncated.ply");
    service.post("/v1/assets", broken);
    const auto fault = service.get(path_of(broken) + "/info");
    EXPECT_EQ(fault.status, 200);
    EXPECT_NE(fault.body.find("truncated"), std::string::npos) << fault.body;
    EXPECT_EQ(code_of(service.get(path_of("else") + "/info")), "not_found");
}

// An importer that never ends, for tests of who waits for it; its process's number stands in `started`.
class EndlessImports {
public:
    EndlessImports()
    {
        program = folder_.write("importer",
                                "#!/bin/sh\necho $$ > '" + started() + ".part'\n/bin/mv '" + started() +
                                    ".part' '" + started() + "'\nexec /bin/sleep 1000\n");
        std::filesystem::permissions(program, std::filesystem::perms::owner_all);
    }
    std::string started() const { return folder_.file("started"); }
    bool wait_for_start() const
    {
        return eventually([this] { return std::filesystem::exists(started()); });
    }
    bool wait_for_end() const // of the child
    {
        const auto pid = static_cast<pid_t>(std::stoi(tests::bytes_of(started())));
        return eventually([pid] { return kill(pid, 0) != 0; });
    }

    std::string program;

private:
    template <typename Predicate>
    static bool eventually(const Predicate& holds)
    {
        const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(15);
        while (!holds() && std::chrono::steady_clock::now() < end)
            std::this_thread::sleep_for(std::chrono::milliseconds(10));
        return holds();
    }

    tests::TempFolder folder_;
};

TEST(Assets, InfoEndsItsImportWhenTheClientHangsUp)
{
    const EndlessImports endless;
    const LiveService service({}, endless.program);
    const std::string mesh = "v 0 0 0";
    service.post("/v1/assets", mesh);
    RawConnection asks(service.http.port());
    asks.send("GET " + path_of(mesh) + "/info HTTP/1.1\r\nHost: a\r\n\r\n");
    ASSERT_TRUE(endless.wait_for_start());
    asks.hang_up();
    EXPECT_TRUE(endless.wait_for_end());
}

TEST(Assets, InfoEndsItsImportWhenTheServiceStops)
{
    const EndlessImports endless;
    LiveService service({}, endless.program);
    const std::string mesh = "v 0 0 0";
    service.post("/v1/assets", mesh);
    RawConnection asks(service.http.port());
    asks.send("GET " + path_of(mesh) + "/info HTTP/1.1\r\nHost: a\r\n\r\n");
    ASSERT_TRUE(endless.wait_for_start());
    service.http.stop();
    const auto answer = asks.read();
    ASSERT_TRUE(answer);
    EXPECT_EQ(answer->status, 503);
    EXPECT_EQ(code_of(*answer), "draining");
    EXPECT_NE(answer->header("retry-after"), "");
}

TEST(Assets, InfoTakesAPlaceAmongTheWaitingUnlessItIsKnown)
{
    renderer::Limits limits;
    limits.waiters = 1;
    const LiveService service(limits);
    const std::string known = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", unknown = known + "f 1 3 2\n";
    service.post("/v1/assets", known);
    service.post("/v1/assets", unknown);
    EXPECT_EQ(service.get(path_of(known) + "/info").status, 200);
    const std::string job = service.submit(tests::long_job()).header("location");
    // Until a connection waits in the only place: whoever asks may come before it, and then it is sent away.
    std::vector<std::unique_ptr<RawConnection>> waiting;
    do {
        waiting.push_back(std::make_unique<RawConnection>(service.http.port()));
        waiting.back()->send("GET " + job + "/image HTTP/1.1\r\nHost: a\r\nPrefer: wait=60\r\n\r\n");
        ASSERT_LT(waiting.size(), 60U);
    } while (service.get(job, {{"Prefer", "wait=1"}}).status == 200);
    const auto refused = service.get(path_of(unknown) + "/info");
    EXPECT_EQ(refused.status, 429);
    EXPECT_EQ(code_of(refused), "too_many_waiters");
    EXPECT_EQ(service.get(path_of(known) + "/info").status, 200);
}

} // namespace
