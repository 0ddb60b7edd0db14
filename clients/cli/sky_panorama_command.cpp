#include "clients/cli/files.h"
#include "clients/cli/output_format.h"
#include "clients/cli/sky_commands.h"
#include "clients/cli/sky_queries.h"
#include "clients/cli/user_error.h"
#include "renderer/film/encode_picture.h"
#include "renderer/sky/sky_light.h"

#include <cstdio>

namespace clients {

ExitCode sky_panorama_command(const SkyPanoramaOptions& options, const std::stop_token& stop)
{
    const renderer::PictureEncoding encoding = encoding_of(options.output, {});
    if (options.width < 2 || options.height < 2 || options.width > 32768 || options.height > 32768)
        throw UserError(ExitCode::usage, "a panorama has 2 to 32768 pixels a side");
    check_writable(options.output);
    const renderer::AtmosphereDescription atmosphere = read_atmosphere_file(options.atmosphere);
    renderer::ThreadPool pool(options.threads);
    const renderer::SkyLight light(atmosphere, pool, stop);
    if (stop.stop_requested()) return ExitCode::interrupted;
    renderer::SkyPanorama panorama = light.panorama(options.width, options.height, pool);
    renderer::Picture picture;
    picture.image = {options.width, options.height, std::move(panorama.pixels)};
    picture.exposure_ev = options.exposure_ev;
    const std::vector<std::uint8_t> bytes = renderer::encode_picture(picture, encoding);
    write_file(options.output, std::string_view(reinterpret_cast<const char*>(bytes.data()), bytes.size()));
    return ExitCode::ok;
}

} // namespace clients
