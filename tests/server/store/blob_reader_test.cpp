// A blob read piece by piece: what is handed out is what was put, or nothing is.
#include "server/store/blob_reader.h"
#include "server/store/blob_store.h"
#include "tests/support/temp_folder.h"

#include <gtest/gtest.h>

#include <fstream>
#include <random>

namespace {

using server::BlobReader;
using server::BlobStore;
using server::kBlobPiece;
using server::StoreError;
using tests::TempFolder;
using Kind = BlobStore::Kind;

std::string noise(std::size_t bytes)
{
    std::mt19937 random(7);
    std::string text(bytes, '\0');
    for (char& c : text)
        c = static_cast<char>(random());
    return text;
}

std::string put(BlobStore& blobs, const std::string& text)
{
    return blobs.put(Kind::asset, std::as_bytes(std::span(text.data(), text.size())));
}

std::string read_from(BlobReader& reader, std::uint64_t offset)
{
    std::string text;
    while (offset + text.size() < reader.size()) {
        const auto bytes = reader.at(offset + text.size());
        text.append(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    }
    return text;
}

void flip(const std::filesystem::path& file, std::uint64_t offset)
{
    std::fstream stream(file, std::ios::in | std::ios::out | std::ios::binary);
    stream.seekg(static_cast<std::streamoff>(offset));
    const char was = static_cast<char>(stream.get());
    stream.seekp(static_cast<std::streamoff>(offset));
    stream.put(static_cast<char>(was ^ 1));
}

TEST(BlobReader, ReadsFromAnywhereToTheEnd)
{
    const TempFolder folder;
    BlobStore blobs(folder.path());
    for (const std::size_t size : {std::size_t{0}, std::size_t{1}, kBlobPiece, 2 * kBlobPiece + 5}) {
        const std::string text = noise(size);
        const auto reader = blobs.open(Kind::asset, put(blobs, text));
        ASSERT_TRUE(reader);
        EXPECT_EQ(reader->size(), size);
        EXPECT_TRUE(read_from(*reader, 0) == text) << size;
        for (const std::size_t from : {size / 2, size - size / 3})
            EXPECT_TRUE(read_from(*reader, from) == text.substr(from)) << from << " of " << size;
    }
}

TEST(BlobReader, HandsOutNoMoreThanAPieceAtATime)
{
    const TempFolder folder;
    BlobStore blobs(folder.path());
    const auto reader = blobs.open(Kind::asset, put(blobs, noise(2 * kBlobPiece + 5)));
    EXPECT_EQ(reader->at(0).size(), kBlobPiece);
    EXPECT_EQ(reader->at(kBlobPiece - 3).size(), 3U);
    EXPECT_EQ(reader->at(2 * kBlobPiece + 1).size(), 4U);
}

TEST(BlobReader, ProvesAPieceAnewThatItLetGo)
{
    const TempFolder folder;
    BlobStore blobs(folder.path());
    const std::string text = noise(2 * kBlobPiece), digest = put(blobs, text);
    const auto reader = blobs.open(Kind::asset, digest);
    reader->at(5);
    reader->let_go();
    EXPECT_TRUE(read_from(*reader, 5) == text.substr(5));
    reader->at(5);
    std::fstream(blobs.path(Kind::asset, digest), std::ios::in | std::ios::out)
        .seekp(7)
        .put(static_cast<char>(~text[7]));
    EXPECT_NO_THROW(reader->at(6)) << "held";
    reader->let_go();
    EXPECT_THROW(reader->at(6), server::StoreError);
}

TEST(BlobReader, IsNotToBeHadOfWhatIsNotThere)
{
    const TempFolder folder;
    BlobStore blobs(folder.path());
    EXPECT_FALSE(blobs.open(Kind::asset, server::digest_of("nowhere")));
    EXPECT_FALSE(blobs.open(Kind::asset, "../secret"));
    const std::string digest = put(blobs, "abc");
    std::filesystem::remove(blobs.path(Kind::asset, digest));
    EXPECT_FALSE(blobs.open(Kind::asset, digest));
    EXPECT_FALSE(blobs.has(Kind::asset, digest));
}

TEST(BlobReader, IsNotToBeHadOfWhatWasDamagedBeforeItsFirstUse)
{
    const TempFolder folder;
    const std::string text = noise(2 * kBlobPiece + 5);
    std::string digest;
    {
        BlobStore blobs(folder.path());
        digest = put(blobs, text);
    }
    BlobStore blobs(folder.path());
    flip(blobs.path(Kind::asset, digest), kBlobPiece + 1);
    for (int attempt = 0; attempt < 2; ++attempt)
        EXPECT_THROW(blobs.open(Kind::asset, digest), StoreError);
    EXPECT_FALSE(blobs.has(Kind::asset, digest)) << "so that a client sends it again";
    EXPECT_EQ(put(blobs, text), digest);
    EXPECT_TRUE(read_from(*blobs.open(Kind::asset, digest), 0) == text);
}

TEST(BlobReader, HandsOutNothingOfAPieceThatWasDamagedSince)
{
    const TempFolder folder;
    BlobStore blobs(folder.path());
    const std::string text = noise(2 * kBlobPiece + 5), digest = put(blobs, text);
    const auto file = blobs.path(Kind::asset, digest);
    const auto used = std::filesystem::last_write_time(file);
    const auto before = blobs.open(Kind::asset, digest);
    read_from(*before, 0);
    flip(file, 2 * kBlobPiece + 1);
    std::filesystem::last_write_time(file, used); // as a disk that loses a bit does: it leaves no trace
    const auto after = blobs.open(Kind::asset, digest);
    for (BlobReader* const reader : {before.get(), after.get()}) {
        reader->at(0); // of the other pieces, everything
        reader->at(kBlobPiece);
        try {
            reader->at(2 * kBlobPiece + 3);
            ADD_FAILURE() << "handed out";
        } catch (const StoreError& error) {
            EXPECT_NE(std::string(error.what()).find(digest), std::string::npos) << error.what();
        }
    }
    EXPECT_FALSE(blobs.has(Kind::asset, digest));
    EXPECT_THROW(blobs.open(Kind::asset, digest), StoreError);
    put(blobs, text);
    EXPECT_TRUE(read_from(*blobs.open(Kind::asset, digest), 0) == text);
}

TEST(BlobReader, MissesWhatWasCutOff)
{
    const TempFolder folder;
    BlobStore blobs(folder.path());
    const std::string digest = put(blobs, noise(kBlobPiece + 5));
    const auto reader = blobs.open(Kind::asset, digest);
    std::filesystem::resize_file(blobs.path(Kind::asset, digest), kBlobPiece + 2);
    EXPECT_EQ(reader->at(0).size(), kBlobPiece);
    EXPECT_THROW(reader->at(kBlobPiece), StoreError);
}

TEST(BlobReader, ReadsOnWhatIsRemovedOrUploadedAgainMeanwhile)
{
    const TempFolder folder;
    BlobStore blobs(folder.path());
    const std::string text = noise(kBlobPiece + 5), digest = put(blobs, text);
    const auto reader = blobs.open(Kind::asset, digest);
    blobs.remove(Kind::asset, digest);
    EXPECT_TRUE(read_from(*reader, 0) == text);

    put(blobs, text);
    const auto old = blobs.open(Kind::asset, digest);
    flip(blobs.path(Kind::asset, digest), 3);
    EXPECT_THROW(old->at(0), StoreError);
    put(blobs, text);
    EXPECT_THROW(old->at(0), StoreError);
    EXPECT_TRUE(blobs.has(Kind::asset, digest)) << "the new file is another";
}

} // namespace
