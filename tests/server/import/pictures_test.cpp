// Pictures through the importer's child: decoded there, checked here, kept in memory, told by /info.
#include "server/import/flat_mesh.h"
#include "server/import/import_service.h"
#include "tests/support/places.h"
#include "tests/support/temp_folder.h"

#include <gtest/gtest.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>

namespace {

namespace fs = std::filesystem;
using server::BlobStore;
using server::ImportedPixels;
using server::ImportFailure;

std::string asset(const std::string& name)
{
    std::ifstream file(fs::path(tests::asset_dir()) / "images" / name, std::ios::binary);
    EXPECT_TRUE(file) << name;
    return {std::istreambuf_iterator<char>(file), {}};
}

class Pictures : public testing::Test {
protected:
    std::string put(const std::string& bytes)
    {
        return blobs_.put(BlobStore::Kind::asset, std::as_bytes(std::span(bytes)));
    }
    std::string code(const std::string& name, const std::string& digest)
    {
        const auto result = imports_.picture(name, digest, {});
        const auto* failure = std::get_if<ImportFailure>(&result);
        return failure != nullptr ? failure->code : "ok";
    }

    tests::TempFolder folder_;
    BlobStore blobs_{folder_.path() / "blobs"};
    renderer::Limits limits_;
    server::Log log_{server::LogLevel::error};
    server::ImportService imports_{fs::path(tests::bin_dir()) / "heliograph-import", blobs_, limits_, log_};
    renderer::ThreadPool pool_{1};
};

TEST_F(Pictures, AreDecodedOnceAndKept)
{
    const std::string digest = put(asset("rgba.png"));
    const auto first = imports_.picture("a.png", digest, {}),
               second = imports_.picture("b/c.png", digest, {});
    const auto& pixels = std::get<ImportedPixels>(first);
    ASSERT_TRUE(pixels);
    EXPECT_EQ(pixels->width, 5u);
    EXPECT_EQ(pixels->height, 4u);
    EXPECT_EQ(pixels->channels, 4u);
    EXPECT_EQ(pixels->bytes[0], std::byte{5});
    EXPECT_EQ(pixels, std::get<ImportedPixels>(second));
    EXPECT_EQ(imports_.imports_run(), 1u);
    EXPECT_EQ(imports_.cached_bytes(), 5u * 4 * 4);
}

TEST_F(Pictures, ComeThroughInEveryForm)
{
    for (const char* name : {"grey.png", "rgb_16.png", "rgb.jpg", "light.hdr", "rgb.tga"})
        EXPECT_EQ(code(name, put(asset(name))), "ok") << name;
}

TEST_F(Pictures, TellTheFaultOfABrokenOneAndRememberIt)
{
    std::istringstream manifest(asset("broken/manifest.tsv"));
    std::string line;
    for (int i = 0; i < 8 && std::getline(manifest, line); ++i) { // all of them: import_image_test.cpp
        const std::string name = line.substr(0, line.find('\t'));
        const std::string rest = line.substr(name.size() + 1);
        if (asset("broken/" + name).empty()) continue; // the store has no empty blobs to hand over
        EXPECT_EQ(code(name, put(asset("broken/" + name))), rest.substr(0, rest.find('\t'))) << line;
    }
    const std::string digest = put(asset("broken/animated.gif"));
    EXPECT_EQ(code("a.gif", digest), "unsupported");
    const std::uint64_t runs = imports_.imports_run();
    EXPECT_EQ(code("a.gif", digest), "unsupported");
    EXPECT_EQ(imports_.imports_run(), runs);
    const auto known = imports_.known_failure({"a.gif", digest, {}, true});
    ASSERT_TRUE(std::holds_alternative<ImportFailure>(known));
}

TEST_F(Pictures, AreNoMeshes)
{
    const std::string digest = put(asset("rgb.png"));
    const auto mesh = imports_.import({"a.obj", digest, {}}, pool_, {});
    ASSERT_TRUE(std::holds_alternative<ImportFailure>(mesh));
    EXPECT_EQ(std::get<ImportFailure>(mesh).code, "not_a_mesh");
    EXPECT_EQ(code("a.png", digest), "ok"); // all the same
}

TEST_F(Pictures, AreNotMadeOfMeshes)
{
    EXPECT_EQ(code("a.png", put("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")), "unknown_format");
}

TEST_F(Pictures, AreToldByInfo)
{
    const auto info = imports_.info(put(asset("rgb_16.png")), {});
    ASSERT_TRUE(info && info->image);
    EXPECT_FALSE(info->mesh);
    EXPECT_FALSE(info->fault);
    EXPECT_EQ(info->image->format, "png");
    EXPECT_EQ(info->image->width, 5u);
    EXPECT_EQ(info->image->channels, 3u);
    EXPECT_EQ(info->image->bits, 16u);
    const auto broken = imports_.info(put(asset("broken/animated.gif")), {});
    ASSERT_TRUE(broken && broken->fault);
    EXPECT_EQ(broken->fault->code, "unsupported");
    const auto tga = imports_.info(put(asset("rgb.tga")), {});
    ASSERT_TRUE(tga && tga->image);
    EXPECT_EQ(tga->image->format, "tga");
}

server::ImportedPicture picture()
{
    server::ImportedPicture made{{3, 2, 1, renderer::PixelType::whole_8, {}}, "png"};
    for (int i = 0; i < 6; ++i)
        made.image.bytes.push_back(static_cast<std::byte>(i));
    return made;
}

std::vector<std::byte> flat_of(const server::ImportOutcome& outcome)
{
    std::vector<std::byte> bytes;
    write_flat(outcome,
               [&](std::span<const std::byte> more) { bytes.insert(bytes.end(), more.begin(), more.end()); });
    return bytes;
}

server::ImportOutcome read(const std::vector<std::byte>& bytes, const renderer::Limits& limits = {})
{
    const auto kept = std::make_shared<const std::vector<std::byte>>(bytes);
    return server::read_flat({*kept, kept}, limits);
}

TEST(FlatPicture, GivesBackWhatWasWritten)
{
    const auto back = read(flat_of(picture()));
    const auto* found = std::get_if<server::ImportedPicture>(&back);
    ASSERT_NE(found, nullptr);
    EXPECT_EQ(found->format, "png");
    EXPECT_EQ(found->image.bytes, picture().image.bytes);
    EXPECT_TRUE(found->image.bytes.is_lent());
}

TEST(FlatPicture, IsRefusedWhereAnyByteMakesItUnsound)
{
    const std::vector<std::byte> whole = flat_of(picture());
    for (std::size_t size = 0; size < whole.size(); ++size)
        EXPECT_TRUE(std::holds_alternative<ImportFailure>(
            read({whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size)})))
            << size;
    for (std::size_t at = 0; at < whole.size(); ++at)
        for (const int bit : {0, 3, 7}) {
            std::vector<std::byte> bytes = whole;
            bytes[at] ^= static_cast<std::byte>(1 << bit);
            const auto outcome = read(bytes);
            if (const auto* found = std::get_if<server::ImportedPicture>(&outcome)) {
                EXPECT_EQ(renderer::validate_image(found->image), std::nullopt) << at;
            }
        }
}

TEST(FlatPicture, HoldsTheLimitOfPixels)
{
    renderer::Limits limits;
    limits.texture_pixels = 5;
    const auto outcome = read(flat_of(picture()), limits);
    ASSERT_TRUE(std::holds_alternative<ImportFailure>(outcome));
    EXPECT_EQ(std::get<ImportFailure>(outcome).code, "over_limit");
}

} // namespace
