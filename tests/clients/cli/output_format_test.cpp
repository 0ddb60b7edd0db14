#include "clients/cli/output_format.h"
#include "clients/cli/user_error.h"

#include <gtest/gtest.h>

namespace {

using clients::encoding_of;
using clients::UserError;
using renderer::PictureEncoding;
using renderer::PictureFormat;

TEST(OutputFormat, FollowsTheExtension)
{
    EXPECT_EQ(encoding_of("a.png", {}), (PictureEncoding{PictureFormat::png, 8}));
    EXPECT_EQ(encoding_of("folder.exr/a.PNG", 16), (PictureEncoding{PictureFormat::png, 16}));
    EXPECT_EQ(encoding_of("a.jpeg", {}), (PictureEncoding{PictureFormat::jpeg, 8}));
    EXPECT_EQ(encoding_of("a.b.hdr", 8), (PictureEncoding{PictureFormat::hdr, 8}));
    EXPECT_EQ(encoding_of("a.exr", {}), (PictureEncoding{PictureFormat::exr, 8}));
    EXPECT_EQ(encoding_of("a.pfm", {}), (PictureEncoding{PictureFormat::pfm, 8}));
    EXPECT_EQ(encoding_of("-", {}), (PictureEncoding{PictureFormat::png, 8}));
    EXPECT_EQ(encoding_of("-", 16), (PictureEncoding{PictureFormat::png, 16}));
}

TEST(OutputFormat, RefusesWhatItDoesNotKnow)
{
    for (const char* name : {"a", "a.gif", ".png/a", ""})
        EXPECT_THROW(encoding_of(name, {}), UserError) << name;
    EXPECT_THROW(encoding_of("a.jpg", 16), UserError);
    EXPECT_THROW(encoding_of("a.exr", 16), UserError);
}

} // namespace
