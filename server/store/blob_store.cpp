#include "server/store/blob_store.h"

#include "server/store/blob_shelf.h"
#include "server/store/sha256.h"

#include <unistd.h>

namespace server {

struct BlobStore::State {
    BlobShelf assets, results;

    explicit State(const std::filesystem::path& folder)
        : assets(folder / "assets", true), results(folder / "results", false)
    {
    }
    BlobShelf& shelf(Kind kind) { return kind == Kind::asset ? assets : results; }
};

// Streams into a temporary file and hashes on the way.
class BlobStore::FileWriter final : public BlobStore::Writer {
public:
    FileWriter(BlobShelf& shelf, bool durable) : shelf_(shelf), durable_(durable)
    {
        auto [file, path] = shelf_.folder().make_temporary();
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
        const IncomingBlob blob{file_, path_, digest(), bytes_};
        const bool kept = shelf_.keeps(blob, durable_);
        if (kept)
            discard();
        else
            shelf_.take(blob, durable_);
        path_.clear();
        return !kept;
    }

private:
    void discard()
    {
        file_.reset();
        if (!path_.empty()) ::unlink(path_.c_str());
        path_.clear();
    }

    BlobShelf& shelf_;
    bool durable_;
    FileDescriptor file_;
    std::filesystem::path path_; // empty once committed or discarded
    Sha256 sha_;
    std::uint64_t bytes_ = 0;
    std::string digest_;
};

BlobStore::BlobStore(const std::filesystem::path& folder) : state_(std::make_unique<State>(folder)) {}

BlobStore::~BlobStore() = default;

std::unique_ptr<BlobStore::Writer> BlobStore::write(Kind kind, bool durable)
{
    return std::make_unique<FileWriter>(state_->shelf(kind), durable);
}

std::string BlobStore::put(Kind kind, std::span<const std::byte> bytes, bool durable)
{
    FileWriter writer(state_->shelf(kind), durable);
    writer.append(bytes);
    writer.commit();
    return writer.digest();
}

void BlobStore::make_durable(Kind kind, const std::vector<std::string>& digests)
{
    state_->shelf(kind).make_durable(digests);
}

bool BlobStore::has(Kind kind, std::string_view digest) const
{
    return size(kind, digest).has_value();
}

std::optional<std::uint64_t> BlobStore::size(Kind kind, std::string_view digest) const
{
    return state_->shelf(kind).size(digest);
}

std::optional<std::vector<std::byte>> BlobStore::read(Kind kind, std::string_view digest)
{
    return state_->shelf(kind).read(digest);
}

std::unique_ptr<BlobReader> BlobStore::open(Kind kind, std::string_view digest)
{
    return state_->shelf(kind).open(digest);
}

std::filesystem::path BlobStore::path(Kind kind, std::string_view digest) const
{
    if (!is_digest(digest)) return {};
    return state_->shelf(kind).folder().path(digest);
}

bool BlobStore::remove(Kind kind, std::string_view digest)
{
    return state_->shelf(kind).remove(digest);
}

void BlobStore::touch(Kind kind, std::string_view digest)
{
    state_->shelf(kind).touch(digest);
}

std::uint64_t BlobStore::total_bytes(Kind kind) const
{
    return state_->shelf(kind).total_bytes();
}

std::vector<std::string> BlobStore::list(Kind kind) const
{
    return state_->shelf(kind).list();
}

bool BlobStore::make_room(std::uint64_t bytes,
                          std::uint64_t limit,
                          const std::function<std::vector<std::string>()>& in_use)
{
    return state_->assets.make_room(bytes, limit, in_use);
}

} // namespace server
