#include "clients/cli/exr_file.h"

#include "clients/cli/user_error.h"

#include <array>
#include <tinyexr.h>

namespace clients {
namespace {

constexpr int kLongestSidePx = 32768;

[[noreturn]] void refuse(const std::string& name, const std::string& why)
{
    throw UserError(ExitCode::usage, name + ": " + why);
}

// A file in tinyexr's hands.
class ExrFile {
public:
    ExrFile(std::string_view bytes, const std::string& name) : bytes_(bytes), name_(name)
    {
        InitEXRHeader(&header_);
        InitEXRImage(&image_);
    }
    ~ExrFile()
    {
        FreeEXRImage(&image_);
        FreeEXRHeader(&header_);
    }
    ExrFile(const ExrFile&) = delete;
    ExrFile& operator=(const ExrFile&) = delete;

    void read()
    {
        EXRVersion version;
        if (ParseEXRVersionFromMemory(&version, data(), bytes_.size()) != TINYEXR_SUCCESS)
            refuse(name_, "not a readable EXR file");
        if (version.multipart != 0 || version.non_image != 0)
            refuse(name_, "an EXR file of many parts or of deep samples");
        const char* error = nullptr;
        if (ParseEXRHeaderFromMemory(&header_, &version, data(), bytes_.size(), &error) != TINYEXR_SUCCESS)
            fail(error);
        const EXRBox2i& window = header_.data_window;
        const long long width = 1LL + window.max_x - window.min_x, height = 1LL + window.max_y - window.min_y;
        if (width < 1 || height < 1 || width > kLongestSidePx || height > kLongestSidePx)
            refuse(name_, "a side of the picture is 0 or over 32768 pixels");
        if (header_.tiled != 0) refuse(name_, "an EXR file of tiles: only scan lines are read");
        for (int c = 0; c < header_.num_channels; ++c)
            if (header_.pixel_types[c] == TINYEXR_PIXELTYPE_HALF)
                header_.requested_pixel_types[c] = TINYEXR_PIXELTYPE_FLOAT;
        if (LoadEXRImageFromMemory(&image_, &header_, data(), bytes_.size(), &error) != TINYEXR_SUCCESS)
            fail(error);
    }

    renderer::LinearImage picture() const
    {
        std::array<const float*, 3> channels{channel("R"), channel("G"), channel("B")};
        if (const float* grey = channel("Y"); grey && !channels[0]) channels = {grey, grey, grey};
        if (!channels[0] || !channels[1] || !channels[2])
            refuse(name_, "the EXR file has neither the channels R, G and B nor Y");
        renderer::LinearImage picture{
            static_cast<std::uint32_t>(image_.width), static_cast<std::uint32_t>(image_.height), {}};
        picture.pixels.resize(std::size_t{picture.width_px} * picture.height_px);
        for (std::size_t i = 0; i < picture.pixels.size(); ++i)
            picture.pixels[i] = {channels[0][i], channels[1][i], channels[2][i]};
        return picture;
    }

private:
    const unsigned char* data() const { return reinterpret_cast<const unsigned char*>(bytes_.data()); }

    [[noreturn]] void fail(const char* error) const
    {
        const std::string why = error != nullptr ? error : "unknown error";
        if (error != nullptr) FreeEXRErrorMessage(error);
        refuse(name_, "not a readable EXR file: " + why.substr(0, why.find('\n')));
    }

    // Null if there is none of floats.
    const float* channel(std::string_view name) const
    {
        for (int c = 0; c < header_.num_channels; ++c)
            if (name == header_.channels[c].name &&
                header_.requested_pixel_types[c] == TINYEXR_PIXELTYPE_FLOAT)
                return reinterpret_cast<const float*>(image_.images[c]);
        return nullptr;
    }

    std::string_view bytes_;
    const std::string& name_;
    EXRHeader header_;
    EXRImage image_;
};

} // namespace

bool is_exr(std::string_view bytes)
{
    return bytes.starts_with("\x76\x2f\x31\x01");
}

renderer::LinearImage read_exr(std::string_view bytes, const std::string& name)
{
    ExrFile file(bytes, name);
    file.read();
    return file.picture();
}

} // namespace clients
