#include "server/import/import_cache.h"

#include <gtest/gtest.h>

namespace {

using server::ImportCache;
using server::KnownImport;

std::shared_ptr<const renderer::PreparedMesh> prepared(std::size_t triangles = 1)
{
    renderer::Mesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    mesh.triangles.assign(triangles, {0, 1, 2});
    renderer::ThreadPool pool(1);
    return prepare_mesh(std::move(mesh), renderer::MeshTree::wide_sah, pool);
}

KnownImport known(const std::string& main, const server::NamedDigests& answers = {}, bool with_mesh = true)
{
    KnownImport entry{main, answers, {}, api::AssetInfo::MeshInfo{}, {}, {}};
    if (with_mesh) entry.prepared[0] = prepared();
    return entry;
}

TEST(ImportCache, FindsWhatWouldImportTheSameWay)
{
    ImportCache cache(1 << 20);
    cache.store(known("main", {{"a.mtl", "sha256:a"}, {"b.mtl", ""}}));
    EXPECT_TRUE(cache.find("main", {{"a.mtl", "sha256:a"}}));
    EXPECT_TRUE(cache.find("main", {{"a.mtl", "sha256:a"}, {"unused.png", "sha256:u"}}));
    EXPECT_FALSE(cache.find("main", {{"a.mtl", "sha256:other"}}));
    EXPECT_FALSE(cache.find("main", {})); // a.mtl would not be there now
    EXPECT_FALSE(
        cache.find("main", {{"a.mtl", "sha256:a"}, {"b.mtl", "sha256:b"}})); // b.mtl was not there then
    EXPECT_FALSE(cache.find("other", {{"a.mtl", "sha256:a"}}));
}

TEST(ImportCache, DropsTheMeshesThatWereUsedLongestAgo)
{
    const std::uint64_t each = size_bytes(*prepared());
    ImportCache cache(2 * each);
    cache.store(known("a"));
    cache.store(known("b"));
    EXPECT_EQ(cache.bytes(), 2 * each);
    ASSERT_TRUE(cache.find("a", {}));
    cache.store(known("c"));
    EXPECT_EQ(cache.bytes(), 2 * each);
    EXPECT_TRUE(cache.peek("a", {})->prepared[0]);
    EXPECT_FALSE(cache.peek("b", {})->prepared[0]);
    EXPECT_TRUE(cache.peek("b", {})->figures); // figures stay
    EXPECT_TRUE(cache.peek("c", {})->prepared[0]);
}

TEST(ImportCache, KeepsNoMeshThatIsLargerThanAllOfIt)
{
    ImportCache cache(10);
    cache.store(known("a"));
    EXPECT_EQ(cache.bytes(), 0u);
    EXPECT_FALSE(cache.find("a", {})->prepared[0]);
}

TEST(ImportCache, AddsAnotherSplitToTheSameEntry)
{
    ImportCache cache(1 << 20);
    cache.store(known("a"));
    KnownImport midpoint = known("a", {}, false);
    midpoint.prepared[1] = prepared();
    cache.store(std::move(midpoint));
    EXPECT_TRUE(cache.find("a", {})->prepared[0]);
    EXPECT_TRUE(cache.find("a", {})->prepared[1]);
    EXPECT_EQ(cache.bytes(), 2 * size_bytes(*prepared()));
}

TEST(ImportCache, ForgetsTheOldestOfVeryManyEntries)
{
    ImportCache cache(1 << 20);
    for (int i = 0; i < 10'001; ++i)
        cache.store(known(std::to_string(i), {}, false));
    EXPECT_FALSE(cache.find("0", {}));
    EXPECT_TRUE(cache.find("1", {}));
    EXPECT_TRUE(cache.find("10000", {}));
}

} // namespace
