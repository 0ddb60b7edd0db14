#include "server/store/blob_store.h"
#include "tests/support/temp_folder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <fcntl.h>
#include <fstream>
#include <sys/stat.h>
#include <thread>

namespace {

using server::BlobStore;
using server::digest_of;
using server::StoreError;
using tests::TempFolder;
using Kind = BlobStore::Kind;

constexpr const char* kAbcDigest =
    "sha256:ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad"; // FIPS 180-4

std::span<const std::byte> bytes_of(std::string_view text)
{
    return std::as_bytes(std::span(text.data(), text.size()));
}

std::string text_of(const std::optional<std::vector<std::byte>>& bytes)
{
    if (!bytes) return "(nothing)";
    return {reinterpret_cast<const char*>(bytes->data()), bytes->size()};
}

std::size_t files_below(const std::filesystem::path& folder)
{
    std::size_t files = 0;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder))
        if (entry.is_regular_file()) ++files;
    return files;
}

TEST(Digest, IsSha256InLowerCaseHex)
{
    EXPECT_EQ(digest_of("abc"), kAbcDigest);
    EXPECT_EQ(digest_of(bytes_of("abc")), kAbcDigest);
    EXPECT_EQ(digest_of(""), "sha256:e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
    EXPECT_TRUE(server::is_digest(kAbcDigest));
    const std::string digest = kAbcDigest;
    std::string upper = digest;
    std::transform(upper.begin() + 7, upper.end(), upper.begin() + 7, [](char c) {
        return static_cast<char>(std::toupper(c));
    });
    for (const std::string& bad : {std::string(),
                                   digest.substr(7),
                                   digest + "0",
                                   digest.substr(0, 70),
                                   upper,
                                   "sha256:" + std::string(64, 'g'),
                                   "md5:" + digest.substr(7)})
        EXPECT_FALSE(server::is_digest(bad)) << bad;
}

TEST(BlobStore, GivesBackWhatWasPut)
{
    const TempFolder folder;
    BlobStore blobs(folder.path());
    EXPECT_EQ(blobs.put(Kind::asset, bytes_of("abc")), kAbcDigest);
    EXPECT_EQ(blobs.put(Kind::asset, bytes_of("abc")), kAbcDigest);
    EXPECT_EQ(text_of(blobs.read(Kind::asset, kAbcDigest)), "abc");
    EXPECT_EQ(blobs.size(Kind::asset, kAbcDigest), 3U);
    EXPECT_EQ(blobs.total_bytes(Kind::asset), 3U);
    EXPECT_EQ(blobs.path(Kind::asset, kAbcDigest),
              folder.path() / "assets" / "ba" / std::string(kAbcDigest).substr(7));
    EXPECT_FALSE(blobs.has(Kind::result, kAbcDigest)) << "the kinds are apart";
    EXPECT_EQ(blobs.put(Kind::result, {}, false), digest_of(""));
    EXPECT_EQ(text_of(blobs.read(Kind::result, digest_of(""))), "");
}

TEST(BlobStore, StreamsAndForgetsWhatIsNotCommitted)
{
    const TempFolder folder;
    BlobStore blobs(folder.path());
    {
        const auto writer = blobs.write(Kind::asset);
        writer->append(bytes_of("lost"));
    }
    EXPECT_EQ(files_below(folder.path()), 0U);
    const auto writer = blobs.write(Kind::asset);
    writer->append(bytes_of("a"));
    writer->append({});
    writer->append(bytes_of("bc"));
    EXPECT_EQ(writer->bytes(), 3U);
    EXPECT_EQ(writer->digest(), kAbcDigest);
    EXPECT_FALSE(blobs.has(Kind::asset, kAbcDigest));
    EXPECT_TRUE(writer->commit());
    const auto again = blobs.write(Kind::asset);
    again->append(bytes_of("abc"));
    EXPECT_FALSE(again->commit());
    EXPECT_EQ(files_below(folder.path()), 1U);
}

TEST(BlobStore, KeepsBlobsOverARestartAndRemovesLeftovers)
{
    const TempFolder folder;
    {
        BlobStore blobs(folder.path());
        blobs.put(Kind::asset, bytes_of("abc"));
        blobs.put(Kind::result, bytes_of("picture"), false);
    }
    folder.write("assets/incoming-Ab12Cd", "half an upload");
    folder.write("assets/notes.txt", "somebody's notes");
    folder.write("assets/ba/other.txt", "more notes");
    BlobStore blobs(folder.path());
    EXPECT_FALSE(std::filesystem::exists(folder.path() / "assets/incoming-Ab12Cd"));
    EXPECT_TRUE(std::filesystem::exists(folder.path() / "assets/notes.txt")) << "not ours to remove";
    EXPECT_EQ(blobs.list(Kind::asset), std::vector<std::string>{kAbcDigest});
    EXPECT_EQ(blobs.total_bytes(Kind::asset), 3U);
    EXPECT_EQ(text_of(blobs.read(Kind::asset, kAbcDigest)), "abc");
    EXPECT_EQ(text_of(blobs.read(Kind::result, digest_of("picture"))), "picture");
}

TEST(BlobStore, ReportsADamagedBlobByNameUntilItIsUploadedAgain)
{
    const TempFolder folder;
    BlobStore blobs(folder.path());
    blobs.put(Kind::asset, bytes_of("abc"));
    const auto file = blobs.path(Kind::asset, kAbcDigest);
    for (const char* damage : {"abd", "ab", "", "abcd"}) {
        std::ofstream(file, std::ios::trunc) << damage;
        for (int attempt = 0; attempt < 2; ++attempt) {
            try {
                blobs.read(Kind::asset, kAbcDigest);
                ADD_FAILURE() << "served: " << damage;
            } catch (const StoreError& error) {
                EXPECT_NE(std::string(error.what()).find(kAbcDigest), std::string::npos) << error.what();
                EXPECT_FALSE(error.storage_full);
            }
        }
        EXPECT_FALSE(blobs.has(Kind::asset, kAbcDigest)) << "so that a client sends it again";
        EXPECT_EQ(blobs.put(Kind::asset, bytes_of("abc")), kAbcDigest);
        EXPECT_EQ(text_of(blobs.read(Kind::asset, kAbcDigest)), "abc");
    }
}

TEST(BlobStore, TakesABlobThatSomebodyDeletedAsMissing)
{
    const TempFolder folder;
    BlobStore blobs(folder.path());
    blobs.put(Kind::asset, bytes_of("abc"));
    std::filesystem::remove(blobs.path(Kind::asset, kAbcDigest));
    EXPECT_FALSE(blobs.read(Kind::asset, kAbcDigest));
    EXPECT_FALSE(blobs.has(Kind::asset, kAbcDigest));
    blobs.put(Kind::asset, bytes_of("abc"));
    std::filesystem::remove(blobs.path(Kind::asset, kAbcDigest));
    blobs.put(Kind::asset, bytes_of("abc")); // without having noticed
    EXPECT_EQ(text_of(blobs.read(Kind::asset, kAbcDigest)), "abc");
}

TEST(BlobStore, FollowsNoNameThatIsNoDigest)
{
    const TempFolder folder;
    folder.write("secret", "secret");
    BlobStore blobs(folder.path());
    for (const std::string name : {"", "sha256:", "../secret", "sha256:../../secret", "sha256:/etc/passwd"}) {
        EXPECT_FALSE(blobs.has(Kind::asset, name));
        EXPECT_FALSE(blobs.read(Kind::asset, name));
        EXPECT_FALSE(blobs.remove(Kind::asset, name));
        EXPECT_TRUE(blobs.path(Kind::asset, name).empty());
        blobs.touch(Kind::asset, name);
    }
    EXPECT_TRUE(std::filesystem::exists(folder.path() / "secret"));
}

TEST(BlobStore, RemovesOnce)
{
    const TempFolder folder;
    BlobStore blobs(folder.path());
    blobs.put(Kind::asset, bytes_of("abc"));
    EXPECT_TRUE(blobs.remove(Kind::asset, kAbcDigest));
    EXPECT_FALSE(blobs.remove(Kind::asset, kAbcDigest));
    EXPECT_EQ(blobs.total_bytes(Kind::asset), 0U);
    EXPECT_EQ(files_below(folder.path()), 0U);
}

TEST(BlobStore, MakesRoomByWhatWasUsedLongestAgo)
{
    const TempFolder folder;
    BlobStore blobs(folder.path());
    std::vector<std::string> digests;
    for (const char* text : {"1111", "2222", "3333", "4444"})
        digests.push_back(blobs.put(Kind::asset, bytes_of(text)));
    blobs.put(Kind::result, bytes_of("never counted"));
    blobs.touch(Kind::asset, digests[0]);
    blobs.read(Kind::asset, digests[1]);
    blobs.put(Kind::asset, bytes_of("3333")); // uploading again is a use, too
    EXPECT_EQ(blobs.list(Kind::asset),
              (std::vector<std::string>{digests[3], digests[0], digests[1], digests[2]}));

    const auto keeping = [](std::vector<std::string> used) { return [used] { return used; }; };
    const auto none = []() -> std::vector<std::string> {
        ADD_FAILURE() << "who is in use matters only where something must go";
        return {};
    };
    EXPECT_TRUE(blobs.make_room(4, 20, none));
    EXPECT_EQ(blobs.list(Kind::asset).size(), 4U) << "it fits already";
    EXPECT_FALSE(blobs.make_room(9, 16, keeping({digests[0], digests[1], digests[2]})));
    EXPECT_FALSE(blobs.make_room(17, 16, none));
    EXPECT_EQ(blobs.list(Kind::asset).size(), 4U) << "what cannot help removes nothing";
    EXPECT_TRUE(blobs.make_room(5, 16, keeping({digests[3]})));
    EXPECT_EQ(blobs.list(Kind::asset), (std::vector<std::string>{digests[3], digests[2]}));
    EXPECT_EQ(blobs.total_bytes(Kind::asset), 8U);
    EXPECT_TRUE(blobs.make_room(UINT64_MAX, UINT64_MAX, keeping({})));
    EXPECT_TRUE(blobs.list(Kind::asset).empty());
}

TEST(BlobStore, IsMendedByWritingTheSameBytesAlsoWhereNobodyHadNoticed)
{
    for (const bool noticed : {false, true}) {
        const TempFolder folder;
        BlobStore blobs(folder.path());
        blobs.put(Kind::asset, bytes_of("abc"));
        {
            std::fstream file(blobs.path(Kind::asset, kAbcDigest), std::ios::in | std::ios::out);
            file.put('A' ^ 1);
        }
        if (noticed) {
            EXPECT_THROW(blobs.open(Kind::asset, kAbcDigest), server::DamagedBlob);
            EXPECT_FALSE(blobs.has(Kind::asset, kAbcDigest));
        }
        blobs.put(Kind::asset, bytes_of("abc"));
        EXPECT_TRUE(blobs.has(Kind::asset, kAbcDigest));
        EXPECT_EQ(text_of(blobs.read(Kind::asset, kAbcDigest)), "abc");
        EXPECT_EQ(blobs.open(Kind::asset, kAbcDigest)->size(), 3U);
    }
}

TEST(BlobStore, MakesManyBlobsDurableTogether)
{
    const TempFolder folder;
    BlobStore blobs(folder.path());
    std::vector<std::string> digests;
    for (int i = 0; i < 20; ++i)
        digests.push_back(blobs.put(Kind::asset, bytes_of(std::to_string(i)), false));
    digests.push_back("sha256:" + std::string(64, '0')); // was removed meanwhile
    blobs.make_durable(Kind::asset, digests);
    blobs.make_durable(Kind::asset, {digests[0], digests.back()});
    for (int i = 0; i < 20; ++i)
        EXPECT_EQ(text_of(blobs.read(Kind::asset, digests[static_cast<std::size_t>(i)])), std::to_string(i));
}

TEST(BlobStore, RemovesWhatADeathLeftHalfRemoved)
{
    const TempFolder folder;
    {
        BlobStore blobs(folder.path());
        blobs.put(Kind::asset, bytes_of("abc"));
        // As remove() leaves it before it is unlinked.
        std::filesystem::rename(blobs.path(Kind::asset, kAbcDigest),
                                folder.path() / "assets" / ("incoming-" + std::string(kAbcDigest).substr(7)));
    }
    const BlobStore blobs(folder.path());
    EXPECT_FALSE(blobs.has(Kind::asset, kAbcDigest));
    EXPECT_EQ(files_below(folder.path()), 0U);
}

TEST(BlobStore, RemembersTheOrderOfUseOverARestart)
{
    const TempFolder folder;
    std::vector<std::string> digests;
    {
        BlobStore blobs(folder.path());
        for (const char* text : {"1111", "2222", "3333"})
            digests.push_back(blobs.put(Kind::asset, bytes_of(text)));
        timespec times[2] = {{.tv_sec = 1'000'000, .tv_nsec = 5}, {.tv_sec = 1'000'000, .tv_nsec = 5}};
        for (const std::size_t i : {2U, 0U, 1U}) {
            ASSERT_EQ(utimensat(AT_FDCWD, blobs.path(Kind::asset, digests[i]).c_str(), times, 0), 0);
            ++times[1].tv_nsec;
        }
        blobs.touch(Kind::asset, digests[2]); // to the present
    }
    const BlobStore blobs(folder.path());
    EXPECT_EQ(blobs.list(Kind::asset), (std::vector<std::string>{digests[0], digests[1], digests[2]}));
}

TEST(BlobStore, TakesTheSameAndOtherBlobsFromManyThreads)
{
    const TempFolder folder;
    BlobStore blobs(folder.path());
    std::vector<std::thread> threads;
    for (int t = 0; t < 8; ++t)
        threads.emplace_back([&, t] {
            for (int i = 0; i < 10; ++i) {
                const std::string shared = "shared " + std::to_string(i);
                const std::string own = std::to_string(t) + " own " + std::to_string(i);
                EXPECT_EQ(
                    text_of(blobs.read(Kind::result, blobs.put(Kind::result, bytes_of(shared), i % 2 == 0))),
                    shared);
                const std::string digest = blobs.put(Kind::result, bytes_of(own), false);
                EXPECT_EQ(text_of(blobs.read(Kind::result, digest)), own);
                EXPECT_TRUE(blobs.remove(Kind::result, digest));
            }
        });
    for (std::thread& thread : threads)
        thread.join();
    EXPECT_EQ(blobs.list(Kind::result).size(), 10U);
    EXPECT_EQ(blobs.total_bytes(Kind::result), 80U);
    EXPECT_EQ(files_below(folder.path()), 10U);
}

TEST(BlobStore, SaysWhereItCannotBe)
{
    const TempFolder folder;
    folder.write("file", "not a folder");
    try {
        BlobStore blobs(folder.path() / "file");
        FAIL();
    } catch (const StoreError& error) {
        EXPECT_NE(std::string(error.what()).find("file/assets"), std::string::npos) << error.what();
    }
}

} // namespace
