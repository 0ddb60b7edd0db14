#include "clients/cli/local_commands.h"
#include "clients/cli/picture_difference.h"
#include "clients/cli/picture_file.h"
#include "clients/cli/user_error.h"

#include <cstdio>

namespace clients {

ExitCode compare_command(const CompareOptions& options)
{
    const renderer::LinearImage picture = read_picture(options.picture);
    const renderer::LinearImage reference = read_picture(options.reference);
    const auto found = difference(picture, reference);
    if (!found) {
        const auto size = [](const renderer::LinearImage& image) {
            return std::to_string(image.width_px) + 'x' + std::to_string(image.height_px);
        };
        throw UserError(ExitCode::usage,
                        "sizes differ: " + options.picture + " is " + size(picture) + ", " +
                            options.reference + " is " + size(reference));
    }
    std::fputs((options.json ? write_json(*found) : write_text(*found)).c_str(), stdout);
    return ExitCode::ok;
}

} // namespace clients
