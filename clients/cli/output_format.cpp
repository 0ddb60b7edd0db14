#include "clients/cli/output_format.h"

#include "clients/cli/files.h"
#include "clients/cli/user_error.h"

namespace clients {

renderer::PictureEncoding encoding_of(const std::string& output, std::optional<std::uint32_t> bits)
{
    const renderer::PictureFormatEntry* entry =
        output == "-" ? &entry_of(renderer::PictureFormat::png)
                      : renderer::find_picture_extension(lower_extension(output));
    if (!entry)
        throw UserError(ExitCode::usage,
                        output + ": the name's end tells the format: " + renderer::picture_extensions());
    if (bits && *bits == 16 && entry->format != renderer::PictureFormat::png)
        throw UserError(ExitCode::usage, output + ": --bits 16 is for PNG; other formats have one depth");
    return {entry->format, static_cast<std::uint8_t>(bits.value_or(8))};
}

} // namespace clients
