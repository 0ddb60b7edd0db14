// ImportCache: what imports came to, by content: prepared meshes and pictures, least recently used first out by
// bytes, and what is known of a file without them: its figures, or why it does not import.
//
// Key      the main file's digest, the extension that hinted at its format, and every name that the importer
//          asked for with the digest that answered (or that there was none): where all those agree, the
//          import would go the same way. The importer's version needs no place in it: the cache dies with the
//          process, and the flat form checks it.
// Threads  one at a time; ImportService holds the lock.
#pragma once

#include "api/job_view.h"
#include "renderer/accel/prepared_mesh.h"
#include "renderer/plan/plan.h"
#include "renderer/textures/image.h"
#include "server/import/import_failure.h"

#include <array>
#include <cstdint>
#include <list>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace server {

using NamedDigests =
    std::map<std::string, std::string>; // name -> digest; an answer "" means there is no such file

struct KnownImport {
    std::string main;     // digest and extension
    NamedDigests answers; // to what the importer asked
    std::optional<ImportFailure> failure;
    std::optional<api::AssetInfo::MeshInfo> figures;  // engaged of a mesh
    std::shared_ptr<const renderer::MeshFacts> facts; // once a mesh was prepared
    std::array<std::shared_ptr<const renderer::PreparedMesh>, renderer::kMeshTrees>
        prepared; // by tree; null where not (any more) in memory
    // With any of them; null where there is none.
    std::shared_ptr<const renderer::PreparedMesh> with_any_tree() const
    {
        for (const auto& mesh : prepared)
            if (mesh) return mesh;
        return nullptr;
    }
    std::optional<api::AssetInfo::ImageInfo> picture_figures{}; // engaged of a picture, instead of `figures`
    std::shared_ptr<const renderer::Image> picture{};           // null where not (any more) in memory
};

class ImportCache {
public:
    explicit ImportCache(std::uint64_t most_bytes) : most_bytes_(most_bytes) {}

    // What is known for these files, now the most recently used; nullptr if nothing is. Valid until the next
    // store().
    KnownImport* find(const std::string& main, const NamedDigests& files);
    const KnownImport* peek(const std::string& main, const NamedDigests& files) const;
    // Replaces what was known for the same main file and answers; keeps the prepared meshes of that.
    void store(KnownImport known);
    std::uint64_t bytes() const { return bytes_; }

private:
    using Entries = std::list<KnownImport>; // most recently used first
    Entries::const_iterator position(const std::string& main, const NamedDigests& files) const;
    void forget(Entries::iterator entry);
    void make_room();

    std::uint64_t most_bytes_, bytes_ = 0;
    Entries entries_;
    std::map<std::string, std::vector<Entries::iterator>> by_main_;
};

} // namespace server
