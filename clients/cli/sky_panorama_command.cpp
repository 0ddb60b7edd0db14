#include "clients/cli/files.h"
#include "clients/cli/sky_commands.h"
#include "clients/cli/sky_queries.h"
#include "clients/cli/user_error.h"
#include "renderer/film/develop.h"
#include "renderer/sky/sky_light.h"

#include <cstdio>

namespace clients {

ExitCode sky_panorama_command(const SkyPanoramaOptions& options, const std::stop_token& stop)
{
    const std::string extension = lower_extension(options.output);
    if (extension != ".pfm" && extension != ".png")
        throw UserError(ExitCode::usage, options.output + ": the name must end in .png or .pfm");
    if (options.width < 2 || options.height < 2 || options.width > 32768 || options.height > 32768)
        throw UserError(ExitCode::usage, "a panorama has 2 to 32768 pixels a side");
    check_writable(options.output);
    const renderer::AtmosphereDescription atmosphere = read_atmosphere_file(options.atmosphere);
    renderer::ThreadPool pool(options.threads);
    const renderer::SkyLight light(atmosphere, pool, stop);
    if (stop.stop_requested()) return ExitCode::interrupted;
    renderer::SkyPanorama picture = light.panorama(options.width, options.height, pool);
    renderer::LinearImage image;
    image.width_px = options.width;
    image.height_px = options.height;
    image.pixels = std::move(picture.pixels);
    renderer::ImageSettings settings;
    settings.exposure_ev = options.exposure_ev;
    const std::vector<std::uint8_t> bytes = extension == ".pfm"
                                                ? renderer::encode_pfm(image)
                                                : renderer::encode_png(renderer::develop(image, settings));
    write_file(options.output, std::string_view(reinterpret_cast<const char*>(bytes.data()), bytes.size()));
    return ExitCode::ok;
}

} // namespace clients
