// StoredMeshes: prepared meshes on disk, so that a restart neither imports nor builds again: a cache, which
// may lose anything at any time but never gives what is not right.
//
// Key      the main file's digest and the extension that hinted at its format, the tree, and the build: the
//          digests of both programs, since a tree is good for the build that made it alone. A file also says
//          which names the importer asked for and what answered (see ImportCache).
// On disk  <folder>/<digest>-<rest of the key>: a head, the flat form as the importer sent it, the tree's
//          arrays. Written whole to a temporary file, synced, renamed. The time of modification is the last
//          use; least recently used first out, by bytes. What another build left is removed at open.
// Proof    SHA-256 of the head and of every MiB behind it, held before any of it is used; what does not hold is
//          removed and told in the log. After that the file is mapped, not read: who writes to the folder
//          behind the service's back, or cuts a file short, may take the service down, so the folder is to be
//          the service's alone (the data folder's lock sees to one service).
// Threads  any. Files are written by a thread of its own, one at a time; when several wait, further ones are
//          not kept. The destructor gives up what is not yet written.
// Errors   none reach the caller: a full disk, a folder that cannot be written are told in the log.
#pragma once

#include "renderer/description/settings.h"
#include "renderer/parallel/thread_pool.h"
#include "server/import/import_cache.h"
#include "server/log/log.h"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>

namespace server {

class StoredMeshes {
public:
    // `build` stands for all that a file must agree with beside its content. `is_wanted` tells at open whether
    // the asset of a digest is still there.
    StoredMeshes(std::filesystem::path folder,
                 std::uint64_t most_bytes,
                 std::string build,
                 const std::function<bool(const std::string& digest)>& is_wanted,
                 const Log& log);
    ~StoredMeshes();
    StoredMeshes(const StoredMeshes&) = delete;
    StoredMeshes& operator=(const StoredMeshes&) = delete;

    // What was kept for these files, proven on the pool's threads; nothing if there is none that fits.
    std::optional<KnownImport> load(const std::string& main,
                                    const NamedDigests& files,
                                    renderer::MeshTree tree,
                                    renderer::ThreadPool& pool);
    // Keeps what is prepared with `tree`, some time soon; only the trees that jobs render with.
    void keep(const KnownImport& known, renderer::MeshTree tree);

    void flush(); // until what is to be kept is on disk: for tests
    std::uint64_t bytes() const;

private:
    struct State;
    std::unique_ptr<State> state_;
};

} // namespace server
