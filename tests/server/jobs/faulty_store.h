// FaultyStore: a store whose disk fails when told to, for tests of what the service does then.
#pragma once

#include "server/store/store.h"

#include <atomic>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <utility>

namespace tests {

struct DiskFaults {
    std::atomic<bool> no_results{false}; // complete() throws
    std::atomic<bool> full{false};       // submit() throws storage_full
    std::atomic<int> lost_reads{0};      // that many get() throw
    std::atomic<int> refused_results{0}; // counts what no_results threw
};

class FaultyStore final : public server::Store {
public:
    FaultyStore(std::unique_ptr<server::Store> real, DiskFaults& faults)
        : real_(std::move(real)), faults_(faults)
    {
    }

    server::Submitted submit(const server::SubmitRequest& request) override
    {
        if (faults_.full) throw server::StoreError("disk full, says the test", true);
        return real_->submit(request);
    }
    std::optional<server::JobRecord> get(const server::Tenant& tenant, const server::JobId& id) override
    {
        lose_reads();
        return real_->get(tenant, id);
    }
    std::optional<server::JobRecord> find(const server::Tenant& tenant, const server::JobId& id) override
    {
        lose_reads();
        return real_->find(tenant, id);
    }
    server::ListPage list(const server::ListQuery& query) override { return real_->list(query); }
    server::QueueDepth depth() override { return real_->depth(); }
    bool storage_full() override { return faults_.full || real_->storage_full(); }
    std::optional<std::uint32_t> queue_position(const server::JobId& id) override
    {
        return real_->queue_position(id);
    }
    std::vector<server::Lease>
    claim(const std::string& worker, std::size_t max, std::chrono::milliseconds ttl) override
    {
        return real_->claim(worker, max, ttl);
    }
    std::size_t renew(const std::vector<server::Lease>& leases, std::chrono::milliseconds ttl) override
    {
        return real_->renew(leases, ttl);
    }
    bool complete(const server::Lease& lease,
                  const server::JobResult& result,
                  std::int64_t now_ms,
                  bool reused) override
    {
        if (faults_.no_results) {
            ++faults_.refused_results;
            faults_.refused_results.notify_all();
            throw server::StoreError("no row today, says the test", true);
        }
        return real_->complete(lease, result, now_ms, reused);
    }
    bool
    complete_queued(const server::JobId& id, const server::JobResult& result, std::int64_t now_ms) override
    {
        return real_->complete_queued(id, result, now_ms);
    }
    std::optional<server::JobResult> find_result(const server::Tenant& tenant,
                                                 const std::string& key) override
    {
        return real_->find_result(tenant, key);
    }
    std::optional<std::string> find_picture(const server::Tenant& tenant, const std::string& key) override
    {
        return real_->find_picture(tenant, key);
    }
    // A node that dies releases nothing.
    void release(const std::vector<server::Lease>& leases) override
    {
        if (!faults_.no_results) real_->release(leases);
    }
    bool
    fail(const server::Lease& lease, const server::JobFailure& why, bool retry, std::int64_t now_ms) override
    {
        return real_->fail(lease, why, retry, now_ms);
    }
    bool confirm_cancel(const server::Lease& lease, std::int64_t now_ms) override
    {
        return real_->confirm_cancel(lease, now_ms);
    }
    std::optional<server::JobRecord>
    cancel(const server::Tenant& tenant, const server::JobId& id, std::int64_t now_ms) override
    {
        return real_->cancel(tenant, id, now_ms);
    }
    bool render_again(const server::Tenant& tenant,
                      const server::JobId& id,
                      const std::string& image_digest) override
    {
        return real_->render_again(tenant, id, image_digest);
    }
    bool remove(const server::Tenant& tenant, const server::JobId& id) override
    {
        return real_->remove(tenant, id);
    }
    std::size_t sweep(std::int64_t before_ms) override { return real_->sweep(before_ms); }
    std::uint64_t newest() override { return real_->newest(); }
    std::vector<std::string> expire_results(const std::vector<std::string>& digests,
                                            std::uint64_t newest) override
    {
        return real_->expire_results(digests, newest);
    }
    std::size_t forget_ended(std::size_t most) override { return real_->forget_ended(most); }
    std::uint64_t stored_bytes() override { return real_->stored_bytes(); }
    std::vector<std::string> assets_in_use() override { return real_->assets_in_use(); }
    std::vector<std::string> pictures() override { return real_->pictures(); }
    bool shows(const std::string& image_digest) override { return real_->shows(image_digest); }
    void wait_work(std::chrono::milliseconds timeout, std::stop_token stop) override
    {
        real_->wait_work(timeout, std::move(stop));
    }

private:
    void lose_reads()
    {
        int left = faults_.lost_reads;
        while (left > 0 && !faults_.lost_reads.compare_exchange_weak(left, left - 1)) {
        }
        if (left > 0) throw server::StoreError("unreadable, says the test", false);
    }

    std::unique_ptr<server::Store> real_;
    DiskFaults& faults_;
};

} // namespace tests
