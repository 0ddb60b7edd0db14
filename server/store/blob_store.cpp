#include "server/store/blob_store.h"

#include "server/store/blob_folder.h"
#include "server/store/sha256.h"

#include <mutex>
#include <unistd.h>
#include <unordered_set>

namespace server {

namespace {

struct Shelf {
    const char* name;
    BlobFolder folder;
    BlobIndex index;

    Shelf(const char* kind_name, const std::filesystem::path& path)
        : name(kind_name), folder(path), index(folder.scan())
    {
    }
};

} // namespace

struct BlobStore::State {
    Shelf assets, results;
    mutable std::mutex
        mutex; // of the indexes; held over renames and removals, never over reading or writing bytes

    explicit State(const std::filesystem::path& folder)
        : assets("asset", folder / "assets"), results("result", folder / "results")
    {
    }
    Shelf& shelf(Kind kind) { return kind == Kind::asset ? assets : results; }

    StoreError damage(const Shelf& shelf, std::string_view digest) const
    {
        return {std::string(shelf.name) + ' ' + std::string(digest) + " is damaged on disk (" +
                    shelf.folder.path(digest).string() + "): its bytes are not those of its digest",
                false};
    }
    // Gone since it was looked up, or taken away behind our back.
    void forget_if_gone(Shelf& shelf, std::string_view digest)
    {
        const std::lock_guard lock(mutex);
        if (::access(shelf.folder.path(digest).c_str(), F_OK) != 0) shelf.index.remove(digest);
    }
};

// Streams into a temporary file and hashes on the way.
class BlobStore::FileWriter final : public BlobStore::Writer {
public:
    FileWriter(State& state, Kind kind, bool durable)
        : state_(state), shelf_(state.shelf(kind)), durable_(durable)
    {
        auto [file, path] = shelf_.folder.make_temporary();
        file_ = std::move(file);
        path_ = std::move(path);
    }
    ~FileWriter() override { discard(); }
    FileWriter(const FileWriter&) = delete;
    FileWriter& operator=(const FileWriter&) = delete;

    void append(std::span<const std::byte> bytes) override
    {
        write_all(file_, bytes, path_);
        sha_.append(bytes);
        bytes_ += bytes.size();
    }

    std::uint64_t bytes() const override { return bytes_; }

    std::string digest() override
    {
        if (digest_.empty()) digest_ = sha_.finish();
        return digest_;
    }

    bool commit() override
    {
        const std::string name = digest();
        if (keep_present(name)) return false;
        if (durable_) sync_file(file_, path_);
        {
            const std::lock_guard lock(state_.mutex);
            shelf_.folder.adopt(path_, name);
            path_.clear();
            shelf_.index.add(name, {.bytes = bytes_});
        }
        if (durable_) make_name_last(name);
        return true;
    }

private:
    // Whether the blob is there already, sound as far as is known, and as durable as asked for.
    bool keep_present(const std::string& name)
    {
        const std::lock_guard lock(state_.mutex);
        BlobIndex::Blob* present = shelf_.index.find(name);
        if (present == nullptr || present->damaged || present->bytes != bytes_) return false;
        if (::access(shelf_.folder.path(name).c_str(), F_OK) != 0) return false;
        if (durable_ && !present->synced) shelf_.folder.sync(name);
        present->synced = present->synced || durable_;
        shelf_.index.use(name);
        shelf_.folder.mark_used(name);
        discard();
        return true;
    }

    // Not under the mutex, which others need; until it is done nobody may count on it.
    void make_name_last(const std::string& name)
    {
        sync_folder(shelf_.folder.path(name).parent_path());
        const std::lock_guard lock(state_.mutex);
        if (BlobIndex::Blob* blob = shelf_.index.find(name)) blob->synced = true;
    }

    void discard()
    {
        file_.reset();
        if (!path_.empty()) ::unlink(path_.c_str());
        path_.clear();
    }

    State& state_;
    Shelf& shelf_;
    bool durable_;
    FileDescriptor file_;
    std::filesystem::path path_; // empty once committed or discarded
    Sha256 sha_;
    std::uint64_t bytes_ = 0;
    std::string digest_;
};

BlobStore::BlobStore(const std::filesystem::path& folder) : state_(std::make_unique<State>(folder)) {}

BlobStore::~BlobStore() = default;

std::unique_ptr<BlobStore::Writer> BlobStore::write(Kind kind)
{
    return std::make_unique<FileWriter>(*state_, kind, true);
}

std::string BlobStore::put(Kind kind, std::span<const std::byte> bytes, bool durable)
{
    FileWriter writer(*state_, kind, durable);
    writer.append(bytes);
    writer.commit();
    return writer.digest();
}

bool BlobStore::has(Kind kind, std::string_view digest) const
{
    return size(kind, digest).has_value();
}

std::optional<std::uint64_t> BlobStore::size(Kind kind, std::string_view digest) const
{
    const std::lock_guard lock(state_->mutex);
    const BlobIndex::Blob* blob = state_->shelf(kind).index.find(digest);
    if (blob == nullptr || blob->damaged) return std::nullopt;
    return blob->bytes;
}

std::optional<std::vector<std::byte>> BlobStore::read(Kind kind, std::string_view digest)
{
    Shelf& shelf = state_->shelf(kind);
    {
        const std::lock_guard lock(state_->mutex);
        if (shelf.index.find(digest) == nullptr) return std::nullopt;
    }
    std::optional<std::vector<std::byte>> bytes = shelf.folder.read(digest);
    if (!bytes) {
        state_->forget_if_gone(shelf, digest);
        return std::nullopt;
    }
    const bool sound = digest_of(std::span<const std::byte>(*bytes)) == digest;
    const std::lock_guard lock(state_->mutex);
    if (!sound) {
        if (BlobIndex::Blob* blob = shelf.index.find(digest)) blob->damaged = true;
        throw state_->damage(shelf, digest);
    }
    shelf.index.use(digest);
    shelf.folder.mark_used(digest);
    return bytes;
}

std::unique_ptr<BlobReader> BlobStore::open(Kind kind, std::string_view digest)
{
    Shelf& shelf = state_->shelf(kind);
    std::shared_ptr<const BlobProof> proof;
    {
        const std::lock_guard lock(state_->mutex);
        const BlobIndex::Blob* blob = shelf.index.find(digest);
        if (blob == nullptr) return nullptr;
        if (!blob->damaged) proof = blob->proof;
    }
    std::optional<FileDescriptor> file = shelf.folder.open(digest);
    if (!file) {
        state_->forget_if_gone(shelf, digest);
        return nullptr;
    }
    if (!proof) {
        proof = prove_blob(*file, shelf.folder.path(digest), digest);
        const std::lock_guard lock(state_->mutex);
        if (BlobIndex::Blob* blob = shelf.index.find(digest)) {
            blob->damaged = proof == nullptr;
            blob->proof = proof;
        }
        if (!proof) throw state_->damage(shelf, digest);
    }
    auto damaged = [state = state_.get(), &shelf, name = std::string(digest), proof] {
        const std::lock_guard lock(state->mutex);
        BlobIndex::Blob* blob = shelf.index.find(name);
        if (blob != nullptr && blob->proof == proof) blob->damaged = true; // else it was uploaded again
        return state->damage(shelf, name);
    };
    touch(kind, digest);
    return std::make_unique<BlobReader>(
        *std::move(file), shelf.folder.path(digest), std::move(proof), std::move(damaged));
}

std::filesystem::path BlobStore::path(Kind kind, std::string_view digest) const
{
    if (!is_digest(digest)) return {};
    return state_->shelf(kind).folder.path(digest);
}

bool BlobStore::remove(Kind kind, std::string_view digest)
{
    const std::lock_guard lock(state_->mutex);
    Shelf& shelf = state_->shelf(kind);
    if (shelf.index.find(digest) == nullptr) return false;
    const bool removed = shelf.folder.remove(digest);
    shelf.index.remove(digest);
    return removed;
}

void BlobStore::touch(Kind kind, std::string_view digest)
{
    const std::lock_guard lock(state_->mutex);
    Shelf& shelf = state_->shelf(kind);
    if (shelf.index.find(digest) == nullptr) return;
    shelf.index.use(digest);
    shelf.folder.mark_used(digest);
}

std::uint64_t BlobStore::total_bytes(Kind kind) const
{
    const std::lock_guard lock(state_->mutex);
    return state_->shelf(kind).index.total_bytes();
}

std::vector<std::string> BlobStore::list(Kind kind) const
{
    const std::lock_guard lock(state_->mutex);
    const auto& digests = state_->shelf(kind).index.digests();
    return {digests.begin(), digests.end()};
}

bool BlobStore::make_room(std::uint64_t bytes, std::uint64_t limit, const std::vector<std::string>& keep)
{
    if (bytes > limit) return false;
    const std::unordered_set<std::string_view> kept(keep.begin(), keep.end());
    const std::lock_guard lock(state_->mutex);
    BlobIndex& index = state_->assets.index;
    std::uint64_t total = index.total_bytes();
    std::vector<std::string> victims;
    for (auto digest = index.digests().begin(); digest != index.digests().end() && total > limit - bytes;
         ++digest) {
        if (kept.count(*digest) != 0) continue;
        total -= index.find(*digest)->bytes;
        victims.push_back(*digest);
    }
    if (total > limit - bytes) return false;
    for (const std::string& victim : victims) {
        state_->assets.folder.remove(victim);
        index.remove(victim);
    }
    return true;
}

} // namespace server
