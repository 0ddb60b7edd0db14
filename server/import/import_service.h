// ImportService: from an uploaded blob to a prepared mesh or a picture, once per content. Imports run in
// heliograph-import, a child process under rlimits, no_new_privs and a deadline, whose output is validated as
// hostile. Prepared meshes are kept in memory and on disk, pictures in
// memory, least recently used first out, by bytes.
//
// Key      digest and extension of the main file, digests of every file that it asked for (or that there was
//          none), tree. Failures that would come again are remembered too; time and memory
//          are not such.
// Bytes    every blob is verified against its digest before what came of it is told or kept: the importer
//          reads the file itself while this process verifies it.
// Threads  every function may be called from any thread; a mesh asked for twice at once is imported once.
// Errors   the client's doing (a broken mesh, one too large for the limits) is a value; StoreError and
//          std::system_error (no child can be started, or it cannot lock itself down) are the world's.
#pragma once

#include "api/job_view.h"
#include "renderer/accel/prepared_mesh.h"
#include "renderer/description/limits.h"
#include "renderer/parallel/thread_pool.h"
#include "renderer/plan/plan.h"
#include "renderer/textures/image.h"
#include "server/import/import_failure.h"
#include "server/import/import_request.h"
#include "server/log/log.h"
#include "server/store/blob_store.h"

#include <filesystem>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>
#include <variant>
#include <vector>

namespace server {

struct PreparedAsset {
    std::shared_ptr<const renderer::PreparedMesh> mesh; // null: stopped, without facts; or not to be built
    std::vector<std::string> notes;                     // from the importer
    std::shared_ptr<const renderer::MeshFacts> facts;
};

using ImportedPixels = std::shared_ptr<const renderer::Image>;

class ImportService {
public:
    // `program`: path of heliograph-import. `kept`: folder where prepared meshes are kept on disk (see
    // stored_meshes.h); none if it is empty.
    ImportService(std::filesystem::path program,
                  BlobStore& blobs,
                  const renderer::Limits& limits,
                  const Log& log,
                  const std::filesystem::path& kept = {});
    ~ImportService();
    ImportService(const ImportService&) = delete;
    ImportService& operator=(const ImportService&) = delete;

    // Cached or imported now.
    std::variant<PreparedAsset, ImportFailure>
    import(const ImportRequest& request, renderer::ThreadPool& pool, const std::stop_token& stop);
    // The same of a picture, which is decoded; null if `stop` was requested.
    std::variant<ImportedPixels, ImportFailure>
    picture(const std::string& name, const std::string& digest, const std::stop_token& stop);
    // A fault known from an earlier import of this very request; no work is done. For checks at POST.
    std::variant<std::monostate, ImportFailure> known_failure(const ImportRequest& request) const;
    // What GET /v1/assets/{digest}/info tells; imports (without building a BVH) if not yet known. Nothing if
    // `stop` was requested.
    std::optional<api::AssetInfo> info(const std::string& digest, const std::stop_token& stop);
    // The same if it is known; no work is done.
    std::optional<api::AssetInfo> known_info(const std::string& digest) const;

    std::uint64_t cached_bytes() const;
    std::uint64_t stored_bytes() const; // on disk
    void flush();                       // until what is to be kept on disk is there: for tests
    std::uint64_t imports_run() const;  // child processes started so far

private:
    struct State;
    std::unique_ptr<State> state_;
};

} // namespace server
