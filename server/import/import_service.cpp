#include "server/import/import_service.h"

#include "api/words/digest.h"
#include "renderer/description/mesh_formats.h"
#include "server/import/import_cache.h"
#include "server/import/import_files.h"
#include "server/import/mesh_figures.h"
#include "server/import/run_import.h"
#include "server/import/stored_meshes.h"

#include <atomic>
#include <condition_variable>
#include <future>
#include <mutex>
#include <new>
#include <set>
#include <utility>

namespace server {

namespace {

constexpr BlobStore::Kind kAsset = BlobStore::Kind::asset;

// An asset by itself, as /info looks at it.
ImportRequest bare_request(const std::string& digest)
{
    return {"", digest, {}, false};
}

ImportFailure out_of_memory()
{
    return {"import_out_of_memory",
            "there is not enough memory for this file now; try again, or simplify it"};
}

// What a cache holds is kept whole.
std::shared_ptr<const renderer::MeshFacts> facts_of_shared(const renderer::Mesh& mesh)
{
    renderer::MeshFacts facts = renderer::facts_of(mesh);
    facts.is_shared = true;
    return std::make_shared<const renderer::MeshFacts>(std::move(facts));
}

ImportFailure not_a_mesh(const api::AssetInfo::ImageInfo& picture)
{
    return {"not_a_mesh", "the file is a picture (" + picture.format + "), not a mesh"};
}

} // namespace

struct ImportService::State {
    State(std::filesystem::path program_path,
          BlobStore& store,
          const renderer::Limits& bounds,
          const Log& log_to,
          const std::filesystem::path& kept)
        : program(std::move(program_path)), blobs(store), files(store), limits(bounds), log(log_to),
          cache(bounds.mesh_cache_bytes)
    {
        if (kept.empty()) return;
        stored.emplace(
            kept,
            bounds.stored_mesh_bytes,
            digest_of_file("/proc/self/exe") + digest_of_file(program),
            [&store](const std::string& digest) { return store.has(kAsset, digest); },
            log);
    }

    // Holds the right to import one main file, and one of the places of a child.
    class Flight {
    public:
        Flight(State& state, std::string main) : state_(state), main_(std::move(main)) {}
        ~Flight()
        {
            const std::lock_guard lock(state_.mutex);
            state_.in_flight.erase(main_);
            state_.changed.notify_all();
        }
        Flight(const Flight&) = delete;
        Flight& operator=(const Flight&) = delete;

    private:
        State& state_;
        std::string main_;
    };

    using Imported =
        std::variant<std::monostate, ImportedAsset, ImportedPicture, ImportFailure>; // nothing: stopped

    // Until `answer` finds one in the cache (then it is returned, no flight) or this caller may import (then
    // nothing, and the flight is this caller's). `stopped` is set, and nothing returned, if `stop` was
    // requested.
    template <typename Answer>
    auto
    wait_for_turn(const ImportRequest& request, const Answer& answer, std::stop_token stop, bool& stopped)
    {
        const std::string main = main_key(request);
        std::unique_lock lock(mutex);
        while (true) {
            if (KnownImport* known = cache.find(main, request.files))
                if (auto found = answer(*known)) return found;
            stopped = stop.stop_requested();
            if (stopped || (!in_flight.contains(main) && in_flight.size() < most_children)) break;
            changed.wait(
                lock, stop, [&] { return !in_flight.contains(main) && in_flight.size() < most_children; });
        }
        if (!stopped) in_flight.insert(main);
        return decltype(answer(std::declval<KnownImport&>()))();
    }

    // A damaged file is the disk's fault, but the client's to mend.
    Imported
    import(const ImportRequest& request, NamedDigests& answers, bool& repeatable, std::stop_token stop)
    try {
        repeatable = false;
        const FileDescriptor file = files.open(request.digest);
        if (!file)
            return ImportFailure{"missing_asset",
                                 request.digest + " is not uploaded: PUT /v1/assets/" + request.digest};
        // The child starts reading at once; its answer counts only if the bytes are what the digest says.
        auto verified = std::async(std::launch::async, [&] { return files.are_sound(file, request.digest); });
        imports_run.fetch_add(1);
        ImportRunEnd end = run_import(
            {program,
             file.get(),
             extension_of(request.name),
             request.is_picture,
             [&](std::string_view name) { return files.open_companion(request.files, name, answers); },
             limits,
             files.bytes_of(request.digest, request.files)},
            std::move(stop));
        if (!verified.get())
            return ImportFailure{"missing_asset", request.digest + " was removed while it was imported"};
        if (!end.outcome) return std::monostate();
        repeatable = end.repeatable;
        if (auto* asset = std::get_if<ImportedAsset>(&*end.outcome)) return std::move(*asset);
        if (auto* picture = std::get_if<ImportedPicture>(&*end.outcome)) return std::move(*picture);
        auto& failure = std::get<ImportFailure>(*end.outcome);
        log.write(LogLevel::info,
                  "import_failed",
                  {{"digest", request.digest},
                   {"code", failure.code},
                   {"detail", failure.detail},
                   {"importer_log", end.log}});
        return std::move(failure);
    } catch (const DamagedBlob& damage) {
        log.write(LogLevel::error, "asset_damaged", {{"digest", damage.digest}, {"what", damage.what()}});
        repeatable = false;
        return ImportFailure{"asset_damaged", api::damaged_asset_words(damage.digest)};
    }

    // What a child made of it, and what is known from that.
    struct Run {
        Imported imported;
        KnownImport known;
        bool repeatable = false; // the same would come again
    };
    Run run(const ImportRequest& request, const std::stop_token& stop)
    {
        Run run{{}, {main_key(request), {}, {}, {}, {}, {}}};
        run.imported = import(request, run.known.answers, run.repeatable, stop);
        if (const auto* failure = std::get_if<ImportFailure>(&run.imported))
            run.known.failure = *failure;
        else if (const auto* picture = std::get_if<ImportedPicture>(&run.imported))
            run.known.picture_figures = picture_figures(*picture);
        else if (const auto* asset = std::get_if<ImportedAsset>(&run.imported))
            run.known.figures = mesh_figures(*asset);
        if (run.known.failure && run.repeatable) remember(run.known);
        return run;
    }

    // As it is in memory: with some tree, not always the one that is asked for.
    std::optional<KnownImport> in_memory(const ImportRequest& request)
    {
        const std::lock_guard lock(mutex);
        const KnownImport* known = cache.find(main_key(request), request.files);
        if (!known || !known->with_any_tree()) return std::nullopt;
        return *known;
    }

    // The same from the disk, and into the cache.
    std::optional<KnownImport> on_disk(const ImportRequest& request, renderer::ThreadPool& pool)
    {
        if (!stored) return std::nullopt;
        std::optional<KnownImport> found;
        const auto load = [&](renderer::MeshTree tree) {
            auto known = stored->load(main_key(request), request.files, tree, pool);
            if (!known) return;
            known->facts = facts_of_shared(mesh_of(*known->prepared[static_cast<std::size_t>(tree)]));
            found = *known;
            remember(std::move(*known));
        };
        // What it would ask for of a small mesh is the likeliest: how large this one is, is not known yet.
        const renderer::MeshTree likely = tree_for(request, 1);
        load(likely);
        using enum renderer::MeshTree;
        for (const renderer::MeshTree other : {wide_sah, wide_spatial, wide_midpoint}) {
            if (found) break;
            if (other != likely) load(other);
        }
        if (!found) return std::nullopt;
        const renderer::MeshTree asked = tree_for(request, found->facts->triangles);
        if (!found->prepared[static_cast<std::size_t>(asked)]) load(asked);
        return found;
    }

    // With the tree that is asked for, if it may be built; what is known is remembered.
    template <typename Build>
    PreparedAsset prepare(const ImportRequest& request, KnownImport known, const Build& build)
    {
        PreparedAsset prepared{nullptr, known.figures->notes, known.facts};
        const renderer::MeshTree tree = tree_for(request, known.facts->triangles);
        if (!request.may_build || request.may_build(*known.facts)) {
            prepared.mesh = build(tree);
            if (!prepared.mesh) prepared = {}; // stopped
        }
        known.prepared[static_cast<std::size_t>(tree)] = prepared.mesh;
        if (stored && prepared.mesh) stored->keep(known, tree);
        remember(std::move(known));
        return prepared;
    }

    void remember(KnownImport known)
    {
        const std::lock_guard lock(mutex);
        cache.store(std::move(known));
    }

    const std::filesystem::path program;
    BlobStore& blobs;
    const ImportFiles files;
    const renderer::Limits limits;
    const Log log;
    const std::size_t most_children = renderer::usable_cores();
    std::atomic<std::uint64_t> imports_run{0};
    mutable std::mutex mutex;
    std::condition_variable_any changed;
    ImportCache cache; // under mutex
    std::optional<StoredMeshes> stored;
    std::set<std::string> in_flight; // under mutex: main keys
};

ImportService::ImportService(std::filesystem::path program,
                             BlobStore& blobs,
                             const renderer::Limits& limits,
                             const Log& log,
                             const std::filesystem::path& kept)
    : state_(std::make_unique<State>(std::move(program), blobs, limits, log, kept))
{
}

ImportService::~ImportService() = default;

std::variant<PreparedAsset, ImportFailure>
ImportService::import(const ImportRequest& request, renderer::ThreadPool& pool, const std::stop_token& stop)
try {
    using Answer = std::variant<PreparedAsset, ImportFailure>;
    const auto answer = [&](const KnownImport& known) -> std::optional<Answer> {
        if (known.failure) return *known.failure;
        if (known.picture_figures) return not_a_mesh(*known.picture_figures);
        if (!known.facts) return std::nullopt;
        if (const auto& mesh =
                known.prepared[static_cast<std::size_t>(tree_for(request, known.facts->triangles))])
            return PreparedAsset{mesh, known.figures->notes, known.facts};
        return std::nullopt;
    };
    bool stopped = false;
    if (auto found = state_->wait_for_turn(request, answer, stop, stopped)) return std::move(*found);
    if (stopped) return PreparedAsset{};
    const State::Flight flight(*state_, main_key(request));

    std::optional<KnownImport> held = state_->in_memory(request);
    if (!held) held = state_->on_disk(request, pool);
    if (held) {
        if (auto found = answer(*held)) return std::move(*found);
        const auto other = held->with_any_tree();
        return state_->prepare(request, std::move(*held), [&](renderer::MeshTree tree) {
            return prepare_again(other, tree, pool, stop);
        });
    }

    State::Run run = state_->run(request, stop);
    KnownImport& known = run.known;
    if (known.failure) return *known.failure;
    if (known.picture_figures) {
        const ImportFailure failure = not_a_mesh(*known.picture_figures);
        state_->remember(std::move(known));
        return failure;
    }
    auto* asset = std::get_if<ImportedAsset>(&run.imported);
    if (!asset) return PreparedAsset{};
    known.facts = facts_of_shared(asset->mesh);
    return state_->prepare(request, std::move(known), [&](renderer::MeshTree tree) {
        return prepare_mesh(std::move(asset->mesh), tree, pool, stop);
    });
} catch (const std::bad_alloc&) {
    return out_of_memory();
}

std::variant<ImportedPixels, ImportFailure>
ImportService::picture(const std::string& name, const std::string& digest, const std::stop_token& stop)
try {
    using Answer = std::variant<ImportedPixels, ImportFailure>;
    const auto answer = [&](const KnownImport& known) -> std::optional<Answer> {
        if (known.failure) return *known.failure;
        if (known.picture) return known.picture;
        return std::nullopt;
    };
    const ImportRequest request{name, digest, {}, true};
    bool stopped = false;
    if (auto found = state_->wait_for_turn(request, answer, stop, stopped)) return std::move(*found);
    if (stopped) return ImportedPixels();
    const State::Flight flight(*state_, main_key(request));

    State::Run run = state_->run(request, stop);
    if (run.known.failure) return *run.known.failure;
    auto* picture = std::get_if<ImportedPicture>(&run.imported);
    if (!picture) return ImportedPixels();
    const auto pixels = std::make_shared<const renderer::Image>(std::move(picture->image));
    run.known.picture = pixels;
    state_->remember(std::move(run.known));
    return pixels;
} catch (const std::bad_alloc&) {
    return out_of_memory();
}

std::variant<std::monostate, ImportFailure> ImportService::known_failure(const ImportRequest& request) const
{
    const std::lock_guard lock(state_->mutex);
    const KnownImport* known = state_->cache.peek(main_key(request), request.files);
    if (known && known->failure) return *known->failure;
    return std::monostate();
}

std::optional<api::AssetInfo> ImportService::info(const std::string& digest, const std::stop_token& stop)
{
    const std::uint64_t bytes = state_->blobs.size(kAsset, digest).value_or(0);
    const auto answer = [&](const KnownImport& known) -> std::optional<api::AssetInfo> {
        return info_of(digest, bytes, known);
    };
    const ImportRequest request = bare_request(digest);
    try {
        bool stopped = false;
        if (auto found = state_->wait_for_turn(request, answer, stop, stopped)) return found;
        if (stopped) return std::nullopt;
        const State::Flight flight(*state_, main_key(request));

        State::Run run = state_->run(request, stop);
        if (std::holds_alternative<std::monostate>(run.imported)) return std::nullopt;
        auto info = answer(run.known);
        if (run.repeatable && !run.known.failure) state_->remember(std::move(run.known));
        return info;
    } catch (const std::bad_alloc&) {
        KnownImport known{main_key(request), {}, {}, {}, {}, {}};
        known.failure = out_of_memory();
        return answer(known);
    }
}

std::optional<api::AssetInfo> ImportService::known_info(const std::string& digest) const
{
    const std::uint64_t bytes = state_->blobs.size(kAsset, digest).value_or(0);
    const std::lock_guard lock(state_->mutex);
    const KnownImport* known = state_->cache.peek(main_key(bare_request(digest)), {});
    if (!known) return std::nullopt;
    return info_of(digest, bytes, *known);
}

std::uint64_t ImportService::cached_bytes() const
{
    const std::lock_guard lock(state_->mutex);
    return state_->cache.bytes();
}

std::uint64_t ImportService::stored_bytes() const
{
    return state_->stored ? state_->stored->bytes() : 0;
}

void ImportService::flush()
{
    if (state_->stored) state_->stored->flush();
}

std::uint64_t ImportService::imports_run() const
{
    return state_->imports_run.load();
}

} // namespace server
