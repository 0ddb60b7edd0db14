#include "server/import/stored_meshes.h"

#include "server/import/mesh_file.h"
#include "server/store/sha256.h"
#include "server/store/store.h"

#include <algorithm>
#include <condition_variable>
#include <deque>
#include <fcntl.h>
#include <list>
#include <map>
#include <mutex>
#include <sys/stat.h>
#include <thread>
#include <unistd.h>
#include <utility>
#include <vector>

namespace server {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t kMostWaiting = 4; // each holds a mesh
constexpr std::size_t kDigestLetters = 64;
constexpr const char* kTemporary = ".being-written";

// "sha256:<hex>.obj" and the rest of the key as a file's name.
std::string name_of(const std::string& main, renderer::MeshTree tree, const std::string& build)
{
    constexpr std::size_t kKeyLetters = 16;
    const std::string hex = main.substr(main.find(':') + 1);
    const std::string key = main + '\n' + std::to_string(static_cast<int>(tree)) + '\n' + build;
    Sha256 sha;
    sha.append(std::as_bytes(std::span(key)));
    const std::string rest = sha.finish();
    return hex.substr(0, kDigestLetters) + '-' + rest.substr(rest.find(':') + 1, kKeyLetters);
}

} // namespace

struct StoredMeshes::State {
    struct File {
        std::string name;
        std::uint64_t bytes = 0;
    };
    struct Waiting {
        KnownImport known;
        renderer::MeshTree tree;
    };

    State(fs::path where, std::uint64_t most, std::string of_build, const Log& log_to)
        : folder(std::move(where)), most_bytes(most), build(std::move(of_build)), log(log_to)
    {
    }

    // What a run before this one left: least recently used first; what is of no use goes.
    void scan(const std::function<bool(const std::string&)>& is_wanted)
    {
        struct Found {
            File file;
            fs::file_time_type used;
        };
        std::vector<Found> found;
        for (const auto& entry : fs::directory_iterator(folder)) {
            const std::string name = entry.path().filename();
            const bool is_ours = name.size() > kDigestLetters && name[kDigestLetters] == '-';
            if (!is_ours || !is_wanted("sha256:" + name.substr(0, kDigestLetters)))
                fs::remove(entry.path());
            else
                found.push_back({{name, entry.file_size()}, entry.last_write_time()});
        }
        std::sort(found.begin(), found.end(), [](const Found& a, const Found& b) { return a.used < b.used; });
        for (Found& file : found)
            add(std::move(file.file));
        make_room();
    }

    void add(File file) // under mutex
    {
        forget(file.name);
        total += file.bytes;
        files.push_front(std::move(file));
        by_name[files.front().name] = files.begin();
    }
    void forget(const std::string& name) // under mutex
    {
        const auto known = by_name.find(name);
        if (known == by_name.end()) return;
        total -= known->second->bytes;
        files.erase(known->second);
        by_name.erase(known);
    }
    // Who has a file mapped keeps it: only its name goes.
    void make_room() // under mutex
    {
        while (total > most_bytes && !files.empty()) {
            const std::string name = files.back().name;
            ::unlink((folder / name).c_str());
            forget(name);
        }
    }

    void tell(const char* event, const std::string& name, const std::string& why) const
    {
        log.write(LogLevel::warning, event, {{"file", (folder / name).string()}, {"detail", why}});
    }

    void drop(const std::string& name, const std::string& why)
    {
        tell("stored_mesh_dropped", name, why);
        const std::lock_guard lock(mutex);
        ::unlink((folder / name).c_str());
        forget(name);
    }

    void write(const Waiting& what, const std::stop_token& stop)
    {
        const std::string name = name_of(what.known.main, what.tree, build);
        const fs::path temporary = folder / kTemporary;
        try {
            ::unlink(temporary.c_str());
            const FileDescriptor file(::open(temporary.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0600));
            if (!file) throw_io_error("make", temporary, errno);
            if (!write_mesh_file(file, temporary, what.known, what.tree, stop)) {
                ::unlink(temporary.c_str());
                return;
            }
            const std::uint64_t bytes = fs::file_size(temporary);
            const std::lock_guard lock(mutex);
            if (bytes > most_bytes) {
                ::unlink(temporary.c_str());
                return;
            }
            fs::rename(temporary, folder / name);
            add({name, bytes});
            make_room();
        } catch (const std::exception& error) {
            ::unlink(temporary.c_str());
            tell("mesh_not_stored", name, error.what());
        }
    }

    void write_all_that_wait(const std::stop_token& stop)
    {
        std::unique_lock lock(mutex);
        while (changed.wait(lock, stop, [&] { return !waiting.empty(); })) {
            if (stop.stop_requested()) return;
            const Waiting next = std::move(waiting.front());
            waiting.pop_front();
            is_writing = true;
            lock.unlock();
            write(next, stop);
            lock.lock();
            is_writing = false;
            changed.notify_all();
        }
    }

    const fs::path folder;
    const std::uint64_t most_bytes;
    const std::string build;
    const Log log;
    mutable std::mutex mutex;
    std::condition_variable_any changed;
    std::list<File> files; // under mutex, as all below: most recently used first
    std::map<std::string, std::list<File>::iterator, std::less<>> by_name;
    std::uint64_t total = 0;
    std::deque<Waiting> waiting;
    bool is_writing = false;
    bool is_open = false;
    std::jthread writer; // last: it ends first
};

StoredMeshes::StoredMeshes(fs::path folder,
                           std::uint64_t most_bytes,
                           std::string build,
                           const std::function<bool(const std::string&)>& is_wanted,
                           const Log& log)
    : state_(std::make_unique<State>(std::move(folder), most_bytes, std::move(build), log))
{
    try {
        make_folder(state_->folder);
        state_->scan(is_wanted);
        state_->is_open = most_bytes > 0;
    } catch (const std::exception& error) {
        state_->tell("stored_meshes_unavailable", "", error.what());
        return;
    }
    if (state_->is_open)
        state_->writer = std::jthread(
            [state = state_.get()](const std::stop_token& stop) { state->write_all_that_wait(stop); });
}

StoredMeshes::~StoredMeshes() = default;

std::optional<KnownImport> StoredMeshes::load(const std::string& main,
                                              const NamedDigests& files,
                                              renderer::MeshTree tree,
                                              renderer::ThreadPool& pool)
{
    const std::string name = name_of(main, tree, state_->build);
    FileDescriptor file;
    {
        const std::lock_guard lock(state_->mutex);
        const auto known = state_->by_name.find(name);
        if (known == state_->by_name.end()) return std::nullopt;
        state_->files.splice(state_->files.begin(), state_->files, known->second);
        file = FileDescriptor(::open((state_->folder / name).c_str(), O_RDONLY | O_CLOEXEC));
    }
    const MappedBytes mapped = file ? map_file(file.get()) : MappedBytes();
    if (!mapped.keeper) {
        state_->drop(name, "it cannot be opened");
        return std::nullopt;
    }
    auto answer = read_mesh_file(mapped, main, files, tree, pool);
    if (const auto* fault = std::get_if<MeshFileFault>(&answer)) {
        state_->drop(name, fault->why + "; it is made again");
        return std::nullopt;
    }
    auto* known = std::get_if<KnownImport>(&answer);
    if (!known) return std::nullopt;
    ::futimens(file.get(), nullptr); // used now: for the order of the next start
    return std::move(*known);
}

void StoredMeshes::keep(const KnownImport& known, renderer::MeshTree tree)
{
    const auto& prepared = known.prepared[static_cast<std::size_t>(tree)];
    if (!state_->is_open || !renderer::bvh_of(*prepared)) return; // other trees are for measuring
    const std::lock_guard lock(state_->mutex);
    if (state_->waiting.size() >= kMostWaiting) return;
    State::Waiting waiting{{known.main, known.answers, {}, known.figures, {}, {}}, tree};
    waiting.known.prepared[static_cast<std::size_t>(tree)] = known.prepared[static_cast<std::size_t>(tree)];
    state_->waiting.push_back(std::move(waiting));
    state_->changed.notify_all();
}

void StoredMeshes::flush()
{
    std::unique_lock lock(state_->mutex);
    state_->changed.wait(lock, [&] { return state_->waiting.empty() && !state_->is_writing; });
}

std::uint64_t StoredMeshes::bytes() const
{
    const std::lock_guard lock(state_->mutex);
    return state_->total;
}

} // namespace server
