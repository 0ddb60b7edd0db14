// What tests of the job service share: a whole service without HTTP, real renderer and real importer, over
// either store.
#pragma once

#include "server/import/import_service.h"
#include "server/jobs/job_service.h"
#include "server/store/blob_store.h"
#include "server/store/mem_store.h"
#include "server/store/sqlite_store.h"
#include "tests/support/places.h"
#include "tests/support/temp_folder.h"
#include "tests/support/thinning.h"

#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <thread>
#include <variant>

namespace tests {

// For what must happen; never reached when all is well.
inline constexpr std::chrono::seconds kPatience{60 * kSlowness};

// One process's worth of service. What is on disk outlives it.
class Node {
public:
    // `wrap` may put a faulty store around the real one.
    using Wrap = std::function<std::unique_ptr<server::Store>(std::unique_ptr<server::Store>)>;

    Node(std::unique_ptr<server::Store> opened,
         const std::filesystem::path& folder,
         const renderer::Limits& limits)
        : store(std::move(opened)), blobs(folder / "blobs"),
          imports(
              tests::bin_dir() + "/heliograph-import", blobs, limits, server::Log(server::LogLevel::error)),
          jobs(*store,
               blobs,
               imports,
               {.limits = limits, .threads = 2, .log = server::Log(server::LogLevel::error)})
    {
    }

    std::unique_ptr<server::Store> store;
    server::BlobStore blobs;
    server::ImportService imports;
    server::JobService jobs;
};

class JobServiceTest : public testing::TestWithParam<const char*> {
protected:
    // Opens what is on disk; with MemStore, jobs begin anew.
    std::unique_ptr<Node> open(const renderer::Limits& limits = {}, const Node::Wrap& wrap = {})
    {
        std::unique_ptr<server::Store> store = std::string(GetParam()) == "MemStore"
                                                   ? server::make_mem_store()
                                                   : server::open_sqlite_store(folder.path() / "jobs.sqlite");
        if (wrap) store = wrap(std::move(store));
        return std::make_unique<Node>(std::move(store), folder.path(), limits);
    }

    TempFolder folder;
};

// Not a job's words: fails the test and throws.
template <typename T, typename V>
T expect(V answer)
{
    if (const auto* problem = std::get_if<api::ProblemDetails>(&answer)) {
        ADD_FAILURE() << api::write_problem(*problem);
        throw std::runtime_error("refused");
    }
    return std::get<T>(std::move(answer));
}

inline api::JobView
submit(Node& node, const std::string& body, bool no_cache = false, const std::string& key = {})
{
    return expect<server::SubmitAnswer>(
               node.jobs.submit(
                   {.body = body, .part_digests = {}, .idempotency_key = key, .no_cache = no_cache}))
        .job;
}

inline api::ProblemDetails refusal(Node& node, const server::SubmitWords& words)
{
    const auto answer = node.jobs.submit(words);
    const auto* problem = std::get_if<api::ProblemDetails>(&answer);
    EXPECT_NE(problem, nullptr) << words.body;
    return problem != nullptr ? *problem : api::ProblemDetails{};
}

inline api::JobView finished(Node& node, const server::JobId& id)
{
    const auto view = node.jobs.wait(id, kPatience);
    EXPECT_TRUE(view && api::is_final(view->state)) << id;
    return view.value_or(api::JobView{});
}

inline api::JobView succeeded(Node& node, const server::JobId& id)
{
    const api::JobView view = finished(node, id);
    EXPECT_EQ(view.state, api::JobState::succeeded) << (view.error ? api::write_problem(*view.error) : "");
    return view;
}

// Waits until the job is past the queue and its rays fly.
inline api::JobView running(Node& node, const server::JobId& id)
{
    const auto deadline = std::chrono::steady_clock::now() + kPatience;
    std::string etag = "none";
    for (;;) {
        const auto view = node.jobs.wait(id, kPatience, etag);
        if (!view || api::is_final(view->state) || std::chrono::steady_clock::now() > deadline) {
            ADD_FAILURE() << "job " << id << " never ran";
            return view.value_or(api::JobView{});
        }
        if (view->state == api::JobState::running) return *view;
        etag = server::etag_of(*view);
    }
}

inline server::EncodedPicture picture(Node& node, const server::JobId& id)
{
    return expect<server::EncodedPicture>(node.jobs.image(id));
}

inline std::string digest_of_picture(Node& node, const server::JobId& id)
{
    const server::EncodedPicture image = picture(node, id);
    EXPECT_EQ(server::digest_of(std::span<const std::byte>(*image.bytes)), image.digest);
    return image.digest;
}

// The name of the blob that keeps the job's picture, once the store knows it.
inline std::string blob_of(server::Store& store, const server::JobId& id)
{
    const auto deadline = std::chrono::steady_clock::now() + kPatience;
    for (;;) {
        const auto record = store.find({}, id);
        if (record && record->result) return record->result->image_digest;
        if (std::chrono::steady_clock::now() > deadline) {
            ADD_FAILURE() << "the result of job " << id << " was never stored";
            return {};
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
}

inline api::ProblemDetails image_refusal(Node& node, const server::JobId& id)
{
    const auto answer = node.jobs.image(id);
    const auto* problem = std::get_if<api::ProblemDetails>(&answer);
    EXPECT_NE(problem, nullptr);
    return problem != nullptr ? *problem : api::ProblemDetails{};
}

// False: it is not there.
inline bool removed(Node& node, const server::JobId& id)
{
    const auto problem = node.jobs.remove(id);
    EXPECT_TRUE(!problem || problem->status == 404) << api::write_problem(*problem);
    return !problem;
}

inline std::string upload(Node& node, const std::string& bytes)
{
    return node.blobs.put(server::BlobStore::Kind::asset,
                          std::as_bytes(std::span(bytes.data(), bytes.size())));
}

// A sphere, small and quick. `more`: further members of the job, each with a comma before it.
inline std::string quick_job(const std::string& more = {}, int samples = 4)
{
    return R"({"scene":{"objects":[{"shape":"sphere"}]},"image":{"width":32,"height":24},"quality":{"samples":)" +
           std::to_string(samples) + "}" + more + "}";
}

// Takes minutes unless it is stopped.
inline std::string endless_job(const std::string& more = {})
{
    return R"({"scene":{"objects":[{"shape":"sphere"}]},"image":{"width":1024,"height":768},"quality":{"samples":65536})" +
           more + "}";
}

inline std::string mesh_job(const std::string& digest, const std::string& name = "mesh.obj")
{
    return R"({"scene":{"objects":[{"mesh":")" + name + R"("}]},"files":{")" + name + R"(":")" + digest +
           R"("},"image":{"width":32,"height":24},"quality":{"samples":2}})";
}

inline const char* const kTetrahedron =
    "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";

} // namespace tests
