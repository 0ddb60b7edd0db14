// What tests of stores share: a clock set by hand, requests in a few words, both stores by name.
#pragma once

#include "server/store/mem_store.h"
#include "server/store/sqlite_store.h"
#include "server/store/store.h"
#include "tests/support/temp_folder.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace tests {

inline constexpr std::chrono::milliseconds kTtl{30'000};
inline constexpr std::int64_t kDay_ms = 24LL * 3600 * 1000;

// Time stands still unless moved. Outlives the stores that hold its clock.
struct HandClock {
    std::atomic<std::int64_t> steady_ms{0};
    std::atomic<std::int64_t> wall_ms{1'000 * kDay_ms};

    server::StoreClock clock()
    {
        return {.steady =
                    [this] {
                        return std::chrono::steady_clock::time_point(std::chrono::milliseconds(steady_ms));
                    },
                .wall_ms = [this] { return wall_ms.load(); }};
    }
};

inline server::SubmitRequest a_request(const std::string& name, int priority = 50)
{
    server::SubmitRequest request;
    request.tenant = "alice";
    request.body_digest = "digest of " + name;
    request.spec = {.request_json = "{\"scene\":\"" + name + "\"}",
                    .render_key = "sha256:key-of-" + name,
                    .asset_digests = {"sha256:mesh-of-" + name, "sha256:shared"},
                    .priority = priority,
                    .labels = {{"name", name}, {"kind", "test"}}};
    request.now_ms = 1'000 * kDay_ms;
    return request;
}

inline server::JobResult a_result(const std::string& name)
{
    return {.image_digest = "sha256:picture-of-" + name,
            .report_json = "{\"report\":1}",
            .scene_json = "{\"executed\":1}",
            .samples = 64};
}

// One suite for every store: what holds for one holds for the other.
class StoreTest : public testing::TestWithParam<const char*> {
protected:
    void SetUp() override
    {
        if (std::string(GetParam()) == "MemStore")
            store = server::make_mem_store(time.clock());
        else
            store = server::open_sqlite_store(folder.path() / "jobs.sqlite", time.clock());
    }

    server::JobRecord submit(const std::string& name, int priority = 50)
    {
        const server::Submitted submitted = store->submit(a_request(name, priority));
        EXPECT_EQ(submitted.status, server::SubmitStatus::accepted);
        return submitted.job;
    }
    server::Lease claim_one()
    {
        const std::vector<server::Lease> leases = store->claim("worker", 1, kTtl);
        EXPECT_EQ(leases.size(), 1U);
        return leases.empty() ? server::Lease{} : leases.front();
    }
    server::JobRecord succeed(const std::string& name)
    {
        const server::JobRecord job = submit(name);
        EXPECT_TRUE(store->complete(claim_one(), a_result(name), now()));
        return job;
    }
    server::JobRecord get(const server::JobId& id) { return store->get("alice", id).value(); }
    std::int64_t now() const { return time.wall_ms; }

    TempFolder folder;
    HandClock time;
    std::unique_ptr<server::Store> store;
};

inline std::string store_name(const testing::TestParamInfo<const char*>& info)
{
    return info.param;
}

} // namespace tests
