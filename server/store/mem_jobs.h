// MemJobs: the jobs of a MemStore and the orders in which they are looked at.
//
// Threads  none of its own: the MemStore's mutex guards it.
// Cost     what is about more than one job looks at everything: it is a store for tests.
#pragma once

#include "server/store/store.h"
#include "server/store/work_bell.h"

#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

namespace server {

JobRecord without_long_texts(JobRecord job); // but that of a failure

class MemJobs {
public:
    struct Job {
        std::uint64_t sequence = 0; // the order of submission
        JobRecord record;
    };
    struct IdempotencyKey {
        std::string body_digest;
        std::uint64_t sequence = 0;
        std::int64_t created_ms = 0;
    };

    // `bell` rings when a job begins to wait.
    explicit MemJobs(WorkBell& bell) : bell_(bell) {}

    Job& add(JobRecord record); // throws StoreError if its id is taken
    Job* find(const JobId& id);
    Job* find(const Tenant& tenant, const JobId& id);
    Job* find_leased(const Lease& lease); // nothing: fenced
    const Job* find_reusable(const Tenant& tenant, const std::string& render_key) const;
    Job* next_waiting();
    std::uint32_t position(const Job& waiting) const;
    std::size_t waiting() const { return waiting_.size(); }
    QueueDepth depth() const;
    ListPage list(const ListQuery& query) const;
    std::vector<std::string> assets_in_use() const;
    std::vector<std::string> pictures() const;
    std::uint64_t newest() const { return last_sequence_; }
    std::uint64_t bytes() const;

    void enter(Job& job, StoredState state);
    void finish(Job& job, StoredState state, std::int64_t now_ms);
    void forget(std::uint64_t sequence);
    std::size_t expire(std::int64_t before_ms); // and forgets; how many
    bool expire_picture(const std::string& image_digest, std::uint64_t newest);
    std::size_t forget_ended(std::size_t most);
    void forget_keys(std::int64_t before_ms);

    std::map<std::uint64_t, Job> by_sequence;
    std::map<std::pair<Tenant, std::string>, IdempotencyKey> keys;

private:
    // The order of claims: highest priority first, then oldest.
    using WaitingKey = std::pair<int, std::uint64_t>; // minus priority, sequence

    WorkBell& bell_;
    std::uint64_t last_sequence_ = 0;
    std::unordered_map<JobId, std::uint64_t> sequence_of_;
    std::set<WaitingKey> waiting_;
};

} // namespace server
